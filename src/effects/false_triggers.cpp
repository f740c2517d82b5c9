// Triggers without a person: noise of element and amplifier, draughts.
#include "effects/kit.hpp"

namespace pirsim::effects {
namespace {

/// A Poisson process a sensor, or one for all of them, alike at all times.
class FalseTriggers final : public CloneableTriggerStage<FalseTriggers> {
 public:
  /// groups: sensors that trigger together.
  FalseTriggers(std::vector<std::vector<std::uint32_t>> groups, double mean_per_tick)
      : groups_(std::move(groups)), mean_per_tick_(mean_per_tick) {
    for (const auto& group : groups_) first_.push_back(group.front());
  }

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(first_, seed, run, Purpose::false_trigger);
    next_.clear();
    for (Stream& stream : streams_) next_.push_back(ticks_to_event(stream, mean_per_tick_));
  }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (tick != next_[i]) continue;
      for (const std::uint32_t sensor : groups_[i]) triggers[sensor] = 1;
      next_[i] += ticks_to_event(streams_[i], mean_per_tick_);
    }
  }

 private:
  std::vector<std::vector<std::uint32_t>> groups_;
  double mean_per_tick_;
  std::vector<std::uint32_t> first_;  ///< (n_groups) sensor
  std::vector<Stream> streams_;       ///< (n_groups)
  std::vector<std::int64_t> next_;    ///< (n_groups) tick
};

std::unique_ptr<TriggerStage> make(const EffectSpec& effect, const StageContext& context) {
  const std::vector<std::uint32_t> sensors = sensors_of(effect, context.scene);
  std::vector<std::vector<std::uint32_t>> groups;
  if (word(effect, "timing") == "simultaneous") {
    groups = {sensors};
  } else {
    for (const std::uint32_t sensor : sensors) groups.push_back({sensor});
  }
  return std::make_unique<FalseTriggers>(std::move(groups),
                                         effect.parameters.at("rate_per_s") / context.sensing.tick_rate_hz);
}

/// One sensor alone triggers by itself whichever word says so.
void draw(EffectSpec& effect, const SceneSpec&, const ScriptSpec&, Stream&) {
  if (effect.choices.contains("sensor")) effect.choices["timing"] = "independent";
}

}  // namespace

const Effect& false_triggers() {
  static const Effect effect{
      .info = {.name = "false_triggers",
               .family = Family::environment,
               .stage = "environment",
               .summary =
                   "Sensors trigger at random moments without anybody's doing, at one rate: each by itself, or all at "
                   "the same moments, as a disturbed supply makes them.",
               .fingerprint = "silent cells come alive, all by the same amount; single ones, at any moment",
               .confused_with = {"trigger_bursts", "fidgeting", "soft_zone_edges"},
               .parameters = {{.name = "rate_per_s",
                               .unit = "1/s",
                               .off = 0.0,
                               .typical = 0.01,
                               .low = 0.0005,
                               .high = 0.06,
                               .least = 0.0,
                               .most = 10.0,
                               .scale = Scale::logarithmic,
                               .source = "assumed: from one in half an hour to one in 17 s"}},
               .choices = {{"timing", ChoiceKind::variant, {"independent", "simultaneous"}, "independent"},
                           sensor_choice()},
               .reach = Reach::triggers},
      .make_stage = make,
      .draw = draw};
  return effect;
}

}  // namespace pirsim::effects
