#include "pir/analog_detector.hpp"

#include <algorithm>

namespace pirsim::pir {

AnalogDetector::AnalogDetector(const DetectorSpec& spec, double volts_per_watt, double tick_s)
    : filter_(spec, volts_per_watt, tick_s),
      comparator_(spec.comparator, tick_s),
      lowest_v_(spec.amplifier.lowest_v - spec.amplifier.offset_v),
      highest_v_(spec.amplifier.highest_v - spec.amplifier.offset_v) {}

AnalogDetector::State AnalogDetector::start(double power_w, StreamKey noise) const noexcept {
  State state{.sections = filter_.at_rest(power_w), .power_w = power_w, .noise = Stream(noise)};
  if (filter_.noisy()) filter_.add_stationary_noise(state.sections, state.noise);
  state.volts = std::clamp(filter_.output(state.sections), lowest_v_, highest_v_);
  return state;
}

void AnalogDetector::advance(State& state, double power_w) const noexcept {
  const double white = filter_.noisy() ? state.noise.normal() : 0.0;
  filter_.advance(state.sections, state.power_w, power_w, white);
  state.power_w = power_w;
  state.volts = std::clamp(filter_.output(state.sections), lowest_v_, highest_v_);
  comparator_.advance(state.comparator, state.volts);
}

}  // namespace pirsim::pir
