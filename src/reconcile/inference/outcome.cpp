#include "reconcile/inference/outcome.hpp"

#include <algorithm>

#include "effects/catalogue.hpp"

namespace pirsim::reconcile {

std::string_view name(Verdict verdict) noexcept { return verdict_names[static_cast<std::size_t>(verdict)]; }

std::vector<Candidate> with_twins(const std::vector<Candidate>& candidates) {
  std::vector<Candidate> all;
  for (const Candidate& candidate : candidates) {
    all.push_back(candidate);
    for (const std::string& twin : effects::twins_of(candidate.score.hypothesis)) {
      const auto is_twin = [&](const Candidate& other) { return other.score.hypothesis == twin; };
      if (std::ranges::any_of(candidates, is_twin)) continue;  // it was asked for
      all.push_back(candidate);
      all.back().score.hypothesis = twin;
      all.back().reason = "Judged as " + candidate.score.hypothesis + ", which changes the model in the same way.";
    }
  }
  return all;
}

}  // namespace pirsim::reconcile
