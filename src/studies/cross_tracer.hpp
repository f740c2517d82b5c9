// One ray against all poses of a bar, several poses at a time. Private to studies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pirsim/rays.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::studies {

/// All poses of one capsule as posed by place(), laid out for lanes of poses; padded to whole lanes.
struct BarPoses {
  std::vector<float> ax, ay, az, bx, by, bz;
  float radius = 0.0F;
};

/// Half axes of a bar, relative to its middle, computed once: (n_poses).
[[nodiscard]] std::vector<Vec3> half_axes(const Capsule& bar, const std::vector<Quat>& rotation);
/// The poses of a bar with its middle at `middle`, the same bits as place() of each.
void pose_bar(const std::vector<Vec3>& half_axes, const Vec3& middle, double radius, BarPoses& poses);

/// Lanes of poses in a row of `n_poses`: how long `active` below is.
[[nodiscard]] std::size_t padded(std::size_t n_poses) noexcept;

/// active[pose] becomes 1 where entry_distance(ray, capsule of the pose, range) has a value. (padded n_poses)
void mark_active(const Ray& ray, float range, const BarPoses& poses, std::vector<std::uint8_t>& active) noexcept;

/// Whether the ray passes through a sphere within its range; a millimetre is added to be on the safe side of rounding.
[[nodiscard]] bool may_hit(const Ray& ray, float range, const Vec3& middle, double reach_m) noexcept;

/// A ray and how far others that start near it and look much the same way stray from it.
struct RayCone {
  Vec3 origin{0.0}, direction{0.0, 0.0, 1.0};
  double range_m = 0.0;       ///< the longest ray's
  double spread_m = 0.0;      ///< between the origins
  double spread_per_m = 0.0;  ///< between the rays, for each metre along them
};

/// Round the rays [first, last) of a bundle.
[[nodiscard]] RayCone cone_of(const RayBundle& bundle, std::uint32_t first, std::uint32_t last) noexcept;
/// False if may_hit() is false for every ray of the cone.
[[nodiscard]] bool may_hit(const RayCone& cone, const Vec3& middle, double reach_m) noexcept;

}  // namespace pirsim::studies
