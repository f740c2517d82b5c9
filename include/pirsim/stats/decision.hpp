// From p-values to one of five verdicts.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace pirsim::stats {

enum class Verdict {
  no_disagreement,    ///< the model without any effect isn't refused
  named,              ///< exactly one effect survives
  one_of,             ///< several survive: this data can't tell them apart
  several,            ///< no single effect survives, but two or more together do
  none_in_catalogue,  ///< nothing known makes such data
};

/// An effect, or some together, and the p-value of "these and nothing else made the data".
struct Candidate {
  std::vector<std::size_t> effects;  ///< indices into the catalogue, ascending; none: the model as it is
  double p = 0.0;
};

struct Decision {
  Verdict verdict = Verdict::no_disagreement;
  std::vector<std::size_t> kept;  ///< indices of the surviving candidates, likeliest (greatest p) first: of singles if
                                  ///< named or one_of, of combinations if several
  std::vector<std::size_t> common;  ///< effects that all surviving candidates share, ascending
  std::optional<int> family;        ///< of all effects of the survivors, if it is one and the same
  bool operator==(const Decision&) const = default;
};

/// null_p: of the model without effects; families: (n_effects) of the catalogue. A candidate survives if its p exceeds
/// alpha. While the model as it is survives too, if it is among the singles, nothing is named: the disagreement is too
/// weak (one_of). Combinations are looked at only if no single effect survives: the simplest explanation is taken.
/// Throws Error(usage) for an effect that isn't in `families`.
[[nodiscard]] Decision decide(double null_p, std::span<const Candidate> singles,
                              std::span<const Candidate> combinations, std::span<const int> families, double alpha);

}  // namespace pirsim::stats
