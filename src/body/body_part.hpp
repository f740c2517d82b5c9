// The thirteen solids of the humanoid (Stefansson et al. 2021, section 2.2: one sphere, three boxes, nine
// capsules), a posture of them, and how warm their surfaces are.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "pirsim/geometry.hpp"
#include "pirsim/script.hpp"
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
/// The index of a part in an array that has an element a part.
[[nodiscard]] constexpr std::size_t at(Part part) noexcept { return static_cast<std::size_t>(part); }
/// "left_upper_arm" and so on, as glTF node names and messages use it.
[[nodiscard]] std::string_view name(Part part) noexcept;

/// world_from_part for every part, indexed by Part. A capsule's axis is its part's local Y.
using Posture = std::array<Frame, n_parts>;
/// The solids of one person, indexed by Part, in their part's frame.
using Solids = std::array<Shape, n_parts>;

/// Degrees Celsius, indexed by Part: of skin, of hair and clothing between skin and room, or of both where a part has
/// both. Derivation: docs/physics/analog.md. Ref: [Mehnert2000, ISO7730].
[[nodiscard]] std::array<double, n_parts> surface_temperatures_c(const WarmthSpec& warmth, double ambient_c);

}  // namespace pirsim::body
