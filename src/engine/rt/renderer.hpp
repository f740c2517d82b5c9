// Pictures of a room, people and beams, through the room's own ray scene.
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/rt/room.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::rt {

/// Linear-light red, green, blue in [0, 1].
using Colour = std::array<float, 3>;

/// +Y is up in the picture.
struct Camera {
  Vec3 position{0.0};
  Vec3 target{0.0, 0.0, -1.0};
  double vertical_fov_rad = 0.8;
};

/// A thin glowing line, hidden by what is in front of it.
struct Beam {
  Vec3 from{0.0};
  Vec3 to{0.0};
  Colour colour{1.0F, 1.0F, 1.0F};
};

struct RenderedSolid {
  PosedShape shape;
  Colour colour{0.8F, 0.8F, 0.8F};
};

enum class Surface {
  opaque,
  see_through,  ///< cut away where it stands between the camera and its target: the front walls of a doll's house
  hidden,       ///< not drawn and throws no shadow
};

/// Top row first.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 8-bit sRGB, (height x width x 3)
  std::vector<float> depth_m;     ///< (height x width), of the nearest surface before the camera; infinity for none
};

/// sRGB of a pixel in which there is nothing.
inline constexpr std::array<std::uint8_t, 3> background_rgb{244, 246, 249};

/// mesh_surfaces and mesh_colours: (n_meshes of the room). The same arguments give the same bytes, whatever the
/// number of threads. Throws Error(usage) for arrays of another length or a picture without pixels.
[[nodiscard]] Image render(const Room& room, std::span<const Surface> mesh_surfaces,
                           std::span<const Colour> mesh_colours, std::span<const RenderedSolid> solids,
                           std::span<const Beam> beams, const Camera& camera, int width, int height);

// What the steps of a rendering share: the camera's view and the picture before it is encoded.

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
  /// Where a point appears, in pixels; nothing behind the camera.
  [[nodiscard]] std::optional<glm::vec2> pixel_of(const Vec3f& point) const noexcept {
    const float depth = depth_of(point);
    if (depth <= 0.0F) return std::nullopt;
    const float scale = pixels_per_tangent / depth;
    return glm::vec2(0.5F * static_cast<float>(width) + glm::dot(point - position, right) * scale,
                     0.5F * static_cast<float>(height) - glm::dot(point - position, up) * scale);
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
