// Postures that follow upon one another: only what has moved is worked out anew.
#pragma once

#include <array>
#include <cstdint>

#include "body/motion.hpp"

namespace pirsim::body {

/// Of a pose or a posture: all that hangs together. Arrays are left, right.
struct Limbs {
  bool hips = true;
  bool spine = true;
  bool chest = true;
  bool head = true;
  bool arms = true;
  std::array<bool, 2> ankles{true, true};
};

/// Overwrites what depends on any of these of the outline, or of the pose; the rest stays as it is.
void update(Pose& pose, const Humanoid& humanoid, const Outline& outline, const Limbs& changed) noexcept;
void update(Posture& posture, const Humanoid& humanoid, const Pose& pose, const Limbs& changed) noexcept;

/// posture_of(), bit for bit, in less time where only arms or legs have moved since the last call.
class Poser {
 public:
  /// humanoid: outlives this.
  explicit Poser(const Humanoid& humanoid) noexcept : humanoid_(&humanoid) {}
  [[nodiscard]] const Humanoid& humanoid() const noexcept { return *humanoid_; }
  [[nodiscard]] const Posture& posture(const Outline& outline) noexcept;
  /// Bit i: the last call worked out part i anew.
  [[nodiscard]] std::uint32_t renewed() const noexcept { return renewed_; }

 private:
  const Humanoid* humanoid_;
  bool begun_ = false;
  Outline outline_;
  Pose pose_;
  Posture posture_;
  std::uint32_t renewed_ = 0;
};

}  // namespace pirsim::body
