// The tracers' makers.
#pragma once

#include <memory>

#include "rt/tracer.hpp"

namespace pirsim::rt {

[[nodiscard]] std::unique_ptr<Tracer> make_reference_tracer(const TracerSetup& setup);
[[nodiscard]] std::unique_ptr<Tracer> make_embree_tracer(const TracerSetup& setup);
[[nodiscard]] std::unique_ptr<Tracer> make_direct_tracer(const TracerSetup& setup);

}  // namespace pirsim::rt
