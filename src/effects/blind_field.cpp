// Dirt, a cable or a shelf close by makes a part of a lens blind.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  study.sensing.blind_fields.push_back(
      {sensors_of(effect, study.scene), effect.parameters.at("share"), effect.parameters.at("side_deg")});
}

}  // namespace

const Effect& blind_field() {
  static const Effect effect{
      .info =
          {.name = "blind_field",
           .family = Family::optics,
           .stage = "optics",
           .summary = "A part of a lens's field is blind, from its rim inwards.",
           .fingerprint = "one sensor falls silent for the seats on one side of it, and is as it was for the others",
           .confused_with = {"dead_sensor", "missing_occluder", "sensor_yaw", "sensor_tilt"},
           .parameters = {{.name = "share",
                           .unit = "",
                           .off = 0.0,
                           .typical = 0.4,
                           .low = 0.15,
                           .high = 0.8,
                           .least = 0.0,
                           .most = 1.0,
                           .source = "assumed: of the rays"},
                          detail("side_deg", "deg", 0.0, -180.0, 180.0, -360.0, 360.0,
                                 "any: where the blind part begins, from the lens's right (0) to its upper side (90)")},
           .choices = {sensor_choice()},
           .reach = Reach::geometry,
           .acts_on = ActsOn::zone_sensors},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
