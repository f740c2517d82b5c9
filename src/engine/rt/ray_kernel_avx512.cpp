#include "engine/rt/ray_kernel_impl.hpp"

// Sixteen rays at a time; compiled with -mavx512f (src/CMakeLists.txt).

namespace pirsim::rt {

extern const RayKernel ray_kernel_avx512;
const RayKernel ray_kernel_avx512 = make_kernel("avx512f", [] { return __builtin_cpu_supports("avx512f") != 0; });

}  // namespace pirsim::rt
