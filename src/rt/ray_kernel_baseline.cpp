// What every processor of the architecture can: SSE2 with four rays at a time on x86-64, elsewhere one.
#include "rt/ray_kernel_impl.hpp"

namespace pirsim::rt {

extern const RayKernel ray_kernel_baseline;
const RayKernel ray_kernel_baseline = make_kernel("baseline", [] { return true; });

}  // namespace pirsim::rt
