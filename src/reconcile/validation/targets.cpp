#include "reconcile/validation/targets.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "effects/catalogue.hpp"

namespace pirsim::reconcile {
namespace {

Reached reached(const Target& target, const Rate& rate) {
  if (rate.of == 0) return Reached::not_tested;
  const auto within = [&](double share) { return target.at_least <= share && share <= target.at_most; };
  const bool all = within(rate.interval.low) && within(rate.interval.high);
  const bool any = rate.interval.high >= target.at_least && rate.interval.low <= target.at_most;
  if (within(rate.value())) return all ? Reached::yes : Reached::probably;
  return any ? Reached::hardly : Reached::no;
}

bool names_other(const std::string& effect, const std::string& other) {
  const std::vector<std::string>& names = effects::find(effect).info.confused_with;
  return std::ranges::find(names, other) != names.end();
}

const std::string& fingerprint_of(const std::string& effect) { return effects::find(effect).info.fingerprint; }

}  // namespace

std::vector<Target> targets(Geometry geometry) {
  return {{Counted::alarm_on_nothing, 0.0, 0.05},
          {Counted::name_on_nothing, 0.0, 0.01},
          {Counted::exact_name, geometry == Geometry::known ? 0.93 : 0.82, 1.0},
          {Counted::right_family, 0.92, 1.0},
          {Counted::wrong_name, 0.0, 0.01},
          {Counted::truth_in_set, 0.95, 1.0},
          {Counted::parameters_covered, 0.87, 0.93},
          {Counted::most_closed, 0.50, 1.0},  // a median share of 0.90
          {Counted::shrunk_on_nothing, 0.0, 0.05},
          {Counted::out_of_catalogue_none, 0.80, 1.0},
          {Counted::out_of_catalogue_named, 0.0, 0.10},
          {Counted::told_left_out_none, 0.70, 1.0},
          {Counted::left_out_named, 0.0, 0.12},
          {Counted::left_out_named_outside, 0.0, 0.05},
          {Counted::variant_named, 0.85, 1.0},
          {Counted::motion_as_sensor, 0.0, 0.03}};
}

std::vector<TargetResult> compare_with_targets(const SelftestResult& result, Geometry geometry) {
  const std::vector<Rate> rates = rates_of(result);
  std::vector<TargetResult> results;
  for (const Target& target : targets(geometry)) {
    TargetResult one{target, {target.rate, 0, 0, {0.0, 1.0}, Strength::none}, Reached::not_tested};
    const auto rate = std::ranges::find(rates, target.rate, &Rate::what);
    if (rate != rates.end()) one.rate = *rate;
    one.reached = reached(target, one.rate);
    results.push_back(std::move(one));
  }
  return results;
}

std::vector<ConfusedPair> confused_pairs(const SelftestResult& result, double least_share) {
  std::map<std::string, std::size_t> cases;
  std::map<std::pair<std::string, std::string>, std::size_t> taken;  // in alphabetical order
  for (const InjectedCase& c : result.cases) {
    if (c.kind != CaseKind::one || !c.seen()) continue;
    ++cases[c.truth];
    if (c.likeliest != c.truth && c.likeliest != "nothing") ++taken[std::minmax(c.truth, c.likeliest)];
  }
  constexpr std::size_t fewest_cases = 3;
  std::vector<ConfusedPair> pairs;
  for (const auto& [names, hits] : taken) {
    const auto& [a, b] = names;
    Rate rate{Counted::confused, hits, cases[a] + cases[b], {}, Strength::none};
    if (hits < fewest_cases || rate.value() < least_share) continue;
    rate.interval = stats::clopper_pearson(rate.hits, rate.of);
    pairs.push_back(
        {a, b, std::move(rate), names_other(a, b) || names_other(b, a), fingerprint_of(a), fingerprint_of(b)});
  }
  std::ranges::stable_sort(pairs, std::ranges::greater{}, [](const ConfusedPair& pair) { return pair.rate.value(); });
  return pairs;
}

}  // namespace pirsim::reconcile
