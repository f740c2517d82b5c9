// The logger's clock isn't the choreography's.
#include <deque>

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// What happens at t is logged at t + lag + drift * t. What would be logged after the run's end is lost.
class ClockLag final : public CloneableTriggerStage<ClockLag> {
 public:
  ClockLag(std::vector<std::uint32_t> sensors, double lag_ticks, double drift)
      : sensors_(std::move(sensors)), lag_ticks_(lag_ticks), drift_(drift) {}

  void begin_run(std::uint64_t, std::uint32_t) override { on_the_way_.clear(); }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    const auto arrival = tick + std::llround(lag_ticks_ + drift_ * static_cast<double>(tick));
    for (const std::uint32_t sensor : sensors_) {
      if (triggers[sensor] != 0) on_the_way_.push_back({arrival, sensor});
      triggers[sensor] = 0;
    }
    for (; !on_the_way_.empty() && on_the_way_.front().arrival <= tick; on_the_way_.pop_front()) {
      triggers[on_the_way_.front().sensor] = 1;
    }
  }

 private:
  struct Trigger {
    std::int64_t arrival = 0;  ///< tick; never falls from one to the next
    std::uint32_t sensor = 0;
  };
  std::vector<std::uint32_t> sensors_;
  double lag_ticks_;
  double drift_;
  std::deque<Trigger> on_the_way_;
};

std::unique_ptr<TriggerStage> make(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<ClockLag>(sensors_of(effect, context.scene),
                                    effect.parameters.at("lag_s") * context.sensing.tick_rate_hz,
                                    effect.parameters.at("drift_percent") / 100.0);
}

}  // namespace

const Effect& clock_lag() {
  static const Effect effect{
      .info = {.name = "clock_lag",
               .family = Family::electronics,
               .stage = "electronics",
               .summary = "Rows are stamped late by a fixed time that may grow: the logger's clock is off.",
               .fingerprint = "the peak after a change of posture moves in its cycle; sums hardly change",
               .confused_with = {"trunk_tilt", "arm_motion"},
               .parameters = {{.name = "lag_s",
                               .unit = "s",
                               .off = 0.0,
                               .typical = 3.0,
                               .low = 0.5,
                               .high = 15.0,
                               .least = 0.0,
                               .most = 600.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: a clock set by hand"},
                              {.name = "drift_percent",
                               .unit = "%",
                               .off = 0.0,
                               .typical = 0.0,
                               .low = 0.0,
                               .high = 1.0,
                               .least = 0.0,
                               .most = 50.0,
                               .source = "assumed: an untrimmed RC oscillator keeps 1 %"}},
               .choices = {sensor_choice()},
               .reach = Reach::triggers},
      .make_stage = make};
  return effect;
}

}  // namespace pirsim::effects
