// A sensor says nothing until its element has warmed up after power came on.
#include "engine/effects/kit.hpp"

namespace pirsim::effects {
namespace {

class WarmUp final : public CloneableTriggerStage<WarmUp> {
 public:
  WarmUp(std::vector<std::uint32_t> sensors, double ticks) : sensors_(std::move(sensors)), ticks_(ticks) {}

  void begin_run(std::uint64_t, std::uint32_t) override {}

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    if (static_cast<double>(tick) > ticks_) return;
    for (const std::uint32_t sensor : sensors_) triggers[sensor] = 0;
  }

 private:
  std::vector<std::uint32_t> sensors_;
  double ticks_;
};

std::unique_ptr<TriggerStage> make_warm_up(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<WarmUp>(sensors_of(effect, context.scene),
                                  effect.parameters.at("duration_s") * context.sensing.tick_rate_hz);
}

Effect warm_up() {
  return {.info = {.name = "warm_up",
                   .family = Family::electronics,
                   .stage = "electronics",
                   .summary = "Sensors say nothing in the first seconds of a run.",
                   .fingerprint = "no ones while people come in, everything as it was later",
                   .confused_with = {"clock_lag"},
                   .parameters = {{.name = "duration_s",
                                   .unit = "s",
                                   .off = 0.0,
                                   .typical = 7.0,
                                   .low = 5.0,
                                   .high = 30.0,
                                   .least = 0.0,
                                   .most = 600.0,
                                   .source = "assumed: data sheets ask for up to 30 s"}},
                   .choices = {sensor_choice()},
                   .reach = Reach::triggers},
          .make_stage = make_warm_up};
}

}  // namespace

std::vector<Effect> warm_up_effects() { return {warm_up()}; }

}  // namespace pirsim::effects
