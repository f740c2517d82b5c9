#include "rt/tracers.hpp"

#include <cassert>

namespace pirsim::rt {

std::string_view name(TracerKind kind) noexcept {
  switch (kind) {
    case TracerKind::reference:
      return "reference";
    case TracerKind::embree:
      return "embree";
  }
  return "unknown";
}

std::unique_ptr<Tracer> make_tracer(TracerKind kind, const TracerSetup& setup) {
  assert(setup.room != nullptr && setup.rated != nullptr && setup.clipped != nullptr);
  return kind == TracerKind::reference ? make_reference_tracer(setup) : make_embree_tracer(setup);
}

}  // namespace pirsim::rt
