#include "engine/rt/ray_kernel_impl.hpp"

// Eight rays at a time; compiled with -mavx2 (src/CMakeLists.txt).

namespace pirsim::rt {

extern const RayKernel ray_kernel_avx2;
const RayKernel ray_kernel_avx2 = make_kernel("avx2", [] { return __builtin_cpu_supports("avx2") != 0; });

}  // namespace pirsim::rt
