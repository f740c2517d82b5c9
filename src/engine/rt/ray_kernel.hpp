// The inner loops of the direct tracer, compiled once an instruction set and chosen when the program runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "engine/rt/tracer.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::rt {

/// Bit i: the packet's ray i hits the solid before its range ends.
using PacketHits = std::uint16_t;

struct RayKernel {
  std::string_view name;
  bool (*is_available)();
  /// Writes the indices of cones that may touch the sphere (never leaves one out that does) and tells how many they
  /// are.
  std::size_t (*cull)(const ConeBlock* cones, std::size_t n_blocks, const BoundingSphere& sphere,
                      std::uint32_t* indices) noexcept;
  /// picked: (n) indices into rays; hits: (n). The same bits as entry_distance() of pirsim/shapes.hpp, ray by ray;
  /// `around` is a sphere around the solid.
  void (*intersect_sphere)(const RayPacket* rays, const std::uint32_t* picked, std::size_t n, const PosedSphere& solid,
                           const BoundingSphere& around, PacketHits* hits) noexcept;
  void (*intersect_capsule)(const RayPacket* rays, const std::uint32_t* picked, std::size_t n,
                            const PosedCapsule& solid, const BoundingSphere& around, PacketHits* hits) noexcept;
  void (*intersect_box)(const RayPacket* rays, const std::uint32_t* picked, std::size_t n, const PosedBox& solid,
                        const BoundingSphere& around, PacketHits* hits) noexcept;
  /// These three also tell where the rays enter. distances: (n x packet_size), metres, of rays that hit the solid.
  void (*enter_sphere)(const RayPacket* rays, const std::uint32_t* picked, std::size_t n, const PosedSphere& solid,
                       const BoundingSphere& around, PacketHits* hits, float* distances) noexcept;
  void (*enter_capsule)(const RayPacket* rays, const std::uint32_t* picked, std::size_t n, const PosedCapsule& solid,
                        const BoundingSphere& around, PacketHits* hits, float* distances) noexcept;
  void (*enter_box)(const RayPacket* rays, const std::uint32_t* picked, std::size_t n, const PosedBox& solid,
                    const BoundingSphere& around, PacketHits* hits, float* distances) noexcept;
};

/// Fastest first; the last is available everywhere.
[[nodiscard]] std::span<const RayKernel* const> all_ray_kernels() noexcept;
/// The first that this processor can run.
[[nodiscard]] const RayKernel& best_ray_kernel() noexcept;

}  // namespace pirsim::rt
