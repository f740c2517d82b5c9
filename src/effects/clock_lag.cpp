// The logger's clock isn't the choreography's.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

void set_clocks(const EffectSpec& effect, const StageContext& context, Clocks& clocks) {
  const double lag_ticks = effect.parameters.at("lag_s") * context.sensing.tick_rate_hz;
  for (const std::uint32_t sensor : sensors_of(effect, context.scene)) {
    clocks.set(context.scene.sensors.size(), sensor, lag_ticks, effect.parameters.at("drift_percent") / 100.0);
  }
}

}  // namespace

const Effect& clock_lag() {
  static const Effect effect{
      .info = {.name = "clock_lag",
               .family = Family::electronics,
               .stage = "electronics",
               .summary =
                   "Rows are stamped late (positive) or early by a fixed time that may grow: the logger's clock is "
                   "off.",
               .fingerprint = "the peak after a change of posture moves in its cycle; sums hardly change",
               .confused_with = {"trunk_tilt", "arm_motion"},
               .parameters = {offset("lag_s", "s", 15.0, 3.0, 600.0, "assumed: a clock set by hand"),
                              offset("drift_percent", "%", 1.0, 0.0, 50.0,
                                     "assumed: an untrimmed RC oscillator keeps 1 %, to either side")},
               .choices = {sensor_choice()},
               .reach = Reach::triggers,
               .idle_in = {Survey::walk_test}},
      .set_clocks = set_clocks};
  return effect;
}

}  // namespace pirsim::effects
