// How far points are from a floor's outline.
#pragma once

#include "pirsim/geometry.hpp"

namespace pirsim {

/// To the nearest edge, from inside or outside; infinite without any.
[[nodiscard]] double distance_to_edge_m(const FloorArea& floor, const Vec2& place);

/// A point inside, far from the edges: where a name has room.
[[nodiscard]] Vec2 roomiest_point(const FloorArea& area);

}  // namespace pirsim
