#include "engine/rt/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>

#include "engine/rt/room_impl.hpp"
#include "engine/rt/tracer.hpp"
#include "model/core/parallel.hpp"
#include "pirsim/error.hpp"

// Soft light from everywhere (ambient occlusion), one soft key light, and a doll's-house cut.

namespace pirsim::rt {
namespace {

constexpr int samples_a_side = 2;  // 2 x 2 a pixel
constexpr int n_samples = samples_a_side * samples_a_side;
constexpr int occlusion_rays = 4;        // a sample
constexpr float occlusion_reach = 0.9F;  // metres within which surfaces darken each other
constexpr float surface_offset = 1e-3F;  // metres above a surface at which its own rays start
constexpr float far_away = 1e4F;         // metres
constexpr float key_softness = 0.07F;    // tangent of the key light's angular radius
constexpr float key_strength = 0.42F, sky_strength = 0.64F;
constexpr float occlusion_strength = 0.8F;  // 1 would make the inmost corner black in the sky's light

float linear_from_srgb(float x) { return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F); }
float srgb_from_linear(float x) { return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F; }
std::uint8_t encoded(float light) {
  return static_cast<std::uint8_t>(std::lround(255.0F * srgb_from_linear(std::clamp(light, 0.0F, 1.0F))));
}
Vec3f vector(const Colour& colour) { return {colour[0], colour[1], colour[2]}; }

/// A value in [0, 1) that differs evenly between neighbouring pixels. Ref: [Jimenez2014], interleaved gradient noise.
float pixel_noise(int x, int y) {
  const float inner = 0.06711056F * static_cast<float>(x) + 0.00583715F * static_cast<float>(y);
  const float outer = 52.9829189F * (inner - std::floor(inner));
  return outer - std::floor(outer);
}

/// Two unit vectors square to a normal and to each other.
std::array<Vec3f, 2> tangents(const Vec3f& normal) {
  const Vec3f helper = std::abs(normal.y) < 0.9F ? Vec3f(0, 1, 0) : Vec3f(1, 0, 0);
  const Vec3f first = glm::normalize(glm::cross(helper, normal));
  return {first, glm::cross(normal, first)};
}

/// Point i of n spread evenly over the unit disc, turned by `turn` in [0, 1).
std::array<float, 2> on_disc(int i, int n, float turn) {
  constexpr float golden_angle = 2.39996323F;
  const float radius = std::sqrt((static_cast<float>(i) + 0.5F) / static_cast<float>(n));
  const float angle = static_cast<float>(i) * golden_angle + turn * 2.0F * std::numbers::pi_v<float>;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

struct SurfacePoint {
  float distance = 0.0F;
  Vec3f position{0.0F};
  Vec3f normal{0.0F};  ///< unit, towards where the ray came from
  Vec3f colour{0.0F};
};

/// Does the plane through a triangle have the camera on one side and the camera's target on the other?
bool separates(const std::array<Vec3, 3>& corners, const Camera& camera) {
  const Vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  return glm::dot(normal, camera.position - corners[0]) * glm::dot(normal, camera.target - corners[0]) < 0.0;
}

/// The room without what is hidden or cut away; mesh indices stay.
Room drawn_part(const Room& room, std::span<const Surface> surfaces, const Camera& camera) {
  std::vector<TriMesh> drawn(room.n_meshes());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (surfaces[i] == Surface::hidden) continue;
    const RoomMesh& mesh = room.impl().meshes[i];
    drawn[i].positions.assign(mesh.positions.begin(), mesh.positions.end());
    const auto& positions = drawn[i].positions;
    std::copy_if(mesh.triangles.begin(), mesh.triangles.end(), std::back_inserter(drawn[i].triangles),
                 [&](const auto& t) {
                   return surfaces[i] == Surface::opaque ||
                          !separates({positions[t[0]], positions[t[1]], positions[t[2]]}, camera);
                 });
  }
  return Room(drawn);
}

/// False only if the ray passes the sphere.
bool may_hit(const Ray& ray, const BoundingSphere& sphere, float reach) {
  const Vec3f offset = sphere.centre - ray.origin;
  const float nearest = std::clamp(glm::dot(offset, ray.direction), 0.0F, reach);
  const Vec3f miss = offset - ray.direction * nearest;
  const float radius = sphere.radius * 1.001F + 1e-3F;
  return glm::dot(miss, miss) <= radius * radius;
}

class Picture {
 public:
  Picture(const Room& drawn_room, std::span<const Colour> colours, std::span<const RenderedSolid> solids,
          const View& view)
      : room_(drawn_room), colours_(colours), solids_(solids), view_(view) {
    for (const RenderedSolid& solid : solids) spheres_.push_back(bounding_sphere(solid.shape));
    to_key_ = glm::normalize(Vec3f(0.0F, 0.75F, 0.0F) + view.right * -0.3F - view.forward * 0.6F);
    key_sides_ = tangents(to_key_);
    for (std::size_t i = 0; i < 3; ++i) {
      background_[static_cast<int>(i)] = linear_from_srgb(static_cast<float>(background_rgb[i]) / 255.0F);
    }
  }

