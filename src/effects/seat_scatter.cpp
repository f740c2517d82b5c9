// Nobody sits on the point that is drawn.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  for (TrialInForce& trial : study.trials) {
    for (PersonInForce& person : trial.people) {
      SeatScatterSpec& scatter = person.seat_scatter;
      scatter.position_sd_m = std::hypot(scatter.position_sd_m, effect.parameters.at("position_sd_m"));
      scatter.heading_sd_deg = std::hypot(scatter.heading_sd_deg, effect.parameters.at("heading_sd_deg"));
    }
  }
}

}  // namespace

const Effect& seat_scatter() {
  static const Effect effect{
      .info = {.name = "seat_scatter",
               .family = Family::person,
               .stage = "placement",
               .summary = "Where exactly and how turned people sit differs from run to run.",
               .fingerprint = "residuals of both signs without a change of the mean; replicates differ more",
               .confused_with = {"seat_shift", "soft_zone_edges"},
               .parameters = {{.name = "position_sd_m",
                               .unit = "m",
                               .off = 0.0,
                               .typical = 0.06,
                               .low = 0.02,
                               .high = 0.2,
                               .least = 0.0,
                               .most = 0.5,
                               .scale = Scale::logarithmic,
                               .source = "assumed: of each horizontal coordinate"},
                              {.name = "heading_sd_deg",
                               .unit = "deg",
                               .off = 0.0,
                               .typical = 0.0,
                               .low = 0.0,
                               .high = 10.0,
                               .least = 0.0,
                               .most = 45.0,
                               .source = "assumed"}},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
