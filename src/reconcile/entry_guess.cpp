#include "reconcile/entry_guess.hpp"

#include <algorithm>
#include <cmath>

namespace pirsim::reconcile {
namespace {

using effects::ParameterInfo;
using effects::Scale;

stats::Matrix<double> in_double(const stats::Matrix<float>& narrow) {
  stats::Matrix<double> wide(narrow.rows(), narrow.columns());
  std::ranges::copy(narrow.values(), wide.values().begin());
  return wide;
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

EntryGuess::EntryGuess(const ReferenceTable& table, std::size_t entry, const EntryDatasets& training,
                       const EntryDatasets& held_back) {
  for (const ParameterInfo& info : effects::find(table.entry_name(entry)).info.parameters) {
    if (info.low < info.high) infos_.push_back(&info);
  }
  if (infos_.empty()) return;
  guess_ = stats::ParameterGuess::fit(in_double(training.features), parameters_of(table, training.rows, infos_));
  parameters_ = parameters_of(table, held_back.rows, infos_);
  guesses_ = guess_.guess(in_double(held_back.features));
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
