// A sensor looks further down than drawn, or less far.
#include "pirsim/geometry.hpp"

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  const Quat tilt = glm::angleAxis(-radians(effect.parameters.at("tilt_deg")), Vec3(1, 0, 0));
  for_each_sensor(study, effect, [&](SensorSpec& sensor) {
    Quat& rotation = sensor.world_from_sensor.rotation;
    rotation = glm::normalize(rotation * tilt);
  });
}

}  // namespace

const Effect& sensor_tilt() {
  static const Effect effect{.info = {.name = "sensor_tilt",
                                      .family = Family::mounting,
                                      .stage = "placement",
                                      .summary = "Sensors look further down (positive) or up than drawn.",
                                      .fingerprint = "near and far seats change oppositely",
                                      .confused_with = {"sensor_height", "seat_shift", "sensor_yaw"},
                                      .parameters = {offset("tilt_deg", "deg", 6.0, 2.0, 90.0, "assumed: by eye")},
                                      .choices = {sensor_choice()},
                                      .reach = Reach::geometry},
                             .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
