#include "sim/natural_acts.hpp"

#include <array>
#include <cmath>
#include <iterator>

namespace pirsim::sim {
namespace {

using body::Channel;
using Side = Stroke::Side;
using enum Act::After;

// The exponent: Ref: [Nakamura2007], near 0.9 for the locomotor activity of healthy people. The ends are assumed
// (shortest 0.5-2 s, longest 300-1200 s).
constexpr StillPeriods by_power_law{0.9, 1.0, 600.0};
constexpr StillPeriods while_speaking{0.9, 0.3, 3.0};  // assumed (longest 2-5 s): hands rest between two gestures
constexpr StillPeriods while_walking{0.9, 2.0, 30.0};  // assumed (longest 10-60 s): looks ahead in between

// At home. Of homes with real sensors only the silences between two triggers of one sensor are known, as exponents
// between 5 and 300 s: 0.36 of sleep, 0.59 of television, 0.96 to 1.0 of washing, 1.4 to 1.7 of cooking. Those of
// bodies are assumed near them (each tried by 0.2 up and down, the ends by half and twice).
constexpr StillPeriods while_asleep{0.4, 10.0, 2400.0};
constexpr StillPeriods while_watching{0.6, 2.0, 600.0};
constexpr StillPeriods while_washing{0.98, 0.5, 60.0};
constexpr StillPeriods while_cooking{1.5, 0.5, 60.0};
constexpr StillPeriods while_eating{1.2, 1.5, 60.0};

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

constexpr Stroke look[]{{Channel::head_turn, radians(15), radians(50), Side::either}};
constexpr Stroke sway[]{{Channel::trunk_tilt, radians(1), radians(4), Side::either}};
constexpr Stroke touch_face[]{{Channel::right_hand_to_head, 0.8, 1.0}};
constexpr Act fidgets_of_all[]{{"look round", 1, look, 0.7, 1, 2, returns, assumed},
                               {"sway", 1, sway, 0.6, 1, 3, returns, assumed},
                               {"touch the face", 1, touch_face, 1.0, 1, 1, returns, assumed}};

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
constexpr Act looking[]{{"look round", 1, look, 0.7, 1, 2, returns, assumed}};
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
constexpr Act eating[]{{"bring to the mouth", 4, to_mouth, 0.9, 1, 3, returns, assumed},
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

// Lying. Who sleeps turns over as often as accelerometers on trunks tell: 1.6 times an hour (standard deviation over
// people 0.7). Cameras see 2.1 to 3.6 shifts of trunk, head, arms or legs an hour in adults.
constexpr const char* trunk_shifts = "rate [Skarpsno2017]; angles assumed";
constexpr const char* all_shifts = "rate: [DeKoninck1992] less [Skarpsno2017]; movement assumed";
constexpr double turns_per_s = 1.6 / 3600.0, limb_shifts_per_s = (2.7 - 1.6) / 3600.0;
constexpr Stroke turn_over[]{{Channel::roll, radians(-95), radians(95)}, {Channel::curl, 0.0, 0.8}};
constexpr Stroke move_legs[]{{Channel::curl, 0.0, 0.8}};
constexpr Stroke move_arm[]{{Channel::right_hand_to_head, 0.2, 0.9}};
constexpr Stroke move_head[]{{Channel::head_turn, radians(5), radians(35), Side::either}};
constexpr Act turns_in_bed[]{{"turn over", 1, turn_over, 2.0, 1, 1, stays, trunk_shifts}};
constexpr Act limbs_in_bed[]{{"move the legs", 1, move_legs, 1.2, 1, 1, stays, all_shifts},
                             {"move an arm", 1, move_arm, 1.2, 1, 1, returns, all_shifts}};
constexpr Act asleep[]{{"move the head", 1, move_head, 0.8, 1, 1, returns, assumed},
                       {"twitch", 1, sway, 0.4, 1, 1, returns, assumed}};
constexpr Stroke stretch_legs[]{{Channel::curl, 0.0, 0.4}};
constexpr Act lying_shifts[]{{"move the legs", 1, stretch_legs, 1.2, 1, 1, stays, assumed}};
constexpr Act lying_fidgets[]{{"look round", 1, look, 0.7, 1, 2, returns, assumed},
                              {"touch the face", 1, touch_face, 1.0, 1, 1, returns, assumed}};
constexpr Act lying_idly[]{{"glance", 1, glance, 0.6, 1, 2, returns, assumed}};

/// In the order of Activity.

using ByActivity = std::array<Repertoire, activity_names.size()>;
constexpr Repertoire seated_idly{seated_shifts, fidgets_of_all, sitting_idly, {}, by_power_law};
constexpr ByActivity seated{{{seated_shifts, fidgets_of_all, typing, {}, by_power_law},
                             {seated_shifts, fidgets_of_all, reading, {}, by_power_law},
                             {seated_shifts, fidgets_of_all, listening, {}, by_power_law},
                             {seated_shifts, fidgets_of_all, phoning, at_the_ear, by_power_law},
                             seated_idly,
                             {seated_shifts, fidgets_of_all, asleep, {}, while_asleep},
                             {seated_shifts, fidgets_of_all, watching, {}, while_watching},
                             seated_idly,
                             seated_idly,
                             {seated_shifts, fidgets_of_all, eating, {}, while_eating}}};
constexpr Repertoire seated_speaker{seated_shifts, fidgets_of_all, speaking, {}, while_speaking};
constexpr Repertoire standing_idly{standing_shifts, fidgets_of_all, looking, {}, by_power_law};
constexpr ByActivity standing{{standing_idly,
                               standing_idly,
                               {standing_shifts, fidgets_of_all, standing_listening, {}, by_power_law},
                               {standing_shifts, fidgets_of_all, standing_phoning, at_the_ear, by_power_law},
                               {standing_shifts, fidgets_of_all, at_whiteboard, {}, while_speaking},
                               standing_idly,
                               {standing_shifts, fidgets_of_all, watching, {}, while_watching},
                               {standing_shifts, fidgets_of_all, at_stove, {}, while_cooking},
                               {standing_shifts, fidgets_of_all, at_basin, {}, while_washing},
                               {standing_shifts, fidgets_of_all, eating, {}, while_eating}}};
constexpr Repertoire standing_speaker{standing_shifts, fidgets_of_all, standing_speaking, {}, while_speaking};
constexpr Repertoire walking{{}, {}, looking, {}, while_walking};
constexpr Repertoire walking_on_phone{{}, {}, looking, at_the_ear, while_walking};
constexpr Repertoire lying{lying_shifts, lying_fidgets, lying_idly, {}, by_power_law};
constexpr Repertoire lying_watching{lying_shifts, lying_fidgets, lying_idly, {}, while_watching};
constexpr Repertoire lying_asleep{turns_in_bed, limbs_in_bed, asleep, {}, while_asleep, turns_per_s, limb_shifts_per_s};

/// The integral of x^power between two points, relative to that between the ends; inverted.
double within(double low, double high, double power, double share) noexcept {
  const double p = power + 1.0;
  return std::pow(std::pow(low, p) + share * (std::pow(high, p) - std::pow(low, p)), 1.0 / p);
}

}  // namespace

double StillPeriods::mean_s() const noexcept {
  const double ratio = longest_s / shortest_s;
  return exponent / (1.0 - exponent) * shortest_s * (std::pow(ratio, 1.0 - exponent) - 1.0) /
         (1.0 - std::pow(ratio, -exponent));
}

double StillPeriods::length_s(double u) const noexcept { return within(shortest_s, longest_s, -exponent - 1.0, u); }

/// A period is met in proportion to its length, anywhere in it.
double StillPeriods::rest_s(double u, double v) const noexcept {
  return v * within(shortest_s, longest_s, -exponent, u);
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
