// Which groups of rays can't hit any solid? A cone around each group's rays against a sphere around each solid.
#pragma once

#include <span>
#include <vector>

#include "pirsim/rays.hpp"

namespace pirsim::rt {

/// BoundingSphere around a solid.
struct BoundingSphere {
  Vec3f centre{0.0F};
  float radius = 0.0F;
};
[[nodiscard]] BoundingSphere bounding_sphere(const PosedShape& shape) noexcept;
/// BoundingSphere around spheres; at least one.
[[nodiscard]] BoundingSphere bounding_sphere(std::span<const BoundingSphere> spheres) noexcept;

/// All points that rays from `apex` within `half_angle` of `axis` reach up to `length` metres.
struct ViewCone {
  Vec3f apex{0.0F};
  Vec3f axis{0.0F, 0.0F, -1.0F};
  float cosine = -1.0F;  ///< of the half-angle
  float sine = 0.0F;
  float length = 0.0F;
};

/// Around rays that start in one point; range: (n of `rays`).
[[nodiscard]] ViewCone cone_around(std::span<const Ray> rays, std::span<const float> range);
/// One cone a cluster (n_clusters) or a zone (n_zones). A group whose rays don't share one origin gets a cone that
/// touches everything.
[[nodiscard]] std::vector<ViewCone> cluster_cones(const RayBundle& bundle);
[[nodiscard]] std::vector<ViewCone> zone_cones(const RayBundle& bundle);

/// False only if no ray of the cone can hit anything inside a sphere; true may be wrong.
[[nodiscard]] bool may_touch_any(const ViewCone& cone, std::span<const BoundingSphere> spheres) noexcept;

}  // namespace pirsim::rt
