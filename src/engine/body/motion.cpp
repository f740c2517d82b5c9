#include "engine/body/motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <string>

#include "model/schema/words.hpp"
#include "pirsim/error.hpp"

// The state machine: commands and the tick.

namespace pirsim::body {

namespace {

constexpr double walking_lift_m = 0.15;                // paper, section 2.2: ellipse 0.5 m long and 0.3 m high
constexpr double walking_pitch_per_lift = 2.6;         // assumed (1-2.9 rad/m): 13 degrees at mid-swing
constexpr double walking_acceleration_m_s2 = 1.5;      // assumed (1-2)
constexpr double turning_step = radians(22.5);         // of the pelvis; each foot turns by up to twice that
constexpr double turning_lift_m = 0.05;                // assumed (0.03-0.08)
constexpr double turning_speed = radians(90);          // per second, assumed (60-120)
constexpr double turning_acceleration = radians(180);  // per second squared, assumed (120-360)
constexpr double standstill_m_s = 0.05;                // assumed: slower than this is waiting
constexpr double turn_before_walking = radians(20);    // assumed: less is blended into the first step
constexpr double furthest_from_route_m = 0.1;          // assumed: more than that is another place

constexpr double sliding_speed_m_s = 0.4;       // assumed (0.2-0.6), highest
constexpr double shortest_slide_s = 0.6;        // assumed
constexpr double reach_s = 1.0;                 // assumed (0.6-1.5): hands between thighs and table
constexpr double tilt_s = 1.0;                  // assumed (0.5-2): for 15 degrees of spine tilt
constexpr double shortest_tilt_s = 0.4;         // assumed
constexpr double chair_turn_s = 1.5;            // assumed (1-3): a quarter turn
constexpr double lying_down_s = 3.5;            // assumed (2-6): from the edge, legs and all
constexpr double lying_speed_m_s = 0.4;         // assumed (0.2-0.6): a wide bed takes longer
constexpr double turning_over_s = 2.0;          // assumed (1.5-4): onto the back, or down from half-lying
constexpr double backmost_tilt = radians(-20);  // within the spine's limits, with room for a passing overshoot
constexpr double foremost_tilt = radians(50);

[[noreturn]] void refuse(const char* command, Stage stage) {
  throw Error(ErrorCode::internal, std::string(command) + " is not possible while " + std::string(name(stage)));
}

bool rests_at(const MinJerk& motion, double target) { return motion.settled() && motion.target() == target; }

/// By bytes, so that 0 and -0 count as different and no number as itself.
template <typename Value>
bool differ(const Value& a, const Value& b) noexcept {
  static_assert(sizeof(Value) % sizeof(double) == 0);
  return std::memcmp(static_cast<const void*>(&a), static_cast<const void*>(&b), sizeof a) != 0;
}

Limbs changes(const Outline& a, const Outline& b) noexcept {
  Limbs changed;
  if (a.lying.progress > 0.0 || b.lying.progress > 0.0) {  // what hangs on the surface hangs together
    Outline same_breath = a;
    same_breath.chest_m = b.chest_m;
    const bool any = differ(same_breath, b);
    return {any, any, differ(a.chest_m, b.chest_m), any, any, {any, any}};
  }
  changed.hips = differ(a.pelvis, b.pelvis) || differ(a.hip_height_m, b.hip_height_m);
  changed.spine = differ(a.spine_tilt, b.spine_tilt) || differ(a.spine_lean, b.spine_lean);
  changed.chest = differ(a.chest_m, b.chest_m);
  changed.head = differ(a.head_turn, b.head_turn);
  const bool floor = differ(a.floor_height_m, b.floor_height_m);
  for (const std::size_t side : {0U, 1U}) changed.ankles[side] = floor || differ(a.feet[side], b.feet[side]);
  changed.arms = changed.hips || changed.spine || changed.ankles[0] || changed.ankles[1] || differ(a.fall, b.fall) ||
                 differ(a.reach, b.reach) || differ(a.thigh_angle, b.thigh_angle) ||
                 differ(a.table_height_m, b.table_height_m) || differ(a.hand_offset_m, b.hand_offset_m) ||
                 differ(a.hand_ahead_m, b.hand_ahead_m) || differ(a.hand_up_m, b.hand_up_m) ||
                 differ(a.hand_to_head, b.hand_to_head);
  return changed;
}

constexpr std::uint32_t bit(Part left, std::size_t side = 0) {
  return 1U << (static_cast<std::uint32_t>(left) + static_cast<std::uint32_t>(side));
}

/// See update(Posture&, ...).
std::uint32_t parts_of(const Limbs& changed) noexcept {
  const bool trunk = changed.hips || changed.spine;
  std::uint32_t parts = 0;
  if (changed.hips) parts |= bit(Part::pelvis);
  if (trunk || changed.chest) parts |= bit(Part::torso);
  if (trunk || changed.head) parts |= bit(Part::head);
  for (const std::size_t side : {0U, 1U}) {
    if (trunk || changed.arms) parts |= bit(Part::left_upper_arm, side) | bit(Part::left_forearm, side);
    if (changed.hips || changed.ankles[side]) parts |= bit(Part::left_thigh, side) | bit(Part::left_shank, side);
    if (changed.ankles[side]) parts |= bit(Part::left_foot, side);
  }
  return parts;
}

constexpr double furthest_extension = 0.998;  // of a stretched leg that stands off to the side; assumed (0.995-1)
/// Within the spine's limits; tilts alone are within them already.
double swayed(double tilt) { return std::clamp(tilt, -20 * pi / 180, 50 * pi / 180); }

constexpr double lean_while_falling = 25 * pi / 180;  // assumed (15-40 degrees), at half way

double height_over(double leg_m, double horizontal_m) {
  return std::sqrt(std::max(0.0, leg_m * leg_m - horizontal_m * horizontal_m));
}

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

Manner natural_manner(double pace_m_s, double stature_m) noexcept {
  constexpr double mean_stature_m = 1.75;
  return {.pace_m_s = pace_m_s,
          .step_m = 0.63 * std::pow(pace_m_s, 0.42) * std::pow(stature_m / mean_stature_m, 0.79),
          .sitting_down_s = 1.5,
          .rising_s = 1.8};
}

std::string_view name(Stage stage) noexcept { return phases_of_body[static_cast<std::size_t>(stage)]; }

Motion::Motion(const Humanoid& humanoid, const Vec2& position, double heading, double floor_height_m, double tick_s)
    : humanoid_(humanoid), floor_height_m_(floor_height_m), tick_s_(tick_s) {
  manner_.pace_m_s = humanoid.walking_speed_m_s();
  manner_.step_m *= humanoid.measures().stature_m / reference_stature_m;
  const Placement place{position, heading};
  const double half_stance = 0.5 * humanoid.measures().hip_width_m;
  come_to_stand(place, {Footstep{place.shifted(0.0, -half_stance)}, Footstep{place.shifted(0.0, half_stance)}});
  update_stance();
}

int Motion::ticks(double seconds) const noexcept {
  return std::max(1, static_cast<int>(std::lround(seconds / tick_s_)));
}

void Motion::come_to_stand(const Placement& place, const Feet& feet) noexcept {
  stage_ = Stage::standing;
  stand_ = {place.position, wrapped(place.heading)};
  stand_feet_ = feet;
  track_speed_ = 0.0;
  followed_m_.reset();
}

void Motion::begin_track(Stage stage, const Track& track, const StepStyle& style) {
  track_ = track;
  steps_ = FootPlan(stand_feet_, track.length(), style, 0.5 * humanoid_.measures().hip_width_m);
  distance_ = 0.0;
  track_speed_ = 0.0;
  hips_lowered_m_ = 0.0;
  stage_ = stage;
}

void Motion::bring_feet_together() {
  const Feet feet_now = feet();
  const Placement place = pelvis();
  const double lowered = standing_hip_height_m(humanoid_.measures()) - hip_height_m(place, feet_now);
  come_to_stand(place, feet_now);
  const int airborne = feet_now[1].lift_m > 0.0 ? 1 : 0;
  begin_track(Stage::turning, Track::stay(place, 2.0 * turning_step),
              {.step = 2.0 * turning_step, .lift_m = turning_lift_m, .pitch_per_lift = 1.0, .first_foot = airborne});
  hips_lowered_m_ = lowered;
}

void Motion::begin_turn(double angle) {
  const int leading_foot = angle > 0.0 ? 0 : 1;
  begin_track(Stage::turning, Track::turn(stand_, angle),
              {.step = turning_step, .lift_m = turning_lift_m, .pitch_per_lift = 1.0, .first_foot = leading_foot});
}

void Motion::walk(const Route& route) {
  if (stage_ != Stage::standing) refuse("walking off", stage_);
  if (glm::distance(route.position(0.0), stand_.position) > furthest_from_route_m) {
    throw Error(ErrorCode::internal, "a route begins where the person stands");
  }
  if (route.length_m() > 0.0) walk_from(route, 0.0);
  update_stance();
}

void Motion::walk_from(const Route& route, double from_s) {
  const double aside = wrapped(route.heading(from_s) - stand_.heading);
  if (std::abs(aside) > turn_before_walking) {
    begin_turn(aside);
    remainder_ = Remainder{route, from_s};
    return;
  }
  const StepStyle style = walking_style();
  const double to_s = next_pivot(route, from_s, style.step);
  begin_track(Stage::walking, Track(route, from_s, to_s, stand_, style.step), style);
  if (to_s < route.length_m()) remainder_ = Remainder{route, to_s};
}

StepStyle Motion::walking_style() const noexcept {
  const double scale = humanoid_.measures().stature_m / reference_stature_m;
  return {.step = manner_.step_m, .lift_m = walking_lift_m * scale, .pitch_per_lift = walking_pitch_per_lift / scale};
}

void Motion::follow(const Route& route, std::span<const double> at_m, std::span<const double> headings) {
  if (stage_ != Stage::standing) refuse("following a way", stage_);
  const StepStyle style = walking_style();
  Track track(route, 0.0, route.length_m(), stand_, style.step);
  if (!headings.empty()) track.face(at_m, headings);
  begin_track(Stage::walking, track, style);
  followed_m_ = 0.0;
  update_stance();
}

void Motion::turn_to(double heading) {
  if (stage_ != Stage::standing) refuse("turning", stage_);
  const double angle = wrapped(heading - stand_.heading);
  if (angle != 0.0) begin_turn(angle);
  update_stance();
}

void Motion::stop() {
  if (stage_ == Stage::standing) return;
  if (!on_track()) refuse("stopping", stage_);
  remainder_.reset();
  if (stage_ == Stage::walking && track_speed_ < standstill_m_s) {
    bring_feet_together();
  } else {
    const double braking = stage_ == Stage::walking ? walking_acceleration_m_s2 : turning_acceleration;
    steps_.shorten(distance_, track_speed_ * track_speed_ / (2.0 * braking) + track_speed_ * tick_s_);
  }
  update_stance();
}

void Motion::sit_down(const SeatPlace& seat) {
  if (stage_ == Stage::rising && seat == seating_.seat()) {
    stage_ = Stage::sitting_down;
    return;
  }
  if (stage_ != Stage::standing) refuse("sitting down", stage_);
  seating_ = Seating(humanoid_, seat, stand_, stand_feet_);
  stage_ = Stage::sitting_down;
  update_stance();
}

void Motion::lie_down(const LyingPlace& bed) {
  if (stage_ != Stage::seated) refuse("lying down", stage_);
  rest();
  bed_ = bed;
  stage_ = Stage::lying_down;
}

void Motion::rise() {
  if (stage_ == Stage::rising || stage_ == Stage::getting_up) return;
  if (!on_seat()) refuse("rising", stage_);
  rest();
  for (MinJerk& motion : channels_) {
    if (!rests_at(motion, 0.0)) motion.move_to(0.0, ticks(in_bed() ? turning_over_s : fidget_s));
  }
  if (seating_.seat().approach_turn != 0.0) {
    MinJerk& chair = channels_[static_cast<std::size_t>(Channel::chair_turn)];
    chair.move_to(0.0, ticks(chair_turn_s));
  }
  chest_m_ = 0.0;
  stage_ = in_bed() ? Stage::getting_up : Stage::rising;
}

void Motion::work(const DeskWork& work) {
  if (stage_ != Stage::seated) refuse("desk work", stage_);
  // The oscillation starts with this tick; what the hands were off their base until now fades.
  hand_offset_left_over_m_ = MinJerk(reach_.value() > 0.0 ? hand_offset_m() : 0.0);
  hand_offset_left_over_m_.move_to(0.0, ticks(reach_s));
  work_ = work;
  work_tick_ = 0;
  reach_.move_to(1.0, ticks(reach_s));
}

void Motion::rest() {
  if (!on_seat()) return;
  reach_.move_to(0.0, ticks(reach_s));
  if (stage_ == Stage::seated) tilt_spine(0.0);
}

void Motion::tilt_spine(double target_rad) {
  if (stage_ != Stage::seated) refuse("tilting the spine", stage_);
  const double target = std::clamp(target_rad, backmost_tilt, foremost_tilt);
  const double seconds = tilt_s * std::sqrt(std::abs(target - tilt_.value()) / radians(15));
  tilt_.move_to(target, ticks(std::max(seconds, shortest_tilt_s)));
}

void Motion::adjust(Channel channel, double target, double seconds) {
  const bool on_the_way = stage_ == Stage::rising || stage_ == Stage::sitting_down || stage_ == Stage::lying_down ||
                          stage_ == Stage::getting_up;
  if (on_the_way) refuse("a small movement", stage_);
  channels_[static_cast<std::size_t>(channel)].move_to(target, ticks(seconds));
}

bool Motion::channels_rest() const noexcept {
  return std::ranges::all_of(channels_, [](const MinJerk& motion) { return rests_at(motion, 0.0); });
}

void Motion::limit_speed(double metres_per_second) { speed_limit_m_s_ = std::max(0.0, metres_per_second); }

void Motion::halt() noexcept {
  if (stage_ != Stage::walking) return;
  track_speed_ = 0.0;
  speed_limit_m_s_ = 0.0;
}

void Motion::advance() {
  const Stage before = stage_;
  const bool was_moving =
      on_track() || (on_seat() && !(fall_.settled() && slide_m_.settled() && channel(Channel::chair_turn).settled()));
  if (++since_channel_step_ >= channel_step_) {
    for (MinJerk& motion : channels_) {
      for (int i = 0; i < since_channel_step_; ++i) motion.advance();
    }
    since_channel_step_ = 0;
  }
  if (on_track()) advance_on_track();
  if (on_seat()) advance_on_seat();
  if (in_bed()) advance_in_bed();
  if (was_moving || stage_ != before) update_stance();
}

void Motion::update_stance() noexcept {
  stance_.pelvis = pelvis();
  stance_.feet = feet();
  stance_.hip_height_m = hip_height_m(stance_.pelvis, stance_.feet);
  if (on_seat() && channel(Channel::chair_turn).value() != 0.0) turn_with_chair(stance_);
}

void Motion::advance_on_track() {
  const bool walking = stage_ == Stage::walking;
  const double acceleration = walking ? walking_acceleration_m_s2 : turning_acceleration;
  const double wanted = walking ? std::min(manner_.pace_m_s, speed_limit_m_s_) : turning_speed;
  const double change = acceleration * tick_s_;
  // The highest speed from which, after this tick, one can still brake on the way that remains.
  const double remaining = steps_.length() - distance_;
  const double root = std::sqrt(tick_s_ * tick_s_ + 2.0 * remaining / acceleration);
  const double braking = acceleration * (root - tick_s_);
  track_speed_ = std::min(std::clamp(wanted, track_speed_ - change, track_speed_ + change), braking);
  if (followed_m_) track_speed_ = (*followed_m_ - distance_) / tick_s_;
  distance_ = followed_m_.value_or(distance_ + track_speed_ * tick_s_);
  followed_m_.reset();
  constexpr double arrived = 1e-7;  // metres or radians
  if (steps_.length() - distance_ > arrived) return;

  const Feet feet = steps_.feet(track_, steps_.length());
  come_to_stand(track_.at(steps_.length()), {Footstep{feet[0].print}, Footstep{feet[1].print}});
  if (!remainder_) return;
  const Remainder remainder = *remainder_;
  remainder_.reset();
  walk_from(remainder.route, remainder.from_s);
}

void Motion::advance_on_seat() noexcept {
  for (MinJerk* motion : {&fall_, &slide_m_, &tilt_, &reach_, &hand_offset_left_over_m_}) motion->advance();
  ++work_tick_;
  const auto slide_to = [this](double target) {
    const double seconds = 1.875 * std::abs(target - slide_m_.value()) / sliding_speed_m_s;  // minimum jerk's peak
    slide_m_.move_to(target, ticks(std::max(seconds, shortest_slide_s)));
  };
  const double seat_slide = seating_.slide_length_m();
  if (stage_ == Stage::sitting_down) {
    fall_.move_to(1.0, ticks(manner_.sitting_down_s));
    if (rests_at(fall_, 1.0)) slide_to(seat_slide);
    if (rests_at(fall_, 1.0) && rests_at(slide_m_, seat_slide)) turn_to_table();
  } else if (stage_ == Stage::rising && rests_at(reach_, 0.0) && rests_at(tilt_, 0.0) && channels_rest()) {
    slide_to(0.0);
    if (rests_at(slide_m_, 0.0)) fall_.move_to(0.0, ticks(manner_.rising_s));
    if (rests_at(fall_, 0.0)) come_to_stand(stand_, stand_feet_);
  }
}

void Motion::advance_in_bed() noexcept {
  lying_.advance();
  const Vec2 way = floor_point(bed_.world_from_place.origin) - stance_.pelvis.position;
  const double seconds = std::max(lying_down_s, 1.875 * glm::length(way) / lying_speed_m_s);  // minimum jerk's peak
  if (stage_ == Stage::lying_down) {
    lying_.move_to(1.0, ticks(seconds));
    if (rests_at(lying_, 1.0)) stage_ = Stage::lying;
  } else if (stage_ == Stage::getting_up && channels_rest()) {
    lying_.move_to(0.0, ticks(seconds));
    if (rests_at(lying_, 0.0)) stage_ = Stage::rising;
  }
}

/// A chair that was sat on turned away from the table turns back.
void Motion::turn_to_table() noexcept {
  const double wanted = -seating_.seat().approach_turn;
  MinJerk& chair = channels_[static_cast<std::size_t>(Channel::chair_turn)];
  if (rests_at(chair, wanted)) {
    stage_ = Stage::seated;
  } else {
    chair.move_to(wanted, ticks(chair_turn_s));
  }
}

bool Motion::settled() const noexcept {
  if (stage_ == Stage::standing) return true;
  return (stage_ == Stage::seated || stage_ == Stage::lying) && tilt_.settled() && reach_.settled() &&
         hand_offset_left_over_m_.settled();
}

const Posture& Poser::posture(const Outline& outline) noexcept {
  if (humanoid_->animal()) {
    renewed_ = (1U << n_parts) - 1U;
    return posture_ = posture_of(*humanoid_->animal(), outline);
  }
  const Limbs changed = begun_ ? changes(outline_, outline) : Limbs{};
  begun_ = true;
  outline_ = outline;
  update(pose_, *humanoid_, outline, changed);
  update(posture_, *humanoid_, pose_, changed);
  renewed_ = parts_of(changed);
  return posture_;
}

// How the state of motion becomes a posture.

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

void Motion::pose_as(const Outline& outline) noexcept {
  posed_ = outline;
  stance_.pelvis = outline.pelvis;
}

Outline Motion::outline() const noexcept {
  if (posed_) return *posed_;
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
  if (humanoid.animal()) return posture_of(*humanoid.animal(), outline);
  Pose pose;
  update(pose, humanoid, outline, {});
  return posture_of(humanoid, pose);
}

double Motion::heading() const noexcept { return wrapped(stance_.pelvis.heading); }

double Motion::speed_m_s() const noexcept { return stage_ == Stage::walking ? track_speed_ : 0.0; }

}  // namespace pirsim::body
