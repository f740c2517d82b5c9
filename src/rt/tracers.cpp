#include "rt/tracers.hpp"

#include <cassert>

namespace pirsim::rt {

std::string_view name(TracerKind kind) noexcept {
  switch (kind) {
    case TracerKind::reference:
      return "reference";
    case TracerKind::remembering:
      return "remembering";
    case TracerKind::embree:
      return "embree";
  }
  return "unknown";
}

std::unique_ptr<Tracer> make_tracer(TracerKind kind, const TracerSetup& setup) {
  assert(setup.room != nullptr && setup.rated != nullptr && setup.clipped != nullptr);
  switch (kind) {
    case TracerKind::reference:
      return make_reference_tracer(setup);
    case TracerKind::embree:
      return make_embree_tracer(setup);
    case TracerKind::remembering:
      break;
  }
  return make_remembering_tracer(setup);
}

}  // namespace pirsim::rt
