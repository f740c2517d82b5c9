#include "engine/pir/analog_circuit.hpp"

#include <cmath>
#include <complex>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using pir::AnalogFilter;

namespace {

DetectorSpec silent_filter(int order) {
  DetectorSpec spec;
  spec.amplifier.order = order;
  spec.amplifier.noise_v_pp = 0.0;
  return spec;
}

/// Poles, rad/s, by the definition of the corners.
struct Poles {
  double thermal, electrical, low, high;
};
Poles poles_of(const DetectorSpec& spec) {
  const double one_of_n = std::sqrt(std::pow(2.0, 1.0 / spec.amplifier.order) - 1.0);
  return {1.0 / spec.element.thermal_s, 1.0 / spec.element.electrical_s, 2.0 * pi * spec.amplifier.low_hz * one_of_n,
          2.0 * pi * spec.amplifier.high_hz / one_of_n};
}

std::complex<double> transfer(const DetectorSpec& spec, double f_hz) {
  const Poles poles = poles_of(spec);
  const std::complex<double> s(0.0, 2.0 * pi * f_hz);
  const std::complex<double> element = s / (s + poles.thermal) * poles.electrical / (s + poles.electrical);
  return element * std::pow(s / (s + poles.low) * poles.high / (s + poles.high), spec.amplifier.order);
}

/// To a power that rises from 0 by 1 W/s from t = 0 on, for order 1: residues of c / prod(s + p).
double ramp_response(const Poles& poles, double t) {
  if (t <= 0.0) return 0.0;
  const std::array<double, 4> p{poles.thermal, poles.electrical, poles.low, poles.high};
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    double residue = poles.electrical * poles.high * std::exp(-p[i] * t);
    for (std::size_t j = 0; j < 4; ++j) {
      if (j != i) residue /= p[j] - p[i];
    }
    sum += residue;
  }
  return sum;
}

/// The output at the end of each tick.
std::vector<double> response(const DetectorSpec& spec, const std::vector<double>& power_w, double tick_s) {
  const AnalogFilter filter(spec, 1.0, tick_s);
  AnalogFilter::Sections sections = filter.at_rest(power_w.front());
  std::vector<double> volts{filter.output(sections)};
  for (std::size_t i = 1; i < power_w.size(); ++i) {
    filter.advance(sections, power_w[i - 1], power_w[i], 0.0);
    volts.push_back(filter.output(sections));
  }
  return volts;
}

template <typename Function>
std::vector<double> sampled(Function power, double tick_s, double seconds) {
  std::vector<double> values;
  for (int i = 0; i * tick_s <= seconds + 1e-9; ++i) values.push_back(power(i * tick_s));
  return values;
}

/// Integral of |impulse response|: the most that an input of at most 1 can bring.
double gain_of_bounded_input(const DetectorSpec& spec) {
  constexpr double tick_s = 1e-3;
  const std::vector<double> step = response(spec, sampled([](double t) { return t > 0.0; }, tick_s, 30.0), tick_s);
  double sum = 0.0;
  for (std::size_t i = 1; i < step.size(); ++i) sum += std::abs(step[i] - step[i - 1]);
  return sum;
}

}  // namespace

TEST_CASE("a step of power answers as the four poles say") {
  const DetectorSpec spec = silent_filter(1);
  const Poles poles = poles_of(spec);
  for (const double tick_s : {0.002, 0.02, 0.1}) {
    const std::vector<double> volts = response(spec, sampled([](double t) { return t > 0.0; }, tick_s, 5.0), tick_s);
    for (std::size_t i = 0; i < volts.size(); ++i) {
      const double t = static_cast<double>(i) * tick_s;  // the step is a ramp that lasts one tick
      const double expected = (ramp_response(poles, t) - ramp_response(poles, t - tick_s)) / tick_s;
      REQUIRE(volts[i] == Approx(expected).margin(1e-11));
    }
  }
}

TEST_CASE("with a wide amplifier a step answers as the element's two poles") {
  DetectorSpec spec = silent_filter(1);
  spec.amplifier.low_hz = 1e-6;
  spec.amplifier.high_hz = 1e5;
  const double fast = 1.0 / spec.element.thermal_s, slow = 1.0 / spec.element.electrical_s, tick_s = 1e-3;
  const std::vector<double> volts = response(spec, sampled([](double t) { return t > 0.0; }, tick_s, 3.0), tick_s);
  for (std::size_t i = 1; i < volts.size(); ++i) {
    const double t = (static_cast<double>(i) - 0.5) * tick_s;
    REQUIRE(volts[i] == Approx(slow / (slow - fast) * (std::exp(-fast * t) - std::exp(-slow * t))).margin(5e-5));
  }
}

