// The rays of a bundle in packets of sixteen that lie close together, and a cone around each packet; both laid out in
// columns for the ray kernels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pirsim/rays.hpp"

namespace pirsim::rt {

inline constexpr std::size_t packet_size = 16;
using Column = float[packet_size];

/// Rays that are missing to a full packet have a negative range and hit nothing.
struct alignas(64) RayPacket {
  Column origin_x, origin_y, origin_z;
  Column direction_x, direction_y, direction_z;
  Column range;
  std::uint32_t zone[packet_size];  ///< that the ray belongs to
  std::uint32_t ray[packet_size];   ///< its index in the bundle
};

/// Cones as in view_cones.hpp, sixteen at a time; nothing touches those that are missing to a full block.
struct alignas(64) ConeBlock {
  Column apex_x, apex_y, apex_z;
  Column axis_x, axis_y, axis_z;
  Column cosine, sine, length;
};

/// Sorts each sensor's rays by direction into packets.
[[nodiscard]] std::vector<RayPacket> packet_of_rays(const RayBundle& bundle);
/// Cone i, counted through the blocks, is around packet i.
[[nodiscard]] std::vector<ConeBlock> cones_around(const std::vector<RayPacket>& packets);
/// Picks cones by their indices; `picked` is overwritten and has room for them.
void pick(const std::vector<ConeBlock>& cones, const std::uint32_t* indices, std::size_t n,
          std::vector<ConeBlock>& picked);

}  // namespace pirsim::rt
