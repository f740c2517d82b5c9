// How far a point is from a floor's outline.
#pragma once

#include "pirsim/geometry.hpp"

namespace pirsim {

/// To the nearest edge, from inside or outside; infinite without any.
[[nodiscard]] double distance_to_edge_m(const FloorArea& floor, const Vec2& place);

}  // namespace pirsim
