// Which zones see a person at this tick, and what does each ray hit first? Several tracers answer, all with the same
// bits.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "pirsim/rays.hpp"
#include "rt/room.hpp"

namespace pirsim::rt {

[[nodiscard]] std::string_view name(TracerKind kind) noexcept;

/// A ray of the bundle and the solid that it hits before all others and the room.
struct FirstHit {
  std::uint32_t ray = 0;
  std::uint32_t solid = 0;  ///< index; the lower one where a ray enters two at once
  bool operator==(const FirstHit&) const = default;
};

/// Scratch memory of one thread; not shared.
class Tracer {
 public:
  virtual ~Tracer() = default;
  /// Adds the zones that see one person of several; what is kept from tick to tick is kept by `person`. solids:
  /// surfaces of meshes outlive the tracer.
  virtual void add(std::size_t person, std::span<const PosedShape> solids, ZoneSet& zones) = 0;
  /// One entry a ray that hits a solid within its range, in any order; `hits` is overwritten.
  virtual void find_first(std::span<const PosedShape> solids, std::vector<FirstHit>& hits) = 0;
  /// May whoever asks remember the answers? The slow tracers are there to be compared with: they look at every tick.
  [[nodiscard]] virtual bool may_be_remembered() const noexcept { return false; }
};

/// What a tracer works on; all of it outlives the tracer.
struct TracerSetup {
  const Room* room = nullptr;
  const RayBundle* rated = nullptr;    ///< ranges as rated
  const RayBundle* clipped = nullptr;  ///< the same rays cut at the room
};
/// "avx512f", "avx2" or "baseline": what the direct tracer uses on this processor. Changes no bit.
[[nodiscard]] std::string_view direct_instruction_set() noexcept;
[[nodiscard]] std::unique_ptr<Tracer> make_tracer(TracerKind kind, const TracerSetup& setup);

// The tracers' makers.

[[nodiscard]] std::unique_ptr<Tracer> make_reference_tracer(const TracerSetup& setup);
[[nodiscard]] std::unique_ptr<Tracer> make_embree_tracer(const TracerSetup& setup);
[[nodiscard]] std::unique_ptr<Tracer> make_direct_tracer(const TracerSetup& setup);

}  // namespace pirsim::rt
