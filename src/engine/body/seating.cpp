#include "engine/body/seating.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <variant>

#include "engine/body/skeleton.hpp"
#include "model/core/text.hpp"
#include "pirsim/error.hpp"

namespace pirsim::body {

namespace {

constexpr double leg_extension = 0.995;      // assumed (0.99-1): knees 11 degrees bent
constexpr double furthest_off_axis_m = 0.3;  // assumed: more than that is another place, not an error
constexpr double furthest_off_heading = radians(45);
constexpr double furthest_slide_m = 1.5;       // assumed: a chair's way from under a table
constexpr double negligible_slide_m = 0.02;    // assumed: less is leaned away rather than walked
constexpr double lowest_thigh = radians(120);  // from the vertical; knees bent by about 130 degrees
constexpr double highest_thigh = radians(30);  // leaning rather than sitting
// A chair is moved by small steps. assumed (step 0.15-0.3 m, lift 0.02-0.05 m)
constexpr StepStyle shuffle{.step = 0.2, .lift_m = 0.03, .pitch_per_lift = 1.0, .first_foot = 0};

/// The leg of a standing person seen from the side.
struct StandingLeg {
  double knee_ahead_m;   ///< of hip and ankle, which are above one another
  double knee_height_m;  ///< above the floor
  double thigh_angle;    ///< from the vertical
};

StandingLeg standing_leg(const Measures& m) {
  const double distance = leg_extension * (m.thigh_m + m.shank_m);
  const double along = (m.shank_m * m.shank_m - m.thigh_m * m.thigh_m + distance * distance) / (2.0 * distance);
  const double ahead = std::sqrt(m.shank_m * m.shank_m - along * along);
  return {ahead, m.ankle_height_m + along, std::asin(ahead / m.thigh_m)};
}

/// Of the thigh from the vertical when the hips are at the seat's height; may be out of range.
double cosine_when_seated(const Measures& m, const SeatPlace& seat) {
  const double hip_height = seat.world_from_seat.origin.y - seat.floor_height_m;
  return (hip_height - standing_leg(m).knee_height_m) / m.thigh_m;
}

}  // namespace

double standing_hip_height_m(const Measures& m) noexcept {
  return m.ankle_height_m + leg_extension * (m.thigh_m + m.shank_m);
}

double fall_back_m(const Humanoid& humanoid, const SeatPlace& seat) noexcept {
  const Measures& m = humanoid.measures();
  const double cosine = std::clamp(cosine_when_seated(m, seat), -1.0, 1.0);
  return m.thigh_m * std::sqrt(1.0 - cosine * cosine) - standing_leg(m).knee_ahead_m;
}

std::optional<std::string> unfit_height(const Humanoid& humanoid, const SeatPlace& seat) {
  const Measures& m = humanoid.measures();
  const double cosine = cosine_when_seated(m, seat), knee_m = standing_leg(m).knee_height_m;
  if (cosine >= std::cos(lowest_thigh) && cosine <= std::cos(highest_thigh)) return std::nullopt;
  const Vec3& point = seat.world_from_seat.origin;
  return "the seat at (" + fixed(point.x, 2) + ", " + fixed(point.z, 2) + "), whose pelvis point is " +
         fixed(point.y - seat.floor_height_m, 2) + " m above the floor, can't be sat on by a person of " +
         fixed(m.stature_m, 2) + " m, who can sit from " + fixed(knee_m + m.thigh_m * std::cos(lowest_thigh), 2) +
         " m to " + fixed(knee_m + m.thigh_m * std::cos(highest_thigh), 2) + " m";
}

Seating::Seating(const Humanoid& humanoid, const SeatPlace& seat, const Placement& standing, const Feet& feet)
    : seat_(seat), from_(standing) {
  const Measures& m = humanoid.measures();
  if (const auto unfit = unfit_height(humanoid, seat)) throw Error(ErrorCode::infeasible, *unfit);
  const double cosine = cosine_when_seated(m, seat);
  const StandingLeg leg = standing_leg(m);
  thigh_m_ = m.thigh_m;
  knee_ahead_m_ = leg.knee_ahead_m;
  knee_height_m_ = leg.knee_height_m;
  standing_angle_ = leg.thigh_angle;
  seated_angle_ = std::acos(cosine);

  const double seat_heading = heading_of(seat.world_from_seat) + seat.approach_turn;
  const Vec2 seat_point = floor_point(seat.world_from_seat.origin);
  const Vec2 forward = direction_of(seat_heading);
  const double ahead = glm::dot(standing.position - seat_point, forward);
  double slide = fall_back_m(humanoid, seat) - ahead;
  const double off_axis = glm::length(standing.position - seat_point - ahead * forward);
  const double off_heading = wrapped(seat_heading - standing.heading);
  if (off_axis > furthest_off_axis_m || std::abs(slide) > furthest_slide_m ||
      std::abs(off_heading) > furthest_off_heading) {
    throw Error(ErrorCode::internal, "a person sits down from a place on the seat's axis, facing as the seat does");
  }
  if (std::abs(slide) < negligible_slide_m) slide = 0.0;
  const double before_m = fall_back_m(humanoid, seat) - slide;
  before_ = {seat_point + before_m * forward, standing.heading + off_heading};
  sliding_ = Track::slide(before_, before_.heading, slide);
  double feet_slide_m = sliding_.length();
  resting_angle_ = thigh_angle(1.0);
  if (slide < 0.0 && seat.feet_ahead_m > before_m + slide) {
    feet_slide_m = std::max(0.0, before_m - seat.feet_ahead_m);
    feet_share_ = feet_slide_m / sliding_.length();
    resting_angle_ = angle_with_feet_ahead(m, before_m - feet_slide_m);
  }
  shuffling_ = FootPlan(feet, feet_slide_m, shuffle, 0.5 * m.hip_width_m);
}

/// The knees are where thighs and shanks meet.
double Seating::angle_with_feet_ahead(const Measures& m, double ahead_m) const noexcept {
  const Vec3 hip(0.0, hip_height_m(1.0), 0.0), ankle(0.0, m.ankle_height_m, -ahead_m);
  const Vec3 knee = two_bone_joint(hip, ankle, m.thigh_m, m.shank_m, Vec3(0, 0, -1));
  return std::acos(std::clamp((hip.y - knee.y) / m.thigh_m, -1.0, 1.0));
}

double Seating::thigh_angle(double fall) const noexcept {
  return standing_angle_ + fall * (seated_angle_ - standing_angle_);
}

double Seating::hip_height_m(double fall) const noexcept {
  return knee_height_m_ + thigh_m_ * std::cos(thigh_angle(fall));
}

Placement Seating::pelvis(double fall, double slide_m) const noexcept {
  const double weight = smoothstep(fall);
  const Placement slid = sliding_.at(slide_m);
  const Placement over_feet{slid.position + (1.0 - weight) * (from_.position - before_.position),
                            slid.heading + (1.0 - weight) * (from_.heading - before_.heading)};
  return over_feet.shifted(knee_ahead_m_ - thigh_m_ * std::sin(thigh_angle(fall)), 0.0);
}

namespace {

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