  [[nodiscard]] std::vector<Pixel> row(int y) const {
    std::vector<Pixel> pixels(static_cast<std::size_t>(view_.width));
    for (int x = 0; x < view_.width; ++x) pixels[static_cast<std::size_t>(x)] = pixel(x, y);
    return pixels;
  }

 private:
  [[nodiscard]] Pixel pixel(int x, int y) const {
    Pixel result{Vec3f(0.0F), std::numeric_limits<float>::infinity()};
    for (int sample = 0; sample < n_samples; ++sample) {
      const float dx = (static_cast<float>(sample % samples_a_side) + 0.5F) / samples_a_side;
      const float dy = (static_cast<float>(sample / samples_a_side) + 0.5F) / samples_a_side;
      const Ray ray = view_.ray_through(static_cast<float>(x) + dx, static_cast<float>(y) + dy);
      const auto point = intersect(ray);
      if (point) result.depth = std::min(result.depth, view_.depth_of(point->position));
      result.light += (point ? shade(*point, sample, pixel_noise(x, y)) : background_) / static_cast<float>(n_samples);
    }
    return result;
  }

  [[nodiscard]] std::optional<SurfacePoint> intersect(const Ray& ray) const {
    std::optional<SurfacePoint> nearest;
    if (const auto hit = room_.first_hit(ray, far_away)) {
      const Vec3f position = ray.origin + ray.direction * hit->distance;
      nearest = SurfacePoint{hit->distance, position, hit->normal, vector(colours_[hit->mesh])};
    }
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      const float reach = nearest ? nearest->distance : far_away;
      if (!may_hit(ray, spheres_[i], reach)) continue;
      const RenderedSolid& solid = solids_[i];
      const auto distance = entry_distance(ray, solid.shape, reach);
      if (!distance) continue;
      const Vec3f position = ray.origin + ray.direction * *distance;
      const Vec3f outward = surface_normal(solid.shape, position);
      // A mesh may be open and show its inside.
      const Vec3f normal = glm::dot(outward, ray.direction) <= 0.0F ? outward : -outward;
      nearest = SurfacePoint{*distance, position, normal, vector(solid.colour)};
    }
    return nearest;
  }

