// After a pulse the circuit is blind for a while.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// What happens meanwhile: nothing, or the time starts anew.
enum class DeadTimeKind { non_paralysable, paralysable };

class DeadTime final : public CloneableTriggerStage<DeadTime> {
 public:
  DeadTime(std::vector<std::uint32_t> sensors, std::int64_t dead_ticks, DeadTimeKind kind)
      : sensors_(std::move(sensors)), dead_ticks_(dead_ticks), kind_(kind) {}

  void begin_run(std::uint64_t, std::uint32_t) override { awake_from_.assign(sensors_.size(), 0); }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      std::uint8_t& trigger = triggers[sensors_[i]];
      if (trigger == 0) continue;
      const bool blind = tick < awake_from_[i];
      if (blind) trigger = 0;
      if (!blind || kind_ == DeadTimeKind::paralysable) awake_from_[i] = tick + dead_ticks_;
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  std::int64_t dead_ticks_;
  DeadTimeKind kind_;
  std::vector<std::int64_t> awake_from_;  ///< (n_sensors) tick
};

std::unique_ptr<TriggerStage> make(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<DeadTime>(
      sensors_of(effect, context.scene), std::llround(effect.parameters.at("dead_s") * context.sensing.tick_rate_hz),
      word(effect, "kind") == "paralysable" ? DeadTimeKind::paralysable : DeadTimeKind::non_paralysable);
}

}  // namespace

const Effect& dead_time() {
  static const Effect effect{
      .info = {.name = "dead_time",
               .family = Family::electronics,
               .stage = "electronics",
               .summary =
                   "After a trigger a sensor is blind for a fixed time, which a trigger meanwhile doesn't prolong "
                   "(non-paralysable) or starts anew (paralysable).",
               .fingerprint = "no short gaps between ones; busy cells are capped",
               .confused_with = {"missed_triggers", "pulse_stretching"},
               .parameters = {{.name = "dead_s",
                               .unit = "s",
                               .off = 0.0,
                               .typical = 2.0,
                               .low = 0.5,
                               .high = 5.0,
                               .least = 0.0,
                               .most = 600.0,
                               .source = "assumed: lock-out times of common PIR modules are 0.2-5 s"}},
               .choices = {{"kind", ChoiceKind::variant, {"non_paralysable", "paralysable"}, "non_paralysable"},
                           sensor_choice()},
               .reach = Reach::triggers,
               .idle_in = {Survey::walk_test}},
      .make_stage = make};
  return effect;
}

}  // namespace pirsim::effects
