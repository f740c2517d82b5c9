// A sensor hangs higher or lower than drawn.
#include "effects/entries.hpp"
#include "effects/kit.hpp"
#include "effects/parameter.hpp"

namespace pirsim::effects {
namespace {

void alter(SceneSpec& scene, ScriptSpec&, const EffectSpec& effect) {
  for (const std::uint32_t i : sensors_of(effect, scene)) {
    Frame& frame = scene.sensors[i].world_from_sensor;
    frame.origin.y += effect.parameters.at("height_m");
  }
}

}  // namespace

const Effect& sensor_height() {
  static const Effect effect{
      .info = {.name = "sensor_height",
               .family = Family::mounting,
               .stage = "placement",
               .summary = "Sensors hang higher (positive) or lower than drawn.",
               .fingerprint = "near and far seats change oppositely, as with tilt",
               .confused_with = {"sensor_tilt", "seat_shift"},
               .parameters = {offset("height_m", "m", 0.3, -0.15, 3.0, "assumed: measured from the wrong edge")},
               .choices = {sensor_choice()},
               .reach = Reach::geometry},
      .alter = alter};
  return effect;
}

}  // namespace pirsim::effects
