// From what the optics show to rows: detectors turn zones into triggers, the logger turns triggers into rows. Every
// loop over ticks goes through Logger::observe_tick(): runs, replays of recordings and coverage studies.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "effects/pipeline.hpp"
#include "pir/analog_circuit.hpp"
#include "pir/soft_edges.hpp"
#include "pir/window_reader.hpp"
#include "pir/zone_motion.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/script.hpp"
#include "sim/sensor_array.hpp"

namespace pirsim::sim {

// What counts as motion: the sensors' electronics.

/// The detectors of all sensors of an array, each as its response asks: a change of a channel or the pair of opposite
/// polarity, with the counting, holding and blind time that come behind them, or the analog chain. Runs, recordings,
/// coverage studies and walk tests all decide by tick(). A value; the array outlives it.
class Detector {
 public:
  explicit Detector(const SensorArray& array);

  /// Forgets everything, and settles as if `rest` had been seen for long. Seed and run fix all randomness.
  void begin_run(std::uint64_t seed, std::uint32_t run, const Exposure& rest);
  /// From one tick to the next. triggers: (n_sensors) set to 1 where a sensor triggers at the later one, else to 0.
  void tick(const Exposure& before, const Exposure& after, std::span<std::uint8_t> triggers) noexcept;
  /// tick() with the same exposure before and after, without comparing it.
  void tick_unchanged(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept;
  /// tick() of sensors that answer by their zones alone; triggers of the others are set to 0.
  void tick_zones(const Exposure& before, const Exposure& after, std::span<std::uint8_t> triggers) noexcept;
  void tick_zones_unchanged(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept;
  /// True if tick_unchanged() would change nothing and trigger nothing.
  [[nodiscard]] bool is_at_rest(const Exposure& exposure) const;
  /// Whether a tick's triggers follow from its two exposures alone, in any run.
  [[nodiscard]] bool is_memoryless() const noexcept;

  /// (n_sensors) at the last tick; nothing for a sensor that answers by its zones. Empty without analog sensors.
  [[nodiscard]] const std::vector<std::optional<pir::AnalogCircuit::State>>& analog() const noexcept { return analog_; }

 private:
  /// triggers: (n_sensors) changes of zones; set to 1 where the output behind them is on.
  void switch_outputs(std::span<std::uint8_t> triggers) noexcept;
  void advance_analog(const Exposure& exposure, std::span<std::uint8_t> triggers) noexcept;

  const SensorArray* array_;
  pir::SoftEdges edges_;
  std::optional<pir::PolarityFilter> polarity_;
  std::vector<std::optional<pir::Comparator::State>> outputs_;  ///< (n_sensors) behind zones, where there is any
  std::vector<std::optional<pir::AnalogCircuit::State>> analog_;
};

// What electronics, environment and bookkeeping do to triggers, and who reads them when.

/// A value: copied with the run that it belongs to.
class Logger {
 public:
  Logger(const effects::Pipeline& stages, const SensingSpec& sensing, std::size_t n_sensors);

  /// Forgets everything. Seed and run fix all randomness.
  void begin_run(std::uint64_t seed, std::uint32_t run);
  /// Somebody left a seat (index into the scene's) in the step to the next tick: effects may leave it warm.
  void seat_left(std::size_t seat) { stages_.seat_left(seat); }
  /// Hears of one tick more. sense(tick): sets `triggers` (n_sensors) to the detectors' at that tick; the effects
  /// change them.
  template <typename Sense>
  void hear_tick(std::span<std::uint8_t> triggers, const Sense& sense) {
    sense(++heard_);
    stages_.hear(heard_, triggers);
  }
  /// One tick from the optics to what is read once a window. sense(): as above, asked once for every tick in order, and
  /// for later ticks than this one where a clock is early. triggers: set to those that are logged at this tick.
  template <typename Sense>
  void observe_tick(std::span<std::uint8_t> triggers, const Sense& sense) {
    for (const std::int64_t last = stages_.heard_by(++tick_); heard_ < last;) hear_tick(triggers, sense);
    stages_.log(tick_, triggers);
    reader_.advance(triggers);
  }
  /// Passes over ticks without triggers; only while is_at_rest().
  void skip(std::int64_t n_ticks) noexcept { heard_ = tick_ += n_ticks; }
  [[nodiscard]] bool looks_ahead() const noexcept { return stages_.looks_ahead(); }
  /// True if whole windows without triggers would leave it as it is.
  [[nodiscard]] bool is_at_rest() const noexcept { return !stages_.acts_on_triggers() && reader_.is_at_rest(); }
  /// The row's bits as they were read last, then what the effects do to the row.
  void complete(Sample& row) noexcept;

 private:
  effects::Pipeline stages_;
  Reader kind_;
  std::int32_t ticks_per_window_;
  std::size_t n_sensors_;
  pir::WindowReader reader_;
  std::int64_t tick_ = 0, heard_ = 0;  ///< logged and heard so far
};

}  // namespace pirsim::sim
