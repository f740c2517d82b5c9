// Every solid against the rays near it, without a hierarchy: cones around packets of sixteen rays leave out most
// packets, of what remains the rays that pass the solid closely are gathered into packets of their own, and until the
// solid has moved as far as that only they are tested with the shared ray tests, sixteen at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/rt/ray_kernel.hpp"
#include "engine/rt/tracer.hpp"
#include "pirsim/rays.hpp"

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

// What each ray hits first of people who move, followed from one posture to the next.

/// Keeps of every ray all solids that it hits. As a part moves, most of its rays stay on it and hit nothing else: of
/// them nothing is to be done.
class FirstHits {
 public:
  FirstHits(std::size_t n_rays, RaySearch& search);

  /// As Tracer::follow().
  void follow(std::span<const Moved> moved, std::vector<FirstHitChange>& changes);
  [[nodiscard]] std::vector<SolidId> first_hits() const;

 private:
  /// A solid that a ray hits; `next` leads to another.
  struct Node {
    std::uint32_t ray = 0;
    std::uint32_t next = 0;
    SolidId solid;
    std::uint32_t surface : 8 = 0;
    std::uint32_t lane : 24 = 0;  ///< in the solid's arrays
  };
  static constexpr std::uint32_t none = 0;  ///< no node: the first is never used

  /// The rays near a solid, packet by packet.
  struct Lanes {
    std::vector<PacketHits> hits, hits_before;
    std::vector<float> distances;      ///< (n_packets x packet_size) metres, of rays that hit
    std::vector<std::uint32_t> nodes;  ///< (n_packets x packet_size) of rays that hit
  };
  struct Person {
    std::vector<FollowedSolid> solids;
    std::vector<Lanes> lanes;  ///< (n_solids)
    std::vector<std::uint8_t> surfaces;
  };

  void move(SolidId id);
  void forget(Lanes& lanes);
  void insert(std::uint32_t ray, SolidId solid, std::uint32_t lane, Lanes& lanes);
  void remove(std::uint32_t node);
  /// Another set of solids is on the ray.
  void touch(std::uint32_t ray);
  void look_again(std::uint32_t ray);
  [[nodiscard]] float distance(const Node& node) const noexcept {
    return people_[node.solid.person].lanes[node.solid.solid].distances[node.lane];
  }
  [[nodiscard]] SolidId first_of(std::uint32_t chain) const noexcept;

  RaySearch& search_;
  std::vector<Person> people_;
  std::vector<std::uint32_t> chains_;    ///< (n_rays) nodes
  std::vector<std::uint8_t> is_shared_;  ///< (n_rays) 1: it hits several surfaces
  std::vector<SolidId> first_;           ///< (n_rays) of the surface that each ray hits first
  std::vector<Node> nodes_{1};
  std::vector<std::uint32_t> unused_;     ///< nodes
  std::vector<std::uint32_t> touched_;    ///< rays whose first hit may have changed
  std::vector<std::uint8_t> is_touched_;  ///< (n_rays)
};

// Rays near each solid (ray_search.hpp), and what is kept of them while it stands still: zones, or what they hit first.

class DirectTracer final : public Tracer {
 public:
  explicit DirectTracer(const TracerSetup& setup, const RayKernel& kernel = best_ray_kernel());
  void add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) override;
  void follow(std::span<const Moved> moved, std::vector<FirstHitChange>& changes) override {
    first_hits_.follow(moved, changes);
  }
  [[nodiscard]] std::vector<SolidId> first_hits() const override { return first_hits_.first_hits(); }
  void turn_leaves(std::span<const LeafStep> steps) override;
  [[nodiscard]] bool may_be_remembered() const noexcept override { return true; }

 private:
  using ZoneParts = std::vector<ZoneSet::Part>;
  struct Person {
    std::vector<FollowedSolid> solids;
    std::vector<ZoneParts> zones;  ///< (n_solids)
  };

  void find_zones(const FollowedSolid& solid, ZoneParts& zones);

  RaySearch search_;
  std::vector<Person> people_;
  FirstHits first_hits_;
  const LeafCuts* cuts_;      ///< null: there are no doors
  std::vector<float> range_;  ///< scratch
};

}  // namespace pirsim::rt
