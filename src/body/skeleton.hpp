// The joint tree: from a few quantities that decide a posture to the thirteen parts, and back to joint angles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "body/body_part.hpp"
#include "body/humanoid.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::body {

/// The circle on which the middle joint can lie: centre, radius (0 where the bones are stretched or folded).
struct ElbowCircle {
  Vec3 centre{0.0};
  Vec3 axis{0.0};  ///< unit, root to end
  double radius = 0.0;
};
[[nodiscard]] inline ElbowCircle elbow_circle(const Vec3& root, const Vec3& end, double upper, double lower) noexcept {
  const Vec3 way = end - root;
  const double distance = std::max(glm::length(way), 1e-9);
  const Vec3 axis = way / distance;
  const double reach = std::clamp(distance, std::abs(upper - lower) + 1e-9, upper + lower);
  const double along = (upper * upper - lower * lower + reach * reach) / (2.0 * reach);
  return {root + along * axis, axis, std::sqrt(std::max(0.0, upper * upper - along * along))};
}

/// The middle joint, bent towards `pole` (a direction that isn't parallel to root-end).
[[nodiscard]] inline Vec3 two_bone_joint(const Vec3& root, const Vec3& end, double upper, double lower,
                                         const Vec3& pole) noexcept {
  const ElbowCircle circle = elbow_circle(root, end, upper, lower);
  return circle.centre + circle.radius * glm::normalize(pole - glm::dot(pole, circle.axis) * circle.axis);
}

/// Shoulder (ball) and elbow (hinge). The upper arm's frame has its origin in the shoulder and its Y towards it from
/// the elbow; the elbow bends about X, positive forward.
struct ArmPose {
  Quat torso_from_upper_arm{1.0, 0.0, 0.0, 0.0};
  double elbow_flexion = 0.0;  ///< radians
};

/// Arrays are left, right.
struct Pose {
  Frame world_from_hips;                  ///< upright unless one lies; origin midway between the hip joints
  double spine_tilt = 0.0;                ///< radians about the hips' axis, positive forward
  double spine_lean = 0.0;                ///< radians, positive to the right
  double head_turn = 0.0;                 ///< radians about the neck, positive to the left
  double chest_m = 0.0;                   ///< by which breath has moved the torso's solid forward; no joint moves
  std::array<Frame, 2> world_from_ankle;  ///< origin in the ankle joint, facing as the foot does
  std::array<ArmPose, 2> arms;
};

/// Forward kinematics for spine, head and arms, two-bone inverse kinematics for the legs (knees forward).
[[nodiscard]] Posture posture_of(const Humanoid& humanoid, const Pose& pose) noexcept;

/// Of the torso in the hips' frame.
[[nodiscard]] Quat torso_rotation(const Pose& pose) noexcept;
/// Frame of the torso with its origin midway between the hips.
[[nodiscard]] Frame world_from_torso(const Pose& pose) noexcept;
/// The neck's axis, behind the head's centre.
[[nodiscard]] double neck_behind_m(const Measures& measures) noexcept;
/// The direction along X of the left side, 0, or the right side, 1.
[[nodiscard]] constexpr double sign_of(std::size_t side) noexcept { return side == 0 ? -1.0 : 1.0; }
/// The shoulder joint in the torso's frame.
[[nodiscard]] Vec3 shoulder(const Measures& measures, std::size_t side) noexcept;
/// The arm whose elbow and hand are at these points of the torso's frame; bone lengths win over the hand's place.
[[nodiscard]] ArmPose arm_through(const Vec3& shoulder, const Vec3& elbow, const Vec3& hand) noexcept;
[[nodiscard]] ArmPose blend(const ArmPose& a, const ArmPose& b, double weight_of_b) noexcept;

/// Twelve joints below the root, which is the pelvis.
enum class Joint : std::size_t {
  spine,
  neck,
  left_shoulder,
  right_shoulder,
  left_elbow,
  right_elbow,
  left_hip,
  right_hip,
  left_knee,
  right_knee,
  left_ankle,
  right_ankle,
};
inline constexpr std::size_t n_joints = 12;

/// Radians. Child relative to parent: flexion, then abduction (away from the middle), then twist about the child's
/// long axis (inwards).
struct JointAngles {
  double flexion = 0.0;
  double abduction = 0.0;
  double twist = 0.0;
};
struct JointLimits {
  JointAngles lower;
  JointAngles upper;
};
[[nodiscard]] const JointLimits& limits(Joint joint) noexcept;
[[nodiscard]] std::array<JointAngles, n_joints> joint_angles(const Posture& posture) noexcept;
/// The joint's place in the world as its parent has it, and as its child has it: the same point in a sound posture.
struct JointPlaces {
  Vec3 by_parent{0.0};
  Vec3 by_child{0.0};
};
[[nodiscard]] JointPlaces joint_places(const Humanoid& humanoid, const Posture& posture, Joint joint) noexcept;

}  // namespace pirsim::body
