#include "body/lying.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <variant>

namespace pirsim::body {
namespace {

constexpr Vec3 x_axis(1, 0, 0), y_axis(0, 1, 0);

// All assumed; the range that looks like people is behind each.
constexpr double drawn_up_hip = radians(60);   // 40-90, of legs that are drawn up
constexpr double drawn_up_knee = radians(85);  // 60-120
constexpr double stretched_knee = radians(6);  // 3-10: a knee isn't locked
constexpr double pointed_toes = radians(25);   // 15-35
// Of the way from the edge: the trunk leans first, then the legs come up, and the pelvis moves over.
constexpr double trunk_until = 0.7, legs_from = 0.45, over_from = 0.5;

double between(double progress, double from, double to) { return smoothstep((progress - from) / (to - from)); }

/// How far a part reaches below its frame's origin, metres.
double reach_below_m(const Shape& shape, const Quat& rotation) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return capsule->radius + capsule->half_length * std::abs((rotation * y_axis).y);
  const Vec3 half = std::get<Box>(shape).half_extents;
  return half.x * std::abs((rotation * x_axis).y) + half.y * std::abs((rotation * y_axis).y) +
         half.z * std::abs((rotation * Vec3(0, 0, 1)).y);
}

/// How high above the surface the hips have to be. legs: how far they are on it, 0 to 1.
double least_height_m(const Humanoid& humanoid, const Posture& posture, double hips_y, double legs) {
  double least_m = edge_height_m(humanoid);
  for (std::size_t i = 0; i < n_parts; ++i) {
    const bool is_leg = i >= at(Part::left_thigh);
    const bool is_arm = i >= at(Part::left_upper_arm) && !is_leg;
    const double depth_m = hips_y - posture[i].origin.y + reach_below_m(humanoid.primitives()[i], posture[i].rotation);
    least_m = std::max(least_m, is_leg || is_arm ? legs * depth_m : depth_m);
  }
  return least_m;
}

/// Of a leg in the hips' frame, stretched or drawn up; hip_more: by which the trunk is raised from it.
Frame ankle_of(const Measures& m, double curl, double hip_more, std::size_t side) {
  const double hip = hip_more + curl * drawn_up_hip;
  const double shank = hip - std::lerp(stretched_knee, drawn_up_knee, curl);
  const auto along = [](double angle) { return Vec3(0, -std::cos(angle), -std::sin(angle)); };
  const Vec3 root(0.5 * sign_of(side) * m.hip_width_m, 0, 0);
  return {glm::angleAxis(shank - pointed_toes, x_axis), root + m.thigh_m * along(hip) + m.shank_m * along(shank)};
}

/// Hands on the belly, elbows beside the trunk; on a side both arms lie before the chest.
ArmPose arm_of(const Humanoid& humanoid, double on_side, std::size_t side) {
  const Measures& m = humanoid.measures();
  const double depth_m = std::get<Box>(humanoid.primitives()[at(Part::torso)]).half_extents.z;
  const double sign = sign_of(side), scale = m.stature_m / reference_stature_m;
  const Vec3 from = shoulder(m, side);
  const auto through = [&](const Vec3& hand, const Vec3& pole) {
    return arm_through(from, two_bone_joint(from, hand, m.upper_arm_m, m.forearm_m, pole), hand);
  };
  const double above_m = depth_m + humanoid.radius_m(Part::left_forearm);
  const ArmPose on_belly = through({sign * 0.07 * scale, 0.16 * scale, -above_m}, {sign, -0.5, 0.25});
  const ArmPose before_chest = through({sign * 0.12 * scale, 0.42 * scale, -0.42 * scale}, {0.15 * sign, -1.0, -0.2});
  return blend(on_belly, before_chest, on_side);
}

}  // namespace

double moved_over(double progress) noexcept { return between(progress, over_from, 1.0); }

double edge_height_m(const Humanoid& humanoid) noexcept { return humanoid.radius_m(Part::pelvis); }

void lie_down(Pose& pose, const Humanoid& humanoid, const LyingOutline& lying) noexcept {
  const Measures& m = humanoid.measures();
  const Frame edge = pose.world_from_hips;
  const double legs = between(lying.progress, legs_from, 1.0), trunk = between(lying.progress, 0.0, trunk_until);
  const Quat on_back = rotation_from_heading(lying.place.heading) * glm::angleAxis(0.5 * pi, x_axis);
  Frame& hips = pose.world_from_hips;
  hips.rotation = glm::slerp(edge.rotation, on_back, trunk) * glm::angleAxis(-lying.raise, x_axis) *
                  glm::angleAxis(lying.roll, y_axis);
  const double moved = moved_over(lying.progress);
  hips.origin.x += moved * (lying.place.position.x - edge.origin.x);
  hips.origin.z += moved * (lying.place.position.y - edge.origin.z);
  const double on_side = std::abs(std::sin(lying.roll));
  std::array<Frame, 2> hips_from_ankle;
  for (std::size_t side : {0U, 1U}) {
    const Frame seated = inverse(edge) * pose.world_from_ankle[side];
    const Frame up = ankle_of(m, lying.curl, lying.raise, side);
    hips_from_ankle[side] = {glm::slerp(seated.rotation, up.rotation, legs),
                             seated.origin + legs * (up.origin - seated.origin)};
    pose.world_from_ankle[side] = hips * hips_from_ankle[side];
    pose.arms[side] = blend(pose.arms[side], arm_of(humanoid, on_side, side), legs);
  }
  const double height_m = least_height_m(humanoid, posture_of(humanoid, pose), hips.origin.y, legs);
  hips.origin.y = lying.surface_m + height_m;
  for (std::size_t side : {0U, 1U}) pose.world_from_ankle[side] = hips * hips_from_ankle[side];
}

}  // namespace pirsim::body
