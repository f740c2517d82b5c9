// From p-values to one of five verdicts.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace pirsim::stats {

enum class Verdict {
  no_disagreement,    ///< the model without any effect isn't refused
  named,              ///< one effect survives and is likely, or one of several is far likelier than the others
  one_of,             ///< several survive: these data can't tell them apart; or a single one that isn't likely
  several,            ///< no single effect survives, but two or more together do
  none_in_catalogue,  ///< nothing known makes such data
};

/// An effect, or some together, and the p-value of "these and nothing else made the data".
struct Candidate {
  std::vector<std::size_t> effects;  ///< indices into the catalogue, ascending; none: the model as it is
  double p = 0.0;
  double probability = 0.0;  ///< calibrated, among all candidates of its kind
};

struct DecisionLevels {
  double alpha = 0.05;  ///< a candidate survives if its p exceeds it
  /// An effect at least as probable is named though others survive: their own tests lack the power to refuse them. On
  /// 1,620 planted datasets (Study A, one run) 0.8, 0.85, 0.9 and 0.95 gave the right name in 0.80, 0.79, 0.78 and 0.76
  /// of the disagreements and a wrong one in 0.9, 0.6, 0.4 and 0.3 % of all.
  double sure = 0.85;
  /// An effect that survives alone is named if it is as probable as this. Of 15 less probable ones 1 was right; 10
  /// stood for something that the catalogue lacks, 2 for a pair.
  double plausible = 0.5;
};

struct Decision {
  Verdict verdict = Verdict::no_disagreement;
  std::vector<std::size_t> kept;    ///< indices of the surviving candidates, the named one first, then by p: of singles
                                    ///< if named or one_of, of combinations if several
  std::vector<std::size_t> common;  ///< the named effect, or those that all surviving candidates share, ascending
  std::optional<int> family;        ///< of the named effect, or of all effects of the survivors if it is the same
  bool operator==(const Decision&) const = default;
};

/// null_p: of the model without effects; families: (n_effects) of the catalogue. While the model as it is survives too,
/// if it is among the singles, nothing is named: the disagreement is too weak (one_of). Combinations are looked at only
/// if no single effect survives: the simplest explanation is taken. Throws Error(usage) for an effect that isn't in
/// `families`.
[[nodiscard]] Decision decide(double null_p, std::span<const Candidate> singles,
                              std::span<const Candidate> combinations, std::span<const int> families,
                              const DecisionLevels& levels);

}  // namespace pirsim::stats
