// Every solid against the rays near it, without a hierarchy: cones around packs of sixteen rays leave out most packs,
// of what remains the rays that pass the solid closely are gathered into packs of their own, and until the solid has
// moved as far as that only they are tested with the shared ray tests, sixteen at a time. What a solid hits is kept
// while it stands still.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pirsim/rays.hpp"
#include "rt/near_rays.hpp"
#include "rt/ray_kernel.hpp"
#include "rt/ray_packs.hpp"
#include "rt/tracer.hpp"

namespace pirsim::rt {

class DirectTracer final : public Tracer {
 public:
  explicit DirectTracer(const TracerSetup& setup, const RayKernel& kernel = best_ray_kernel());
  void trace(std::span<const PosedShape> solids, std::span<std::uint8_t> zones) override;
  void add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) override;
  void find_first(std::span<const PosedShape> solids, std::vector<Meeting>& met) override;

 private:
  /// Of the packs around one solid; more are allocated when they are needed.
  static constexpr std::size_t most_packs_reserved = 32;
  /// A solid as last seen. Its zones are words [i * n_words_, (i + 1) * n_words_) of a person's `hits`.
  struct Slot {
    std::optional<PosedShape> solid;
    NearRays near{most_packs_reserved};
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
  void gather_one(const PosedShape& grown, const Ball& ball, NearRays& near);
  /// Writes hits_ of the picked packs.
  void meet(const PosedShape& solid, const Ball& ball, std::span<const RayPack> packs,
            std::span<const std::uint32_t> picked) noexcept;
  void find_zones(const PosedShape& solid, const NearRays& near, ZoneSet::Word* zones);
  [[nodiscard]] float slack_m(const PosedShape& solid) const noexcept;
  void enter(const PosedShape& solid, const NearRays& near, std::vector<Entry>& entries);

  const RayKernel& kernel_;
  std::size_t n_words_;      ///< of a set of all zones
  float farthest_m_ = 0.0F;  ///< where any ray starts, from the world's origin
  std::vector<RayPack> packs_;
  std::vector<ConeBlock> cones_;  ///< of packs_
  std::vector<Memory> people_;
  Memory everybody_;                         ///< of find_first(), which knows no people; without zones
  std::vector<std::vector<Entry>> entries_;  ///< (n_solids) rays that meet each
  // Scratch.
  std::vector<std::uint32_t> moved_;        ///< indices of solids
  std::vector<std::uint32_t> left_;         ///< those of them that have left the rays gathered for them
  std::vector<PosedShape> grown_;           ///< (n of left_)
  std::vector<Ball> balls_;                 ///< around them
  std::vector<std::uint32_t> near_person_;  ///< packs whose cone touches the ball around all that moved
  std::vector<ConeBlock> near_person_cones_;
  std::vector<std::uint32_t> near_solid_;
  std::vector<PackHits> hits_;
  std::vector<std::uint32_t> all_;        ///< 0, 1, 2, ...: indices of gathered packs
  std::vector<float> distances_;          ///< (n_packs x pack_size)
  std::vector<float> nearest_;            ///< (n_rays) infinite between calls
  std::vector<std::uint32_t> first_met_;  ///< (n_rays) solid at the nearest distance
  std::vector<std::uint32_t> met_rays_;
  ZoneSet zones_;
};

}  // namespace pirsim::rt
