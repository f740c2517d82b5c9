// How far points are from a floor's outline.
#pragma once

#include <cstddef>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim {

/// To the nearest edge, from inside or outside; infinite without any.
[[nodiscard]] double distance_to_edge_m(const FloorArea& floor, const Vec2& place);

/// A point inside, far from the edges: where a name has room.
[[nodiscard]] Vec2 roomiest_point(const FloorArea& area);

// How much two areas of the floor have in common.

/// Square metres that belong to both, each inside by the even-odd rule.
[[nodiscard]] double common_m2(const FloorArea& a, const FloorArea& b);

// A floor cut into parts: the one place that knows which part a point is in.

class FloorParts {
 public:
  FloorParts() = default;
  /// parts: apart from each other but for rounding. What of the floor is in none of them is the rest.
  FloorParts(const FloorArea& floor, std::vector<FloorArea> parts);

  /// Without a rest every point of the floor is in a part.
  [[nodiscard]] bool has_rest() const noexcept { return rest_m2_ > 0.0; }
  [[nodiscard]] double rest_m2() const noexcept { return rest_m2_; }
  /// Of a point on the floor: the index of its part, or the number of parts for the rest. A point on the border of two
  /// is in one of them.
  [[nodiscard]] std::size_t at(const Vec2& point) const noexcept;
  /// (n_parts, and the rest if there is one) square metres of the floor.
  [[nodiscard]] const std::vector<double>& areas_m2() const noexcept { return areas_m2_; }

 private:
  std::vector<FloorArea> parts_;
  std::vector<double> areas_m2_;
  double rest_m2_ = 0.0;
};

}  // namespace pirsim
