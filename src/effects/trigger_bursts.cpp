// Triggers that come back: a ventilation that switches on, sun through a blind.
#include <algorithm>
#include <limits>

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

struct Burst {
  double period_ticks = 1.0;
  double length_ticks = 0.0;
  double mean_per_tick = 0.0;  ///< triggers within a burst
};

/// Bursts begin a period apart, at a phase that is the same for all sensors of a run and drawn for each run: one may be
/// under way when it begins.
class TriggerBursts final : public CloneableTriggerStage<TriggerBursts> {
 public:
  TriggerBursts(std::vector<std::uint32_t> sensors, const Burst& burst) : sensors_(std::move(sensors)), burst_(burst) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    constexpr std::uint32_t everybody = 0xFFFFFFFF;
    begin_ = Stream({seed, run, everybody, Purpose::burst}).uniform() * burst_.period_ticks - burst_.period_ticks;
    streams_ = streams_of(sensors_, seed, run, Purpose::burst);
    next_.assign(sensors_.size(), std::numeric_limits<std::int64_t>::min());
  }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    const auto now = static_cast<double>(tick);
    if (now >= begin_ + burst_.length_ticks) begin_ += burst_.period_ticks;
    if (now < begin_) return;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      const auto began = static_cast<std::int64_t>(begin_);
      if (next_[i] <= began) next_[i] = tick - 1 + ticks_to_event(streams_[i], burst_.mean_per_tick);
      if (tick != next_[i]) continue;
      triggers[sensors_[i]] = 1;
      next_[i] += ticks_to_event(streams_[i], burst_.mean_per_tick);
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  Burst burst_;
  double begin_ = 0.0;  ///< tick at which the burst that goes on, or the next one, begins
  std::vector<Stream> streams_;
  std::vector<std::int64_t> next_;  ///< (n_sensors) tick of the next trigger, if the burst lasts
};

std::unique_ptr<TriggerStage> make(const EffectSpec& effect, const StageContext& context) {
  const double rate = context.sensing.tick_rate_hz;
  const double period_s = effect.parameters.at("period_s");
  const double length_s = std::min(effect.parameters.at("length_s"), period_s);
  const double per_s = effect.parameters.at("rate_per_s");
  return std::make_unique<TriggerBursts>(sensors_of(effect, context.scene),
                                         Burst{period_s * rate, length_s * rate, per_s / rate});
}

}  // namespace

const Effect& trigger_bursts() {
  static const Effect effect{
      .info = {.name = "trigger_bursts",
               .family = Family::environment,
               .stage = "environment",
               .summary = "Bursts of triggers come back periodically: ventilation, sun through a blind.",
               .fingerprint = "groups of ones a period apart, whoever sits where",
               .confused_with = {"false_triggers"},
               .parameters = {{.name = "length_s",
                               .unit = "s",
                               .off = 0.0,
                               .typical = 3.0,
                               .low = 1.0,
                               .high = 10.0,
                               .least = 0.0,
                               .most = 600.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed"},
                              {.name = "period_s",
                               .unit = "s",
                               .role = Role::detail,
                               .off = 60.0,
                               .typical = 60.0,
                               .low = 10.0,
                               .high = 600.0,
                               .least = 1.0,
                               .most = 86400.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: a fan's cycle to a heating's"},
                              {.name = "rate_per_s",
                               .unit = "1/s",
                               .role = Role::detail,
                               .off = 2.0,
                               .typical = 2.0,
                               .low = 0.5,
                               .high = 5.0,
                               .least = 0.01,
                               .most = 50.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: of triggers within a burst"}},
               .choices = {sensor_choice()},
               .reach = Reach::triggers},
      .make_stage = make};
  return effect;
}

}  // namespace pirsim::effects
