// What arms do: swing along with the legs, lie on the thighs, work on a table.
#pragma once

#include "body/humanoid.hpp"
#include "body/skeleton.hpp"

namespace pirsim::body {

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
