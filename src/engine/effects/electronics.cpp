#include <algorithm>

#include "engine/effects/kit.hpp"

// What a sensor's circuit and the logger's clock make of what the element saw.
// Assumed: each sensor by itself, alike at all times unless an effect has a trend.
// Method: stages that drop, hold or move triggers tick by tick. What drops them comes before the hold that a sensor has
// by itself: no loss makes its pulses shorter.
// Sources: hold and lock-out times of common PIR modules; else assumed.

namespace pirsim::effects {
namespace {

// missed_triggers: what the zones saw and the sensor missed: a poll that came to nothing, a threshold set too high, a
// battery that runs down. Lost telegrams: dead_sensor.

/// Loses whole windows, so that the chance of a 1 is scaled whatever went on within the second.
class MissedWindows final : public CloneableTriggerStage<MissedWindows> {
 public:
  MissedWindows(std::vector<std::uint32_t> sensors, double mean, const Trend& trend, int ticks_per_window)
      : sensors_(std::move(sensors)), mean_(mean), trend_(trend), ticks_per_window_(ticks_per_window) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(sensors_, seed, run, Purpose::missed_trigger);
    chance_ = trend_.chance(mean_, run);
    lost_.assign(sensors_.size(), 0);
  }

  void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept override {
    const bool window_begins = (tick - 1) % ticks_per_window_ == 0;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (window_begins) lost_[i] = streams_[i].uniform() < chance_ ? 1 : 0;
      if (lost_[i] != 0) triggers[sensors_[i]] = 0;
    }
  }

 private:
  std::vector<std::uint32_t> sensors_;
  double mean_;  ///< over the runs
  Trend trend_;
  int ticks_per_window_;
  double chance_ = 0.0;  ///< in this run
  std::vector<Stream> streams_;
  std::vector<std::uint8_t> lost_;  ///< (n_sensors) 1: nothing of this window comes through
};

/// Loses each trigger by itself, so that a window with many of them hardly ever stays without a 1: weak signals suffer.
class MissedSingly final : public CloneableTriggerStage<MissedSingly> {
 public:
  MissedSingly(std::vector<std::uint32_t> sensors, double mean, const Trend& trend)
      : sensors_(std::move(sensors)), mean_(mean), trend_(trend) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    chance_ = trend_.chance(mean_, run);
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
  double mean_;  ///< over the runs
  Trend trend_;
  double chance_ = 0.0;  ///< in this run
  std::vector<Stream> streams_;
};

std::unique_ptr<TriggerStage> make_missed_triggers(const EffectSpec& effect, const StageContext& context) {
  const std::vector<std::uint32_t> sensors = sensors_of(effect, context.scene);
  if (word(effect, "unit") == "trigger")
    return std::make_unique<MissedSingly>(sensors, effect.parameters.at("trigger_probability"), Trend(effect, context));
  return std::make_unique<MissedWindows>(sensors, effect.parameters.at("probability"), Trend(effect, context),
                                         context.sensing.ticks_per_window);
}

Effect missed_triggers() {
  return {.info = {.name = "missed_triggers",
                   .family = Family::electronics,
                   .stage = "electronics",
                   .summary = "Triggers are lost at random before the sensor holds its motion: all of a window "
                              "together, or each by itself, which hits weak signals hardest. The probability stays, or "
                              "grows about this mean from run to run as a battery runs down.",
                   .fingerprint = "all cells scaled by the same factor, or later ones more; isolated zeros",
                   .confused_with = {"dead_time", "thermal_contrast", "dead_sensor"},
                   .parameters = {told_as("probability of a miss", strength("probability", "", 0.2, 0.05, 0.6, 1.0,
                                                                            "assumed", {"unit", "window"})),
                                  told_as("probability that a trigger is missed",
                                          strength("trigger_probability", "", 0.6, 0.3, 0.95, 1.0, "assumed",
                                                   {"unit", "trigger"}))},
                   .choices = {{"unit", ChoiceKind::variant, {"window", "trigger"}, "windows"},
                               trend_choice(),
                               sensor_choice()},
                   .reach = Reach::triggers,
                   .in_analog = "a trigger is a tick at which the comparator's output is on, so short pulses suffer "
                                "most; for a threshold set too high take range_scale below 1"},
          .make_stage = make_missed_triggers,
          .draw = draw_trend};
}

// dead_time: after a pulse the circuit is blind for a while.

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

std::unique_ptr<TriggerStage> make_dead_time(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<DeadTime>(
      sensors_of(effect, context.scene), std::llround(effect.parameters.at("dead_s") * context.sensing.tick_rate_hz),
      word(effect, "kind") == "paralysable" ? DeadTimeKind::paralysable : DeadTimeKind::non_paralysable);
}

