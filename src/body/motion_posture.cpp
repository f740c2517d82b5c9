// How the state of motion becomes a posture.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "body/motion.hpp"
#include "body/poser.hpp"

namespace pirsim::body {

namespace {

constexpr double furthest_extension = 0.998;  // of a stretched leg that stands off to the side; assumed (0.995-1)
/// Within the spine's limits; tilts alone are within them already.
double swayed(double tilt) { return std::clamp(tilt, -20 * pi / 180, 50 * pi / 180); }

constexpr double lean_while_falling = 25 * pi / 180;  // assumed (15-40 degrees), at half way

double height_over(double leg_m, double horizontal_m) {
  return std::sqrt(std::max(0.0, leg_m * leg_m - horizontal_m * horizontal_m));
}

}  // namespace

Placement Motion::pelvis() const noexcept {
  if (on_track()) return track_.at(distance_);
  if (on_seat()) return seating_.pelvis(std::clamp(fall_.value(), 0.0, 1.0), slide_m_.value());
  return stand_;
}

Feet Motion::feet() const noexcept {
  if (on_track()) return steps_.feet(track_, distance_);
  if (on_seat()) return seating_.feet(slide_m_.value());
  return stand_feet_;
}

/// The chair turns about the pelvis, and the feet go with it.
void Motion::turn_with_chair(Stance& stance) const noexcept {
  const Placement before = stance.pelvis;
  const double turn = channel(Channel::chair_turn).value();
  stance.pelvis.heading += turn;
  const Vec2 ahead = direction_of(before.heading), right(-ahead.y, ahead.x);
  for (Footstep& foot : stance.feet) {
    const Vec2 offset = foot.print.position - before.position;
    foot.print.position = stance.pelvis.shifted(glm::dot(offset, ahead), glm::dot(offset, right)).position;
    foot.print.heading += turn;
  }
}

double Motion::hip_height_m(const Placement& pelvis, const Feet& feet) const noexcept {
  if (on_seat()) return seating_.hip_height_m(std::clamp(fall_.value(), 0.0, 1.0));
  const Measures& m = humanoid_.measures();
  const double standing = standing_hip_height_m(m);
  double height = standing;
  if (stage_ == Stage::walking) {
    // Both feet are half a step away where steps change, and one is below the hip halfway between.
    const double lowest = m.ankle_height_m + height_over(standing - m.ankle_height_m, 0.5 * steps_.step());
    height = lowest + (standing - lowest) * 0.5 * (1.0 + std::cos(2.0 * pi * distance_ / steps_.step()));
  }
  if (stage_ == Stage::turning) height -= hips_lowered_m_ * (1.0 - smoothstep(distance_ / steps_.length()));
  // On a bend a foot can be further away than that.
  const Vec2 ahead = direction_of(pelvis.heading);
  const Vec2 sideways(-ahead.y, ahead.x);
  for (std::size_t side : {0U, 1U}) {
    const Vec2 hip = pelvis.position + (side == 0 ? -0.5 : 0.5) * m.hip_width_m * sideways;
    const double reach =
        height_over(furthest_extension * (m.thigh_m + m.shank_m), glm::distance(hip, feet[side].print.position));
    height = std::min(height, m.ankle_height_m + feet[side].lift_m + reach);
  }
  return height;
}

double Motion::spine_tilt() const noexcept {
  const double more = channel(Channel::trunk_tilt).value();
  if (fall_.settled()) return more == 0.0 ? tilt_.value() : swayed(tilt_.value() + more);
  const double s = std::sin(pi * std::clamp(fall_.value(), 0.0, 1.0));
  return tilt_.value() + lean_while_falling * s * s;
}

double Motion::hand_offset_m() const noexcept {
  const double period = work_.arm_period_s / tick_s_;
  // A whole number of ticks repeats bit for bit.
  const double rounded = std::round(period);
  const bool whole = std::abs(period - rounded) < 1e-9 * period && rounded >= 1.0;
  const double phase = whole ? static_cast<double>(work_tick_ % static_cast<std::int64_t>(rounded)) / rounded
                             : std::fmod(static_cast<double>(work_tick_), period) / period;
  return work_.arm_amplitude_m * std::sin(2.0 * pi * phase) + hand_offset_left_over_m_.value();
}

Vec2 Motion::position() const noexcept {
  const Vec2& here = stance_.pelvis.position;
  if (!in_bed()) return here;
  return here + moved_over(lying_.value()) * (floor_point(bed_.world_from_place.origin) - here);
}

LyingOutline Motion::lying_outline() const noexcept {
  const Frame& place = bed_.world_from_place;
  return {std::clamp(lying_.value(), 0.0, 1.0),
          place.origin.y,
          {floor_point(place.origin), heading_of(place)},
          channel(Channel::roll).value(),
          channel(Channel::raise).value(),
          channel(Channel::curl).value()};
}

Outline Motion::outline() const noexcept {
  Outline outline;
  outline.pelvis = stance_.pelvis;
  outline.feet = stance_.feet;
  outline.floor_height_m = floor_height_m_;
  outline.hip_height_m = floor_height_m_ + stance_.hip_height_m;
  outline.spine_tilt = spine_tilt();
  outline.fall = std::clamp(fall_.value(), 0.0, 1.0);
  outline.reach = std::clamp(reach_.value(), 0.0, 1.0);
  if (in_bed() && lying_.value() > 0.0) outline.lying = lying_outline();
  outline.head_turn = channel(Channel::head_turn).value();
  outline.spine_lean = channel(Channel::trunk_lean).value();
  outline.chest_m = chest_m_;
  outline.hand_to_head = {std::clamp(channel(Channel::left_hand_to_head).value(), 0.0, 1.0),
                          std::clamp(channel(Channel::right_hand_to_head).value(), 0.0, 1.0)};
  if (outline.fall > 0.0) outline.thigh_angle = seating_.seated_thigh_angle();
  if (outline.reach > 0.0) {
    const double thighs = outline.hip_height_m + humanoid_.radius_m(Part::left_thigh);
    outline.table_height_m = seating_.seat().table_height_m.value_or(thighs);
    outline.hand_offset_m = hand_offset_m();
    const double scale = humanoid_.measures().stature_m / reference_stature_m;
    const auto way = [&](Channel which) { return scale * channel(which).value(); };
    outline.hand_ahead_m = {way(Channel::left_hand_ahead), way(Channel::right_hand_ahead)};
    outline.hand_up_m = {way(Channel::left_hand_up), way(Channel::right_hand_up)};
  }
  return outline;
}

namespace {

std::array<ArmPose, 2> arms_of(const Humanoid& humanoid, const Outline& outline, const Pose& pose) noexcept {
  std::array<ArmPose, 2> arms;
  if (outline.fall < 1.0) {
    const Frame hips_from_world = inverse(pose.world_from_hips);
    // Feet before a sitter don't make the arms swing: only their difference counts.
    arms = hanging_arms(humanoid.measures(), {-(hips_from_world * pose.world_from_ankle[0].origin).z,
                                              -(hips_from_world * pose.world_from_ankle[1].origin).z});
  }
  if (outline.fall > 0.0 && outline.reach < 1.0) {
    const auto resting = arms_on_thighs(humanoid, torso_rotation(pose), outline.thigh_angle);
    for (std::size_t side : {0U, 1U}) arms[side] = blend(arms[side], resting[side], smoothstep(outline.fall));
  }
  if (outline.reach > 0.0) {
    const double table_above_hips_m = outline.table_height_m - pose.world_from_hips.origin.y;
    const std::array<HandPlace, 2> hands{
        HandPlace{outline.hand_offset_m + outline.hand_ahead_m[0], outline.hand_up_m[0]},
        HandPlace{-outline.hand_offset_m + outline.hand_ahead_m[1], outline.hand_up_m[1]}};
    const auto working = arms_on_table(humanoid, torso_rotation(pose), table_above_hips_m, hands);
    for (std::size_t side : {0U, 1U}) arms[side] = reach_over(arms[side], working[side], outline.reach);
  }
  return arms;
}

void raise_hands(std::array<ArmPose, 2>& arms, const Humanoid& humanoid, const Outline& outline) noexcept {
  if (outline.hand_to_head == std::array<double, 2>{}) return;
  const auto raised = arms_at_head(humanoid);
  for (std::size_t side : {0U, 1U}) arms[side] = blend(arms[side], raised[side], outline.hand_to_head[side]);
}

}  // namespace

void update(Pose& pose, const Humanoid& humanoid, const Outline& outline, const Limbs& changed) noexcept {
  if (changed.hips) {
    pose.world_from_hips = {rotation_from_heading(outline.pelvis.heading),
                            Vec3(outline.pelvis.position.x, outline.hip_height_m, outline.pelvis.position.y)};
  }
  pose.spine_tilt = outline.spine_tilt;
  pose.spine_lean = outline.spine_lean;
  pose.head_turn = outline.head_turn;
  const double ankle_height = outline.floor_height_m + humanoid.measures().ankle_height_m;
  for (std::size_t side : {0U, 1U}) {
    if (!changed.ankles[side]) continue;
    const Footstep& foot = outline.feet[side];
    pose.world_from_ankle[side] = {
        rotation_from_heading(foot.print.heading) * glm::angleAxis(foot.pitch, Vec3(1, 0, 0)),
        Vec3(foot.print.position.x, ankle_height + foot.lift_m, foot.print.position.y)};
  }
  if (changed.arms) pose.arms = arms_of(humanoid, outline, pose);
  if (outline.lying.progress > 0.0 && changed.hips) {
    pose.chest_m = 0.0;  // breath lifts nobody
    lie_down(pose, humanoid, outline.lying);
  }
  if (changed.arms) raise_hands(pose.arms, humanoid, outline);
  pose.chest_m = outline.chest_m;
}

Posture posture_of(const Humanoid& humanoid, const Outline& outline) noexcept {
  Pose pose;
  update(pose, humanoid, outline, {});
  return posture_of(humanoid, pose);
}

double Motion::heading() const noexcept { return wrapped(stance_.pelvis.heading); }

double Motion::speed_m_s() const noexcept { return stage_ == Stage::walking ? track_speed_ : 0.0; }

}  // namespace pirsim::body
