#include "studies/cross_tracer.hpp"

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>

#include "geom/lanes.hpp"
#include "geom/ray_tests.hpp"

namespace pirsim::studies {

using ray_tests::Lanes;
constexpr std::size_t width = ray_tests::n_lanes;

std::size_t padded(std::size_t n_poses) noexcept { return (n_poses + width - 1) / width * width; }

std::vector<Vec3> half_axes(const Capsule& bar, const std::vector<Quat>& rotation) {
  std::vector<Vec3> result;
  for (const Quat& world_from_bar : rotation) result.push_back(world_from_bar * Vec3(0.0, bar.half_length, 0.0));
  return result;
}

void pose_bar(const std::vector<Vec3>& half_axes, const Vec3& middle, double radius, BarPoses& poses) {
  const std::size_t n = half_axes.size(), n_padded = padded(n);
  for (auto* values : {&poses.ax, &poses.ay, &poses.az, &poses.bx, &poses.by, &poses.bz}) values->resize(n_padded);
  for (std::size_t i = 0; i < n_padded; ++i) {
    const Vec3& half_axis = half_axes[std::min(i, n - 1)];
    poses.ax[i] = static_cast<float>(middle.x - half_axis.x);
    poses.ay[i] = static_cast<float>(middle.y - half_axis.y);
    poses.az[i] = static_cast<float>(middle.z - half_axis.z);
    poses.bx[i] = static_cast<float>(middle.x + half_axis.x);
    poses.by[i] = static_cast<float>(middle.y + half_axis.y);
    poses.bz[i] = static_cast<float>(middle.z + half_axis.z);
  }
  poses.radius = static_cast<float>(radius);
}

void mark_active(const Ray& ray, float range, const BarPoses& poses, std::vector<std::uint8_t>& active) noexcept {
  using Vector = ray_tests::Vector<Lanes>;
  const auto all = [](const Vec3f& v) { return Vector{Lanes(v.x), Lanes(v.y), Lanes(v.z)}; };
  const Vector origin = all(ray.origin), direction = all(ray.direction);
  const Lanes radius(poses.radius), t_max(range);
  for (std::size_t i = 0; i < active.size(); i += width) {
    if (std::all_of(&active[i], &active[i] + width, [](std::uint8_t known) { return known != 0; })) continue;
    const Vector a{Lanes::at(&poses.ax[i]), Lanes::at(&poses.ay[i]), Lanes::at(&poses.az[i])};
    const Vector b{Lanes::at(&poses.bx[i]), Lanes::at(&poses.by[i]), Lanes::at(&poses.bz[i])};
    const auto bar = ray_tests::capsule(origin, direction, ray_tests::capsule_axis(a, b), radius);
    for (unsigned int hits = bits(ray_tests::is_hit(bar, t_max)); hits != 0; hits &= hits - 1) {
      active[i + static_cast<std::size_t>(std::countr_zero(hits))] = 1;
    }
  }
}

namespace {

constexpr double safety_m = 1e-3;  // as the tracers' bounding boxes have it

/// From a point to the nearest one of a ray. `to_point`: from the ray's origin.
double distance(const Vec3& to_point, const Vec3& direction, double range_m) noexcept {
  const double along = std::clamp(glm::dot(to_point, direction), 0.0, range_m);
  return glm::length(to_point - along * direction);
}

}  // namespace

bool may_hit(const Ray& ray, float range, const Vec3& middle, double reach_m) noexcept {
  return distance(middle - Vec3(ray.origin), Vec3(ray.direction), range) <= reach_m + safety_m;
}

RayCone cone_of(const RayBundle& bundle, std::uint32_t first, std::uint32_t last) noexcept {
  if (first == last) return {};
  const Ray& middle = bundle.rays[first + (last - first) / 2];
  RayCone cone{.origin = middle.origin, .direction = middle.direction};
  for (auto i = first; i < last; ++i) {
    cone.range_m = std::max(cone.range_m, static_cast<double>(bundle.range[i]));
    cone.spread_m = std::max(cone.spread_m, glm::distance(Vec3(bundle.rays[i].origin), cone.origin));
    cone.spread_per_m = std::max(cone.spread_per_m, glm::distance(Vec3(bundle.rays[i].direction), cone.direction));
  }
  return cone;
}

bool may_hit(const RayCone& cone, const Vec3& middle, double reach_m) noexcept {
  const Vec3 to_middle = middle - cone.origin;
  const double near_m = reach_m + safety_m + cone.spread_m;
  // A ray that comes so near does it no farther along than this.
  const double farthest_m = glm::length(to_middle) + near_m;
  return distance(to_middle, cone.direction, cone.range_m) <= near_m + cone.spread_per_m * farthest_m;
}

}  // namespace pirsim::studies
