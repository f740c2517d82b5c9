// Where effects of electronics, environment and bookkeeping act: on what the sensors' detectors say, tick by tick, and
// on finished rows; and the clocks that stamp what comes of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "engine/pir/analog_circuit.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim::effects {

/// What a stage may know of the compiled study, of which nothing is kept beyond the making of the stage.
struct StageContext {
  const SceneSpec& scene;
  const SensingSpec& sensing;
  const RayBundle& clipped_rays;  ///< world frame, cut at the room
  std::uint32_t n_runs = 1;       ///< of the study, whichever of them are simulated; they follow each other in time
};

/// Changes which sensors trigger at a tick. A value behind a pointer: clone() goes on by itself from the same moment.
class TriggerStage {
 public:
  virtual ~TriggerStage() = default;
  [[nodiscard]] virtual std::unique_ptr<TriggerStage> clone() const = 0;
  /// Before tick 1 of a run: forgets everything. All randomness follows from these two.
  virtual void begin_run(std::uint64_t seed, std::uint32_t run) = 0;
  /// Somebody rose from a seat (index into the scene's) in the step to the tick that comes next.
  virtual void seat_left(std::size_t /*seat*/) {}
  /// Once a tick, from tick 1 on. triggers: (n_sensors) 1 where the sensor triggers at this tick, and at it alone.
  virtual void tick(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept = 0;
};

/// Changes finished rows: what a logger or a person keeping the books does to them.
class RowStage {
 public:
  virtual ~RowStage() = default;
  [[nodiscard]] virtual std::unique_ptr<RowStage> clone() const = 0;
  virtual void begin_run(std::uint64_t seed, std::uint32_t run) = 0;
  virtual void apply(Sample& row) noexcept = 0;
};

/// Keeps triggers from the tick at which they happen to the tick at which they are logged, which may be the earlier
/// one. A value; until set() all clocks are right.
class Clocks {
 public:
  /// What sensor `sensor` triggers at tick t is logged at t + round(lag_ticks + drift * t); drift above -1.
  void set(std::size_t n_sensors, std::uint32_t sensor, double lag_ticks, double drift);
  [[nodiscard]] bool all_right() const noexcept { return clocks_.empty(); }
  /// Whether anything may be logged before it happens.
  [[nodiscard]] bool any_early() const noexcept;
  /// Before tick 1 of a run: forgets everything.
  void begin_run();
  /// Once a tick, in order. triggers: (n_sensors) at this tick. What would be logged before tick 1 is lost.
  void hear(std::int64_t tick, std::span<const std::uint8_t> triggers);
  /// The last tick that is logged at `tick` or before, by any clock; at least `tick`.
  [[nodiscard]] std::int64_t heard_by(std::int64_t tick) const noexcept;
  /// Sets triggers (n_sensors) to those that are logged at this tick. Asked for in order, after hear(heard_by(tick)).
  void log(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept;

 private:
  struct Clock {
    double lag_ticks = 0.0, drift = 0.0;
    std::deque<std::int64_t> on_the_way{};  ///< ticks at which triggers that have happened will be logged, ascending
  };
  [[nodiscard]] static std::int64_t logged_at(const Clock& clock, std::int64_t tick) noexcept;

  std::vector<Clock> clocks_;  ///< (n_sensors) or empty
};

/// All stages of a study, a value; without stages it does nothing. Their order is the catalogue's, whatever the order
/// in the script; the same effect twice (for two sensors, say) acts in the script's order.
class Pipeline {
 public:
  Pipeline() = default;
  /// Only of effects that act here; the others are passed over. The names have been checked.
  Pipeline(std::span<const EffectSpec> effects, const StageContext& context);
  Pipeline(const Pipeline& other);
  Pipeline& operator=(const Pipeline& other);
  Pipeline(Pipeline&&) noexcept = default;
  Pipeline& operator=(Pipeline&&) noexcept = default;
  ~Pipeline() = default;

  void add(std::unique_ptr<TriggerStage> stage) { trigger_stages_.push_back(std::move(stage)); }
  void add_behind_output(std::unique_ptr<TriggerStage> stage) { output_stages_.push_back(std::move(stage)); }
  void add(std::unique_ptr<RowStage> stage) { row_stages_.push_back(std::move(stage)); }
  /// Whether it does nothing to anything.
  [[nodiscard]] bool empty() const noexcept { return !acts_on_triggers() && row_stages_.empty(); }
  [[nodiscard]] bool acts_on_triggers() const noexcept {
    return !trigger_stages_.empty() || !output_stages_.empty() || !clocks_.all_right();
  }

  void begin_run(std::uint64_t seed, std::uint32_t run);
  void seat_left(std::size_t seat);
  /// Once a tick, from tick 1 on. triggers: (n_sensors) what the detectors say at this tick (sim::Detector::tick); left
  /// as 1 where a sensor's output is on, else 0. What a stage loses or adds before the output comes before its hold.
  void hear(std::int64_t tick, std::span<std::uint8_t> triggers);
  /// Whether heard_by() may be a later tick than was asked for.
  [[nodiscard]] bool looks_ahead() const noexcept { return clocks_.any_early(); }
  /// The tick that has to be heard before it can be told what is logged at `tick`: that one, or a later one where a
  /// clock is early.
  [[nodiscard]] std::int64_t heard_by(std::int64_t tick) const noexcept { return clocks_.heard_by(tick); }
  /// Once a tick, from tick 1 on, after hear(heard_by(tick)). triggers: (n_sensors) set to those that are logged at
  /// this tick; left as hear() made them if all clocks are right.
  void log(std::int64_t tick, std::span<std::uint8_t> triggers) noexcept { clocks_.log(tick, triggers); }
  void apply(Sample& row) noexcept;

 private:
  /// A sensor that counts or holds motion, once more, as motion was lost or added before.
  struct Output {
    std::size_t sensor;
    pir::Comparator comparator;
    pir::Comparator::State state{};
  };

  std::vector<std::unique_ptr<TriggerStage>> trigger_stages_;
  std::vector<Output> outputs_;  ///< of all such sensors, if there are trigger stages
  std::vector<std::unique_ptr<TriggerStage>> output_stages_;
  Clocks clocks_;
  std::vector<std::unique_ptr<RowStage>> row_stages_;
};

}  // namespace pirsim::effects
