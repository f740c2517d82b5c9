#include "io/pages/canvas.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pirsim::io {
void Canvas::blend(int x, int y, const Vec3& colour, double opacity) {
  const double share = std::clamp(opacity, 0.0, 1.0);
  const auto at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_->width) + static_cast<std::size_t>(x));
  for (int channel = 0; channel < 3; ++channel) {
    std::uint8_t& value = picture_->rgb[at + static_cast<std::size_t>(channel)];
    value = static_cast<std::uint8_t>(std::lround(glm::mix(static_cast<double>(value), colour[channel], share)));
  }
}

void Canvas::line(const Vec2& a, const Vec2& b, const Vec3& colour, double width_px) {
  const double length = glm::distance(a, b), reach = 0.5 * width_px + 0.5;
  const Vec2 along = length > 0.0 ? (b - a) / length : Vec2(1.0, 0.0);
  each_near(glm::min(a, b), glm::max(a, b), reach, [&](int x, int y, const Vec2& centre) {
    const double t = std::clamp(glm::dot(centre - a, along), 0.0, length);
    blend(x, y, colour, reach - glm::distance(centre, a + t * along));
  });
}

}  // namespace pirsim::io
