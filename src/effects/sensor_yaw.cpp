// A sensor is screwed on a little turned.
#include "pirsim/geometry.hpp"

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void alter(StudyInForce& study, const EffectSpec& effect) {
  const Quat yaw = rotation_from_heading(radians(effect.parameters.at("yaw_deg")));
  for_each_sensor(study, effect, [&](SensorSpec& sensor) {
    Quat& rotation = sensor.world_from_sensor.rotation;
    rotation = glm::normalize(yaw * rotation);
  });
}

}  // namespace

const Effect& sensor_yaw() {
  static const Effect effect{
      .info = {.name = "sensor_yaw",
               .family = Family::mounting,
               .stage = "placement",
               .summary = "Sensors look further to the left (positive, seen from above) or right than drawn.",
               .fingerprint =
                   "cells change as the map shifts sideways: seats on one side gain what the other side loses",
               .confused_with = {"sensor_tilt", "seat_shift"},
               .parameters = {offset("yaw_deg", "deg", 8.0, 3.0, 180.0, "assumed: by eye")},
               .choices = {sensor_choice()},
               .reach = Reach::geometry},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
