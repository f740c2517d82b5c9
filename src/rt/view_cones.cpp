#include "rt/culling.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace pirsim::rt {
namespace {

/// Widens cones (radians) and spheres (metres, and as a share of the distance) far beyond single precision's rounding.
constexpr double angle_margin = 1e-4;
constexpr float distance_margin = 1e-3F;
constexpr float distance_share = 1e-5F;

ViewCone touches_everything() noexcept {
  ViewCone cone;
  cone.length = std::numeric_limits<float>::infinity();
  cone.sine = 1.0F;
  cone.cosine = 0.0F;
  cone.axis = Vec3f(0.0F);
  return cone;
}

}  // namespace

ViewCone cone_around(std::span<const Ray> rays, std::span<const float> range) {
  if (rays.empty()) return ViewCone{};
  const bool one_origin =
      std::all_of(rays.begin(), rays.end(), [&](const Ray& ray) { return ray.origin == rays.front().origin; });
  Vec3 sum(0.0);
  for (const Ray& ray : rays) sum += Vec3(ray.direction);
  if (!one_origin || !(glm::length(sum) > 1e-6)) return touches_everything();

  const Vec3 axis = glm::normalize(sum);
  double widest = 0.0;
  for (const Ray& ray : rays) {
    const Vec3 direction(ray.direction);
    widest = std::max(widest, std::atan2(glm::length(glm::cross(axis, direction)), glm::dot(axis, direction)));
  }
  const double half_angle = widest + angle_margin;
  // The test below holds for cones up to a half-space.
  if (half_angle > 1.5) return touches_everything();

  ViewCone cone;
  cone.apex = rays.front().origin;
  cone.axis = Vec3f(axis);
  cone.cosine = static_cast<float>(std::cos(half_angle));
  cone.sine = static_cast<float>(std::sin(half_angle));
  cone.length = *std::max_element(range.begin(), range.end());
  return cone;
}

namespace {

ViewCone cone_of(const RayBundle& bundle, std::size_t first_zone, std::size_t end_zone) {
  const std::size_t begin = bundle.zone_rays_begin[first_zone], end = bundle.zone_rays_begin[end_zone];
  return cone_around(std::span(bundle.rays).subspan(begin, end - begin),
                     std::span(bundle.range).subspan(begin, end - begin));
}

bool may_touch(const ViewCone& cone, const BoundingSphere& sphere) noexcept {
  const Vec3f offset = sphere.centre - cone.apex;
  const float along = glm::dot(offset, cone.axis);
  const float across = glm::length(offset - cone.axis * along);
  const float reach = sphere.radius + distance_margin + distance_share * (std::abs(along) + across);
  // Projection of the offset on the cone's outward normal: at most the distance to the cone, equal beside it.
  const bool is_beside = across * cone.cosine - along * cone.sine > reach;
  return !is_beside && along - reach <= cone.length;
}

}  // namespace

BoundingSphere bounding_sphere(const PosedShape& shape) noexcept {
  if (const auto* sphere = std::get_if<PosedSphere>(&shape)) return {sphere->centre, sphere->radius};
  if (const auto* capsule = std::get_if<PosedCapsule>(&shape)) {
    return {(capsule->a + capsule->b) * 0.5F, glm::length(capsule->b - capsule->a) * 0.5F + capsule->radius};
  }
  const auto* mesh = std::get_if<PosedMesh>(&shape);
  const PosedBox box = mesh != nullptr ? box_around(*mesh) : std::get<PosedBox>(shape);
  return {box.centre, glm::length(box.half_extents)};
}

BoundingSphere bounding_sphere(std::span<const BoundingSphere> spheres) noexcept {
  Vec3f lower = spheres.front().centre, upper = lower;
  for (const BoundingSphere& sphere : spheres) {
    lower = glm::min(lower, sphere.centre - sphere.radius);
    upper = glm::max(upper, sphere.centre + sphere.radius);
  }
  BoundingSphere all{(lower + upper) * 0.5F, 0.0F};
  for (const BoundingSphere& sphere : spheres) {
    all.radius = std::max(all.radius, glm::length(sphere.centre - all.centre) + sphere.radius);
  }
  return all;
}

std::vector<ViewCone> cluster_cones(const RayBundle& bundle) {
  std::vector<ViewCone> cones;
  for (std::size_t cluster = 0; cluster < bundle.n_clusters(); ++cluster) {
    cones.push_back(cone_of(bundle, bundle.cluster_zones_begin[cluster], bundle.cluster_zones_begin[cluster + 1]));
  }
  return cones;
}

std::vector<ViewCone> zone_cones(const RayBundle& bundle) {
  std::vector<ViewCone> cones;
  for (std::size_t zone = 0; zone < bundle.n_zones(); ++zone) cones.push_back(cone_of(bundle, zone, zone + 1));
  return cones;
}

bool may_touch_any(const ViewCone& cone, std::span<const BoundingSphere> spheres) noexcept {
  return std::any_of(spheres.begin(), spheres.end(),
                     [&](const BoundingSphere& sphere) { return may_touch(cone, sphere); });
}

}  // namespace pirsim::rt