TEST_CASE("a sine comes out with the gain and the phase of the transfer function") {
  constexpr double tick_s = 0.02, seconds = 40.0;
  for (const int order : {1, 2, 3}) {
    const DetectorSpec spec = silent_filter(order);
    for (const double f_hz : {0.1, 0.59, 1.2, 2.4, 6.5}) {
      const double omega = 2.0 * pi * f_hz;
      const std::vector<double> volts =
          response(spec, sampled([&](double t) { return std::sin(omega * t); }, tick_s, seconds), tick_s);
      const double bound = tick_s * tick_s / 8.0 * omega * omega * gain_of_bounded_input(spec) + 1e-6;
      for (std::size_t i = volts.size() - 100; i < volts.size(); ++i) {
        const double t = static_cast<double>(i) * tick_s;
        const double expected = (transfer(spec, f_hz) * std::polar(1.0, omega * t)).imag();
        REQUIRE(std::abs(volts[i] - expected) <= bound);
      }
    }
  }
}

TEST_CASE("the amplifier's edges lose 3 dB at its corners whatever its order") {
  for (const int order : {1, 2, 3}) {
    DetectorSpec spec = silent_filter(order);
    spec.amplifier.high_hz = 1e5;
    const auto amplifier = [&](double f_hz) {
      const std::complex<double> s(0.0, 2.0 * pi * f_hz);
      const Poles poles = poles_of(spec);
      return std::abs(transfer(spec, f_hz) * (s + poles.thermal) / s * (s + poles.electrical) / poles.electrical);
    };
    REQUIRE(amplifier(0.3) == Approx(std::sqrt(0.5)).epsilon(1e-6));
  }
}

TEST_CASE("halving the tick changes nothing for a power that goes in straight lines between ticks") {
  const DetectorSpec spec = silent_filter(2);
  const auto corners = [](double t) { return std::fmod(std::floor(t / 0.02 + 1e-6) * 7919.0, 13.0) - 6.0; };
  const auto lines = [&](double t) {
    const double before = std::floor(t / 0.02 + 1e-6) * 0.02, share = (t - before) / 0.02;
    return corners(before) * (1.0 - share) + corners(before + 0.02) * share;
  };
  const std::vector<double> coarse = response(spec, sampled(lines, 0.02, 4.0), 0.02);
  const std::vector<double> fine = response(spec, sampled(lines, 0.01, 4.0), 0.01);
  for (std::size_t i = 0; i < coarse.size(); ++i) REQUIRE(coarse[i] == Approx(fine[2 * i]).margin(1e-10));
}

TEST_CASE("halving the tick changes the signal of a passer-by by less than the bound") {
  const DetectorSpec spec = silent_filter(2);
  constexpr double tick_s = 0.02, width_s = 0.1;  // as fast as somebody who runs past at 3 m
  const auto pulse = [](double t) { return std::exp(-0.5 * std::pow((t - 1.0) / width_s, 2)); };
  const double curvature = 1.0 / (width_s * width_s);
  const double bound = (tick_s * tick_s / 8.0 + tick_s * tick_s / 32.0) * curvature * gain_of_bounded_input(spec);
  const std::vector<double> coarse = response(spec, sampled(pulse, tick_s, 4.0), tick_s);
  const std::vector<double> fine = response(spec, sampled(pulse, tick_s / 2.0, 4.0), tick_s / 2.0);
  double largest = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    largest = std::max(largest, std::abs(coarse[i] - fine[2 * i]));
    peak = std::max(peak, std::abs(fine[2 * i]));
  }
  REQUIRE(largest <= bound);
  REQUIRE(largest > 0.02 * bound);  // the bound says something
  REQUIRE(largest < 0.005 * peak);
}

TEST_CASE("at rest with any power nothing comes out") {
  const std::vector<double> volts = response(silent_filter(2), std::vector<double>(500, 3.7), 0.02);
  for (const double value : volts) REQUIRE(std::abs(value) < 1e-12);
}

TEST_CASE("time constants and corners must be positive and the order known") {
  DetectorSpec spec;
  spec.element.thermal_s = 0.0;
  REQUIRE_THROWS_AS(AnalogFilter(spec, 1.0, 0.02), Error);
  spec = {};
  spec.amplifier.order = 4;
  REQUIRE_THROWS_AS(AnalogFilter(spec, 1.0, 0.02), Error);
}
