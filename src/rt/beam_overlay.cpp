// Beams are drawn over the shaded picture as thin lines with a glow, pixel by pixel along their longer side, and are
// hidden where a surface is nearer. Where a beam ends in view it leaves a spot.
#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "rt/renderer.hpp"

namespace pirsim::rt {
namespace {

constexpr float near_plane = 0.05F;   // metres
constexpr float depth_slack = 0.02F;  // metres: an end point lies on a surface, not behind it
constexpr float reach = 4.0F;         // pixels to either side that a line may touch
constexpr float reference_height = 720.0F;

/// A point on the screen; inverse depth is linear along a line's picture.
struct ScreenPoint {
  glm::vec2 at{0.0F};
  float inverse_depth = 0.0F;
};

ScreenPoint project(const View& view, const Vec3f& point) noexcept {
  const Vec3f offset = point - view.position;
  const float inverse_depth = 1.0F / view.depth_of(point);
  const float scale = view.pixels_per_tangent * inverse_depth;
  return {{0.5F * static_cast<float>(view.width) + glm::dot(offset, view.right) * scale,
           0.5F * static_cast<float>(view.height) - glm::dot(offset, view.up) * scale},
          inverse_depth};
}

/// Share of the beam's colour at `distance` pixels from its middle: a core and a glow around it.
float line_cover(float distance) noexcept {
  return 0.42F * std::exp(-distance * distance / 0.5F) + 0.06F * std::exp(-distance * distance / 5.0F);
}

class Painter {
 public:
  Painter(const View& view, Pixels& pixels)
      : view_(view), pixels_(pixels), unit_(std::max(1.0F, static_cast<float>(view.height) / reference_height)) {}

  void paint_line(const Beam& beam) {
    Vec3f from(beam.from), to(beam.to);
    if (!clip_to_front(from, to)) return;
    const ScreenPoint a = project(view_, from), b = project(view_, to);
    const glm::vec2 along = b.at - a.at;
    const float length = glm::length(along);
    if (!(length > 0.0F)) return;
    const bool is_steep = std::abs(along.y) > std::abs(along.x);
    const int major = is_steep ? 1 : 0, minor = 1 - major;
    const int limit = is_steep ? view_.height : view_.width;
    const int begin = clamped(std::min(a.at[major], b.at[major]), limit);
    const int end = clamped(std::max(a.at[major], b.at[major]) + 1.0F, limit);
    const float squeeze = std::abs(along[major]) / length;  // from the minor axis to the line's own normal
    for (int i = begin; i < end; ++i) {
      const float share = std::clamp((static_cast<float>(i) + 0.5F - a.at[major]) / along[major], 0.0F, 1.0F);
      const float middle = a.at[minor] + share * along[minor];
      const float depth = 1.0F / (a.inverse_depth + share * (b.inverse_depth - a.inverse_depth));
      const float half = reach * unit_ / squeeze;
      for (int j = static_cast<int>(std::floor(middle - half)); static_cast<float>(j) <= middle + half; ++j) {
        const float distance = (static_cast<float>(j) + 0.5F - middle) * squeeze / unit_;
        blend(is_steep ? j : i, is_steep ? i : j, depth, line_cover(distance), beam.colour);
      }
    }
  }

  void paint_spot(const Beam& beam) {
    const Vec3f end(beam.to);
    if (view_.depth_of(end) < near_plane) return;
    const ScreenPoint spot = project(view_, end);
    const float radius = std::max(1.2F * unit_, 0.018F * view_.pixels_per_tangent * spot.inverse_depth);
    const int r = static_cast<int>(std::ceil(3.0F * radius));
    for (int dy = -r; dy <= r; ++dy) {
      for (int dx = -r; dx <= r; ++dx) {
        const int x = static_cast<int>(std::floor(spot.at.x)) + dx, y = static_cast<int>(std::floor(spot.at.y)) + dy;
        const glm::vec2 offset(static_cast<float>(x) + 0.5F - spot.at.x, static_cast<float>(y) + 0.5F - spot.at.y);
        const float cover = 0.75F * std::exp(-glm::dot(offset, offset) / (radius * radius));
        blend(x, y, 1.0F / spot.inverse_depth, cover, beam.colour);
      }
    }
  }

 private:
  [[nodiscard]] bool clip_to_front(Vec3f& from, Vec3f& to) const noexcept {
    const float a = view_.depth_of(from), b = view_.depth_of(to);
    if (a < near_plane && b < near_plane) return false;
    const Vec3f crossing = from + (to - from) * ((near_plane - a) / (b - a));
    if (a < near_plane) from = crossing;
    if (b < near_plane) to = crossing;
    return true;
  }

  [[nodiscard]] static int clamped(float x, int limit) noexcept {
    return static_cast<int>(std::clamp(std::floor(x), 0.0F, static_cast<float>(limit)));
  }

  void blend(int x, int y, float depth, float cover, const Colour& colour) noexcept {
    if (x < 0 || y < 0 || x >= view_.width || y >= view_.height) return;
    Pixel& pixel =
        pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) + static_cast<std::size_t>(x)];
    if (depth > pixel.depth + depth_slack) return;
    pixel.light += (Vec3f(colour[0], colour[1], colour[2]) - pixel.light) * cover;
  }

  const View& view_;
  Pixels& pixels_;
  float unit_;  ///< a line's width in pixels, so that a larger picture shows the same
};

}  // namespace

void draw_beams(const View& view, std::span<const Beam> beams, Pixels& pixels) {
  Painter painter(view, pixels);
  for (const Beam& beam : beams) painter.paint_line(beam);
  for (const Beam& beam : beams) painter.paint_spot(beam);
}

}  // namespace pirsim::rt
