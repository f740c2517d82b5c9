// Which rays are worth testing against a solid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/rays.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::rt {

// Which groups of rays can't hit any solid? A cone around each group's rays against a sphere around each solid.

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

/// False only if no ray of the cone can hit anything inside the sphere, or inside any of them; true may be wrong.
[[nodiscard]] bool may_touch(const ViewCone& cone, const BoundingSphere& sphere) noexcept;
[[nodiscard]] bool may_touch_any(const ViewCone& cone, std::span<const BoundingSphere> spheres) noexcept;

// The rays of a bundle in packets of sixteen that lie close together, and a cone around each packet; both laid out in
// columns for the ray kernels.

inline constexpr std::size_t packet_size = 16;
using Column = float[packet_size];

/// Rays that are missing to a full packet have a negative range and hit nothing.
struct alignas(64) RayPacket {
  Column origin_x, origin_y, origin_z;
  Column direction_x, direction_y, direction_z;
  Column range;
  std::uint32_t zone[packet_size];  ///< that the ray belongs to
  std::uint32_t ray[packet_size];   ///< its index in the bundle
};

/// Cones, sixteen at a time; nothing touches those that are missing to a full block.
struct alignas(64) ConeBlock {
  Column apex_x, apex_y, apex_z;
  Column axis_x, axis_y, axis_z;
  Column cosine, sine, length;
};

/// Sorts each sensor's rays by direction into packets.
[[nodiscard]] std::vector<RayPacket> packet_of_rays(const RayBundle& bundle);
/// Cone i, counted through the blocks, is around packet i.
[[nodiscard]] std::vector<ConeBlock> cones_around(const std::vector<RayPacket>& packets);
/// Picks cones by their indices; `picked` is overwritten and has room for them.
void pick(const std::vector<ConeBlock>& cones, const std::uint32_t* indices, std::size_t n,
          std::vector<ConeBlock>& picked);

// The few rays that a solid can hit before it has moved by more than a margin.

/// The solid with all that is within `margin_m` of it: of a box, more at its edges; of a mesh, of the box around it.
[[nodiscard]] PosedShape grown(const PosedShape& solid, float margin_m) noexcept;

/// At least as far as any point of the solid has moved between the two; infinite for solids that aren't the same.
[[nodiscard]] float displacement_m(const PosedShape& from, const PosedShape& to) noexcept;

/// Rays that pass a solid closely, in packets. As long as the solid stays within the margin it can hit no other ray: a
/// part that moves at most v can't reach a ray at distance d before d / v.
class NearRays {
 public:
  /// Room for so many packets, so that gathering allocates nothing.
  explicit NearRays(std::size_t n_packets) { packets_.reserve(n_packets); }

  /// Are these all rays that the solid can hit where it is now?
  [[nodiscard]] bool cover(const PosedShape& solid) noexcept;
  /// Forgets the rays. Those that hit the returned solid are to be added; slack_m: what rounding may be worth.
  [[nodiscard]] PosedShape begin(const PosedShape& solid, float slack_m) noexcept;
  /// rays: bit i for the packet's ray i.
  void add(const RayPacket& packet, unsigned int rays);
  void end() noexcept;
  [[nodiscard]] std::span<const RayPacket> packets() const noexcept { return packets_; }

 private:
  PosedShape around_ = PosedMesh{};  ///< the solid when the rays were gathered
  float margin_m_ = 0.05F;           ///< how far it may move from there
  int n_ticks_ = 0;                  ///< for how long these rays have sufficed
  std::vector<RayPacket> packets_;
  std::size_t n_in_last_ = packet_size;  ///< rays of the last packet
};

}  // namespace pirsim::rt
