#include "pirsim/stats/decision.hpp"

#include <algorithm>
#include <iterator>

#include "stats/require.hpp"

namespace pirsim::stats {
namespace {

std::vector<std::size_t> survivors(std::span<const Candidate> candidates, double alpha) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (candidates[i].p > alpha) kept.push_back(i);
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::size_t a, std::size_t b) { return candidates[a].p > candidates[b].p; });
  return kept;
}

std::vector<std::size_t> shared_effects(std::span<const Candidate> candidates, std::span<const std::size_t> kept) {
  std::vector<std::size_t> common = candidates[kept[0]].effects;
  for (const std::size_t index : kept) {
    std::vector<std::size_t> both;
    const auto& effects = candidates[index].effects;
    std::set_intersection(common.begin(), common.end(), effects.begin(), effects.end(), std::back_inserter(both));
    common = std::move(both);
  }
  return common;
}

std::optional<int> one_family(std::span<const Candidate> candidates, std::span<const std::size_t> kept,
                              std::span<const int> families) {
  std::optional<int> family;
  for (const std::size_t index : kept) {
    for (const std::size_t effect : candidates[index].effects) {
      if (family && *family != families[effect]) return std::nullopt;
      family = families[effect];
    }
  }
  return family;
}

/// Puts the candidate that is to be named first; false if none is.
bool find_name(std::span<const Candidate> singles, std::vector<std::size_t>& kept, const DecisionLevels& levels) {
  const auto is_plain = [&](std::size_t i) { return singles[i].effects.empty(); };
  if (std::ranges::any_of(kept, is_plain)) return false;
  const auto likeliest = std::ranges::max_element(kept, {}, [&](std::size_t i) { return singles[i].probability; });
  if (singles[*likeliest].probability < (kept.size() > 1 ? levels.sure : levels.plausible)) return false;
  std::rotate(kept.begin(), likeliest, likeliest + 1);
  return true;
}

Decision describe(Verdict verdict, std::span<const Candidate> candidates, std::vector<std::size_t> kept,
                  std::span<const int> families) {
  Decision decision{verdict, std::move(kept), {}, {}};
  const auto said = std::span(decision.kept).first(verdict == Verdict::named ? 1 : decision.kept.size());
  decision.common = shared_effects(candidates, said);
  decision.family = one_family(candidates, said, families);
  return decision;
}

}  // namespace

Decision decide(double null_p, std::span<const Candidate> singles, std::span<const Candidate> combinations,
                std::span<const int> families, const DecisionLevels& levels) {
  for (const auto candidates : {singles, combinations})
    for (const Candidate& candidate : candidates)
      for (const std::size_t effect : candidate.effects)
        require(effect < families.size(), "decide: an effect without a family");
  if (null_p > levels.alpha) return {};
  std::vector<std::size_t> kept = survivors(singles, levels.alpha);
  if (!kept.empty()) {
    const Verdict verdict = find_name(singles, kept, levels) ? Verdict::named : Verdict::one_of;
    return describe(verdict, singles, std::move(kept), families);
  }
  kept = survivors(combinations, levels.alpha);
  if (!kept.empty()) return describe(Verdict::several, combinations, std::move(kept), families);
  return {Verdict::none_in_catalogue, {}, {}, {}};
}

}  // namespace pirsim::stats
