// People move though the script says nothing of it.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  const FidgetSpec fidgeting{
      effect.parameters.at("rate_per_s"), effect.parameters.at("tilt_deg"), effect.parameters.at("turn_deg"),
      word(effect, "timing") == "still_periods" ? FidgetTiming::still_periods : FidgetTiming::independent};
  for_each_person(study, [&](PersonInForce& person) { person.changes.fidgeting = fidgeting; });
}

}  // namespace

const Effect& fidgeting() {
  static const Effect effect{
      .info =
          {.name = "fidgeting",
           .family = Family::motion,
           .stage = "body",
           .summary =
               "A seated person leans a little or turns the head at random moments: independent ones, or with still "
               "periods of all lengths in between.",
           .fingerprint = "activity without the arms' phase, where a sensor sees head or trunk",
           .confused_with = {"false_triggers", "soft_zone_edges", "pulse_stretching"},
           .parameters = {{.name = "rate_per_s",
                           .unit = "1/s",
                           .off = 0.0,
                           .typical = 0.1,
                           .low = 0.01,
                           .high = 0.5,
                           .least = 0.0,
                           .most = 5.0,
                           .scale = Scale::logarithmic,
                           .source = "assumed: of moves, on average"},
                          {.name = "tilt_deg",
                           .unit = "deg",
                           .role = Role::detail,
                           .off = 4.0,
                           .typical = 4.0,
                           .low = 1.0,
                           .high = 10.0,
                           .least = 0.0,
                           .most = 15.0,
                           .source = "assumed: the trunk moves to within so much of its scripted tilt"},
                          {.name = "turn_deg",
                           .unit = "deg",
                           .role = Role::detail,
                           .off = 40.0,
                           .typical = 40.0,
                           .low = 10.0,
                           .high = 70.0,
                           .least = 0.0,
                           .most = 80.0,
                           .source = "assumed: the head turns to within so much of straight ahead"}},
           .choices = {{"timing", ChoiceKind::variant, {"independent", "still_periods"}, "independent"}},
           .reach = Reach::geometry,
           .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
