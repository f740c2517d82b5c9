#include "engine/pir/calibration.hpp"

#include <cmath>

#include "engine/pir/analog_circuit.hpp"
#include "engine/pir/optics.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/turned_lens.hpp"

using namespace pirsim;
using pir::Calibration;
using pir::RatedStep;
using pir::TargetPass;

namespace {

SensorModelSpec model_named(const std::string& id) {
  return io::read_sensor_model(test::data_dir() / "sensors" / (id + ".yaml"));
}

/// How far the whole detector, without noise, is driven in units of its threshold, on the mean over the ways. Of the
/// first facet that rated distances hold for.
double driven(const SensorModelSpec& model, int lens_step, const TargetPass& pass) {
  const Calibration calibration = pir::calibrate(model);
  DetectorSpec spec = model.detector;
  spec.amplifier.noise_v_pp = 0.0;
  constexpr double tick_s = 0.004;  // another tick than the calibration's
  const pir::AnalogCircuit detector(spec, calibration.volts_per_watt, tick_s);
  double sum = 0.0, n = 0.0;
  for (const std::size_t facet : pir::reference_facets(model, lens_step)) {
    for (const pir::Crossing& way : pir::crossings(model, facet, pass.target.zones)) {
      pir::AnalogCircuit::State state = detector.start(0.0, {});
      double farthest = 0.0;
      for (const double power_w : way.power(pass, calibration.apertures_m2.at(lens_step), tick_s)) {
        detector.advance(state, power_w);
        farthest = std::max(farthest, std::abs(state.volts) / spec.comparator.positive_v);
      }
      sum += farthest;
      n += 1.0;
    }
  }
  return sum / n;
}

/// An amplifier whose gain is nearly the same from 1 mHz to 1 kHz, and an element likewise.
void flatten(DetectorSpec& spec) {
  spec.element = {.thermal_s = 1000.0, .electrical_s = 1e-4};
  spec.amplifier.low_hz = 1e-4;
  spec.amplifier.high_hz = 1e4;
  spec.amplifier.order = 1;
}

constexpr int rays_for_small_plates = 60000;  // a plate at 80 m is hit by some 400 of them

/// W m^-2 sr^-1
double contrast_of(const TargetPass& pass) {
  const double background_k = pir::kelvin(pass.background_c);
  return pir::band_radiance(background_k + pass.target.contrast_k) - pir::band_radiance(background_k);
}

}  // namespace

TEST_CASE("each lens step just detects the maker's target at its rated distance") {
  for (const char* id : {"EKMC1604111", "EKMC1693111"}) {
    const SensorModelSpec model = model_named(id);
    for (const auto& [lens_step, aperture] : pir::calibrate(model).apertures_m2) {
      const TargetPass rated = RatedStep(model, lens_step).rated();
      CHECK(driven(model, lens_step, rated) == Approx(1.0).epsilon(0.01));
    }
  }
}

TEST_CASE("the target of a lens step is its maker's, and how far its plane is in the facet's direction") {
  const SensorModelSpec model = model_named("EKMC1693111");  // slight motion in the middle, standard around it
  const TargetPass middle = RatedStep(model, 1).rated(), edge = RatedStep(model, 4).rated();
  CHECK(middle.target.zones == 1);
  CHECK(middle.target.speed_m_s == 0.5);
  CHECK(middle.distance_m == 2.2);
  CHECK(edge.target.zones == 2);
  CHECK(edge.target.height_m == 0.4);
  CHECK(edge.distance_m == Approx(2.2 / std::cos(radians(41.0))).epsilon(0.002));  // the drawing's printed angle
  CHECK(RatedStep(model_named("EKMC1604111"), 2).rated().target.width_m == RatedTargetSpec{}.width_m);
}

TEST_CASE("a smaller target at the same distance makes the calibrated gain larger") {
  SensorModelSpec model = model_named("EKMC1601111");
  const double gain = pir::calibrate(model).volts_per_watt;
  model.targets = {{.lens_step = 1, .width_m = 0.2, .height_m = 0.2}};
  CHECK(pir::calibrate(model).volts_per_watt > 1.2 * gain);
}

TEST_CASE("a plate that crosses one zone, smaller than it, brings its own solid angle times aperture and contrast") {
  for (const char* id : {"EKMC1604111", "EKMC1601111", "AMN32111", "HC-SR501"}) {
    SensorModelSpec model = model_named(id);
    model.optics.blur_deg = 0.0;
    flatten(model.detector);
    model.targets = {};
    TargetPass pass{.target = {.width_m = 0.3, .height_m = 0.2, .zones = 1}, .distance_m = 25.0};
    const auto driven_by = [&](const SensorModelSpec& by) {
      SensorModelSpec one = by;
      one.targets = {pass.target};
      return RatedStep(one, 1, rays_for_small_plates).excursion(pass);
    };
    const double watts_m2 = contrast_of(pass) * 0.3 * 0.2 / (25.0 * 25.0);
    CHECK(driven_by(model) == Approx(watts_m2 / model.detector.comparator.positive_v).epsilon(0.05));
    pass.target.width_m = 0.6;
    CHECK(driven_by(model) != Approx(watts_m2 / model.detector.comparator.positive_v).epsilon(0.5));  // must fail
  }
}

