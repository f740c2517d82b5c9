#include "sim/natural_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pirsim/geometry.hpp"

namespace pirsim::sim {
namespace {

using body::Channel;
using body::Stage;

constexpr double goes_on = 0.4;        // assumed (0.2-0.6): another act follows at once
constexpr double liveliness_sd = 0.4;  // assumed (0.3-0.6): of the logarithm of a person's rate
constexpr double pace_sd_m_s = 0.2;    // Ref: [Weidmann1993]: 0.26 in the open
constexpr double slowest_breath_hz = 0.2, fastest_breath_hz = 0.3;  // 12 to 18 breaths a minute, at rest
// How far the chest comes forward while head and limbs lie still: of sitters, Ref: [DeGroote1997]: 3 to 5 mm; lying,
// where the belly moves more [KanekoHorie2012], assumed (3-10).
constexpr double breath_m = 0.004, breath_lying_m = 0.006;
constexpr int breath_levels = 8;  // a posture changes 16 times a breath instead of 200 times
// How often a posture changes in small movements, or the next higher rate that divides the ticks: `assumed` (5 to 50).
// 25 changes a signal by 3.9 % of its rms, less
// than 34 rays a zone do; 5 by 21 % (analog_test.cpp).
constexpr int small_movements_hz = 25;
constexpr double settles_s = 1.0;   // assumed (0.6-1.5): into the posture of a new activity
constexpr double act_ends_s = 2.0;  // assumed (1-4): what is left of the act that one is met in
constexpr double looks_s = 0.8;     // assumed (0.5-1): the head turns to who speaks
constexpr double speaks_up_s = 1.0;
constexpr double farthest_look = radians(50);

struct Bounds {
  double low, high;
};
/// Where channels may come to lie: within the joints' limits whatever the others do, and within an arm's reach.
constexpr Bounds bounds_of(Channel channel) noexcept {
  switch (channel) {
    case Channel::trunk_tilt:
      return {radians(-15), radians(30)};
    case Channel::trunk_lean:
      return {radians(-12), radians(12)};
    case Channel::head_turn:
      return {radians(-55), radians(55)};
    case Channel::left_hand_ahead:
    case Channel::right_hand_ahead:
      return {-0.15, 0.08};
    case Channel::left_hand_up:
    case Channel::right_hand_up:
      return {0.0, 0.3};
    case Channel::left_hand_to_head:
    case Channel::right_hand_to_head:
      return {0.0, 1.0};
    case Channel::roll:
      return {radians(-100), radians(100)};
    case Channel::raise:
      return {0.0, radians(60)};
    case Channel::curl:
      return {0.0, 1.0};
    case Channel::chair_turn:
      break;
  }
  return {-pi, pi};
}

Bearing bearing_of(Stage stage) noexcept {
  if (stage == Stage::seated) return Bearing::seated;
  if (stage == Stage::lying) return Bearing::lying;
  return stage == Stage::standing ? Bearing::standing : Bearing::walking;
}

double total_weight(std::span<const Act> acts) noexcept {
  return std::accumulate(acts.begin(), acts.end(), 0.0, [](double sum, const Act& act) { return sum + act.weight; });
}

double mean_s(std::span<const Act> acts) noexcept {
  if (acts.empty()) return 0.0;
  const auto add = [](double sum, const Act& act) { return sum + act.weight * act.mean_s(); };
  return std::accumulate(acts.begin(), acts.end(), 0.0, add) / total_weight(acts);
}

}  // namespace

NaturalMotion::NaturalMotion(std::uint64_t seed, std::uint32_t run, std::uint32_t person, int tick_rate_hz)
    : stream_({seed, run, person, Purpose::natural_motion}), tick_rate_hz_(tick_rate_hz) {
  // Of mean 1 over people.
  liveliness_ = std::exp(liveliness_sd * stream_.normal() - 0.5 * liveliness_sd * liveliness_sd);
  breath_hz_ = slowest_breath_hz + (fastest_breath_hz - slowest_breath_hz) * stream_.uniform();
  breath_phase_ = stream_.uniform();
  Stream pace({seed, run, person, Purpose::pace});
  pace_ = std::clamp(pace.normal(), -2.0, 2.0);
}

double NaturalMotion::pace(double scripted_m_s) const noexcept {
  return std::max(0.4 * scripted_m_s, scripted_m_s + pace_sd_m_s * pace_);
}

void NaturalMotion::wait(double seconds) {
  next_ = tick_ + std::max<std::int64_t>(1, std::llround(seconds * tick_rate_hz_));
}

void NaturalMotion::be_still() {
  act_ = nullptr;
  phase_ = Phase::still;
  wait(repertoire().still.length_s(stream_.normal()) / liveliness_);
}

/// One is met in the middle of a still period, or at the end of an act, so that rates hold from the first moment on.
void NaturalMotion::enter(body::Motion& motion, const Situation& situation) {
  situation_ = situation;
  home_.fill(0.0);
  if (situation.bearing == Bearing::seated) {
    home_[static_cast<std::size_t>(Channel::chair_turn)] = motion.target(Channel::chair_turn);
  }
  if (situation.bearing == Bearing::lying) {
    home_[static_cast<std::size_t>(Channel::raise)] = motion.target(Channel::raise);
  }
  for (const Hold& hold : repertoire().holds) home_[static_cast<std::size_t>(hold.channel)] = hold.value;
  rest_ = home_;
  if (situation.bearing == Bearing::lying) {
    for (const Channel channel : {Channel::roll, Channel::curl}) rest_of(channel) = motion.target(channel);
  }
  motion.move_in_steps_of(std::max(1, tick_rate_hz_ / small_movements_hz));
  for (std::size_t i = 0; i < body::n_channels; ++i) motion.adjust(static_cast<Channel>(i), rest_[i], settles_s);
  act_ = nullptr;
  const Cycle now = cycle();
  phase_ = stream_.uniform() * now.mean_s < now.still_s ? Phase::still : Phase::returning;
  const double z = stream_.normal(), v = stream_.uniform();
  wait(phase_ == Phase::still ? std::max(settles_s, repertoire().still.rest_s(z, v) / liveliness_) : act_ends_s);
}

/// Who begins to speak moves soon. Who listens looks there when they move next.
void NaturalMotion::attend(const Attention& attention) {
  const bool begins = attention.talk == Talk::speaks && talk_ != Talk::speaks;
  talk_ = attention.talk;
  if (begins && phase_ == Phase::still)
    next_ = std::min<std::int64_t>(next_, tick_ + std::llround(speaks_up_s * tick_rate_hz_));
  rest_of(Channel::head_turn) =
      talk_ == Talk::listens ? std::clamp(attention.towards, -farthest_look, farthest_look) : 0.0;
}

/// By the renewal theorem: if an act and the stillness after it take c seconds on average, and a share p of the acts is
/// of a kind, that kind comes p / c times a second. Habits come at their published rates times this person's
/// liveliness; tasks fill what is left.
NaturalMotion::Cycle NaturalMotion::cycle() const {
  const Repertoire& all = repertoire();
  const double task_s = mean_s(all.tasks), still_s = (1.0 - goes_on) * all.still.mean_s / liveliness_;
  double cycles = 1.0;
  for (const Habit& habit : all.habits) cycles -= habit.per_s * liveliness_ * (mean_s(habit.acts) - task_s);
  return {(still_s + task_s) / cycles, still_s};
}

ActKind NaturalMotion::draw_kind() {
  double left = stream_.uniform() / cycle().mean_s;
  for (std::size_t i = 0; i < n_habits; ++i) {
    if ((left -= repertoire().habits[i].per_s * liveliness_) < 0.0) return static_cast<ActKind>(i);
  }
  return ActKind::task;
}

void NaturalMotion::begin_act() {
  const ActKind kind = draw_kind();
  ++begun_[static_cast<std::size_t>(kind)];
  const std::span<const Act> acts = repertoire().acts(kind);
  double left = stream_.uniform() * total_weight(acts);
  act_ = &acts.back();
  for (const Act& act : acts) {
    if ((left -= act.weight) >= 0.0) continue;
    act_ = &act;
    break;
  }
  phase_ = Phase::moving;
  repeats_left_ =
      act_->fewest + static_cast<int>(stream_.index(static_cast<std::uint32_t>(act_->most - act_->fewest + 1)));
}

void NaturalMotion::stroke(body::Motion& motion) {
  for (const Stroke& stroke : act_->strokes) {
    double way = stroke.low + (stroke.high - stroke.low) * stream_.uniform();
    if (stroke.side == Stroke::Side::either && stream_.index(2) == 1) way = -way;
    double& rest = rest_of(stroke.channel);
    const double home = home_[static_cast<std::size_t>(stroke.channel)];
    const Bounds bounds = bounds_of(stroke.channel);
    const double target = std::clamp((act_->after == Act::After::stays ? home : rest) + way, bounds.low, bounds.high);
    if (act_->after == Act::After::stays) rest = target;
    motion.adjust(stroke.channel, target, act_->stroke_s);
  }
  --repeats_left_;
  wait(act_->stroke_s);
}

double NaturalMotion::return_to_rest(body::Motion& motion) {
  double seconds = 0.0;
  const auto move = [&](Channel channel, double needs_s) {
    const double rest = rest_of(channel);
    if (motion.target(channel) == rest) return;
    motion.adjust(channel, rest, needs_s);
    seconds = std::max(seconds, needs_s);
  };
  for (const Stroke& stroke : act_->strokes) move(stroke.channel, act_->stroke_s);
  move(Channel::head_turn, looks_s);
  return seconds;
}

/// In steps, so that who breathes doesn't move at every tick.
void NaturalMotion::breathe(body::Motion& motion) const {
  const double breath = std::sin(2.0 * pi * (breath_phase_ + breath_hz_ * static_cast<double>(tick_) / tick_rate_hz_));
  const double depth_m = motion.stage() == Stage::lying ? breath_lying_m : breath_m;
  motion.breathe(depth_m * std::round(0.5 * (1.0 + breath) * breath_levels) / breath_levels);
}

void NaturalMotion::settle(body::Motion& motion, std::optional<Activity> activity) const {
  breathe(motion);
  for (const Hold& hold : sim::repertoire(bearing_of(motion.stage()), activity, Talk::none).holds) {
    motion.adjust(hold.channel, hold.value, settles_s);
  }
  for (int tick = 0; tick < settles_s * tick_rate_hz_; ++tick) motion.advance();
}

void NaturalMotion::tick(body::Motion& motion, std::optional<Activity> activity, const Attention& attention) {
  ++tick_;
  const Stage stage = motion.stage();
  const bool on_the_way = stage == Stage::sitting_down || stage == Stage::rising || stage == Stage::lying_down ||
                          stage == Stage::getting_up;
  if (on_the_way) {
    situation_.reset();
    act_ = nullptr;
    return;
  }
  breathe(motion);
  const Situation situation{bearing_of(stage), activity};
  if (situation_ != situation) enter(motion, situation);
  attend(attention);
  if (tick_ < next_) return;
  if (phase_ == Phase::moving && repeats_left_ == 0) {
    phase_ = Phase::returning;
    if (const double seconds = return_to_rest(motion); seconds > 0.0) return wait(seconds);
  }
  if (phase_ == Phase::returning && stream_.uniform() >= goes_on) return be_still();
  if (phase_ != Phase::moving) begin_act();
  stroke(motion);
}

}  // namespace pirsim::sim
