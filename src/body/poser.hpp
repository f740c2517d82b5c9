// Postures that follow upon one another.
#pragma once

#include <cstdint>

#include "body/limbs.hpp"

namespace pirsim::body {

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
