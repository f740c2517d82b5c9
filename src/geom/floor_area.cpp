#include "pirsim/geometry.hpp"

#include <glm/common.hpp>

#include <cmath>
#include <utility>

namespace pirsim {
namespace {

double signed_area(const std::vector<Vec2>& loop) noexcept {
  double twice = 0.0;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
    twice += loop[j].x * loop[i].y - loop[i].x * loop[j].y;
  }
  return 0.5 * twice;
}

/// Just inside the loop, beside the middle of its first edge: unlike a corner it isn't on the edge of a neighbour.
Vec2 point_inside(const std::vector<Vec2>& loop) noexcept {
  const Vec2 along = loop[1 % loop.size()] - loop[0];
  const Vec2 left(-along.y, along.x);
  return loop[0] + 0.5 * along + (signed_area(loop) > 0.0 ? 1e-6 : -1e-6) * left;
}

}  // namespace

FloorArea::FloorArea(std::vector<std::vector<Vec2>> loops, double height_m)
    : loops_(std::move(loops)), height_m_(height_m) {
  if (loops_.empty() || loops_.front().empty()) return;
  lower_ = upper_ = loops_.front().front();
  for (const auto& loop : loops_) {
    for (const Vec2& p : loop) {
      lower_ = glm::min(lower_, p);
      upper_ = glm::max(upper_, p);
    }
  }
}

bool FloorArea::contains(const Vec2& point) const noexcept {
  bool inside = false;
  for (const auto& loop : loops_) {
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
      const Vec2& a = loop[i];
      const Vec2& b = loop[j];
      if ((a.y > point.y) != (b.y > point.y) && point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x) {
        inside = !inside;
      }
    }
  }
  return inside;
}

double FloorArea::area_m2() const {
  // By the even-odd rule a loop adds where an even number of others contain it, and takes away otherwise.
  double total = 0.0;
  for (const auto& loop : loops_) {
    int depth = 0;
    for (const auto& other : loops_) {
      if (&other != &loop && FloorArea({other}, height_m_).contains(point_inside(loop))) ++depth;
    }
    total += (depth % 2 == 0 ? 1.0 : -1.0) * std::abs(signed_area(loop));
  }
  return total;
}

}  // namespace pirsim
