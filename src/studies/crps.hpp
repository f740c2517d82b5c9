// How well counts of simulated runs predict what was measured.
#pragma once

#include "core/tally.hpp"

namespace pirsim::studies {

/// Continuous ranked probability score of an ensemble of whole numbers (at least one): mean |x - y| - 1/2 mean |x -
/// x'|, over all pairs of members, each with itself too. 0 is perfect. In the unit of the values. Ref: [Gneiting2007]
/// equation 21.
[[nodiscard]] double crps(const Tally& ensemble, double observed);

}  // namespace pirsim::studies
