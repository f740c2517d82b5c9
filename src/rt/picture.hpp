// What the steps of a rendering share: the camera's view and the picture before it is encoded.
#pragma once

#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <vector>

#include "rt/renderer.hpp"

namespace pirsim::rt {

/// A pinhole camera; pixel (0, 0) is top left, its centre at (0.5, 0.5).
struct View {
  Vec3f position{0.0F};
  Vec3f right{0.0F}, up{0.0F}, forward{0.0F};
  float pixels_per_tangent = 1.0F;  ///< pixels from the centre to where the tangent of the angle is 1
  int width = 0, height = 0;

  [[nodiscard]] Ray ray_through(float x, float y) const noexcept {
    const float across = (x - 0.5F * static_cast<float>(width)) / pixels_per_tangent;
    const float above = (0.5F * static_cast<float>(height) - y) / pixels_per_tangent;
    return {position, glm::normalize(forward + right * across + up * above)};
  }
  /// Distance before the camera, metres; not along the ray.
  [[nodiscard]] float depth_of(const Vec3f& point) const noexcept { return glm::dot(point - position, forward); }
};
[[nodiscard]] View make_view(const Camera& camera, int width, int height) noexcept;

struct Pixel {
  Vec3f light{0.0F};   ///< linear
  float depth = 0.0F;  ///< of the nearest surface in it, metres before the camera; infinity for none
};
/// (height x width)
using Pixels = std::vector<Pixel>;

void draw_beams(const View& view, std::span<const Beam> beams, Pixels& pixels);

}  // namespace pirsim::rt
