// The output stays high for a while after a trigger, so that the next poll finds it too.
#include <algorithm>

#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

enum class Retrigger { restarts, ignored };

class PulseStretching final : public CloneableTriggerStage<PulseStretching> {
 public:
  PulseStretching(std::vector<std::uint32_t> sensors, double hold_ticks, double spread, Retrigger retrigger)
      : sensors_(std::move(sensors)), hold_ticks_(hold_ticks), spread_(spread), retrigger_(retrigger) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(sensors_, seed, run, Purpose::pulse_length);
    high_until_.assign(sensors_.size(), 0);
  }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      std::uint8_t& trigger = triggers[sensors_[i]];
      const bool holds = tick <= high_until_[i];
      if (trigger != 0 && !(holds && retrigger_ == Retrigger::ignored)) {
        const double factor = spread_ > 0.0 ? 1.0 + spread_ * (2.0 * streams_[i].uniform() - 1.0) : 1.0;
        high_until_[i] = std::max<std::int64_t>(high_until_[i], tick + std::llround(hold_ticks_ * factor));
      } else if (holds) {
        trigger = 1;
      }
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  double hold_ticks_;
  double spread_;
  Retrigger retrigger_;
  std::vector<Stream> streams_;
  std::vector<std::int64_t> high_until_;  ///< (n_sensors) last tick of the pulse
};

std::unique_ptr<TriggerStage> make(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<PulseStretching>(
      sensors_of(effect, context.scene), effect.parameters.at("hold_s") * context.sensing.tick_rate_hz,
      effect.parameters.at("spread"),
      word(effect, "retrigger") == "ignored" ? Retrigger::ignored : Retrigger::restarts);
}

}  // namespace

const Effect& pulse_stretching() {
  static const Effect effect{
      .info = {.name = "pulse_stretching",
               .family = Family::electronics,
               .stage = "electronics",
               .summary =
                   "A sensor's output stays high for a while after each trigger, across the poll. A trigger meanwhile "
                   "starts that time anew, or is ignored.",
               .fingerprint = "runs of ones are longer, gaps shorter; cells with much scattered activity rise most",
               .confused_with = {"dead_time", "fidgeting"},
               .parameters = {{.name = "hold_s",
                               .unit = "s",
                               .off = 0.0,
                               .typical = 1.0,
                               .low = 0.2,
                               .high = 4.0,
                               .least = 0.0,
                               .most = 600.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: hold times of common PIR modules begin at some 0.3-2.5 s"},
                              {.name = "spread",
                               .unit = "",
                               .role = Role::detail,
                               .off = 0.0,
                               .typical = 0.0,
                               .low = 0.0,
                               .high = 1.0,
                               .least = 0.0,
                               .most = 1.0,
                               .source = "assumed: each pulse between (1 - spread) and (1 + spread) times hold_s"}},
               .choices = {{"retrigger", ChoiceKind::variant, {"restarts", "ignored"}, "restarts"}, sensor_choice()},
               .reach = Reach::triggers,
               .idle_in = {Survey::walk_test}},
      .make_stage = make};
  return effect;
}

}  // namespace pirsim::effects
