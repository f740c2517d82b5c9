// What the zones saw and nobody was told: a poll that came to nothing, a threshold set too high.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// Loses whole windows, so that the chance of a 1 is scaled whatever went on within the second.
class MissedTriggers final : public CloneableTriggerStage<MissedTriggers> {
 public:
  MissedTriggers(std::vector<std::uint32_t> sensors, double probability, int ticks_per_window)
      : sensors_(std::move(sensors)), probability_(probability), ticks_per_window_(ticks_per_window) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(sensors_, seed, run, Purpose::missed_trigger);
    lost_.assign(sensors_.size(), 0);
  }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    const bool window_begins = (tick - 1) % ticks_per_window_ == 0;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (window_begins) lost_[i] = streams_[i].uniform() < probability_ ? 1 : 0;
      if (lost_[i] != 0) triggers[sensors_[i]] = 0;
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  double probability_;
  int ticks_per_window_;
  std::vector<Stream> streams_;
  std::vector<std::uint8_t> lost_;  ///< (n_sensors) 1: nothing of this window comes through
};

std::unique_ptr<TriggerStage> make(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<MissedTriggers>(sensors_of(effect, context.scene), effect.parameters.at("probability"),
                                          context.sensing.ticks_per_window);
}

}  // namespace

const Effect& missed_triggers() {
  static const Effect effect{
      .info = {.name = "missed_triggers",
               .family = Family::electronics,
               .stage = "electronics",
               .summary = "A window's triggers are lost altogether, with one probability, independently.",
               .fingerprint = "all cells scaled by the same factor; isolated zeros",
               .confused_with = {"dead_time", "thermal_contrast", "dead_sensor"},
               .parameters = {{.name = "probability",
                               .unit = "",
                               .off = 0.0,
                               .typical = 0.2,
                               .low = 0.05,
                               .high = 0.6,
                               .least = 0.0,
                               .most = 1.0,
                               .source = "assumed"}},
               .choices = {sensor_choice()},
               .reach = Reach::triggers},
      .make_stage = make};
  return effect;
}

}  // namespace pirsim::effects
