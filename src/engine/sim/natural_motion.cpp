#include "engine/sim/natural_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "pirsim/geometry.hpp"

namespace pirsim::sim {
namespace {

using body::Channel;
using Side = Stroke::Side;
using enum Act::After;

// The standard deviation of the logarithm. Fitted to silences of two counted offices; trunk, hands and head that moved
// at their published rates independently of each other would leave stillness with 1.2. Range tried: 1.0-1.4.
constexpr double spread = 1.0;
// Probability that an act follows at once on another one. Fitted to the same rooms (0.4-0.8 tried).
constexpr double in_bouts = 0.6;
// In 16 hours of one to three people at desks no silence reached 8 minutes: nobody awake is still for longer than this.
constexpr double longest_awake_s = 300.0;  // assumed (200-400)

constexpr StillPeriods awake(double mean_s) { return {mean_s, in_bouts, longest_awake_s}; }

// Fitted to the seconds with motion and the silences of two counted offices (5-12 tried).
constexpr StillPeriods at_work = awake(7.5);
// Fitted to two counted meeting rooms (2-8 tried).
constexpr StillPeriods in_meeting = awake(3.0);
// Who is absorbed moves less [Witchel2016]: assumed (12-24). Before a television more would leave no room for what was
// counted.
constexpr StillPeriods while_absorbed = awake(18.0);
constexpr StillPeriods while_speaking = awake(1.2);     // assumed (0.6-2.2): hands rest between two gestures
constexpr StillPeriods while_walking = awake(9.0);      // assumed (4-18): looks ahead in between
constexpr StillPeriods while_eating = awake(7.5);       // assumed (4-12): chews
constexpr StillPeriods at_stove_or_basin = awake(3.0);  // assumed (1.5-6): the hands are at work
// Eleven movements an hour, of one act or several in a row. Ref: [Montini2024]
constexpr StillPeriods while_asleep{320.0, 0.4};  // another act at once: assumed (0.2-0.6)

constexpr const char* assumed = "assumed";
constexpr const char* reading_speed = "weight: a page of 300 words takes 75 s at 238 words a minute [Brysbaert2019]";

// Shifts: the body comes to rest in another posture. Amplitudes of sitters' trunk and hands: fitted to the seconds with
// motion of two counted offices (trunk 1-2 times, hands 1-3 times what a first guess had).
constexpr Stroke lean[]{{Channel::trunk_tilt, radians(-15), radians(21)}};
constexpr Stroke shift_on_chair[]{{Channel::trunk_lean, radians(3), radians(10), Side::either},
                                  {Channel::trunk_tilt, radians(-9), radians(12)}};
constexpr Stroke turn_chair[]{{Channel::chair_turn, radians(4), radians(18), Side::either}};
constexpr Act seated_shifts[]{{"lean", 1, lean, 1.4, 1, 1, stays, assumed},
                              {"shift on the chair", 1, shift_on_chair, 1.0, 1, 1, stays, assumed},
                              {"turn the chair", 1, turn_chair, 1.5, 1, 1, stays, assumed}};

constexpr Stroke sway[]{{Channel::trunk_tilt, radians(1.5), radians(6), Side::either}};
constexpr Act fidgets[]{{"sway", 1, sway, 0.6, 1, 3, returns, assumed}};

// A hand lies at the face for some seconds. Ref: [Zhang2020]: 9 % of the time, 66 % of the touches by the other hand
// than one writes with.
constexpr const char* self_touch = "rate, hand and length [Zhang2020]";
constexpr Stroke left_to_face[]{{Channel::left_hand_to_head, 0.9, 0.9}};
constexpr Stroke right_to_face[]{{Channel::right_hand_to_head, 0.9, 0.9}};
constexpr Act touches[]{{"touch the face", 2, left_to_face, 1.0, 1, 10, returns, self_touch},
                        {"touch the face with the right hand", 1, right_to_face, 1.0, 1, 10, returns, self_touch}};
constexpr Act touches_with_free_hand[]{{"touch the face", 1, right_to_face, 1.0, 1, 10, returns, self_touch}};

constexpr Stroke look[]{{Channel::head_turn, radians(15), radians(50), Side::either}};
constexpr Act looks[]{{"look round", 1, look, 0.7, 1, 2, returns, assumed}};

constexpr Stroke type[]{{Channel::left_hand_ahead, -0.05, 0.05}, {Channel::right_hand_ahead, -0.05, 0.05}};
constexpr Stroke mouse[]{{Channel::right_hand_ahead, -0.12, 0.08}};
constexpr Stroke reach[]{{Channel::right_hand_ahead, 0.03, 0.08}, {Channel::trunk_tilt, radians(6), radians(14)}};
constexpr Act typing[]{{"type", 10, type, 0.35, 3, 14, returns, assumed},
                       {"use the mouse", 5, mouse, 0.7, 2, 6, returns, assumed},
                       {"reach for something", 1, reach, 1.0, 1, 1, returns, assumed}};

constexpr Stroke turn_page[]{{Channel::right_hand_up, 0.03, 0.07}, {Channel::right_hand_ahead, -0.10, 0.04}};
constexpr Stroke glance[]{{Channel::head_turn, radians(4), radians(12), Side::either}};
constexpr Act reading[]{{"follow the lines", 7, glance, 0.8, 1, 4, returns, assumed},
                        {"turn a page", 1, turn_page, 0.7, 1, 2, returns, reading_speed}};

constexpr Stroke gesture[]{{Channel::left_hand_up, 0.04, 0.18},
                           {Channel::right_hand_up, 0.04, 0.18},
                           {Channel::left_hand_ahead, -0.08, 0.08},
                           {Channel::right_hand_ahead, -0.08, 0.08}};
constexpr Stroke lean_to[]{{Channel::trunk_tilt, radians(-8), radians(12)},
                           {Channel::trunk_lean, radians(1), radians(6), Side::either}};
constexpr Stroke nod[]{{Channel::trunk_tilt, radians(0.5), radians(2)}};
constexpr Stroke take_notes[]{{Channel::right_hand_ahead, -0.05, 0.05}};
constexpr Act listening[]{{"nod", 1, nod, 0.4, 1, 3, returns, assumed},
                          {"take notes", 1, take_notes, 0.35, 2, 12, returns, assumed},
                          {"glance", 1, glance, 0.6, 1, 1, returns, assumed},
                          {"lean to somebody", 1, lean_to, 0.9, 1, 1, returns, assumed},
                          {"turn to somebody", 1, turn_chair, 1.0, 1, 1, returns, assumed}};
constexpr Act speaking[]{{"gesture", 3, gesture, 0.7, 2, 6, returns, assumed},
                         {"lean to somebody", 1, lean_to, 0.9, 1, 1, returns, assumed}};

constexpr Stroke one_hand[]{{Channel::right_hand_up, 0.03, 0.15}, {Channel::right_hand_ahead, -0.06, 0.06}};
constexpr Act phoning[]{{"gesture with one hand", 1, one_hand, 0.7, 1, 4, returns, assumed},
                        {"look round", 1, look, 0.7, 1, 2, returns, assumed}};
constexpr Hold at_the_ear[]{{Channel::left_hand_to_head, 1.0}};

constexpr Act sitting_idly[]{{"look round", 1, look, 0.7, 1, 2, returns, assumed},
                             {"move a hand", 1, one_hand, 0.7, 1, 2, returns, assumed}};

// On the feet. Hands that hang are raised part of the way to the head.
constexpr Stroke shift_weight[]{{Channel::trunk_lean, radians(1), radians(3), Side::either}};
constexpr Act standing_shifts[]{{"shift the weight", 1, shift_weight, 1.2, 1, 1, stays, assumed}};
constexpr Stroke raise_hands[]{{Channel::left_hand_to_head, 0.15, 0.45}, {Channel::right_hand_to_head, 0.15, 0.45}};
constexpr Stroke raise_one_hand[]{{Channel::right_hand_to_head, 0.15, 0.45}};
constexpr Stroke write_high[]{{Channel::right_hand_to_head, 0.45, 0.65}, {Channel::trunk_tilt, 0.0, radians(4)}};
constexpr Stroke turn_trunk[]{{Channel::head_turn, radians(30), radians(55), Side::either},
                              {Channel::trunk_lean, radians(1), radians(4), Side::either}};
constexpr Act standing_listening[]{{"nod", 1, nod, 0.4, 1, 3, returns, assumed},
                                   {"glance", 1, glance, 0.6, 1, 1, returns, assumed}};
constexpr Act standing_speaking[]{{"gesture", 1, raise_hands, 0.6, 2, 8, returns, assumed}};
constexpr Act standing_phoning[]{{"gesture with one hand", 1, raise_one_hand, 0.6, 1, 5, returns, assumed},
                                 {"look round", 1, look, 0.7, 1, 2, returns, assumed}};
constexpr Act at_whiteboard[]{{"write", 2, write_high, 0.5, 4, 20, returns, assumed},
                              {"point", 1, raise_one_hand, 0.8, 1, 2, returns, assumed},
                              {"turn to the others", 1, turn_trunk, 0.9, 1, 1, returns, assumed}};

constexpr Stroke to_mouth[]{{Channel::right_hand_to_head, 0.8, 1.0}, {Channel::trunk_tilt, radians(1), radians(6)}};
constexpr Stroke gather[]{{Channel::left_hand_ahead, -0.02, 0.03}, {Channel::right_hand_ahead, -0.02, 0.03}};
// Four bites a minute: assumed (3-6).
constexpr Act eating[]{{"bring to the mouth", 5, to_mouth, 0.9, 1, 1, returns, assumed},
                       {"gather on the plate", 4, gather, 0.4, 2, 6, returns, assumed},
                       {"glance", 1, glance, 0.6, 1, 1, returns, assumed}};
constexpr Act watching[]{{"glance", 3, glance, 0.6, 1, 1, returns, assumed},
                         {"drink or take a bite", 1, to_mouth, 1.2, 1, 2, returns, assumed}};

// At a stove or a basin.
constexpr Stroke chop[]{{Channel::left_hand_to_head, 0.15, 0.25}, {Channel::right_hand_to_head, 0.12, 0.30}};
constexpr Stroke stir[]{{Channel::right_hand_to_head, 0.15, 0.35}, {Channel::trunk_lean, radians(-2), radians(2)}};
constexpr Stroke reach_aside[]{{Channel::trunk_lean, radians(4), radians(12), Side::either},
                               {Channel::right_hand_to_head, 0.2, 0.7}};
constexpr Stroke bend[]{{Channel::trunk_tilt, radians(6), radians(22)}};
constexpr Stroke wash_face[]{{Channel::left_hand_to_head, 0.7, 1.0},
                             {Channel::right_hand_to_head, 0.7, 1.0},
                             {Channel::trunk_tilt, radians(8), radians(25)}};
constexpr Act at_stove[]{{"chop", 3, chop, 0.3, 6, 30, returns, assumed},
                         {"stir", 3, stir, 0.5, 4, 16, returns, assumed},
                         {"reach for something", 3, reach_aside, 0.9, 1, 2, returns, assumed},
                         {"bend over it", 1, bend, 1.0, 1, 1, returns, assumed}};
constexpr Act at_basin[]{{"wash the hands", 3, chop, 0.35, 6, 24, returns, assumed},
                         {"wash the face", 1, wash_face, 0.6, 1, 4, returns, assumed},
                         {"bend over it", 1, bend, 1.0, 1, 1, returns, assumed}};

// Lying. Who sleeps moves for 4 s, in the median, mostly the whole body: stretches in half and scratches in a third of
// the movements with a pattern. Ref: [Montini2024]. Which of them turn the body over: Ref: [Skarpsno2017].
constexpr const char* asleep_as_seen = "kinds and length [Montini2024]; amplitude assumed";
constexpr Stroke turn_over[]{{Channel::roll, radians(-95), radians(95)}, {Channel::curl, 0.0, 0.8}};
constexpr Stroke move_legs[]{{Channel::curl, 0.0, 0.8}};
constexpr Stroke stretch[]{{Channel::curl, 0.0, 0.8},
                           {Channel::left_hand_to_head, 0.2, 0.6},
                           {Channel::right_hand_to_head, 0.2, 0.6},
                           {Channel::head_turn, radians(5), radians(35), Side::either}};
constexpr Stroke scratch[]{{Channel::right_hand_to_head, 0.6, 1.0}};
constexpr Stroke move_head[]{{Channel::head_turn, radians(5), radians(35), Side::either}};
constexpr Act turns_in_bed[]{{"turn over", 1, turn_over, 3.0, 1, 1, stays, "rate [Skarpsno2017]; angles assumed"}};
constexpr Act asleep[]{{"stretch", 5, stretch, 1.5, 1, 1, returns, asleep_as_seen},
                       {"scratch", 3, scratch, 0.5, 3, 6, returns, asleep_as_seen},
                       {"move the legs", 1, move_legs, 1.5, 1, 1, stays, assumed},
                       {"move the head", 1, move_head, 0.8, 1, 1, returns, assumed}};
constexpr Act settling[]{{"shift on the chair", 1, shift_on_chair, 2.0, 1, 1, stays, assumed}};
constexpr Act dozing[]{{"scratch", 1, scratch, 0.5, 3, 6, returns, asleep_as_seen},
                       {"move the head", 1, move_head, 0.8, 1, 1, returns, assumed}};
constexpr Stroke stretch_legs[]{{Channel::curl, 0.0, 0.4}};
constexpr Act lying_shifts[]{{"move the legs", 1, stretch_legs, 1.2, 1, 1, stays, assumed}};
constexpr Act lying_idly[]{{"glance", 1, glance, 0.6, 1, 2, returns, assumed}};

using Habits = std::array<Habit, n_habits>;
constexpr double an_hour = 3600.0;
// Of pelvis and back at people's own desks. Ref: [ApplErgon2024]: 9 and 13 in 15 minutes
constexpr Habit seated_shift{seated_shifts, 9.0 / 900.0}, seated_fidget{fidgets, 13.0 / 900.0};
constexpr Habit touch{touches, 50.0 / an_hour};  // Ref: [Zhang2020]: half of 98.7
// assumed (30-230): [Cho2025] has 227 without the trunk over whole days
constexpr Habit look_round{looks, 60.0 / an_hour};
constexpr Habit look_away{looks, 120.0 / an_hour};  // from a television. Ref: [AndersonField1983]: one to two hundred
constexpr Habits at_desk{{seated_shift, seated_fidget, touch, look_round}};
constexpr Habits on_phone{{seated_shift, seated_fidget, {touches_with_free_hand, touch.per_s}, look_round}};
constexpr Habits before_television{{seated_shift, seated_fidget, touch, look_away}};
// Ref: [DuarteZatsiorsky1999]: sideways, of those who stand for half an hour as they like
constexpr Habit standing_shift{standing_shifts, 1.0 / 199.0}, standing_fidget{fidgets, 1.0 / 49.0};
constexpr Habits on_feet{{standing_shift, standing_fidget, touch, look_round}};
constexpr Habits on_feet_on_phone{{standing_shift, standing_fidget, {touches_with_free_hand, touch.per_s}, look_round}};
constexpr Habit lying_shift{lying_shifts, seated_shift.per_s};  // assumed: as seated
constexpr Habits in_bed{{lying_shift, {}, touch, look_round}};
constexpr Habits in_bed_before_television{{lying_shift, {}, touch, look_away}};
constexpr double turns_per_s = 1.6 / an_hour;  // Ref: [Skarpsno2017]: 0.7 is the standard deviation over people
constexpr Habits asleep_in_bed{{{turns_in_bed, turns_per_s}}}, asleep_in_chair{{{settling, turns_per_s}}};

/// In the order of Activity.
using ByActivity = std::array<Repertoire, activity_names.size()>;
constexpr Repertoire seated_idly{at_desk, sitting_idly, {}, at_work};
constexpr ByActivity seated{{{at_desk, typing, {}, at_work},
                             {at_desk, reading, {}, while_absorbed},
                             {at_desk, listening, {}, in_meeting},
                             {on_phone, phoning, at_the_ear, at_work},
                             seated_idly,
                             {asleep_in_chair, dozing, {}, while_asleep},
                             {before_television, watching, {}, while_absorbed},
                             seated_idly,
                             seated_idly,
                             {at_desk, eating, {}, while_eating}}};
constexpr Repertoire seated_speaker{at_desk, speaking, {}, while_speaking};
constexpr Repertoire standing_idly{on_feet, looks, {}, at_work};
constexpr ByActivity standing{{standing_idly,
                               standing_idly,
                               {on_feet, standing_listening, {}, in_meeting},
                               {on_feet_on_phone, standing_phoning, at_the_ear, at_work},
                               {on_feet, at_whiteboard, {}, while_speaking},
                               standing_idly,
                               {on_feet, watching, {}, while_absorbed},
                               {on_feet, at_stove, {}, at_stove_or_basin},
                               {on_feet, at_basin, {}, at_stove_or_basin},
                               {on_feet, eating, {}, while_eating}}};
constexpr Repertoire standing_speaker{on_feet, standing_speaking, {}, while_speaking};
constexpr Repertoire walking{{}, looks, {}, while_walking};
constexpr Repertoire walking_on_phone{{}, looks, at_the_ear, while_walking};
constexpr Repertoire lying{in_bed, lying_idly, {}, at_work};
constexpr Repertoire lying_watching{in_bed_before_television, lying_idly, {}, while_absorbed};
constexpr Repertoire lying_asleep{asleep_in_bed, asleep, {}, while_asleep};

using body::Channel;
using body::Stage;

constexpr double liveliness_sd = 0.4;  // assumed (0.3-0.6): of the logarithm of a person's rate
// Of the logarithm of everybody's rate on a day: fitted to three days of a room (0.2-0.5).
constexpr double day_sd = 0.35;
// How much more a listener moves for each other person: fitted to two meeting rooms (0.25-1).
constexpr double per_other = 0.25;
constexpr double pace_sd_m_s = 0.2;                                 // Ref: [Weidmann1993]: 0.26 in the open
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

constexpr double bout_s = 20.0;  // assumed (10-60): swinging and stillness take turns in stretches of this length

}  // namespace

namespace {

/// One that isn't longer than the longest, of the law whose logarithm is moved by so much.
double cut_length_s(const StillPeriods& still, Stream& stream, double moved) noexcept {
  double length_s = 0.0;
  do {
    length_s = still.mean_s * std::exp(spread * (stream.normal() + moved));
  } while (length_s > still.longest_s);
  return length_s;
}

}  // namespace

double StillPeriods::length_s(Stream& stream) const noexcept { return cut_length_s(*this, stream, -0.5 * spread); }

/// A period is met in proportion to its length, anywhere in it.
double StillPeriods::rest_s(Stream& stream) const noexcept {
  return stream.uniform() * cut_length_s(*this, stream, 0.5 * spread);
}

double StillPeriods::cut_mean_s() const noexcept {
  const auto below = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  const double longest_z = std::log(longest_s / mean_s) / spread;
  return mean_s * below(longest_z - 0.5 * spread) / below(longest_z + 0.5 * spread);
}

const Repertoire& repertoire(Bearing bearing, std::optional<Activity> activity, Talk talk) noexcept {
  switch (bearing) {
    case Bearing::walking:
      return activity == Activity::phone ? walking_on_phone : walking;
    case Bearing::standing:
      if (talk == Talk::speaks) return standing_speaker;
      return activity ? standing[static_cast<std::size_t>(*activity)] : standing_idly;
    case Bearing::lying:
      if (activity == Activity::sleeping) return lying_asleep;
      return activity == Activity::watching_tv ? lying_watching : lying;
    case Bearing::seated:
      break;
  }
  if (talk == Talk::speaks) return seated_speaker;
  return activity ? seated[static_cast<std::size_t>(*activity)] : seated_idly;
}

NaturalMotion::NaturalMotion(std::uint64_t seed, std::uint32_t run, std::uint32_t person, int tick_rate_hz)
    : stream_({seed, run, person, Purpose::natural_motion}), tick_rate_hz_(tick_rate_hz) {
  Stream day({seed, run, 0, Purpose::day_liveliness});
  // Of mean 1 over people and days.
  liveliness_ = std::exp(liveliness_sd * stream_.normal() - 0.5 * liveliness_sd * liveliness_sd +
                         day_sd * day.normal() - 0.5 * day_sd * day_sd);
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
  wait(still().length_s(stream_));
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
  const double rest_s = still().rest_s(stream_);
  wait(phase_ == Phase::still ? std::max(settles_s, rest_s) : act_ends_s);
}

/// Who begins to speak moves soon. Who listens looks there when they move next.
void NaturalMotion::attend(const Attention& attention) {
  const bool begins = attention.talk == Talk::speaks && talk_ != Talk::speaks;
  talk_ = attention.talk;
  company_ = talk_ == Talk::listens ? 1.0 + per_other * static_cast<double>(attention.n_others) : 1.0;
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
  const double task_s = mean_s(all.tasks), still_s = (1.0 - still().goes_on) * still().cut_mean_s();
  double cycles = 1.0;
  for (const Habit& habit : all.habits) cycles -= habit.per_s * rate() * (mean_s(habit.acts) - task_s);
  return {(still_s + task_s) / cycles, still_s};
}

ActKind NaturalMotion::draw_kind() {
  double left = stream_.uniform() / cycle().mean_s;
  for (std::size_t i = 0; i < n_habits; ++i) {
    if ((left -= repertoire().habits[i].per_s * rate()) < 0.0) return static_cast<ActKind>(i);
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
  if (phase_ == Phase::returning && stream_.uniform() >= still().goes_on) return be_still();
  if (phase_ != Phase::moving) begin_act();
  stroke(motion);
}

Restlessness::Restlessness(const PersonChanges& changes, std::uint64_t seed, std::uint32_t run, std::uint32_t person,
                           double tick_s)
    : fidgeting_(changes.fidgeting),
      arms_(changes.uneven_arms),
      tick_s_(tick_s),
      acts_(changes.fidgeting.rate_per_s > 0.0 || changes.uneven_arms.spread > 0.0 ||
            changes.uneven_arms.pause_share > 0.0 || changes.trunk_sway.amplitude_deg > 0.0 ||
            changes.chair_swing.amplitude_deg > 0.0),
      fidget_stream_({seed, run, person, Purpose::fidgeting}),
      arms_stream_({seed, run, person, Purpose::uneven_arms}),
      trunk_{changes.trunk_sway, body::Channel::trunk_lean, Stream({seed, run, person, Purpose::trunk_sway})},
      chair_{changes.chair_swing, body::Channel::chair_turn, Stream({seed, run, person, Purpose::chair_swing})} {}

std::int64_t Restlessness::ticks(double seconds) const noexcept {
  return std::max<std::int64_t>(1, std::llround(seconds / tick_s_));
}

void Restlessness::tick(body::Motion& motion, const action::Work* work) {
  fidget(motion);
  swing(trunk_, motion);
  swing(chair_, motion);
  if (work != nullptr) swing_arms(motion, *work);
}

void Restlessness::leave_seat() noexcept {
  trunk_.middle.reset();
  chair_.middle.reset();
}

void Restlessness::fidget(body::Motion& motion) {
  if (fidgeting_.rate_per_s <= 0.0) return;
  if (fidgeting_.timing == FidgetTiming::independent) {
    if (fidget_stream_.uniform() >= -std::expm1(-fidgeting_.rate_per_s * tick_s_)) return;
  } else {
    if (--ticks_to_fidget_ > 0) return;
    const bool first = ticks_to_fidget_ < 0;
    // Nobody sits down just after a fidget: else the first of the long pauses would come too late.
    const StillPeriods between_fidgets{1.0 / fidgeting_.rate_per_s};
    ticks_to_fidget_ = ticks(first ? between_fidgets.rest_s(fidget_stream_) : between_fidgets.length_s(fidget_stream_));
    if (first) return;
  }
  const double way = 2.0 * fidget_stream_.uniform() - 1.0;
  if (fidget_stream_.index(2) == 0) {
    motion.adjust(body::Channel::trunk_tilt, radians(fidgeting_.tilt_deg) * way, body::fidget_s);
  } else {
    motion.adjust(body::Channel::head_turn, radians(fidgeting_.turn_deg) * way, body::fidget_s);
  }
}

void Restlessness::swing(Swing& swing, body::Motion& motion) const {
  if (swing.spec.amplitude_deg <= 0.0) return;
  if (!swing.middle) swing.middle = motion.target(swing.channel);
  if (--swing.ticks_to_turn > 0) return;
  const double half_s = 0.5 * swing.spec.period_s;
  swing.ticks_to_turn = ticks(half_s);
  if (swing.turns_left-- == 0) {
    swing.turns_left = std::llround(bout_s / half_s);
    swing.swings = swing.stream.uniform() < swing.spec.share;
  }
  const double amplitude = swing.swings ? radians(swing.spec.amplitude_deg) : 0.0;
  motion.adjust(swing.channel, *swing.middle + swing.side * amplitude, half_s);
  swing.side = -swing.side;
}

void Restlessness::swing_arms(body::Motion& motion, const action::Work& work) {
  if (arms_.spread <= 0.0 && arms_.pause_share <= 0.0) return;
  if (--ticks_to_swing_ > 0) return;
  // Of mean 1 both, so that neither the amplitude nor the period is another on average.
  const auto factor = [&] {
    return std::exp(arms_.spread * arms_stream_.normal() - 0.5 * arms_.spread * arms_.spread);
  };
  const double amplitude_m = work.arm_amplitude_m * factor(), period_s = work.arm_period_s * factor();
  const bool pauses = arms_stream_.uniform() < arms_.pause_share;
  motion.work({pauses ? 0.0 : amplitude_m, period_s});
  ticks_to_swing_ = ticks(period_s);
}

}  // namespace pirsim::sim
