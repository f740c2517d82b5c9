#include "rt/tracer.hpp"

#include <cassert>

#include "rt/ray_kernel.hpp"

namespace pirsim::rt {

std::string_view name(TracerKind kind) noexcept {
  switch (kind) {
    case TracerKind::reference:
      return "reference";
    case TracerKind::embree:
      return "embree";
    case TracerKind::direct:
      return "direct";
  }
  return "unknown";
}

std::string_view direct_instruction_set() noexcept { return best_ray_kernel().name; }

std::unique_ptr<Tracer> make_tracer(TracerKind kind, const TracerSetup& setup) {
  assert(setup.room != nullptr && setup.rated != nullptr && setup.clipped != nullptr);
  switch (kind) {
    case TracerKind::reference:
      return make_reference_tracer(setup);
    case TracerKind::embree:
      return make_embree_tracer(setup);
    case TracerKind::direct:
      break;
  }
  return make_direct_tracer(setup);
}

}  // namespace pirsim::rt
