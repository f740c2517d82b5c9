#include "reconcile/validation/targets.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <utility>

#include "effects/catalogue.hpp"
#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {
namespace {

std::string bounds_of(const Target& target) {
  if (target.at_least > 0.0 && target.at_most < 1.0) {
    return fixed(target.at_least, 2) + " to " + fixed(target.at_most, 2);
  }
  return target.at_least > 0.0 ? "at least " + fixed(target.at_least, 2) : "at most " + fixed(target.at_most, 2);
}

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
  return {{"a disagreement although nothing is hidden", 0.0, 0.05},
          {"a name although nothing is hidden", 0.0, 0.01},
          {"exactly the right name, given a disagreement", geometry == Geometry::known ? 0.93 : 0.82, 1.0},
          {"the right family, given a disagreement", 0.92, 1.0},
          {"one wrong name", 0.0, 0.01},
          {"the truth in the set, given a disagreement", 0.95, 1.0},
          {"parameters within their 90 % intervals", 0.87, 0.93},
          {"nine tenths of what can be closed, given the right name", 0.50, 1.0},  // a median share of 0.90
          {"a gap that shrunk although nothing is hidden", 0.0, 0.05},
          {"an out-of-catalogue fault: called none in the catalogue, given a disagreement", 0.80, 1.0},
          {"an out-of-catalogue fault: called by one name", 0.0, 0.10},
          {"an effect that the catalogue lacks: called none in the catalogue, given a disagreement", 0.80, 1.0},
          {"an effect that the catalogue lacks: called by one name", 0.0, 0.10}};
}

std::string_view name(Reached reached) noexcept {
  constexpr std::array<std::string_view, 5> names{"met", "met, but too few cases to be sure",
                                                  "not met, but too few cases to be sure", "not met", "not tested"};
  return names[static_cast<std::size_t>(reached)];
}

std::vector<TargetResult> compare_with_targets(const SelftestResult& result, Geometry geometry) {
  const std::vector<Rate> rates = rates_of(result);
  std::vector<TargetResult> results;
  for (const Target& target : targets(geometry)) {
    TargetResult one{target, {std::string(target.rate), 0, 0, {0.0, 1.0}}, Reached::not_tested};
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
    Rate rate{a + ", " + b, hits, cases[a] + cases[b], {}};
    if (hits < fewest_cases || rate.value() < least_share) continue;
    rate.interval = stats::clopper_pearson(rate.hits, rate.of);
    pairs.push_back(
        {a, b, std::move(rate), names_other(a, b) || names_other(b, a), fingerprint_of(a), fingerprint_of(b)});
  }
  std::ranges::stable_sort(pairs, std::ranges::greater{}, [](const ConfusedPair& pair) { return pair.rate.value(); });
  return pairs;
}

std::string targets_markdown(const SelftestResult& result, Geometry geometry) {
  std::ostringstream out;
  out << "| quantity | target | share (95 % interval) | cases | |\n|---|---|---|---:|---|\n";
  for (const TargetResult& one : compare_with_targets(result, geometry)) {
    out << "| " << one.target.rate << " | " << bounds_of(one.target) << " | ";
    if (one.rate.of > 0) {
      out << fixed(one.rate.value(), 3) << " (" << fixed(one.rate.interval.low, 3) << "-"
          << fixed(one.rate.interval.high, 3) << ")";
    }
    out << " | " << one.rate.of << " | " << name(one.reached) << " |\n";
  }
  out << "| calibration error of the probabilities | at most " << fixed(largest_calibration_error, 2) << " | ";
  if (const stats::Reliability& counted = result.reliability; counted.bins.empty()) {
    out << "| | " << name(Reached::not_tested) << " |\n";
  } else {
    const double error = counted.expected_calibration_error;
    out << fixed(error, 3) << " | | " << name(error <= largest_calibration_error ? Reached::yes : Reached::no)
        << " |\n";
  }
  const std::vector<ConfusedPair> pairs = confused_pairs(result);
  if (pairs.empty()) {
    out << "\nNo two effects are taken for each other in a tenth of their cases.\n";
    return out.str();
  }
  out << "\nPairs that are taken for each other in a tenth of their cases or more (three cases at least):\n\n"
         "| pair | share (95 % interval) | in the catalogue | why: what each does to the data |\n|---|---|---|---|\n";
  for (const ConfusedPair& pair : pairs) {
    out << "| " << pair.rate.what << " | " << fixed(pair.rate.value(), 2) << " (" << fixed(pair.rate.interval.low, 2)
        << "-" << fixed(pair.rate.interval.high, 2) << ") | " << (pair.expected ? "foreseen" : "not foreseen") << " | "
        << pair.first_does << " / " << pair.second_does << " |\n";
  }
  return out.str();
}

}  // namespace pirsim::reconcile
