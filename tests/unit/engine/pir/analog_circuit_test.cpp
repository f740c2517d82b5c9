#include "engine/pir/analog_circuit.hpp"

#include <cmath>
#include <vector>

#include "pirsim/geometry.hpp"
#include "support/catch.hpp"

using namespace pirsim;

namespace {

constexpr StreamKey noise_of_sensor{.seed = 5, .run = 2, .entity = 1, .purpose = Purpose::detector_noise};

DetectorSpec silent() {
  DetectorSpec spec;
  spec.amplifier.noise_v_pp = 0.0;
  return spec;
}

std::vector<double> volts(const DetectorSpec& spec, double scale, int n) {
  const pir::AnalogCircuit detector(spec, 1.0, 0.02);
  pir::AnalogCircuit::State state = detector.start(0.0, noise_of_sensor);
  std::vector<double> values;
  for (int tick = 1; tick <= n; ++tick) {
    detector.advance(state, scale * std::sin(0.15 * tick));
    values.push_back(state.volts);
  }
  return values;
}

double noise_sd(const DetectorSpec& spec) { return spec.amplifier.noise_v_pp / 6.6; }

/// The density of the noise at the output, but for a factor: white before the electrical section.
double noise_density(const DetectorSpec& spec, double f_hz, double electrical_s) {
  const double one_of_n = std::sqrt(std::pow(2.0, 1.0 / spec.amplifier.order) - 1.0);
  const double low = f_hz / (spec.amplifier.low_hz * one_of_n), high = f_hz * one_of_n / spec.amplifier.high_hz;
  const double edge = low * low / (1.0 + low * low) / (1.0 + high * high);
  return std::pow(edge, spec.amplifier.order) / (1.0 + std::pow(2.0 * pi * f_hz * electrical_s, 2));
}

/// Rice's rate of passing a level upwards, per second. Ref: [Rice1945]
double rice_rate(const DetectorSpec& spec, double level_in_sd, double electrical_s) {
  double zeroth = 0.0, second = 0.0;
  constexpr double step = 0.001;
  for (double f_hz = 0.5 * step; f_hz < 400.0; f_hz += step) {
    const double density = noise_density(spec, f_hz, electrical_s);
    zeroth += density;
    second += density * f_hz * f_hz;
  }
  return std::sqrt(second / zeroth) * std::exp(-0.5 * level_in_sd * level_in_sd);
}

}  // namespace

TEST_CASE("a change of every zone's sign changes the sign of the signal and nothing else") {
  const std::vector<double> plus = volts(silent(), 0.7, 300), minus = volts(silent(), -0.7, 300);
  for (std::size_t i = 0; i < plus.size(); ++i) REQUIRE(plus[i] == -minus[i]);
}

TEST_CASE("the output saturates where the data sheet says") {
  double highest = 0.0, lowest = 0.0;
  for (const double value : volts(silent(), 100.0, 300)) {
    highest = std::max(highest, value);
    lowest = std::min(lowest, value);
  }
  REQUIRE(highest == Approx(1.9 - 1.1));
  REQUIRE(lowest == Approx(0.2 - 1.1));
}

TEST_CASE("a copy of a detector's state goes on as the original does") {
  const pir::AnalogCircuit detector({}, 1.0, 0.02);
  pir::AnalogCircuit::State state = detector.start(0.2, noise_of_sensor);
  for (int tick = 0; tick < 50; ++tick) detector.advance(state, 0.1 * tick);
  pir::AnalogCircuit::State copy = state;
  for (int tick = 0; tick < 50; ++tick) {
    detector.advance(state, 3.0);
    detector.advance(copy, 3.0);
  }
  REQUIRE(copy == state);
  detector.advance(copy, 3.0);
  REQUIRE_FALSE(copy == state);
}

TEST_CASE("without noise no random number is drawn and a steady power is silent") {
  const pir::AnalogCircuit detector(silent(), 1.0, 0.02);
  pir::AnalogCircuit::State state = detector.start(0.4, noise_of_sensor);
  for (int tick = 0; tick < 100; ++tick) detector.advance(state, 0.4);
  REQUIRE(state.noise == Stream(noise_of_sensor));
  REQUIRE(std::abs(state.volts) < 1e-12);
}

TEST_CASE("noise has the data sheet's strength from the first tick on and at any tick") {
  constexpr int n = 4000;  // independent sensors; relative standard error of the deviation 1 / sqrt(2 n) = 1.1 %
  for (const double tick_s : {0.005, 0.02, 0.1}) {
    const pir::AnalogCircuit detector({}, 1.0, tick_s);
    double at_start = 0.0, later = 0.0;
    for (std::uint32_t sensor = 0; sensor < n; ++sensor) {
      StreamKey key = noise_of_sensor;
      key.entity = sensor;
      pir::AnalogCircuit::State state = detector.start(0.0, key);
      at_start += state.volts * state.volts;
      for (int tick = 0; tick < 40; ++tick) detector.advance(state, 0.0);
      later += state.volts * state.volts;
    }
    const double standard_error = 1.0 / std::sqrt(2.0 * n), expected = noise_sd({});
    REQUIRE(std::abs(std::sqrt(at_start / n) / expected - 1.0) < 4.0 * standard_error);
    REQUIRE(std::abs(std::sqrt(later / n) / expected - 1.0) < 4.0 * standard_error);
    REQUIRE(std::abs(std::sqrt(later / n) / (0.9 * expected) - 1.0) > 4.0 * standard_error);  // must fail
  }
}

TEST_CASE("noise alone gives the rate of false alarms that Rice's formula predicts") {
  constexpr double tick_s = 0.005, seconds = 30000.0, level_in_sd = 2.0;
  DetectorSpec spec;
  spec.comparator.positive_v = spec.comparator.negative_v = level_in_sd * noise_sd(spec);
  const pir::AnalogCircuit detector(spec, 1.0, tick_s);
  pir::AnalogCircuit::State state = detector.start(0.0, noise_of_sensor);
  std::vector<double> alarms_by_part(100, 0.0);  // independent but for their ends
  for (double& alarms : alarms_by_part) {
    for (int tick = 0; tick < seconds / tick_s / 100.0; ++tick) {
      const bool before = pir::AnalogCircuit::on(state);
      detector.advance(state, 0.0);
      if (!before && pir::AnalogCircuit::on(state)) ++alarms;
    }
  }
  double sum = 0.0, squares = 0.0;
  for (const double alarms : alarms_by_part) {
    sum += alarms;
    squares += alarms * alarms;
  }
  const double variance = (squares - sum * sum / 100.0) / 99.0;
  const double standard_error = std::sqrt(variance * 100.0);  // of the sum; about 1.5 %
  const auto distance = [&](double rate) { return std::abs(sum - 2.0 * rate * seconds) / standard_error; };
  REQUIRE(standard_error < 0.03 * sum);
  REQUIRE(distance(rice_rate(spec, level_in_sd, spec.element.electrical_s)) < 4.0);
  REQUIRE(distance(rice_rate(spec, level_in_sd, 1e-3)) > 4.0);  // must fail: noise that passes no electrical section
  REQUIRE(distance(rice_rate(spec, 1.1 * level_in_sd, spec.element.electrical_s)) > 4.0);  // must fail: other level
}
