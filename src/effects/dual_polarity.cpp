// Two elements of opposite sign, an amplifier with a pass band, a threshold: what a real detector has in place of
// "something changed".
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// Where the physics is: pir::PolarityFilter.
void alter(StudyInForce& study, const EffectSpec& effect) {
  study.sensing.dual_polarity = {effect.parameters.at("threshold"), effect.parameters.at("high_pass_hz"),
                                 effect.parameters.at("low_pass_hz")};
}

}  // namespace

const Effect& dual_polarity() {
  static const Effect effect{
      .info = {.name = "dual_polarity",
               .family = Family::electronics,
               .stage = "detector",
               .summary = "Zones count with their element's sign; a sensor triggers while their band-passed sum is "
                          "beyond a threshold.",
               .fingerprint =
                   "beams count one by one, so most cells change; slow motion is lost, and motion across both signs "
                   "at once; above a threshold of 1 most of everything",
               .confused_with = {"missed_triggers", "arm_motion", "pulse_stretching"},
               .parameters = {{.name = "threshold",
                               .unit = "zones",
                               .off = 0.0,
                               .typical = 0.8,
                               .low = 0.2,
                               .high = 1.5,
                               .least = 0.0,
                               .most = 100.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: the step that one zone makes is 1"},
                              {.name = "high_pass_hz",
                               .unit = "Hz",
                               .role = Role::detail,
                               .off = 0.3,
                               .typical = 0.3,
                               .low = 0.1,
                               .high = 0.6,
                               .least = 0.001,
                               .most = 10.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: usual PIR amplifiers begin to pass at 0.1-0.6 Hz"},
                              {.name = "low_pass_hz",
                               .unit = "Hz",
                               .role = Role::detail,
                               .off = 7.0,
                               .typical = 7.0,
                               .low = 4.0,
                               .high = 12.0,
                               .least = 0.1,
                               .most = 100.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: and end at 5-10 Hz"}},
               .reach = Reach::geometry,
               .acts_on = ActsOn::zone_sensors},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
