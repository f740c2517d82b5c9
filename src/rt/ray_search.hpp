// Every solid against the rays near it, without a hierarchy: cones around packets of sixteen rays leave out most
// packets, of what remains the rays that pass the solid closely are gathered into packets of their own, and until the
// solid has moved as far as that only they are tested with the shared ray tests, sixteen at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pirsim/rays.hpp"
#include "rt/culling.hpp"
#include "rt/ray_kernel.hpp"

namespace pirsim::rt {

/// A solid as last seen, and the rays near it.
struct FollowedSolid {
  std::optional<PosedShape> solid;
  /// Room for the packets around one solid; more are allocated when they are needed.
  NearRays near{32};
};

/// The rays of a bundle, which it outlives. Belongs to one thread.
class RaySearch {
 public:
  RaySearch(const RayBundle& clipped, const RayKernel& kernel);

  /// Takes the solids to where they are now. followed: resized to (n_solids).
  void follow(std::span<const PosedShape> solids, std::vector<FollowedSolid>& followed);
  /// How far the rays go from now on: none farther than in the bundle. range: (n_rays). What was followed before has
  /// rays of other ranges: forget it.
  void set_ranges(std::span<const float> range) noexcept;
  /// Of the last follow(): indices of the solids that aren't as they were, and of those of them that got other rays.
  [[nodiscard]] std::span<const std::uint32_t> moved() const noexcept { return moved_; }
  [[nodiscard]] std::span<const std::uint32_t> gathered() const noexcept { return left_; }

  /// (n_packets) which of its rays hit the solid; valid until the next call.
  [[nodiscard]] std::span<const PacketHits> hits(const FollowedSolid& followed);
  /// Also where the rays enter it. hits: (n_packets); distances: (n_packets x packet_size), metres, of rays that hit.
  void enter(const FollowedSolid& followed, std::span<PacketHits> hits, std::span<float> distances) const;

 private:
  void gather(std::span<const PosedShape> solids, std::vector<FollowedSolid>& followed);
  void gather_one(const PosedShape& grown, const BoundingSphere& sphere, NearRays& near);
  /// Writes hits_ of the picked packets.
  void intersect(const PosedShape& solid, const BoundingSphere& around, std::span<const RayPacket> packets,
                 std::span<const std::uint32_t> picked) noexcept;
  [[nodiscard]] float slack_m(const PosedShape& solid) const noexcept;

  const RayKernel& kernel_;
  float farthest_m_ = 0.0F;  ///< where any ray starts, from the world's origin
  std::vector<RayPacket> packets_;
  std::vector<ConeBlock> cones_;    ///< of packets_
  std::vector<std::uint32_t> all_;  ///< 0, 1, 2, ...: indices of gathered packets
  std::vector<std::uint32_t> moved_;
  std::vector<std::uint32_t> left_;  ///< those of moved_ that have left the rays gathered for them
  // Scratch.
  std::vector<PosedShape> grown_;           ///< (n of left_)
  std::vector<BoundingSphere> spheres_;     ///< around them
  std::vector<std::uint32_t> near_person_;  ///< packets whose cone touches the sphere around all that left
  std::vector<ConeBlock> near_person_cones_;
  std::vector<std::uint32_t> near_solid_;
  std::vector<PacketHits> hits_;
};

}  // namespace pirsim::rt
