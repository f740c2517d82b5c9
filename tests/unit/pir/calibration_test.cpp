#include "pir/calibration.hpp"

#include <cmath>

#include "pir/analog_circuit.hpp"
#include "pir/planck.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

using namespace pirsim;
using pir::Calibration;
using pir::TargetPass;

namespace {

SensorModelSpec model_named(const std::string& id) {
  return io::read_sensor_model(test::data_dir() / "sensors" / (id + ".yaml"));
}

/// Has the whole detector, without noise, said "motion" during the pass?
bool detected(const SensorModelSpec& model, const Calibration& calibration, std::size_t facet, const TargetPass& pass) {
  DetectorSpec spec = model.detector;
  spec.amplifier.noise_v_pp = 0.0;
  constexpr double tick_s = 0.004;  // another tick than the calibration's
  const pir::AnalogCircuit detector(spec, calibration.volts_per_watt, tick_s);
  pir::AnalogCircuit::State state = detector.start(0.0, {});
  bool seen = false;
  for (const double power_w : target_power(model, facet, pass, calibration.apertures_m2[facet], tick_s)) {
    detector.advance(state, power_w);
    seen = seen || pir::AnalogCircuit::on(state);
  }
  return seen;
}

/// An amplifier whose gain is nearly the same from 1 mHz to 1 kHz, and an element likewise.
void flatten(DetectorSpec& spec) {
  spec.element = {.thermal_s = 1000.0, .electrical_s = 1e-4};
  spec.amplifier.low_hz = 1e-4;
  spec.amplifier.high_hz = 1e4;
  spec.amplifier.order = 1;
}

/// How far a facet drives the signal for 1 V/W and 1 m^2, for each W m^-2 sr^-1 of contrast.
double signal_of(const DetectorSpec& spec, const pir::PassedFacet& facet, const TargetPass& pass) {
  constexpr double tick_s = 0.01;
  const double background_k = pir::kelvin(pass.background_c);
  const double contrast =
      pir::band_radiance(background_k + pass.temperature_difference_k) - pir::band_radiance(background_k);
  return pir::excursion(spec, 1.0, facet.power(pass, 1.0, tick_s), tick_s) / contrast;
}

constexpr int rays_for_small_plates = 60000;  // a plate at 80 m is hit by some 400 of them

}  // namespace

TEST_CASE("each lens step just detects the data sheet's target at its rated distance") {
  const SensorModelSpec model = model_named("EKMC1604111");
  const Calibration calibration = pir::calibrate(model);
  for (const int lens_step : {1, 2, 3}) {
    const std::size_t facet = pir::reference_facet(model, lens_step);
    const double rated_m = model.clusters[facet].range_m;
    CHECK(pir::excursion(model, calibration, facet, {.distance_m = rated_m}) == Approx(1.0).epsilon(1e-9));
    CHECK(detected(model, calibration, facet, {.distance_m = rated_m, .temperature_difference_k = 4.1}));
    CHECK_FALSE(detected(model, calibration, facet, {.distance_m = rated_m, .temperature_difference_k = 3.9}));
  }
}

TEST_CASE("what an assumed aperture is worth cancels out") {
  SensorModelSpec model = model_named("EKMC1604111");
  const Calibration small = pir::calibrate(model);
  model.optics.aperture_mm2 *= 3.0;
  const Calibration large = pir::calibrate(model);
  for (std::size_t facet = 0; facet < model.clusters.size(); ++facet) {
    CHECK(large.apertures_m2[facet] * large.volts_per_watt ==
          Approx(small.apertures_m2[facet] * small.volts_per_watt).epsilon(1e-12));
  }
}

TEST_CASE("far away the signal of a detector that passes all frequencies falls with the square of the distance") {
  SensorModelSpec model = model_named("EKMC1604111");
  flatten(model.detector);
  const pir::PassedFacet facet(model, 0, rays_for_small_plates);
  const auto signal_at = [&](double distance_m) {
    return signal_of(model.detector, facet, {.distance_m = distance_m});
  };
  CHECK(2.0 * signal_at(40.0 * std::sqrt(2.0)) == Approx(signal_at(40.0)).epsilon(0.03));
  CHECK(4.0 * signal_at(80.0) == Approx(signal_at(40.0)).epsilon(0.03));
  CHECK(4.0 * signal_at(8.0) != Approx(signal_at(4.0)).epsilon(0.1));  // must fail: the plate fills zones
}

TEST_CASE("what counts is how large a target looks and how fast it passes the zones, v over 0.141 R") {
  const SensorModelSpec model = model_named("EKMC1604111");
  const pir::PassedFacet facet(model, 0);
  const TargetPass rated{.distance_m = 12.0};
  const double expected = signal_of(model.detector, facet, rated);
  for (const double scale : {0.2, 0.5, 3.0}) {
    TargetPass alike{.distance_m = scale * rated.distance_m,
                     .speed_m_s = scale * rated.speed_m_s,
                     .width_m = scale * rated.width_m,
                     .height_m = scale * rated.height_m};
    CHECK(signal_of(model.detector, facet, alike) == Approx(expected).epsilon(1e-9));
    alike.speed_m_s = rated.speed_m_s;
    CHECK(signal_of(model.detector, facet, alike) != Approx(expected).epsilon(0.05));  // must fail: another frequency
  }
}

TEST_CASE("the wall lens reaches 1.4 times as far for 8 K as its data sheet says for 4 K at 12 m") {
  const SensorModelSpec model = model_named("EKMC1604111");
  const Calibration calibration = pir::calibrate(model);
  const auto range_m = [&](int lens_step, double difference_k) {
    return pir::detection_range(model, calibration, pir::reference_facet(model, lens_step),
                                {.temperature_difference_k = difference_k});
  };
  CHECK(range_m(1, 4.0) == Approx(12.0).epsilon(0.002));
  CHECK(range_m(1, 8.0) / range_m(1, 4.0) == Approx(1.4).epsilon(0.05));
  // Nearer by the plate fills more of a zone, so that the signal falls less than with the square of the distance.
  CHECK(range_m(2, 4.0) == Approx(6.0).epsilon(0.002));
  CHECK(range_m(2, 8.0) / range_m(2, 4.0) > 1.5);
  // At 3 m it is wider than a zone: going further only slows the humps down, which the element likes.
  CHECK(range_m(3, 4.0) > 4.0);
}

TEST_CASE("a sensor without power at its rated distance can't be calibrated") {
  SensorModelSpec model = model_named("HC-SR501");
  for (ClusterSpec& cluster : model.clusters) {
    for (ZoneSpec& zone : cluster.zones) zone.corners = {Vec2(0.0), Vec2(0.0), Vec2(0.0), Vec2(0.0)};
  }
  CHECK_THROWS_AS(pir::calibrate(model), Error);
}
