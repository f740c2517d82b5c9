// The thirteen solids of the humanoid (Stefansson et al. 2021, section 2.2: one sphere, three boxes, nine
// capsules) and a posture of them.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "pirsim/geometry.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim::body {

enum class Part : std::size_t {
  pelvis,  ///< capsule, lying from hip to hip
  torso,   ///< box: abdomen and thorax
  head,    ///< sphere
  left_upper_arm,
  right_upper_arm,  ///< capsules
  left_forearm,
  right_forearm,  ///< capsules: forearm and loosely closed hand
  left_thigh,
  right_thigh,  ///< capsules
  left_shank,
  right_shank,  ///< capsules
  left_foot,
  right_foot,  ///< boxes
};
inline constexpr std::size_t n_parts = 13;
/// "left_upper_arm" and so on, as glTF node names and messages use it.
[[nodiscard]] std::string_view name(Part part) noexcept;

/// world_from_part for every part, indexed by Part. A capsule's axis is its part's local Y.
using Posture = std::array<Frame, n_parts>;
/// The solids of one person, indexed by Part, in their part's frame.
using Solids = std::array<Shape, n_parts>;

}  // namespace pirsim::body
