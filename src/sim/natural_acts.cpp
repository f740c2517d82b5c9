#include "sim/natural_acts.hpp"

#include <array>
#include <cmath>
#include <iterator>

namespace pirsim::sim {
namespace {

using body::Channel;
using Side = Stroke::Side;
using enum Act::After;

// The standard deviation of the logarithm. Looks at a television or a computer are log-normal with 1.7 to 1.8, and who
// ends one moves; trunk, hands and head that moved at their published rates independently of each other would leave
// stillness with 1.2. Between the two: assumed (1.2-1.6).
constexpr double spread = 1.4;

// At a desk habits and tasks together come as often as trunk, hands and head move in all: assumed (5-12).
constexpr StillPeriods at_work{8.0};
// Who is absorbed moves less [Witchel2016]: assumed (8-16). Before a television more would leave no room for what was
// counted.
constexpr StillPeriods while_absorbed{12.0};
constexpr StillPeriods while_speaking{0.8};     // assumed (0.4-1.5): hands rest between two gestures
constexpr StillPeriods while_walking{6.0};      // assumed (3-12): looks ahead in between
constexpr StillPeriods while_eating{5.0};       // assumed (3-8): chews
constexpr StillPeriods at_stove_or_basin{2.0};  // assumed (1-4): the hands are at work
// Eleven movements an hour, of one act or several in a row. Ref: [Montini2024]
constexpr StillPeriods while_asleep{320.0};

constexpr const char* assumed = "assumed";
constexpr const char* reading_speed = "weight: a page of 300 words takes 75 s at 238 words a minute [Brysbaert2019]";

// Shifts: the body comes to rest in another posture.
constexpr Stroke lean[]{{Channel::trunk_tilt, radians(-10), radians(14)}};
constexpr Stroke shift_on_chair[]{{Channel::trunk_lean, radians(2), radians(7), Side::either},
                                  {Channel::trunk_tilt, radians(-6), radians(8)}};
constexpr Stroke turn_chair[]{{Channel::chair_turn, radians(4), radians(18), Side::either}};
constexpr Act seated_shifts[]{{"lean", 1, lean, 1.4, 1, 1, stays, assumed},
                              {"shift on the chair", 1, shift_on_chair, 1.0, 1, 1, stays, assumed},
                              {"turn the chair", 1, turn_chair, 1.5, 1, 1, stays, assumed}};

constexpr Stroke sway[]{{Channel::trunk_tilt, radians(1), radians(4), Side::either}};
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

constexpr Stroke type[]{{Channel::left_hand_ahead, -0.025, 0.025}, {Channel::right_hand_ahead, -0.025, 0.025}};
constexpr Stroke mouse[]{{Channel::right_hand_ahead, -0.05, 0.05}};
constexpr Stroke reach[]{{Channel::right_hand_ahead, 0.03, 0.08}, {Channel::trunk_tilt, radians(6), radians(14)}};
constexpr Act typing[]{{"type", 2, type, 0.3, 3, 14, returns, assumed},
                       {"use the mouse", 1, mouse, 0.5, 2, 6, returns, assumed},
                       {"reach for something", 1, reach, 1.0, 1, 1, returns, assumed}};

constexpr Stroke turn_page[]{{Channel::right_hand_up, 0.03, 0.07}, {Channel::right_hand_ahead, -0.10, 0.04}};
constexpr Stroke glance[]{{Channel::head_turn, radians(4), radians(12), Side::either}};
constexpr Act reading[]{{"follow the lines", 7, glance, 0.8, 1, 4, returns, assumed},
                        {"turn a page", 1, turn_page, 0.7, 1, 2, returns, reading_speed}};

constexpr Stroke gesture[]{{Channel::left_hand_up, 0.04, 0.18},
                           {Channel::right_hand_up, 0.04, 0.18},
                           {Channel::left_hand_ahead, -0.08, 0.08},
                           {Channel::right_hand_ahead, -0.08, 0.08}};
constexpr Stroke nod[]{{Channel::trunk_tilt, radians(0.5), radians(2)}};
constexpr Stroke take_notes[]{{Channel::right_hand_ahead, -0.03, 0.03}};
constexpr Act listening[]{{"nod", 1, nod, 0.4, 1, 3, returns, assumed},
                          {"take notes", 1, take_notes, 0.3, 2, 12, returns, assumed},
                          {"glance", 1, glance, 0.6, 1, 1, returns, assumed}};
constexpr Act speaking[]{{"gesture", 1, gesture, 0.7, 2, 6, returns, assumed}};

constexpr Stroke one_hand[]{{Channel::right_hand_up, 0.03, 0.15}, {Channel::right_hand_ahead, -0.06, 0.06}};
constexpr Act phoning[]{{"gesture with one hand", 1, one_hand, 0.7, 1, 4, returns, assumed},
                        {"look round", 1, look, 0.7, 1, 2, returns, assumed}};
constexpr Hold at_the_ear[]{{Channel::left_hand_to_head, 1.0}};

constexpr Act sitting_idly[]{{"look round", 1, look, 0.7, 1, 2, returns, assumed},
                             {"sway", 1, sway, 0.6, 1, 3, returns, assumed}};

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
                             {at_desk, listening, {}, at_work},
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
                               {on_feet, standing_listening, {}, at_work},
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

}  // namespace

double StillPeriods::length_s(double z) const noexcept { return mean_s * std::exp(spread * (z - 0.5 * spread)); }

/// A period is met in proportion to its length, anywhere in it.
double StillPeriods::rest_s(double z, double v) const noexcept {
  return v * mean_s * std::exp(spread * (z + 0.5 * spread));
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

}  // namespace pirsim::sim
