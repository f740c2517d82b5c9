// Which zones see a person at this tick, and what does each ray hit first? Several tracers answer, all with the same
// bits.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "pirsim/rays.hpp"
#include "rt/leaf_cuts.hpp"
#include "rt/room.hpp"

namespace pirsim::rt {

[[nodiscard]] std::string_view name(TracerKind kind) noexcept;

/// A person and one of their solids.
struct SolidId {
  std::uint16_t person = 0xFFFFU;
  std::uint16_t solid = 0xFFFFU;
  auto operator<=>(const SolidId&) const = default;
};
inline constexpr SolidId no_solid{};

/// A person's solids as they are from now on. None: they are gone.
struct Moved {
  std::size_t person = 0;
  std::span<const PosedShape> solids;
  /// (n_solids) those of equal number are as one: which of them a ray hits makes no difference. A solid keeps its
  /// number until it is gone.
  std::span<const std::uint8_t> surfaces;
};

/// A ray of the bundle, and what it hit and hits before all other solids and the room.
struct FirstHitChange {
  std::uint32_t ray = 0;
  SolidId before, after;
};

/// Scratch memory of one thread; not shared.
class Tracer {
 public:
  virtual ~Tracer() = default;
  /// Adds the zones that see one person of several; what is kept from tick to tick is kept by `person`. solids:
  /// surfaces of meshes outlive the tracer.
  virtual void add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) = 0;
  /// Takes people to where they are now, each at most once; who isn't named stays as they are. Tells of which rays that
  /// changes the surface that they hit first, in any order: where a ray enters two solids at once, the lower person and
  /// index. What changes within a surface may be told or not. changes: overwritten. Nobody is there at first.
  virtual void follow(std::span<const Moved> moved, std::vector<FirstHitChange>& changes) = 0;
  /// (n_rays) what each ray hits first since then, or no_solid.
  [[nodiscard]] virtual std::vector<SolidId> first_hits() const = 0;
  /// From now on the leaves of doors stand so; at first as before a run. steps: (n_doors). Nobody is followed then:
  /// take them away first.
  virtual void turn_leaves(std::span<const LeafStep> steps) = 0;
  /// May whoever asks remember the answers? The slow tracers are there to be compared with: they look at every tick.
  [[nodiscard]] virtual bool may_be_remembered() const noexcept { return false; }
};

/// What a tracer works on; all of it outlives the tracer.
struct TracerSetup {
  const Room* room = nullptr;
  const RayBundle* rated = nullptr;    ///< ranges as rated
  const RayBundle* clipped = nullptr;  ///< the same rays cut at the room
  const LeafCuts* cuts = nullptr;      ///< of `clipped`; null: there are no doors
};
/// "avx512f", "avx2" or "baseline": what the direct tracer uses on this processor. Changes no bit.
[[nodiscard]] std::string_view direct_instruction_set() noexcept;
[[nodiscard]] std::unique_ptr<Tracer> make_tracer(TracerKind kind, const TracerSetup& setup);

// The tracers' makers.

[[nodiscard]] std::unique_ptr<Tracer> make_reference_tracer(const TracerSetup& setup);
[[nodiscard]] std::unique_ptr<Tracer> make_embree_tracer(const TracerSetup& setup);
[[nodiscard]] std::unique_ptr<Tracer> make_direct_tracer(const TracerSetup& setup);

}  // namespace pirsim::rt