TEST_CASE("a lens is calibrated alike however its file is turned or mirrored", "[turned][seconds]") {
  constexpr double rounding = 1e-5;  // may take a direction on the plate's edge to its other side

  // Lens by lens one of the two turns that make all others.
  std::array<test::Turn, 2> turns{test::Turn{1, 1}, test::Turn{0, -1}};
  for (const std::string& id : test::shipped_lenses()) {
    const Calibration drawn = pir::calibrate(model_named(id));
    std::swap(turns[0], turns[1]);
    const Calibration turned = pir::calibrate(test::read_turned(id, turns[0]));
    INFO(id << ", " << test::name(turns[0]));
    REQUIRE(turned.apertures_m2.size() == drawn.apertures_m2.size());
    CHECK(turned.volts_per_watt == Approx(drawn.volts_per_watt).epsilon(rounding));
    for (const auto& [step, aperture_m2] : drawn.apertures_m2)
      CHECK(turned.apertures_m2.at(step) == Approx(aperture_m2).epsilon(rounding));
  }
}

TEST_CASE("facets nearest to straight ahead are the ones that a rated distance holds for") {
  for (const std::string& id : test::shipped_lenses()) {
    const SensorModelSpec model = model_named(id);
    const auto ahead = [&](std::size_t facet) {  // of the facet's middle, by the cosine
      const Vec2& c = model.clusters[facet].centre;
      return model.plane_m / std::sqrt(glm::dot(c, c) + model.plane_m * model.plane_m);
    };
    const std::vector<std::size_t> facets = pir::reference_facets(model, 1);
    REQUIRE_FALSE(facets.empty());
    for (std::size_t i = 0; i < model.clusters.size(); ++i) {
      if (model.clusters[i].lens_step != 1) continue;
      const bool is_one = std::ranges::find(facets, i) != facets.end();
      const double off_deg = degrees(std::acos(std::min(1.0, ahead(i))));
      const double least_deg = degrees(std::acos(std::min(1.0, ahead(facets[0]))));
      CHECK(is_one == (off_deg < least_deg + 0.8));
    }
  }
}

TEST_CASE("what an assumed aperture is worth cancels out") {
  SensorModelSpec model = model_named("EKMC1604111");
  const Calibration small = pir::calibrate(model);
  model.optics.aperture_mm2 *= 3.0;
  const Calibration large = pir::calibrate(model);
  for (const auto& [step, aperture_m2] : small.apertures_m2) {
    CHECK(large.apertures_m2.at(step) * large.volts_per_watt ==
          Approx(aperture_m2 * small.volts_per_watt).epsilon(1e-12));
  }
}

TEST_CASE("far away the signal of a detector that passes all frequencies falls with the square of the distance") {
  SensorModelSpec model = model_named("EKMC1604111");
  flatten(model.detector);
  const RatedStep step(model, 1, rays_for_small_plates);
  const auto signal_at = [&](double distance_m) { return step.excursion({.target = {}, .distance_m = distance_m}); };
  CHECK(2.0 * signal_at(40.0 * std::sqrt(2.0)) == Approx(signal_at(40.0)).epsilon(0.03));
  CHECK(4.0 * signal_at(80.0) == Approx(signal_at(40.0)).epsilon(0.03));
  CHECK(4.0 * signal_at(8.0) != Approx(signal_at(4.0)).epsilon(0.1));  // must fail: the plate fills zones
}

TEST_CASE("what counts is how large a target looks and how fast it passes the zones, v over 0.141 R") {
  const RatedStep step(model_named("EKMC1604111"), 1);
  const TargetPass rated{};
  const double expected = step.excursion(rated);
  for (const double scale : {0.2, 0.5, 3.0}) {
    TargetPass alike = rated;
    alike.distance_m *= scale;
    for (double RatedTargetSpec::*member :
         {&RatedTargetSpec::speed_m_s, &RatedTargetSpec::width_m, &RatedTargetSpec::height_m})
      alike.target.*member *= scale;
    CHECK(step.excursion(alike) == Approx(expected).epsilon(1e-9));
    alike.target.speed_m_s = rated.target.speed_m_s;
    CHECK(step.excursion(alike) != Approx(expected).epsilon(0.05));  // must fail: another frequency
  }
}

TEST_CASE("the wall lens reaches 1.4 times as far for 8 K as its data sheet says for 4 K at 12 m") {
  const SensorModelSpec model = model_named("EKMC1604111");
  const Calibration calibration = pir::calibrate(model);
  const auto range_m = [&](int lens_step, double contrast_k) {
    return RatedStep(model, lens_step)
        .detection_range(calibration.apertures_m2.at(lens_step) * calibration.volts_per_watt,
                         {.target = {.contrast_k = contrast_k}});
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
