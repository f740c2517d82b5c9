// Pyroelectric element and amplifier as one linear filter.
#pragma once

#include <array>
#include <cstddef>

#include "pirsim/random.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::pir {

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

}  // namespace pirsim::pir
