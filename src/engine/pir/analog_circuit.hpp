// The analog circuit: radiant power through element and amplifier to comparator.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pirsim/random.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

// Pyroelectric element and amplifier as one linear filter.

/// A cascade of first-order sections: the element's thermal high-pass and electrical low-pass, then the amplifier's
/// high-passes and low-passes. Advances by whole ticks, without error for an input that is linear over each tick; for
/// any other the error is at most tick^2 / 8 * max |input''| * integral of |impulse response|.
/// Noise is white over the ticks and enters behind the thermal section, where the charge leaks; its stationary
/// variance at the output is that of the spec at any tick. Derivation: docs/physics/analog.md.
class AnalogFilter {
 public:
  static constexpr std::size_t max_sections = 8;
  using Sections = std::array<double, max_sections>;  ///< what each section remembers, volts; unused ones 0

  /// Throws Error(usage) unless all time constants and corners are positive and the order is 1 to 3.
  AnalogFilter(const DetectorSpec& spec, double volts_per_watt, double tick_s);

  /// All transients gone after a long time at this power, without noise.
  [[nodiscard]] Sections at_rest(double power_w) const noexcept;
  /// Adds noise as it stands at a moment long after it was switched on.
  void add_stationary_noise(Sections& sections, Stream& stream) const noexcept;
  /// One tick on, during which the power goes linearly from one value to the other. white: a standard normal number.
  void advance(Sections& sections, double from_w, double to_w, double white) const noexcept;
  /// Volts above the offset, not yet saturated.
  [[nodiscard]] double output(const Sections& sections) const noexcept { return sections[n_ - 1]; }
  [[nodiscard]] bool noisy() const noexcept { return noisy_; }

 private:
  using Matrix = std::array<Sections, max_sections>;

  std::size_t n_ = 0;
  double volts_per_watt_ = 1.0;
  bool noisy_ = false;
  Matrix advance_{};     ///< lower triangular
  Sections from_{};      ///< per volt of the power at the tick's beginning
  Sections to_{};        ///< per volt of the power at its end
  Sections white_{};     ///< per standard normal number
  Matrix noise_root_{};  ///< lower triangular root of the noise's stationary covariance
};

// From a signal to an output that is on or off.

/// What a detector says at a tick: its output, and on which side of the window the signal is that it follows from.
/// Without a comparator only the output.
inline constexpr std::uint8_t output_on = 1, signal_above = 2, signal_below = 4;

/// A window comparator that counts pulses, and what its device reports; time in ticks.
///
/// A *pulse* begins with the tick at which the signal is outside the window, having been inside or on the other side
/// the tick before. While the output is off, *motion* counts with the last of `pulse_count` pulses that begin within
/// `pulse_window_s`; while it is on, with every tick outside. When motion counts the output is on, from then for
/// `hold_s`. During `again_s` after it counted no motion counts, nor during `blind_s` after the output went off; pulses
/// then are forgotten. With `again_s`, motion that begins no pulse counts only while some of the hold is left, so that
/// the output goes off though motion goes on if `again_s` is at least `hold_s`. With one pulse and no times the output
/// is on just while the signal is outside.
class Comparator {
 public:
  static constexpr int most_pulses = 8;

  struct State {
    std::int8_t side = 0;  ///< +1 above the window, -1 below, 0 inside
    std::int8_t last_pulse_side = 0;
    bool on = false;
    std::int8_t pulses = 0;                    ///< counted
    std::int32_t pulse_age[most_pulses] = {};  ///< ticks since each began, the oldest first
    std::int32_t hold_left = 0;                ///< ticks that the output stays on without more motion
    std::int32_t deaf_left = 0;                ///< ticks during which nothing counts
    bool operator==(const State&) const = default;

    [[nodiscard]] std::uint8_t trigger() const noexcept {
      const std::uint8_t signal = side > 0 ? signal_above : side < 0 ? signal_below : std::uint8_t{0};
      return static_cast<std::uint8_t>(signal | (on ? output_on : 0U));
    }
  };

  /// Throws Error(usage) for thresholds that aren't positive, negative times or a count outside 1 to most_pulses.
  Comparator(const ComparatorSpec& spec, const ReportSpec& report, double tick_s);

  /// One tick on. volts: above the offset.
  void advance(State& state, double volts) const noexcept;
  /// One tick on. side: +1 above the window, -1 below, 0 inside.
  void advance_to(State& state, std::int8_t side) const noexcept { report(state, counts(state, side)); }

  // The two halves of a tick, for whoever loses or adds motion in between.

  /// Whether motion counts at this tick, unless the device ignores all motion just now.
  [[nodiscard]] bool counts(State& state, std::int8_t side) const noexcept;
  /// Switches the output. motion: what counts(); motion that was lost in between was no pulse.
  void report(State& state, bool motion) const noexcept;

 private:
  void count_motion(State& state) const noexcept;
  bool count_pulse(State& state) const noexcept;

  ComparatorSpec spec_;
  std::int32_t pulse_window_ = 0, hold_ = 0, again_ = 0, blind_ = 0;  ///< ticks
};

/// Immutable, shared by all sensors of one model.
class AnalogCircuit {
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

  AnalogCircuit(const DetectorSpec& spec, double volts_per_watt, double tick_s);

  /// Long after power-on, with this power on the element ever since. noise: Purpose::detector_noise, entity the sensor.
  [[nodiscard]] State start(double power_w, StreamKey noise) const noexcept;
  /// One tick on, at whose end the power is `power_w` (signed by the zones' polarities; watts).
  void advance(State& state, double power_w) const noexcept;
  /// The same with the standard normal number that the state's stream would give, which it keeps; any if not noisy().
  void advance(State& state, double power_w, double white) const noexcept;
  [[nodiscard]] bool noisy() const noexcept { return filter_.noisy(); }
  /// The comparator's output.
  [[nodiscard]] static bool on(const State& state) noexcept { return state.comparator.on; }

 private:
  AnalogFilter filter_;
  Comparator comparator_;
  double lowest_v_, highest_v_;  ///< above the offset
};

}  // namespace pirsim::pir
