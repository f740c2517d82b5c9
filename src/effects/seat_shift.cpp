// People sit nearer to the table than the plan says, or further back.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  for (TrialInForce& trial : study.trials) {
    for (PersonInForce& person : trial.people) person.changes.seat_shift_m += effect.parameters.at("forward_m");
  }
}

}  // namespace

const Effect& seat_shift() {
  static const Effect effect{
      .info = {.name = "seat_shift",
               .family = Family::person,
               .stage = "placement",
               .summary = "Everybody sits further forward or back than the seats are drawn.",
               .fingerprint = "rows of seats on opposite sides of the sensors move oppositely",
               .confused_with = {"sensor_tilt", "sensor_height", "body_size"},
               .parameters = {offset("forward_m", "m", 0.25, 0.1, 1.0, "assumed: how far a chair is drawn to a table")},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
