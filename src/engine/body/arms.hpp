// A scalar that moves to targets as people's limbs do, tick by tick.
#pragma once

#include <array>

#include "engine/body/skeleton.hpp"

namespace pirsim::body {

/// Minimum-jerk motion (a quintic in time) from the present value, velocity and acceleration to rest at a target.
/// Can be sent elsewhere at any tick; after the last tick the value is the target itself, bit for bit, whatever
/// came before. Ref: [FlashHogan1985].
class MinJerk {
 public:
  MinJerk() = default;
  explicit MinJerk(double resting_value) noexcept : target_(resting_value) { coefficients_[0] = resting_value; }

  /// Arrives after `ticks` ticks, or earlier where going on at the present speed would lead beyond the target.
  void move_to(double target, int ticks) noexcept;
  // Most are at rest at most ticks, and each person has sixteen.
  void advance() noexcept {
    if (!settled() && ++tick_ == ticks_) *this = MinJerk(target_);
  }
  [[nodiscard]] double value() const noexcept { return settled() ? target_ : moving_value(); }
  [[nodiscard]] double target() const noexcept { return target_; }
  [[nodiscard]] bool settled() const noexcept { return tick_ == ticks_; }
  bool operator==(const MinJerk&) const = default;

 private:
  [[nodiscard]] double moving_value() const noexcept;
  [[nodiscard]] double derivative(int order) const noexcept;  ///< per tick^order

  std::array<double, 6> coefficients_{};  ///< of tau^k, tau = tick/ticks
  double target_ = 0.0;
  int tick_ = 0;
  int ticks_ = 0;  ///< 0: at rest
};

// What arms do: swing along with the legs, lie on the thighs, work on a table.

/// Arm and spine motion of a seated person (Stefansson et al. 2021, section 3.1).
struct DeskWork {
  double arm_amplitude_m = 0.1;
  double arm_period_s = 3.0;
  bool operator==(const DeskWork&) const = default;
};

/// Hanging beside the body; each elbow is drawn forward or back after the opposite foot. feet_ahead_m: of the hips,
/// left and right.
[[nodiscard]] std::array<ArmPose, 2> hanging_arms(const Measures& measures,
                                                  const std::array<double, 2>& feet_ahead_m) noexcept;

/// thigh_angle: from the vertical, radians.
[[nodiscard]] std::array<ArmPose, 2> arms_on_thighs(const Humanoid& humanoid, const Quat& hips_from_torso,
                                                    double thigh_angle) noexcept;

/// Where a hand is beside its base place on the table, metres.
struct HandPlace {
  double ahead_m = 0.0;
  double up_m = 0.0;
};
/// Forearms on a plane, or a hand lifted from it. table_above_hips_m: the plane that the forearms touch. hands: left,
/// right.
[[nodiscard]] std::array<ArmPose, 2> arms_on_table(const Humanoid& humanoid, const Quat& hips_from_torso,
                                                   double table_above_hips_m,
                                                   const std::array<HandPlace, 2>& hands) noexcept;

/// Hands beside mouth and ears, as with a phone.
[[nodiscard]] std::array<ArmPose, 2> arms_at_head(const Humanoid& humanoid) noexcept;

/// From thighs (0) to table (1): hands are lifted on the way, so that they pass over the table's edge.
[[nodiscard]] ArmPose reach_over(const ArmPose& on_thigh, const ArmPose& on_table, double progress) noexcept;

}  // namespace pirsim::body
