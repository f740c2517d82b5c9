// The inner loops of the direct tracer, compiled once an instruction set and chosen when the program runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "pirsim/shapes.hpp"
#include "rt/ray_packs.hpp"
#include "rt/view_cones.hpp"

namespace pirsim::rt {

/// Bit i: the pack's ray i meets the solid before its range ends.
using PackHits = std::uint16_t;

struct RayKernel {
  std::string_view name;
  bool (*is_available)();
  /// Writes the indices of cones that may touch the ball (never leaves one out that does) and tells how many they are.
  std::size_t (*cull)(const ConeBlock* cones, std::size_t n_blocks, const Ball& ball, std::uint32_t* indices) noexcept;
  /// picked: (n) indices into rays; hits: (n). The same bits as entry_distance() of geom/shapes.hpp, ray by ray;
  /// `around` is a ball around the solid.
  void (*meet_sphere)(const RayPack* rays, const std::uint32_t* picked, std::size_t n, const PosedSphere& solid,
                      const Ball& around, PackHits* hits) noexcept;
  void (*meet_capsule)(const RayPack* rays, const std::uint32_t* picked, std::size_t n, const PosedCapsule& solid,
                       const Ball& around, PackHits* hits) noexcept;
  void (*meet_box)(const RayPack* rays, const std::uint32_t* picked, std::size_t n, const PosedBox& solid,
                   const Ball& around, PackHits* hits) noexcept;
  /// The same, and where the rays enter: distances: (n x pack_size), metres, of rays that meet the solid.
  void (*enter_sphere)(const RayPack* rays, const std::uint32_t* picked, std::size_t n, const PosedSphere& solid,
                       const Ball& around, PackHits* hits, float* distances) noexcept;
  void (*enter_capsule)(const RayPack* rays, const std::uint32_t* picked, std::size_t n, const PosedCapsule& solid,
                        const Ball& around, PackHits* hits, float* distances) noexcept;
  void (*enter_box)(const RayPack* rays, const std::uint32_t* picked, std::size_t n, const PosedBox& solid,
                    const Ball& around, PackHits* hits, float* distances) noexcept;
};

/// Fastest first; the last is available everywhere.
[[nodiscard]] std::span<const RayKernel* const> all_ray_kernels() noexcept;
/// The first that this processor can run.
[[nodiscard]] const RayKernel& best_ray_kernel() noexcept;

}  // namespace pirsim::rt
