#include "pir/comparator.hpp"

#include <algorithm>
#include <cmath>

#include "pirsim/error.hpp"

namespace pirsim::pir {
namespace {

std::int32_t ticks(double seconds, double tick_s) { return static_cast<std::int32_t>(std::lround(seconds / tick_s)); }

/// Counts on without ever overflowing.
void age(std::int32_t& ticks) noexcept {
  constexpr std::int32_t oldest = 1 << 30;
  if (ticks < oldest) ++ticks;
}

}  // namespace

Comparator::Comparator(const ComparatorSpec& spec, double tick_s) : spec_(spec) {
  if (!(spec.positive_v > 0.0 && spec.negative_v > 0.0 && spec.hold_s >= 0.0 && spec.blind_s >= 0.0 &&
        spec.pulse_window_s >= 0.0 && spec.pulse_count >= 1 && spec.pulse_count <= most_pulses)) {
    throw Error(ErrorCode::usage, "comparator: expected positive thresholds, times of at least 0 and 1 to 8 pulses");
  }
  pulse_window_ = ticks(spec.pulse_window_s, tick_s);
  hold_ = ticks(spec.hold_s, tick_s);
  blind_ = ticks(spec.blind_s, tick_s);
}

void Comparator::count_pulse(State& state) const noexcept {
  if (spec_.pulse_signs == PulseSigns::alternating && state.pulses > 0 && state.side == state.last_pulse_side) return;
  state.last_pulse_side = state.side;
  state.pulse_age[state.pulses++] = 0;
  state.on = state.pulses >= spec_.pulse_count;
}

void Comparator::advance(State& state, double volts) const noexcept {
  const std::int8_t before = state.side;
  state.side = static_cast<std::int8_t>(volts > spec_.positive_v ? 1 : volts < -spec_.negative_v ? -1 : 0);
  if (state.blind_left > 0) {
    --state.blind_left;
    return;
  }
  for (int i = 0; i < state.pulses; ++i) age(state.pulse_age[i]);
  while (state.pulses > 0 && state.pulse_age[0] > pulse_window_) {
    std::copy(state.pulse_age + 1, state.pulse_age + state.pulses, state.pulse_age);
    state.pulse_age[--state.pulses] = 0;
  }
  age(state.since_outside);
  if (state.side != 0) state.since_outside = 0;
  if (state.on) {
    if (state.since_outside <= hold_) return;
    state = {.side = state.side, .since_outside = state.since_outside, .blind_left = blind_};
  } else if (state.side != 0 && state.side != before) {
    count_pulse(state);
  }
}

}  // namespace pirsim::pir
