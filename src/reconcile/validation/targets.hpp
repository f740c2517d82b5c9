// What the workflow is to reach, and whether a self-test shows that it does.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reconcile/validation/selftest.hpp"

namespace pirsim::reconcile {

enum class Geometry { known, uncertain };  ///< whether nuisance is drawn

/// A rate of the self-test with its bounds.
struct Target {
  Counted rate = Counted::seen;
  double at_least = 0.0, at_most = 1.0;
};
/// Ref for the right name: [Wilson2019], 0.90 of five models.
[[nodiscard]] std::vector<Target> targets(Geometry geometry);
inline constexpr double largest_calibration_error = 0.05;  ///< of the probabilities

enum class Reached {
  yes,        ///< the share and its whole interval are within the bounds
  probably,   ///< the share is, the interval reaches beyond: too few cases to be sure
  hardly,     ///< the share isn't, the interval reaches within
  no,         ///< the whole interval is outside
  not_tested  ///< no case
};

struct TargetResult {
  Target target;
  Rate rate;
  Reached reached = Reached::not_tested;
};
/// One a target, in the order of targets(); rates that the self-test doesn't have are not tested.
[[nodiscard]] std::vector<TargetResult> compare_with_targets(const SelftestResult& result, Geometry geometry);

/// Two effects that are often taken for each other.
struct ConfusedPair {
  std::string first, second;
  Rate rate;                            ///< either taken for the other, of both one's cases with a disagreement
  bool expected = false;                ///< the catalogue names one as confused with the other
  std::string first_does, second_does;  ///< fingerprints
};
/// Pairs whose share is at least so great, in three cases or more; the most confused first.
[[nodiscard]] std::vector<ConfusedPair> confused_pairs(const SelftestResult& result, double least_share = 0.1);

}  // namespace pirsim::reconcile
