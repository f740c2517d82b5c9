// How much two areas of the floor have in common.
#pragma once

#include "pirsim/geometry.hpp"

namespace pirsim {

/// Square metres that belong to both, each inside by the even-odd rule.
[[nodiscard]] double common_m2(const FloorArea& a, const FloorArea& b);

}  // namespace pirsim
