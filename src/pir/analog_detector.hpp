// A whole detector behind its lens: element, amplifier, comparator.
#pragma once

#include "pir/analog_filter.hpp"
#include "pir/comparator.hpp"
#include "pirsim/random.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

/// Immutable, shared by all sensors of one model.
class AnalogDetector {
 public:
  /// Everything that changes, of one sensor.
  struct State {
    AnalogFilter::Sections sections{};
    double power_w = 0.0;  ///< at the last tick
    double volts = 0.0;    ///< above the offset, saturated
    Comparator::State comparator{};
    Stream noise{StreamKey{}};
    bool operator==(const State&) const = default;
  };

  AnalogDetector(const DetectorSpec& spec, double volts_per_watt, double tick_s);

  /// Long after power-on, with this power on the element ever since. noise: Purpose::detector_noise, entity the sensor.
  [[nodiscard]] State start(double power_w, StreamKey noise) const noexcept;
  /// One tick on, at whose end the power is `power_w` (signed by the zones' polarities; watts).
  void advance(State& state, double power_w) const noexcept;
  /// The comparator's output.
  [[nodiscard]] static bool on(const State& state) noexcept { return state.comparator.on; }

 private:
  AnalogFilter filter_;
  Comparator comparator_;
  double lowest_v_, highest_v_;  ///< above the offset
};

}  // namespace pirsim::pir
