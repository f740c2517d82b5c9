// The floor on which people walk and are counted: a polygon with holes in the XZ plane at one height.
#pragma once

#include <vector>

#include "pirsim/geom/frame.hpp"

namespace pirsim {

class FloorArea {
 public:
  FloorArea() = default;
  /// loops: closed polygons in (x, z), inside by the even-odd rule; height_m: y of the floor.
  FloorArea(std::vector<std::vector<Vec2>> loops, double height_m);

  /// Even-odd rule; a point on an edge counts for exactly one of two areas that share the edge.
  [[nodiscard]] bool contains(const Vec2& point) const noexcept;
  [[nodiscard]] double area_m2() const;
  [[nodiscard]] double height_m() const noexcept { return height_m_; }
  [[nodiscard]] Vec2 lower() const noexcept { return lower_; }  ///< corner of the bounding rectangle
  [[nodiscard]] Vec2 upper() const noexcept { return upper_; }
  [[nodiscard]] const std::vector<std::vector<Vec2>>& loops() const noexcept { return loops_; }
  [[nodiscard]] bool empty() const noexcept { return loops_.empty(); }

 private:
  std::vector<std::vector<Vec2>> loops_;
  double height_m_ = 0.0;
  Vec2 lower_{0.0}, upper_{0.0};
};

}  // namespace pirsim
