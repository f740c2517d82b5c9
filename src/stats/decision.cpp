#include "stats/decision.hpp"

#include <algorithm>
#include <utility>

namespace pirsim::stats {
namespace {

constexpr std::size_t plain_model = 0;

std::vector<std::size_t> survivors(std::span<const Candidate> candidates, const DecisionLevels& levels) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool is_certain = i != plain_model && candidates[i].probability >= levels.certain;
    const double level =
        is_certain ? std::min(levels.alpha, std::max(0.4 * levels.alpha, candidates[i].least_p)) : levels.alpha;
    if (candidates[i].p > level) kept.push_back(i);
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::size_t a, std::size_t b) { return candidates[a].p > candidates[b].p; });
  return kept;
}

/// Puts the candidate that is to be named first; false if none is.
bool find_name(std::span<const Candidate> candidates, std::vector<std::size_t>& kept, double sure) {
  const auto likeliest = std::ranges::max_element(kept, {}, [&](std::size_t i) { return candidates[i].probability; });
  if (kept.size() > 1 && candidates[*likeliest].probability < sure) return false;
  std::rotate(kept.begin(), likeliest, likeliest + 1);
  return true;
}

}  // namespace

Decision decide(double null_p, std::span<const Candidate> candidates, const DecisionLevels& levels) {
  if (null_p > levels.alpha) return {};
  std::vector<std::size_t> kept = survivors(candidates, levels);
  if (std::ranges::find(kept, plain_model) != kept.end()) return {Verdict::one_of, std::move(kept)};
  double together = 0.0;
  for (const std::size_t i : kept) together += candidates[i].probability;
  if (kept.empty() || together < levels.plausible) return {Verdict::none_in_catalogue, {}};
  if (!find_name(candidates, kept, levels.sure)) return {Verdict::one_of, std::move(kept)};
  if (candidates[kept.front()].p_own <= levels.entitled * levels.alpha)
    return {Verdict::none_in_catalogue, {}, kept.front()};
  return {Verdict::named, std::move(kept)};
}

}  // namespace pirsim::stats
