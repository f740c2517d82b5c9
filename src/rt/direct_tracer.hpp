// Every solid against the rays near it, without a hierarchy: cones around packs of sixteen rays leave out most packs,
// what remains is tested with the shared ray tests, sixteen rays at a time. What a solid hits is kept while it stands
// still.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pirsim/geom/zone_set.hpp"
#include "pirsim/rt/tracer.hpp"
#include "rt/ray_kernel.hpp"
#include "rt/ray_packs.hpp"

namespace pirsim::rt {

class DirectTracer final : public Tracer {
 public:
  explicit DirectTracer(const TracerSetup& setup, const RayKernel& kernel = best_ray_kernel());
  void trace(std::span<const PosedShape> solids, std::span<std::uint8_t> zones) override;
  void add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) override;

 private:
  /// The bits of all numbers of a solid: what is compared to tell whether it moved.
  using Key = std::array<std::uint32_t, 16>;
  /// A solid as last seen. Its zones are words [i * n_words_, (i + 1) * n_words_) of a person's `hits`.
  struct Slot {
    Key key{};
    Ball ball;
  };
  struct Memory {
    std::vector<Slot> slots;  ///< (n_solids)
    std::vector<ZoneSet::Word> hits;
  };

  [[nodiscard]] static Key key_of(const PosedShape& solid) noexcept;
  void find_moved(std::span<const PosedShape> solids, Memory& memory);
  void meet(const PosedShape& solid, const Ball& ball, ZoneSet::Word* zones);

  const RayKernel& kernel_;
  std::size_t n_words_;  ///< of a set of all zones
  std::vector<RayPack> packs_;
  std::vector<ConeBlock> cones_;  ///< of packs_
  std::vector<Memory> people_;
  // Scratch.
  std::vector<std::uint32_t> moved_;  ///< indices of solids
  std::vector<Ball> moved_balls_;
  std::vector<std::uint32_t> near_person_;  ///< packs whose cone touches the ball around all that moved
  std::vector<ConeBlock> near_person_cones_;
  std::vector<std::uint32_t> near_solid_;
  std::vector<PackHits> hits_;
  ZoneSet zones_;
};

}  // namespace pirsim::rt
