// What the zones saw and nobody was told: a poll that came to nothing, a threshold set too high.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// Loses whole windows, so that the chance of a 1 is scaled whatever went on within the second.
class MissedWindows final : public CloneableTriggerStage<MissedWindows> {
 public:
  MissedWindows(std::vector<std::uint32_t> sensors, double probability, int ticks_per_window)
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

/// Loses each trigger by itself, so that a window with many of them hardly ever stays without a 1: weak signals suffer.
class MissedSingly final : public CloneableTriggerStage<MissedSingly> {
 public:
  MissedSingly(std::vector<std::uint32_t> sensors, double chance) : sensors_(std::move(sensors)), chance_(chance) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(sensors_, seed, run, Purpose::missed_trigger);
  }

  void tick(std::int64_t, std::span<std::uint8_t> triggers) noexcept override {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      std::uint8_t& trigger = triggers[sensors_[i]];
      if (trigger != 0 && streams_[i].uniform() < chance_) trigger = 0;
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  double chance_;
  std::vector<Stream> streams_;
};

std::unique_ptr<TriggerStage> make(const EffectSpec& effect, const StageContext& context) {
  const std::vector<std::uint32_t> sensors = sensors_of(effect, context.scene);
  if (word(effect, "unit") == "trigger")
    return std::make_unique<MissedSingly>(sensors, effect.parameters.at("trigger_probability"));
  return std::make_unique<MissedWindows>(sensors, effect.parameters.at("probability"),
                                         context.sensing.ticks_per_window);
}

}  // namespace

const Effect& missed_triggers() {
  static const Effect effect{
      .info = {.name = "missed_triggers",
               .family = Family::electronics,
               .stage = "electronics",
               .summary =
                   "Triggers are lost with one probability, independently: those of a window altogether, or each "
                   "by itself, which weak signals suffer from.",
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
                               .source = "assumed",
                               .only_if = {"unit", "window"}},
                              {.name = "trigger_probability",
                               .unit = "",
                               .off = 0.0,
                               .typical = 0.6,
                               .low = 0.3,
                               .high = 0.95,
                               .least = 0.0,
                               .most = 1.0,
                               .source = "assumed",
                               .only_if = {"unit", "trigger"}}},
               .choices = {{"unit", ChoiceKind::variant, {"window", "trigger"}, "windows"}, sensor_choice()},
               .reach = Reach::triggers},
      .make_stage = make};
  return effect;
}

}  // namespace pirsim::effects
