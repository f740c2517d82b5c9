// Everything that changes during one run: people, what the optics show, detectors, logger.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "pirsim/sample.hpp"
#include "sim/crowd.hpp"
#include "sim/detection.hpp"
#include "sim/observer.hpp"
#include "sim/sensor_array.hpp"

namespace pirsim::sim {

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
