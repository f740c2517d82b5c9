#include "engine/body/arms.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/body/skeleton.hpp"

namespace pirsim::body {

void MinJerk::move_to(double target, int ticks) noexcept {
  if (target == target_) return;
  const double start = value();
  const double velocity = derivative(1);
  const double acceleration = derivative(2);
  const double way = target - start;
  // A quintic of duration T overshoots if v T > 2.5 way (a = 0); 2.2 leaves room for an acceleration.
  if (velocity * way > 0.0) ticks = std::min(ticks, static_cast<int>(2.2 * way / velocity));
  ticks_ = std::max(ticks, 1);
  tick_ = 0;
  target_ = target;
  const double n = ticks_;
  const double v = velocity * n;
  const double a = acceleration * n * n;
  coefficients_ = {start,
                   v,
                   0.5 * a,
                   10.0 * way - 6.0 * v - 1.5 * a,
                   -15.0 * way + 8.0 * v + 1.5 * a,
                   6.0 * way - 3.0 * v - 0.5 * a};
}

double MinJerk::moving_value() const noexcept {
  const double tau = static_cast<double>(tick_) / ticks_;
  double sum = 0.0;
  for (std::size_t k = 6; k-- > 0;) sum = sum * tau + coefficients_[k];
  return sum;
}

double MinJerk::derivative(int order) const noexcept {
  if (settled()) return 0.0;
  const double tau = static_cast<double>(tick_) / ticks_;
  double sum = 0.0;
  for (int k = 5; k >= order; --k) {
    double factor = 1.0;
    for (int i = 0; i < order; ++i) factor *= k - i;
    sum = sum * tau + factor * coefficients_[static_cast<std::size_t>(k)];
  }
  return sum / std::pow(static_cast<double>(ticks_), order);
}

namespace {

constexpr double fitted_stature_m = 1.86;

// assumed: abduction 10 (5-15), elbow 15 (10-30), swing 18 (15-25) degrees at the longest step.
constexpr double hanging_abduction = radians(10);
constexpr double hanging_elbow = radians(15);
constexpr double elbow_per_swing = 0.4;  // 0.3-1: the elbow bends further as the arm comes forward
constexpr double widest_swing = radians(18);
constexpr double longest_half_step_m = 0.25;  // semi-axis of the foot's ellipse, paper section 2.2

constexpr double hand_along_thigh = 0.68;  // assumed (0.5-0.9): from hip to knee

// Base place of forearms on a table, for the 1.86 m man: fitted together with the shipped room (body_fit).
constexpr double elbow_ahead_m = 0.189;
constexpr double elbow_beside_m = 0.260;
constexpr double hand_beside_m = 0.247;
constexpr double arm_follows_torso = 1.0;

// The hand that holds a phone or touches the face, from the head's centre, in radii of the head: assumed; nearer, the
// elbow would bend beyond its limit.
constexpr double beside_head = 1.15;
constexpr double below_head = 0.45;
constexpr double before_head = 1.2;

constexpr double longest_reach = 0.995;  // of the stretched arm, assumed (0.98-1): an elbow isn't locked
// The elbow swings out by at least acos of this from the lowest point it could have. assumed (0.94-0.99): 14 degrees,
// as in the fitted base place. The transition has this width, so that the elbow's speed stays bounded.
constexpr double lowest_elbow = 0.97;
constexpr double lowest_elbow_blend = 0.06;
constexpr double lift_over_edge = radians(35);  // assumed (20-60): further bending of the elbow on the way

/// min(x, limit) without a kink.
double smooth_min(double x, double limit, double width) {
  const double overlap = std::max(width - std::abs(x - limit), 0.0) / width;
  return std::min(x, limit) - 0.25 * width * overlap * overlap;
}

/// The hand in the plane of the table, as far out towards `hand` as the arm reaches.
Vec3 within_reach(const Vec3& shoulder, const Vec3& hand, double reach) {
  const double height = hand.y - shoulder.y;
  const Vec2 way = floor_point(hand - shoulder);
  const double longest = std::sqrt(std::max(0.0, reach * reach - height * height));
  const double length = glm::length(way);
  if (length <= longest) return hand;
  const Vec2 shortened = way * (longest / length);
  return {shoulder.x + shortened.x, hand.y, shoulder.z + shortened.y};
}

/// On the spheres about shoulder and hand and in the plane through the hand: the outer one of the two points; where
/// the spheres meet above the plane only, near the lowest point of the circle in which they meet.
Vec3 elbow_on_table(const Vec3& shoulder, const Vec3& hand, double plane, double upper, double lower,
                    std::size_t side) {
  const ElbowCircle circle = elbow_circle(shoulder, hand, upper, lower);
  const Vec3 down = glm::normalize(Vec3(0, -1, 0) + circle.axis.y * circle.axis);
  const Vec3 outwards = -sign_of(side) * glm::cross(circle.axis, down);
  const double drop = std::max(-circle.radius * down.y, 1e-9);
  const double cosine =
      std::clamp(smooth_min((circle.centre.y - plane) / drop, lowest_elbow, lowest_elbow_blend), -1.0, 1.0);
  const double sine = std::sqrt(1.0 - cosine * cosine);
  return circle.centre + circle.radius * (cosine * down + sine * outwards);
}

}  // namespace

std::array<ArmPose, 2> hanging_arms(const Measures& measures, const std::array<double, 2>& feet_ahead_m) noexcept {
  const double longest = longest_half_step_m * measures.stature_m / fitted_stature_m;
  // Left arm forward with the right foot; the sine lets the swing turn softly where steps change.
  const double stride = std::clamp(0.5 * (feet_ahead_m[1] - feet_ahead_m[0]) / longest, -1.0, 1.0);
  const double left_swing = widest_swing * std::sin(0.5 * std::numbers::pi * stride);
  std::array<ArmPose, 2> arms;
  for (std::size_t side : {0U, 1U}) {
    const double swing = -sign_of(side) * left_swing;
    arms[side].torso_from_upper_arm =
        glm::angleAxis(swing, Vec3(1, 0, 0)) * glm::angleAxis(sign_of(side) * hanging_abduction, Vec3(0, 0, 1));
    arms[side].elbow_flexion = hanging_elbow + elbow_per_swing * (swing + widest_swing);
  }
  return arms;
}

std::array<ArmPose, 2> arms_on_thighs(const Humanoid& humanoid, const Quat& hips_from_torso,
                                      double thigh_angle) noexcept {
  const Measures& m = humanoid.measures();
  const double sine = std::sin(thigh_angle);
  const double cosine = std::cos(thigh_angle);
  const double along = hand_along_thigh * m.thigh_m;
  const double above = humanoid.radius_m(Part::left_thigh) + humanoid.radius_m(Part::left_forearm);
  const Quat torso_from_hips = glm::conjugate(hips_from_torso);
  std::array<ArmPose, 2> arms;
  for (std::size_t side : {0U, 1U}) {
    const Vec3 thigh_point(0.5 * sign_of(side) * m.hip_width_m, -along * cosine, -along * sine);
    const Vec3 hand = torso_from_hips * (thigh_point + above * Vec3(0, sine, -cosine));
    const Vec3 from = shoulder(m, side);
    const Vec3 pole = torso_from_hips * Vec3(0.45 * sign_of(side), -0.3, 0.7);
    const Vec3 elbow = two_bone_joint(from, hand, m.upper_arm_m, m.forearm_m, pole);
    arms[side] = arm_through(from, elbow, hand);
  }
  return arms;
}

std::array<ArmPose, 2> arms_on_table(const Humanoid& humanoid, const Quat& hips_from_torso, double table_above_hips_m,
                                     const std::array<HandPlace, 2>& hands) noexcept {
  const Measures& m = humanoid.measures();
  const double scale = m.stature_m / fitted_stature_m;
  const double inwards = (elbow_beside_m - hand_beside_m) * scale;
  const double base_ahead = elbow_ahead_m * scale + std::sqrt(m.forearm_m * m.forearm_m - inwards * inwards);
  const double plane = table_above_hips_m + humanoid.radius_m(Part::left_forearm);
  const Quat torso_from_hips = glm::conjugate(hips_from_torso);
  std::array<ArmPose, 2> arms;
  for (std::size_t side : {0U, 1U}) {
    const Vec3 from = hips_from_torso * shoulder(m, side);
    const double ahead = base_ahead - arm_follows_torso * from.z + hands[side].ahead_m;
    const Vec3 wanted(sign_of(side) * hand_beside_m * scale, plane + hands[side].up_m, -ahead);
    const Vec3 hand = within_reach(from, wanted, longest_reach * (m.upper_arm_m + m.forearm_m));
    const Vec3 elbow = elbow_on_table(from, hand, hand.y - hands[side].up_m, m.upper_arm_m, m.forearm_m, side);
    arms[side] = arm_through(torso_from_hips * from, torso_from_hips * elbow, torso_from_hips * hand);
  }
  return arms;
}

std::array<ArmPose, 2> arms_at_head(const Humanoid& humanoid) noexcept {
  const Measures& m = humanoid.measures();
  const double r = humanoid.radius_m(Part::head);
  const double centre = m.stature_m - r - m.hip_height_m;
  std::array<ArmPose, 2> arms;
  for (std::size_t side : {0U, 1U}) {
    const Vec3 from = shoulder(m, side);
    const Vec3 hand(sign_of(side) * beside_head * r, centre - below_head * r, -before_head * r);
    const Vec3 pole(0.5 * sign_of(side), -0.8, -0.4);
    const Vec3 elbow = two_bone_joint(from, hand, m.upper_arm_m, m.forearm_m, pole);
    arms[side] = arm_through(from, elbow, hand);
  }
  return arms;
}

ArmPose reach_over(const ArmPose& on_thigh, const ArmPose& on_table, double progress) noexcept {
  if (progress <= 0.0) return on_thigh;
  if (progress >= 1.0) return on_table;
  ArmPose arm = blend(on_thigh, on_table, progress);
  arm.elbow_flexion += lift_over_edge * 4.0 * progress * (1.0 - progress);
  return arm;
}

}  // namespace pirsim::body
