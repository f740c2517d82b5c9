#include "io/pages/canvas.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pirsim::io {
namespace {

/// Where loops cross a row of the picture.
std::vector<double> crossings_of(const std::vector<std::vector<Vec2>>& loops, double level) {
  std::vector<double> crossings;
  for (const std::vector<Vec2>& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 &from = loop[i], &to = loop[(i + 1) % loop.size()];
      if ((from.y > level) == (to.y > level)) continue;
      crossings.push_back(from.x + (level - from.y) / (to.y - from.y) * (to.x - from.x));
    }
  }
  return crossings;
}

}  // namespace

void Canvas::blend(int x, int y, const Vec3& colour, double opacity) {
  const double share = std::clamp(opacity, 0.0, 1.0);
  const auto at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_->width) + static_cast<std::size_t>(x));
  for (int channel = 0; channel < 3; ++channel) {
    std::uint8_t& value = picture_->rgb[at + static_cast<std::size_t>(channel)];
    value = static_cast<std::uint8_t>(std::lround(glm::mix(static_cast<double>(value), colour[channel], share)));
  }
}

void Canvas::line(const Vec2& a, const Vec2& b, const Vec3& colour, double width_px, double dash_px) {
  const double length = glm::distance(a, b), reach = 0.5 * width_px + 0.5;
  const Vec2 along = length > 0.0 ? (b - a) / length : Vec2(1.0, 0.0);
  each_near(glm::min(a, b), glm::max(a, b), reach, [&](int x, int y, const Vec2& centre) {
    const double t = std::clamp(glm::dot(centre - a, along), 0.0, length);
    if (dash_px > 0.0 && static_cast<int>(t / dash_px) % 2 == 1) return;
    blend(x, y, colour, reach - glm::distance(centre, a + t * along));
  });
}

void Canvas::disc(const Vec2& centre, double radius_px, const Vec3& colour) {
  each_near(centre, centre, radius_px + 1.0, [&](int x, int y, const Vec2& pixel) {
    blend(x, y, colour, radius_px + 0.5 - glm::distance(pixel, centre));
  });
}

void Canvas::area(const std::vector<std::vector<Vec2>>& loops, const Vec3& colour) {
  Vec2 lower(1e9), upper(-1e9);
  for (const auto& loop : loops) {
    for (const Vec2& point : loop) lower = glm::min(lower, point), upper = glm::max(upper, point);
  }
  int row = -1;
  std::vector<double> crossings;  // of the row
  each_near(lower, upper, 0.0, [&](int x, int y, const Vec2& centre) {
    if (y != row) {
      row = y;
      crossings = crossings_of(loops, centre.y);
    }
    if (std::ranges::count_if(crossings, [&](double at) { return at < centre.x; }) % 2 == 1) blend(x, y, colour, 1.0);
  });
}

}  // namespace pirsim::io
