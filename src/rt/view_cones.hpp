// Which clusters of rays can't meet any solid? A cone around each cluster's rays against a ball around each solid.
#pragma once

#include <span>
#include <vector>

#include "pirsim/geom/ray_bundle.hpp"

namespace pirsim::rt {

/// Ball around a solid.
struct Ball {
  Vec3f centre{0.0F};
  float radius = 0.0F;
};
[[nodiscard]] Ball ball_around(const PosedShape& shape) noexcept;

/// All points that rays from `apex` within `half_angle` of `axis` reach up to `length` metres.
struct ViewCone {
  Vec3f apex{0.0F};
  Vec3f axis{0.0F, 0.0F, -1.0F};
  float cosine = -1.0F;  ///< of the half-angle
  float sine = 0.0F;
  float length = 0.0F;
};

/// One cone a cluster, (n_clusters). A cluster whose rays don't share one origin gets a cone that touches everything.
[[nodiscard]] std::vector<ViewCone> view_cones(const RayBundle& bundle);

/// False only if no ray of the cone can meet anything inside the ball; true may be wrong.
[[nodiscard]] bool may_touch(const ViewCone& cone, const Ball& ball) noexcept;

}  // namespace pirsim::rt
