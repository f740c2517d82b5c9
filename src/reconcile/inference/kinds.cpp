#include "reconcile/inference/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "effects/catalogue.hpp"

namespace pirsim::reconcile {

using effects::ParameterInfo;
using effects::Scale;

double to_flat(const ParameterInfo& info, double value) {
  const double within = std::clamp(value, info.low, info.high);
  return info.scale == Scale::logarithmic ? std::log(within) : within;
}

double from_flat(const ParameterInfo& info, double value) {
  const double natural = info.scale == Scale::logarithmic ? std::exp(value) : value;
  const double rounded = info.scale == Scale::whole ? std::round(natural) : natural;
  return std::clamp(rounded, info.least, info.most);
}

namespace {

constexpr std::size_t fewest_in_part = 10;  ///< 10 and 20 were tried: no difference
constexpr std::size_t most_parts = 3;       ///< by strength; 1, 2 and 3 were tried: 3 part the hypotheses best

/// What isn't a matter of more or less: choices, and for each strength on which side of `off` it lies.
using ChoicesAndSides = std::pair<std::map<std::string, std::string, std::less<>>, std::vector<int>>;

ChoicesAndSides kind_of(const EffectSpec& effect) {
  ChoicesAndSides kind{effect.choices, {}};
  for (const effects::ParameterInfo& info : effects::find(effect.name).info.parameters) {
    if (info.role != effects::Role::strength || !effects::applies(info, effect)) continue;
    const double value = effect.parameters.at(info.name);
    kind.second.push_back(value > info.off ? 1 : value < info.off ? -1 : 0);
  }
  return kind;
}

double strength_of(const EffectSpec& effect) {
  const effects::ParameterInfo& strength = effects::strength_parameter(effect);
  return to_flat(strength, effect.parameters.at(strength.name));
}

}  // namespace

std::vector<int> number_alike(const ReferenceTable& table, std::span<const std::size_t> rows, std::size_t fewest) {
  if (rows.empty() || table.rows[rows.front()].hypothesis == 0) return std::vector<int>(rows.size(), 0);
  std::map<ChoicesAndSides, std::vector<std::pair<double, std::size_t>>> by_kind;  // strength and place of each
  for (std::size_t place = 0; place < rows.size(); ++place) {
    const EffectSpec& drawn = table.rows[rows[place]].effects.front();
    by_kind[kind_of(drawn)].emplace_back(strength_of(drawn), place);
  }
  std::vector<int> numbers(rows.size(), 0);
  const bool any_small = std::ranges::any_of(by_kind, [&](const auto& k) { return k.second.size() < fewest; });
  int next = any_small ? 1 : 0;  // 0: all those of kinds with few datasets
  for (auto& [kind, members] : by_kind) {
    if (members.size() < fewest) continue;
    std::ranges::sort(members);
    const bool varies = members.front().first < members.back().first;
    const std::size_t parts = varies ? std::clamp<std::size_t>(members.size() / fewest_in_part, 1, most_parts) : 1;
    for (std::size_t i = 0; i < members.size(); ++i)
      numbers[members[i].second] = next + static_cast<int>(i * parts / members.size());
    next += static_cast<int>(parts);
  }
  return numbers;
}

KindFinder::KindFinder(const ReferenceTable& table, std::span<const std::size_t> rows,
                       const stats::Matrix<float>& features) {
  const std::vector<int> numbers = number_alike(table, rows, 1);
  const int n_kinds = numbers.empty() ? 0 : std::ranges::max(numbers) + 1;
  for (int kind = 0; kind < n_kinds; ++kind) {
    examples_.push_back(static_cast<std::size_t>(std::ranges::find(numbers, kind) - numbers.begin()));
    n_.push_back(static_cast<double>(std::ranges::count(numbers, kind)));
  }
  if (n_kinds > 1) discriminant_ = stats::Discriminant::fit(features, numbers, n_kinds);
}

std::size_t KindFinder::one_like(std::span<const float> features) const {
  if (examples_.size() < 2) return examples_.at(0);
  const std::vector<double> densities = discriminant_.log_densities(features);
  return examples_[static_cast<std::size_t>(std::ranges::max_element(densities) - densities.begin())];
}

std::vector<KindFinder::Share> KindFinder::shares(std::span<const float> features) const {
  if (examples_.size() < 2) return {{examples_.at(0), 1.0}};
  std::vector<double> logs = discriminant_.log_densities(features);
  for (std::size_t i = 0; i < logs.size(); ++i) logs[i] += std::log(n_[i]);
  const double highest = std::ranges::max(logs);
  double sum = 0.0;
  std::vector<Share> shares;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    shares.push_back({examples_[i], std::exp(logs[i] - highest)});
    sum += shares.back().probability;
  }
  for (Share& share : shares) share.probability /= sum;
  return shares;
}

}  // namespace pirsim::reconcile
