// From what the optics show to rows: detectors turn zones into triggers, the logger turns triggers into rows. Every
// loop over ticks goes through Logger::observe_tick(): runs, replays of recordings and coverage studies.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/effects/pipeline.hpp"
#include "engine/pir/analog_circuit.hpp"
#include "engine/pir/zone_motion.hpp"
#include "engine/sim/actor.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/script.hpp"

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
  /// From one tick to the next. triggers: (n_sensors) set to what each says at the later one: pir::output_on where it
  /// triggers, and of a comparator the side of its signal.
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
  /// Sets those of beams: 1 while one of their zones is broken.
  void look_at_beams(const Exposure& exposure, std::span<std::uint8_t> triggers) const noexcept;

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

// Everything that changes during one run: people, what the optics show, detectors, logger.

/// A member that changes no result: a copy begins empty, so that its owner can be copied by `= default`.
template <typename T>
class Scratch {
 public:
  Scratch() = default;
  Scratch(const Scratch&) noexcept {}
  Scratch(Scratch&& other) noexcept : value_(std::move(other.value_)) {}
  Scratch& operator=(const Scratch&) noexcept { return *this; }
  Scratch& operator=(Scratch&& other) noexcept {
    value_ = std::move(other.value_);
    return *this;
  }
  ~Scratch() = default;

  [[nodiscard]] T& operator*() noexcept { return value_; }

 private:
  T value_{};
};

/// A member on the heap, or none: copied with its owner.
template <typename T>
class Held {
 public:
  Held() = default;
  Held(const Held& other) : value_(other.value_ ? std::make_unique<T>(*other.value_) : nullptr) {}
  Held(Held&& other) noexcept = default;
  Held& operator=(const Held& other) { return *this = Held(other); }
  Held& operator=(Held&& other) noexcept = default;
  ~Held() = default;

  void hold(const T& value) { value_ = std::make_unique<T>(value); }
  [[nodiscard]] T* get() const noexcept { return value_.get(); }

 private:
  std::unique_ptr<T> value_;
};

/// A value: a copy continues independently from the same tick. The study must outlive it.
struct RunState {
  /// The moment before the first tick of a run, run in [0, study.n_runs()).
  RunState(const CompiledStudy& study, std::uint32_t run);

  [[nodiscard]] Exposure& exposure() noexcept { return exposures[static_cast<std::size_t>(tick % 2)]; }
  [[nodiscard]] const Exposure& exposure() const noexcept { return exposures[static_cast<std::size_t>(tick % 2)]; }

  std::uint32_t run = 0;
  std::int64_t tick = 0;
  bool finished = false;  ///< all actions are carried out and the last window is complete
  Crowd crowd;
  std::array<Exposure, 2>
      exposures;  ///< of this tick and the previous one, at index tick % 2, so that neither is copied
  Detector detector;
  Logger logger;
  std::int64_t empty_ticks = 0;  ///< how many ticks in a row, up to this one, nobody was there
  bool at_rest = false;  ///< sensors and logger can't change until somebody comes, so windows can be passed over
  std::optional<RunClock> clock;       ///< none: rows have no time of day
  std::vector<std::uint8_t> triggers;  ///< (n_sensors) at this tick
  Sample sample;                       ///< at the end of the last whole window
  /// Of a logger with an early clock: the run as it goes on, beyond its end if need be, which tells what is logged
  /// already. Its own logger is idle. None if all clocks are right or late.
  Held<RunState> ahead{};
  /// Remembers what has been traced; changes no result. Made when first needed, unless a pool lends one.
  Scratch<std::shared_ptr<Observer>> observer;
  /// Sees zones that no sensor answers by. Made when first asked for.
  struct Onlooker {
    std::unique_ptr<Observer> observer;
    Exposure exposure;
  };
  Scratch<Onlooker> onlooker;
};

/// At this tick, of all sensors: also of those that don't answer by zones. Valid until the next call or tick.
[[nodiscard]] const ZoneSet& zones_of_all(const CompiledStudy& study, RunState& state);

/// At tick 0: whoever is there has been there for long, and detectors have settled to them. The first step_tick()
/// begins with it.
void settle(const CompiledStudy& study, RunState& state);
/// Advances people alone by a tick and leaves the sensors as they are; don't mix it with step_tick() on one state. True
/// if a window ended with it.
bool move_tick(const CompiledStudy& study, RunState& state);
/// Advances one tick: people, optics, detectors, logger. True if a window ended with it.
bool step_tick(const CompiledStudy& study, RunState& state);
/// Advances by a window in which nobody is there and nobody comes: the same bits as step_tick() for as many ticks, at
/// almost no cost. Does nothing and returns false if somebody may be there.
bool pass_empty_window(const CompiledStudy& study, RunState& state);

}  // namespace pirsim::sim
