#include "body/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>

#include "body/poser.hpp"

namespace pirsim::body {
namespace {

const Vec3 x_axis(1, 0, 0);
const Vec3 y_axis(0, 1, 0);
const Vec3 z_axis(0, 0, 1);

constexpr std::size_t at(Part left, std::size_t side) { return at(left) + side; }

/// The pelvis capsule's Y points to the person's right.
Quat hips_from_pelvis() { return {std::numbers::sqrt2 / 2, 0.0, 0.0, -std::numbers::sqrt2 / 2}; }

/// Rotation whose Y is `up` and whose X is as near to `right` as that allows. Both are unit vectors.
Quat rotation_of(const Vec3& right, const Vec3& up) {
  const Vec3 x = glm::normalize(right - glm::dot(right, up) * up);
  return glm::normalize(glm::quat_cast(glm::dmat3(x, up, glm::cross(x, up))));
}

double torso_centre(const Humanoid& humanoid) {
  // The box ends where the head's sphere begins.
  const Measures& m = humanoid.measures();
  const double top = m.stature_m - 2.0 * humanoid.radius_m(Part::head) + 0.002 * m.stature_m - m.hip_height_m;
  return top - std::get<Box>(humanoid.primitives()[at(Part::torso)]).half_extents.y;
}
double head_centre(const Humanoid& humanoid) {
  const Measures& m = humanoid.measures();
  return m.stature_m - humanoid.radius_m(Part::head) - m.hip_height_m;
}

/// The head turns about an axis that runs through the neck, a little behind its middle.
Frame world_from_head(const Humanoid& humanoid, const Frame& torso, double turn) {
  const Vec3 centre(0, head_centre(humanoid), 0);
  if (turn == 0.0) return {torso.rotation, torso * centre};
  const double ahead = neck_behind_m(humanoid.measures());
  const Quat turned = rotation_from_heading(turn);
  return torso * Frame{turned, centre + Vec3(0, 0, ahead) + turned * Vec3(0, 0, -ahead)};
}

void put_arm(const Measures& m, const Frame& torso, const ArmPose& arm, std::size_t side, Posture& posture) {
  const Frame upper{glm::normalize(torso.rotation * arm.torso_from_upper_arm), torso * shoulder(m, side)};
  const Frame lower{glm::normalize(upper.rotation * glm::angleAxis(arm.elbow_flexion, x_axis)),
                    upper * Vec3(0, -m.upper_arm_m, 0)};
  posture[at(Part::left_upper_arm, side)] = {upper.rotation, upper * Vec3(0, -0.5 * m.upper_arm_m, 0)};
  posture[at(Part::left_forearm, side)] = {lower.rotation, lower * Vec3(0, -0.5 * m.forearm_m, 0)};
}

void put_leg(const Measures& m, const Frame& hips, const Frame& ankle, std::size_t side, Posture& posture) {
  const Vec3 hip = hips * Vec3(0.5 * sign_of(side) * m.hip_width_m, 0, 0);
  // The knee points between where the pelvis and where the foot does; hip and ankle share the turn as their limits do.
  const Vec3 toes = ankle.rotation * Vec3(0, 0, -1), up = hips.up();
  const Vec3 pole = 35.0 * hips.forward() + 45.0 * glm::normalize(toes - glm::dot(toes, up) * up);
  const Vec3 knee = two_bone_joint(hip, ankle.origin, m.thigh_m, m.shank_m, pole);
  const Vec3 thigh_up = (hip - knee) / m.thigh_m;
  const Vec3 shank_up = glm::normalize(knee - ankle.origin);
  const Vec3 right = glm::normalize(glm::cross(pole, hip - ankle.origin));
  posture[at(Part::left_thigh, side)] = {rotation_of(right, thigh_up), knee + 0.5 * m.thigh_m * thigh_up};
  posture[at(Part::left_shank, side)] = {rotation_of(right, shank_up), knee - 0.5 * m.shank_m * shank_up};
}

void put_foot(const Measures& m, const Frame& ankle, std::size_t side, Posture& posture) {
  const Vec3 ankle_to_centre(0, -0.5 * m.ankle_height_m, m.heel_m - 0.5 * m.foot_length_m);
  posture[at(Part::left_foot, side)] = {ankle.rotation, ankle * ankle_to_centre};
}

}  // namespace

Quat torso_rotation(const Pose& pose) noexcept {
  const Quat tilted = glm::angleAxis(-pose.spine_tilt, x_axis);
  return pose.spine_lean == 0.0 ? tilted : tilted * glm::angleAxis(-pose.spine_lean, z_axis);
}

Frame world_from_torso(const Pose& pose) noexcept {
  return pose.world_from_hips * Frame{torso_rotation(pose), Vec3(0.0)};
}

double neck_behind_m(const Measures& measures) noexcept {
  return 0.016 * measures.stature_m;  // assumed (0.01-0.03): 3 cm
}

Vec3 shoulder(const Measures& measures, std::size_t side) noexcept {
  return {0.5 * sign_of(side) * measures.shoulder_width_m, measures.shoulder_height_m - measures.hip_height_m, 0.0};
}

ArmPose arm_through(const Vec3& shoulder, const Vec3& elbow, const Vec3& hand) noexcept {
  const Vec3 upper = glm::normalize(elbow - shoulder);
  const Vec3 lower = glm::normalize(hand - elbow);
  const double flexion = std::acos(std::clamp(glm::dot(upper, lower), -1.0, 1.0));
  return {rotation_of(glm::normalize(glm::cross(upper, lower)), -upper), flexion};
}

ArmPose blend(const ArmPose& a, const ArmPose& b, double weight_of_b) noexcept {
  if (weight_of_b <= 0.0) return a;
  if (weight_of_b >= 1.0) return b;
  const double sign = glm::dot(a.torso_from_upper_arm, b.torso_from_upper_arm) < 0.0 ? -1.0 : 1.0;
  const Quat sum = a.torso_from_upper_arm * (1.0 - weight_of_b) + b.torso_from_upper_arm * (sign * weight_of_b);
  return {glm::normalize(sum), a.elbow_flexion + weight_of_b * (b.elbow_flexion - a.elbow_flexion)};
}

void update(Posture& posture, const Humanoid& humanoid, const Pose& pose, const Limbs& changed) noexcept {
  const Measures& m = humanoid.measures();
  const Frame& hips = pose.world_from_hips;
  const bool trunk = changed.hips || changed.spine;
  if (changed.hips) posture[at(Part::pelvis)] = {glm::normalize(hips.rotation * hips_from_pelvis()), hips.origin};
  if (trunk || changed.chest || changed.head || changed.arms) {
    const Frame torso = world_from_torso(pose);
    if (trunk || changed.chest)
      posture[at(Part::torso)] = {torso.rotation, torso * Vec3(0, torso_centre(humanoid), -pose.chest_m)};
    if (trunk || changed.head) posture[at(Part::head)] = world_from_head(humanoid, torso, pose.head_turn);
    for (std::size_t side : {0U, 1U}) {
      if (trunk || changed.arms) put_arm(m, torso, pose.arms[side], side, posture);
    }
  }
  for (std::size_t side : {0U, 1U}) {
    const Frame& ankle = pose.world_from_ankle[side];
    if (changed.hips || changed.ankles[side]) put_leg(m, hips, ankle, side, posture);
    if (changed.ankles[side]) put_foot(m, ankle, side, posture);
  }
}

Posture posture_of(const Humanoid& humanoid, const Pose& pose) noexcept {
  Posture posture;
  update(posture, humanoid, pose, {});
  return posture;
}

}  // namespace pirsim::body
