#include "engine/rt/ray_kernel.hpp"

#include <algorithm>
#include <array>

#include "engine/rt/ray_kernel_impl.hpp"

namespace pirsim::rt {

#if defined(__x86_64__)
extern const RayKernel ray_kernel_avx512;
extern const RayKernel ray_kernel_avx2;
#endif
extern const RayKernel ray_kernel_baseline;

std::span<const RayKernel* const> all_ray_kernels() noexcept {
#if defined(__x86_64__)
  static constexpr std::array kernels{&ray_kernel_avx512, &ray_kernel_avx2, &ray_kernel_baseline};
#else
  static constexpr std::array kernels{&ray_kernel_baseline};
#endif
  return kernels;
}

const RayKernel& best_ray_kernel() noexcept {
  static const RayKernel& best =
      **std::ranges::find_if(all_ray_kernels(), [](const RayKernel* kernel) { return kernel->is_available(); });
  return best;
}

extern const RayKernel ray_kernel_baseline;
const RayKernel ray_kernel_baseline = make_kernel("baseline", [] { return true; });

}  // namespace pirsim::rt
