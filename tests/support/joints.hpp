// Joints of the humanoid, their limits, and their angles as a posture has them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "engine/body/skeleton.hpp"

namespace pirsim::body::test {

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
/// The joint's place in the world as its parent has it, and as its child has it: the same point in a sound posture.
struct JointPlaces {
  Vec3 by_parent{0.0};
  Vec3 by_child{0.0};
};

struct Link {
  Part parent;
  Part child;
};
// In the order of Joint.
inline constexpr std::array<Link, n_joints> links{{{Part::pelvis, Part::torso},
                                                   {Part::torso, Part::head},
                                                   {Part::torso, Part::left_upper_arm},
                                                   {Part::torso, Part::right_upper_arm},
                                                   {Part::left_upper_arm, Part::left_forearm},
                                                   {Part::right_upper_arm, Part::right_forearm},
                                                   {Part::pelvis, Part::left_thigh},
                                                   {Part::pelvis, Part::right_thigh},
                                                   {Part::left_thigh, Part::left_shank},
                                                   {Part::right_thigh, Part::right_shank},
                                                   {Part::left_shank, Part::left_foot},
                                                   {Part::right_shank, Part::right_foot}}};

inline const JointLimits& limits(Joint joint) {
  constexpr double rounding = 1e-6;  // degrees: a hinge is exact but for rounding
  constexpr auto degrees = [](const JointAngles& lower, const JointAngles& upper) {
    return JointLimits{{radians(lower.flexion), radians(lower.abduction), radians(lower.twist)},
                       {radians(upper.flexion), radians(upper.abduction), radians(upper.twist)}};
  };
  // Ref: [AAOS1965] for the ranges of motion; rows marked `assumed` differ from it, with the reason.
  constexpr JointLimits spine = degrees({-25, -35, -45}, {80, 35, 45});
  constexpr JointLimits neck = degrees({-45, -45, -60}, {45, 45, 60});
  constexpr JointLimits shoulder = degrees({-60, -75, -90}, {180, 180, 90});
  constexpr JointLimits elbow = degrees({0, -rounding, -rounding}, {150, rounding, rounding});
  constexpr JointLimits hip = degrees({-30, -30, -45}, {120, 45, 45});
  // assumed 150 (135-155): calf against thigh.
  constexpr JointLimits knee = degrees({0, -rounding, -rounding}, {150, rounding, rounding});
  // assumed dorsiflexion 35 (30-45), which the ankle has under load; twist 35 (25-45) stands for the subtalar joint
  // and the rotation of the bent knee together, abduction for inversion and eversion.
  constexpr JointLimits ankle = degrees({-50, -35, -35}, {35, 35, 35});
  static constexpr std::array<JointLimits, n_joints> table{spine, neck, shoulder, shoulder, elbow, elbow,
                                                           hip,   hip,  knee,     knee,     ankle, ankle};
  return table[static_cast<std::size_t>(joint)];
}

/// Sign of flexion about +X (thigh, forearm and toes forward and up are positive; spine and knee bend the other way).
inline double flexion_sign(Joint joint) {
  switch (joint) {
    case Joint::spine:
    case Joint::neck:
    case Joint::left_knee:
    case Joint::right_knee:
      return -1.0;
    default:
      return 1.0;
  }
}
/// +1 for joints of the right side and of the middle.
inline double side_sign(Joint joint) {
  const auto index = static_cast<std::size_t>(joint);
  return index >= 2 && index % 2 == 0 ? -1.0 : 1.0;
}
/// The pelvis capsule lies on its side; joint angles count from the upright hips.
inline Quat upright(const Posture& posture, Part part) {
  const Quat& rotation = posture[at(part)].rotation;
  return part == Part::pelvis ? rotation * glm::angleAxis(std::numbers::pi / 2, Vec3(0, 0, 1)) : rotation;
}

inline Vec3 joint_in(const Humanoid& humanoid, Part part, Joint joint, const Vec3& end) {
  const auto side = static_cast<std::size_t>(joint) % 2;
  const Measures& m = humanoid.measures();
  if (part == Part::pelvis)
    return joint == Joint::spine ? Vec3(0.0) : Vec3(0, (side == 0 ? -0.5 : 0.5) * m.hip_width_m, 0);
  const Shape& shape = humanoid.primitives()[at(part)];
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return end * capsule->half_length;
  return Vec3(0.0);
}

inline std::array<JointAngles, n_joints> joint_angles(const Posture& posture) {
  std::array<JointAngles, n_joints> angles;
  for (std::size_t i = 0; i < n_joints; ++i) {
    const auto joint = static_cast<Joint>(i);
    const Quat relative = glm::conjugate(upright(posture, links[i].parent)) * upright(posture, links[i].child);
    // relative = Rx(flexion) Rz(abduction) Ry(twist)
    const Vec3 x = relative * Vec3(1, 0, 0);
    const Vec3 y = relative * Vec3(0, 1, 0);
    const Vec3 z = relative * Vec3(0, 0, 1);
    angles[i].flexion = flexion_sign(joint) * std::atan2(y.z, y.y);
    angles[i].abduction = side_sign(joint) * std::asin(std::clamp(-y.x, -1.0, 1.0));
    angles[i].twist = side_sign(joint) * std::atan2(z.x, x.x);
  }
  return angles;
}

inline JointPlaces joint_places(const Humanoid& humanoid, const Posture& posture, Joint joint) {
  const Link link = links[static_cast<std::size_t>(joint)];
  const Measures& m = humanoid.measures();
  const auto side = static_cast<std::size_t>(joint) % 2;
  Vec3 in_parent = joint_in(humanoid, link.parent, joint, Vec3(0, -1, 0));
  Vec3 in_child = joint_in(humanoid, link.child, joint, Vec3(0, 1, 0));
  const Vec3 hips_in_torso = glm::conjugate(posture[at(Part::torso)].rotation) *
                             (posture[at(Part::pelvis)].origin - posture[at(Part::torso)].origin);
  const Vec3 in_torso(0, hips_in_torso.y, hips_in_torso.z);  // z: breath moves the solid and none of its joints
  switch (joint) {
    case Joint::spine:
      in_child = in_torso;
      break;
    case Joint::left_shoulder:
    case Joint::right_shoulder:
      in_parent = in_torso + shoulder(m, side);
      break;
    case Joint::left_ankle:
    case Joint::right_ankle:
      in_child = Vec3(0, 0.5 * m.ankle_height_m, 0.5 * m.foot_length_m - m.heel_m);
      break;
    default:
      break;
  }
  if (joint == Joint::neck) {
    const double behind = neck_behind_m(m);
    in_child = Vec3(0, -humanoid.radius_m(Part::head), behind);
    in_parent = in_torso + Vec3(0, m.stature_m - 2.0 * humanoid.radius_m(Part::head) - m.hip_height_m, behind);
  }
  return {posture[at(link.parent)] * in_parent, posture[at(link.child)] * in_child};
}

}  // namespace pirsim::body::test
