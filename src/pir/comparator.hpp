// From a signal to an output that is on or off.
#pragma once

#include <cstdint>

#include "pirsim/sensor.hpp"

namespace pirsim::pir {

/// A window comparator that counts pulses, with hold and blind time; time in ticks.
///
/// A *pulse* begins with the tick at which the signal is outside the window, having been inside or on the other side
/// the tick before. `pulse_count` pulses that begin within `pulse_window_s` switch the output on with the last of them.
/// It goes off with the first tick at which the signal has been inside for `hold_s`; then, for `blind_s`, no pulse
/// counts and those counted before are forgotten. With one pulse, no hold and no blind time the output is on just while
/// the signal is outside.
class Comparator {
 public:
  static constexpr int most_pulses = 8;

  struct State {
    std::int8_t side = 0;  ///< +1 above the window, -1 below, 0 inside
    std::int8_t last_pulse_side = 0;
    bool on = false;
    std::int8_t pulses = 0;                    ///< counted
    std::int32_t pulse_age[most_pulses] = {};  ///< ticks since each began, the oldest first
    std::int32_t since_outside = 0;            ///< ticks
    std::int32_t blind_left = 0;               ///< ticks
    bool operator==(const State&) const = default;
  };

  /// Throws Error(usage) for thresholds that aren't positive, negative times or a count outside 1 to most_pulses.
  Comparator(const ComparatorSpec& spec, double tick_s);

  /// One tick on. volts: above the offset.
  void advance(State& state, double volts) const noexcept;

 private:
  void count_pulse(State& state) const noexcept;

  ComparatorSpec spec_;
  std::int32_t pulse_window_ = 0, hold_ = 0, blind_ = 0;  ///< ticks
};

}  // namespace pirsim::pir
