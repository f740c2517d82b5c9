// Every solid against the rays near it, without a hierarchy: cones around packets of sixteen rays leave out most
// packets, of what remains the rays that pass the solid closely are gathered into packets of their own, and until the
// solid has moved as far as that only they are tested with the shared ray tests, sixteen at a time. What a solid hits
// is kept while it stands still.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pirsim/rays.hpp"
#include "rt/culling.hpp"
#include "rt/ray_kernel.hpp"
#include "rt/tracer.hpp"

namespace pirsim::rt {

class DirectTracer final : public Tracer {
 public:
  explicit DirectTracer(const TracerSetup& setup, const RayKernel& kernel = best_ray_kernel());
  void add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) override;
  void find_first(std::span<const PosedShape> solids, std::vector<FirstHit>& hits) override;
  [[nodiscard]] bool may_be_remembered() const noexcept override { return true; }

 private:
  /// Of the packets around one solid; more are allocated when they are needed.
  static constexpr std::size_t most_packets_reserved = 32;
  /// A solid as last seen. Its zones are words [i * n_words_, (i + 1) * n_words_) of a person's `hits`.
  struct Slot {
    std::optional<PosedShape> solid;
    NearRays near{most_packets_reserved};
  };
  struct Memory {
    std::vector<Slot> slots;  ///< (n_solids)
    std::vector<ZoneSet::Word> hits;
  };
  struct Entry {
    std::uint32_t ray;
    float distance;  ///< metres
  };

  void find_moved(std::span<const PosedShape> solids, Memory& memory);
  void gather(std::span<const PosedShape> solids, Memory& memory);
  void gather_one(const PosedShape& grown, const BoundingSphere& sphere, NearRays& near);
  /// Writes hits_ of the picked packets.
  void intersect(const PosedShape& solid, const BoundingSphere& around, std::span<const RayPacket> packets,
                 std::span<const std::uint32_t> picked) noexcept;
  void find_zones(const PosedShape& solid, const NearRays& near, ZoneSet::Word* zones);
  [[nodiscard]] float slack_m(const PosedShape& solid) const noexcept;
  void enter(const PosedShape& solid, const NearRays& near, std::vector<Entry>& entries);

  const RayKernel& kernel_;
  std::size_t n_words_;      ///< of a set of all zones
  float farthest_m_ = 0.0F;  ///< where any ray starts, from the world's origin
  std::vector<RayPacket> packets_;
  std::vector<ConeBlock> cones_;  ///< of packets_
  std::vector<Memory> people_;
  Memory everybody_;                         ///< of find_first(), which knows no people; without zones
  std::vector<std::vector<Entry>> entries_;  ///< (n_solids) rays that hit each
  // Scratch.
  std::vector<std::uint32_t> moved_;        ///< indices of solids
  std::vector<std::uint32_t> left_;         ///< those of them that have left the rays gathered for them
  std::vector<PosedShape> grown_;           ///< (n of left_)
  std::vector<BoundingSphere> spheres_;     ///< around them
  std::vector<std::uint32_t> near_person_;  ///< packets whose cone touches the sphere around all that moved
  std::vector<ConeBlock> near_person_cones_;
  std::vector<std::uint32_t> near_solid_;
  std::vector<PacketHits> hits_;
  std::vector<std::uint32_t> all_;        ///< 0, 1, 2, ...: indices of gathered packets
  std::vector<float> distances_;          ///< (n_packets x packet_size)
  std::vector<float> nearest_;            ///< (n_rays) infinite between calls
  std::vector<std::uint32_t> first_hit_;  ///< (n_rays) solid at the nearest distance
  std::vector<std::uint32_t> hit_rays_;
};

}  // namespace pirsim::rt