Effect dead_time() {
  return {.info = {.name = "dead_time",
                   .family = Family::electronics,
                   .stage = "electronics",
                   .summary = "After a trigger a sensor is blind for a fixed time. A trigger within it is ignored "
                              "(non-paralysable) or starts the time anew (paralysable).",
                   .fingerprint = "no short gaps between ones; busy cells are capped",
                   .confused_with = {"missed_triggers", "pulse_stretching"},
                   .parameters = {told_as("dead time",
                                          strength("dead_s", "s", 2.0, 0.5, 5.0, 600.0,
                                                   "assumed: lock-out times of common PIR modules are 0.2-5 s"))},
                   .choices = {{"kind", ChoiceKind::variant, {"non_paralysable", "paralysable"}, "non_paralysable"},
                               sensor_choice()},
                   .reach = Reach::triggers,
                   .idle_in = {Survey::walk_test}},
          .make_stage = make_dead_time};
}

// pulse_stretching: the output stays high for a while after a trigger, so that the next poll finds it too.

enum class Retrigger { restarts, ignored };

class PulseStretching final : public CloneableTriggerStage<PulseStretching> {
 public:
  PulseStretching(std::vector<std::uint32_t> sensors, double mean_ticks, const Trend& trend, double spread,
                  Retrigger retrigger)
      : sensors_(std::move(sensors)), mean_ticks_(mean_ticks), trend_(trend), spread_(spread), retrigger_(retrigger) {}

  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    streams_ = streams_of(sensors_, seed, run, Purpose::pulse_length);
    hold_ticks_ = trend_.in_run(mean_ticks_, run);
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
  double mean_ticks_;  ///< over the runs
  Trend trend_;
  double spread_;
  Retrigger retrigger_;
  double hold_ticks_ = 0.0;  ///< in this run
  std::vector<Stream> streams_;
  std::vector<std::int64_t> high_until_;  ///< (n_sensors) last tick of the pulse
};

std::unique_ptr<TriggerStage> make_pulse_stretching(const EffectSpec& effect, const StageContext& context) {
  return std::make_unique<PulseStretching>(
      sensors_of(effect, context.scene), effect.parameters.at("hold_s") * context.sensing.tick_rate_hz,
      Trend(effect, context), effect.parameters.at("spread"),
      word(effect, "retrigger") == "ignored" ? Retrigger::ignored : Retrigger::restarts);
}

Effect pulse_stretching() {
  return {
      .info = {.name = "pulse_stretching",
               .family = Family::electronics,
               .stage = "electronics",
               .summary = "A sensor's output stays high for a hold after each trigger, beyond the window's end if need "
                          "be. A trigger within the hold starts it anew, or is ignored. The hold stays, or grows about "
                          "this mean from run to run as a capacitor ages.",
               .fingerprint =
                   "runs of ones are longer, gaps shorter; cells with much scattered activity rise most, or later ones",
               .confused_with = {"dead_time", "fidgeting"},
               .parameters = {logarithmic(
                                  strength("hold_s", "s", 1.0, 0.2, 4.0, 600.0,
                                           "assumed: hold times of common PIR modules begin at some 0.3-2.5 s")),
                              detail("spread", "", 0.0, 0.0, 1.0, 0.0, 1.0,
                                     "assumed: each pulse between (1 - spread) and (1 + spread) times hold_s")},
               .choices = {{"retrigger", ChoiceKind::variant, {"restarts", "ignored"}, "restarts"},
                           trend_choice(),
                           sensor_choice()},
               .reach = Reach::triggers,
               .idle_in = {Survey::walk_test}},
      .make_output_stage = make_pulse_stretching,
      .draw = draw_trend};
}

// clock_lag: the logger's clock isn't the choreography's.

void set_clocks(const EffectSpec& effect, const StageContext& context, Clocks& clocks) {
  const double lag_ticks = effect.parameters.at("lag_s") * context.sensing.tick_rate_hz;
  for (const std::uint32_t sensor : sensors_of(effect, context.scene)) {
    clocks.set(context.scene.sensors.size(), sensor, lag_ticks, effect.parameters.at("drift_percent") / 100.0);
  }
}

Effect clock_lag() {
  return {.info = {.name = "clock_lag",
                   .family = Family::electronics,
                   .stage = "electronics",
                   .summary =
                       "The logger's clock is off: rows are stamped late (positive) or early, by a time that may grow.",
                   .fingerprint = "the peak after a change of posture moves in its cycle; sums hardly change",
                   .confused_with = {"trunk_tilt", "arm_motion"},
                   .parameters = {offset("lag_s", "s", 15.0, 3.0, 600.0, "assumed: a clock set by hand"),
                                  offset("drift_percent", "%", 1.0, 0.0, 50.0,
                                         "assumed: an untrimmed RC oscillator keeps 1 %, to either side")},
                   .choices = {sensor_choice()},
                   .reach = Reach::triggers,
                   .idle_in = {Survey::walk_test}},
          .set_clocks = set_clocks};
}

}  // namespace

std::vector<Effect> electronics_effects() { return {missed_triggers(), dead_time(), pulse_stretching(), clock_lag()}; }

}  // namespace pirsim::effects
