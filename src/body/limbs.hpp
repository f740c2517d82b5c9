// Parts of a posture, worked out one by one.
#pragma once

#include <array>

#include "body/motion.hpp"

namespace pirsim::body {

/// Of a pose or a posture: all that hangs together. Arrays are left, right.
struct Limbs {
  bool hips = true;
  bool spine = true;
  bool head = true;
  bool arms = true;
  std::array<bool, 2> ankles{true, true};
};

/// Overwrites what depends on any of these of the outline, or of the pose; the rest stays as it is.
void update(Pose& pose, const Humanoid& humanoid, const Outline& outline, const Limbs& changed) noexcept;
void update(Posture& posture, const Humanoid& humanoid, const Pose& pose, const Limbs& changed) noexcept;

}  // namespace pirsim::body
