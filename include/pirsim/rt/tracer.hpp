// Which zones see a person at this tick? Several tracers answer, all with the same bits.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "pirsim/geom/ray_bundle.hpp"
#include "pirsim/rt/room.hpp"

namespace pirsim::rt {

enum class TracerKind {
  reference,  ///< the plain way: whole scene rebuilt, closest hit of every ray at its full rated range
  remembering,///< the next one, and the zones of postures seen before are looked up
  embree,     ///< rays cut once at the room, one instance moved per body part, occlusion queries
};
[[nodiscard]] std::string_view name(TracerKind kind) noexcept;

/// Scratch memory of one thread; not shared.
class Tracer {
 public:
  virtual ~Tracer() = default;
  /// solids: everything of every person that is in the scene now (surfaces of meshes outlive the tracer); zones: (n_zones) overwritten.
  virtual void trace(std::span<const PosedShape> solids, std::span<std::uint8_t> zones) = 0;
};

/// What a tracer works on; all of it outlives the tracer.
struct TracerSetup {
  const Room* room = nullptr;
  const RayBundle* rated = nullptr;    ///< ranges as rated
  const RayBundle* clipped = nullptr;  ///< the same rays cut at the room
};
[[nodiscard]] std::unique_ptr<Tracer> make_tracer(TracerKind kind, const TracerSetup& setup);

}  // namespace pirsim::rt
