#include "pirsim/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "pirsim/error.hpp"

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

FloorGrid::FloorGrid(const FloorArea& floor, double spacing_m)
    : spacing_m_(spacing_m), middle_(0.5 * (floor.lower() + floor.upper())) {
  constexpr double most_squares = 2e7;
  const Vec2 size = (floor.upper() - floor.lower()) / spacing_m;
  if (size.x * size.y > most_squares) throw Error(ErrorCode::infeasible, "the grid has more than 20 million squares");
  n_columns_ = static_cast<std::size_t>(std::ceil(size.x));
  n_rows_ = static_cast<std::size_t>(std::ceil(size.y));
  for (std::size_t row = 0; row < n_rows_; ++row) {
    for (std::size_t column = 0; column < n_columns_; ++column) {
      on_floor_.push_back(floor.contains(centre(column, row)) ? 1 : 0);
    }
  }
  n_squares_ = static_cast<std::size_t>(std::ranges::count(on_floor_, 1));
}

Vec2 FloorGrid::centre(std::size_t column, std::size_t row) const noexcept {
  const auto from_middle = [](std::size_t index, std::size_t count) {
    return static_cast<double>(index) - (static_cast<double>(count) - 1.0) / 2.0;
  };
  return {middle_.x + spacing_m_ * from_middle(column, n_columns_), middle_.y + spacing_m_ * from_middle(row, n_rows_)};
}

}  // namespace pirsim
