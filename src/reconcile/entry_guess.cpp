#include "reconcile/entry_guess.hpp"

#include <algorithm>
#include <cmath>

#include "pirsim/reconcile/locate.hpp"

namespace pirsim::reconcile {
namespace {

using effects::ParameterInfo;
using effects::Scale;

stats::Matrix<double> features_of(const ReferenceTable& table, const FeatureMap& map, std::span<const std::size_t> rows,
                                  unsigned threads) {
  const stats::Matrix<float> narrow = map.features(table.statistics.select_rows(rows), threads);
  stats::Matrix<double> features(narrow.rows(), narrow.columns());
  std::ranges::copy(narrow.values(), features.values().begin());
  return features;
}

stats::Matrix<double> parameters_of(const ReferenceTable& table, std::span<const std::size_t> rows,
                                    const std::vector<const ParameterInfo*>& infos) {
  stats::Matrix<double> parameters(rows.size(), infos.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t p = 0; p < infos.size(); ++p)
      parameters(i, p) = to_flat(*infos[p], table.rows[rows[i]].effects.front().parameters.at(infos[p]->name));
  }
  return parameters;
}

}  // namespace

double to_flat(const ParameterInfo& info, double value) {
  return info.scale == Scale::logarithmic ? std::log(value) : value;
}

double from_flat(const ParameterInfo& info, double value) {
  const double natural = info.scale == Scale::logarithmic ? std::exp(value) : value;
  const double rounded = info.scale == Scale::whole ? std::round(natural) : natural;
  return std::clamp(rounded, info.least, info.most);
}

EntryGuess::EntryGuess(const ReferenceTable& table, const FeatureMap& map, std::size_t entry,
                       std::span<const std::size_t> held_back, unsigned threads) {
  for (const ParameterInfo& info : effects::find(table.entry_name(entry)).info.parameters) {
    if (info.low < info.high) infos_.push_back(&info);
  }
  if (infos_.empty()) return;
  const std::vector<std::size_t> training = rows_of(table, entry, Part::training);
  guess_ =
      stats::ParameterGuess::fit(features_of(table, map, training, threads), parameters_of(table, training, infos_));
  parameters_ = parameters_of(table, held_back, infos_);
  guesses_ = guess_.guess(features_of(table, map, held_back, threads));
}

std::vector<stats::Interval> EntryGuess::bounds() const {
  std::vector<stats::Interval> bounds;
  for (const ParameterInfo* info : infos_) bounds.push_back({to_flat(*info, info->low), to_flat(*info, info->high)});
  return bounds;
}

std::vector<double> EntryGuess::of(std::span<const float> features) const {
  return guess_.guess(std::vector<double>(features.begin(), features.end()));
}

}  // namespace pirsim::reconcile
