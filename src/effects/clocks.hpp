// Clocks that are off: when a logger stamps what the sensors trigger.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace pirsim::effects {

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

}  // namespace pirsim::effects