  [[nodiscard]] bool is_blocked(const Ray& ray, float reach) const {
    QueryContext context;
    initialise(context);
    RTCRay query = embree_ray(ray, reach);
    any_hit(room_.impl().scene.get(), context, query);
    if (query.tfar < 0.0F) return true;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      if (may_hit(ray, spheres_[i], reach) && entry_distance(ray, solids_[i].shape, reach)) return true;
    }
    return false;
  }

  [[nodiscard]] Vec3f shade(const SurfacePoint& point, int sample, float noise) const {
    const Vec3f start = point.position + point.normal * surface_offset;
    // A little more light from above than from below, so that undersides read as such.
    const float sky = sky_strength * (0.88F + 0.12F * point.normal.y) * openness(start, point.normal, sample, noise);
    return point.colour * (sky + key_strength * key_light(start, point.normal, sample, noise));
  }

  /// Share of the sky that nothing near takes away, weighted by the cosine. Rays of many lengths let far things count
  /// less than near ones.
  [[nodiscard]] float openness(const Vec3f& start, const Vec3f& normal, int sample, float noise) const {
    constexpr int n = occlusion_rays * n_samples;
    const auto [side, other_side] = tangents(normal);
    int open = 0;
    for (int i = 0; i < occlusion_rays; ++i) {
      const int index = i * n_samples + sample;
      const auto [u, v] = on_disc(index, n, noise);
      const float height = std::sqrt(std::max(1.0F - u * u - v * v, 0.0F));
      const float share = (static_cast<float>((7 * index) % n) + 0.5F) / static_cast<float>(n);
      const Vec3f direction = glm::normalize(side * u + other_side * v + normal * height);
      open += is_blocked({start, direction}, occlusion_reach * std::sqrt(share)) ? 0 : 1;
    }
    return 1.0F - occlusion_strength * (1.0F - static_cast<float>(open) / occlusion_rays);
  }

  [[nodiscard]] float key_light(const Vec3f& start, const Vec3f& normal, int sample, float noise) const {
    const auto [u, v] = on_disc(sample, n_samples, noise);
    const Vec3f direction = glm::normalize(to_key_ + (key_sides_[0] * u + key_sides_[1] * v) * key_softness);
    const float slope = glm::dot(normal, direction);
    if (slope <= 0.0F || is_blocked({start, direction}, far_away)) return 0.0F;
    return slope;
  }

  const Room& room_;
  std::span<const Colour> colours_;
  std::span<const RenderedSolid> solids_;
  const View& view_;
  std::vector<BoundingSphere> spheres_;  ///< (n_solids)
  Vec3f to_key_{0.0F};
  std::array<Vec3f, 2> key_sides_{};
  Vec3f background_{0.0F};
};

void check_arguments(const Room& room, std::span<const Surface> surfaces, std::span<const Colour> colours, int width,
                     int height) {
  const std::size_t n_meshes = room.n_meshes();
  if (surfaces.size() != n_meshes || colours.size() != n_meshes) {
    throw Error(ErrorCode::usage, "the room has " + std::to_string(n_meshes) + " meshes, but there are " +
                                      std::to_string(surfaces.size()) + " surfaces and " +
                                      std::to_string(colours.size()) + " colours");
  }
  if (width < 1 || height < 1) {
    throw Error(ErrorCode::usage,
                "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels can't be drawn");
  }
}

}  // namespace

View make_view(const Camera& camera, int width, int height) noexcept {
  const Vec3 forward = glm::normalize(camera.target - camera.position);
  const Vec3 up_hint = std::abs(forward.y) < 0.9999 ? Vec3(0, 1, 0) : Vec3(0, 0, -1);
  const Vec3 right = glm::normalize(glm::cross(forward, up_hint));
  View view{Vec3f(camera.position), Vec3f(right), Vec3f(glm::cross(right, forward)), Vec3f(forward)};
  view.pixels_per_tangent = static_cast<float>(0.5 * height / std::tan(0.5 * camera.vertical_fov_rad));
  view.width = width;
  view.height = height;
  return view;
}

Image render(const Room& room, std::span<const Surface> mesh_surfaces, std::span<const Colour> mesh_colours,
             std::span<const RenderedSolid> solids, std::span<const Beam> beams, const Camera& camera, int width,
             int height) {
  check_arguments(room, mesh_surfaces, mesh_colours, width, height);
  const View view = make_view(camera, width, height);
  const Room drawn_room = drawn_part(room, mesh_surfaces, camera);
  const Picture picture(drawn_room, mesh_colours, solids, view);
  Pixels pixels;
  pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  ordered_parallel<std::vector<Pixel>>(
      static_cast<std::size_t>(height), 0, [&](std::size_t y) { return picture.row(static_cast<int>(y)); },
      [&](std::vector<Pixel>& row) { pixels.insert(pixels.end(), row.begin(), row.end()); });
  draw_beams(view, beams, pixels);

  Image image{width, height, {}, {}};
  image.rgb.reserve(3 * pixels.size());
  image.depth_m.reserve(pixels.size());
  for (const Pixel& pixel : pixels) {
    image.depth_m.push_back(pixel.depth);
    for (int channel = 0; channel < 3; ++channel) image.rgb.push_back(encoded(pixel.light[channel]));
  }
  return image;
}

// Beams are drawn over the shaded picture as thin lines with a glow, pixel by pixel along their longer side, and are
// hidden where a surface is nearer. Where a beam ends in view it leaves a spot.

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
