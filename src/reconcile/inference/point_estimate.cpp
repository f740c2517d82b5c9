#include "reconcile/inference/point_estimate.hpp"

#include <algorithm>

#include "reconcile/inference/flat_scale.hpp"

namespace pirsim::reconcile {
namespace {

using effects::ParameterInfo;
using effects::Role;

constexpr std::size_t fewest_own = 20;  ///< assumed: an estimate learnt from fewer datasets is worse than one from all

stats::Matrix<double> in_double(const stats::Matrix<float>& narrow) {
  stats::Matrix<double> wide(narrow.rows(), narrow.columns());
  std::ranges::copy(narrow.values(), wide.values().begin());
  return wide;
}

std::vector<const EffectSpec*> drawn_in(const ReferenceTable& table, std::span<const std::size_t> rows) {
  std::vector<const EffectSpec*> drawn;
  for (const std::size_t row : rows) drawn.push_back(&table.rows[row].effects.front());
  return drawn;
}

/// Of one that doesn't apply: what is usual.
double flat_value(const ParameterInfo& info, const EffectSpec& drawn) {
  const auto value = drawn.parameters.find(info.name);
  return to_flat(info, value == drawn.parameters.end() ? info.typical : value->second);
}

/// (n x n_parameters) flat
stats::Matrix<double> parameters_of(const std::vector<const EffectSpec*>& drawn,
                                    const std::vector<const ParameterInfo*>& infos) {
  stats::Matrix<double> parameters(drawn.size(), infos.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    for (std::size_t p = 0; p < infos.size(); ++p) parameters(i, p) = flat_value(*infos[p], *drawn[i]);
  }
  return parameters;
}

}  // namespace

PointEstimator::PointEstimator(const ReferenceTable& table, std::size_t hypothesis, const HypothesisDatasets& training,
                               const HypothesisDatasets& held_back)
    : drawn_(drawn_in(table, training.rows)), finder_(table, training.rows, training.features) {
  for (const ParameterInfo& info : effects::find(table.hypothesis_name(hypothesis)).info.parameters) {
    if (info.low < info.high) infos_.push_back(&info);
  }
  if (infos_.empty()) return;
  const stats::Matrix<double> features = in_double(training.features), parameters = parameters_of(drawn_, infos_);
  std::map<Choices, std::vector<std::size_t>> rows_of;
  for (std::size_t i = 0; i < drawn_.size(); ++i) rows_of[drawn_[i]->choices].push_back(i);
  const std::size_t n = infos_.size();
  stats::Matrix<double> targets(drawn_.size(), rows_of.size() * n);
  for (const auto& [choices, rows] : rows_of) {
    Alike& alike = alike_[choices];
    alike.number = alike_.size() - 1;
    if (rows.size() >= fewest_own)
      alike.from_own = stats::ParameterEstimator::fit(features.select_rows(rows), parameters.select_rows(rows));
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
      for (std::size_t p = 0; p < n; ++p) {
        const bool acts = drawn_[i]->choices == choices || infos_[p]->role != Role::strength;
        targets(i, alike.number * n + p) = acts ? parameters(i, p) : to_flat(*infos_[p], infos_[p]->off);
      }
    }
  }
  from_all_ = stats::ParameterEstimator::fit(features, targets);
  held_back_ = drawn_in(table, held_back.rows);
  parameters_ = parameters_of(held_back_, infos_);
  for (std::size_t i = 0; i < held_back.rows.size(); ++i)
    estimates_.append_row(std::span<const double>(of(held_back.features.row(i))));
}

std::vector<Interval> PointEstimator::bounds() const {
  std::vector<Interval> bounds;
  for (const ParameterInfo* info : infos_) bounds.push_back({to_flat(*info, info->low), to_flat(*info, info->high)});
  return bounds;
}

std::vector<std::size_t> PointEstimator::rows_like(const EffectSpec& kind) const {
  const auto is_like = [&](const EffectSpec* drawn) {
    return std::ranges::all_of(infos_, [&](auto* info) { return applies(*info, *drawn) == applies(*info, kind); });
  };
  std::vector<std::size_t> rows, all;
  for (std::size_t row = 0; row < held_back_.size(); ++row) {
    all.push_back(row);
    if (is_like(held_back_[row])) rows.push_back(row);
  }
  return rows.size() < fewest_own ? all : rows;
}

const EffectSpec& PointEstimator::kind_of(std::span<const float> features) const {
  return *drawn_[finder_.one_like(features)];
}

std::vector<FittedChoice> PointEstimator::choices_of(std::span<const float> features) const {
  std::map<std::string, std::map<std::string, double>> probabilities;  // of each choice's words
  const std::vector<KindFinder::Share> shares = finder_.shares(features);
  for (const KindFinder::Share& share : shares) {
    for (const auto& [name, word] : drawn_[share.example]->choices) probabilities[name];
  }
  for (const KindFinder::Share& share : shares) {
    const Choices& choices = drawn_[share.example]->choices;
    for (auto& [name, words] : probabilities) {
      const auto made = choices.find(name);
      words[made == choices.end() ? "" : made->second] += share.probability;
    }
  }
  std::vector<FittedChoice> fitted;
  for (const auto& [name, words] : probabilities) {
    FittedChoice& choice = fitted.emplace_back(FittedChoice{name, {}});
    for (const auto& [word, probability] : words) choice.words.push_back({word, probability});
    std::ranges::stable_sort(choice.words, std::ranges::greater{}, &FittedChoice::Word::probability);
  }
  return fitted;
}

std::vector<double> PointEstimator::of(std::span<const float> features) const {
  const std::vector<double> wide(features.begin(), features.end());
  const Alike& alike = alike_.at(kind_of(features).choices);
  const std::vector<double> all = from_all_.estimate(wide);
  const auto own = all.begin() + static_cast<std::ptrdiff_t>(alike.number * infos_.size());
  std::vector<double> estimates(own, own + static_cast<std::ptrdiff_t>(infos_.size()));
  if (alike_.size() == 1) return estimates;
  const std::vector<double> more = alike.from_own ? alike.from_own->estimate(wide) : estimates;
  estimates.insert(estimates.end(), more.begin(), more.end());
  return estimates;
}

}  // namespace pirsim::reconcile
