#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/pir/calibration.hpp"
#include "engine/pir/optics.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using pir::Crossing;
using pir::crossings;
using pir::TargetPass;
using test::wall_lens;

namespace {

constexpr double tick_s = 0.01, aperture_m2 = 20e-6;

double largest(const std::vector<double>& power) {
  double result = 0.0;
  for (const double p : power) result = std::max(result, std::abs(p));
  return result;
}

/// Time between the middles of the first and the last half of a course.
double time_between_humps(const std::vector<double>& power) {
  const auto middle = [&](std::size_t begin, std::size_t end) {
    double sum = 0.0, moment = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      sum += power[i];
      moment += power[i] * static_cast<double>(i);
    }
    return moment / sum * tick_s;
  };
  return middle(power.size() / 2, power.size()) - middle(0, power.size() / 2);
}

}  // namespace

TEST_CASE("a target as warm as the background brings no power", "[pir][target]") {
  const TargetPass pass{.target = {.contrast_k = 0.0}};
  for (const double power : crossings(wall_lens(), 0, 2)[0].power(pass, aperture_m2, tick_s)) CHECK(power == 0.0);
}

TEST_CASE("swapped polarity negates the power of a target", "[pir][target]") {
  const SensorModelSpec model = wall_lens();
  SensorModelSpec swapped = model;
  for (ClusterSpec& cluster : swapped.clusters) {
    for (ZoneSpec& zone : cluster.zones) zone.polarity = -zone.polarity;
  }
  const TargetPass pass{.target = {}, .distance_m = 6.0};
  const auto power = crossings(model, 7, 2)[0].power(pass, aperture_m2, tick_s);
  const auto negative = crossings(swapped, 7, 2)[0].power(pass, aperture_m2, tick_s);
  REQUIRE(power.size() == negative.size());
  REQUIRE(largest(power) > 0.0);
  for (std::size_t i = 0; i < power.size(); ++i) CHECK(power[i] == -negative[i]);
}

TEST_CASE("humps of a target's power come with the frequency v over 0.141 R", "[pir][target]") {
  const Crossing way = crossings(wall_lens(), 0, 2, 2048)[0];
  for (const double distance_m : {3.0, 6.0, 12.0}) {
    for (const double speed_m_s : {0.5, 1.0, 2.0}) {
      // So low that it passes between the zones above and below, which are of the other sign.
      const TargetPass pass{.target = {.height_m = 0.02 * distance_m, .speed_m_s = speed_m_s},
                            .distance_m = distance_m};
      const auto power = way.power(pass, aperture_m2, tick_s);
      CHECK(time_between_humps(power) == Approx(0.1414 * distance_m / speed_m_s).epsilon(0.01));
    }
  }
}

TEST_CASE("a facet below the axis is crossed to the left and right, one on a diagonal along rows and columns",
          "[pir][target]") {
  CHECK(crossings(wall_lens(), 0, 2).size() == 2);  // there and back
  const SensorModelSpec square = io::read_sensor_model(test::data_dir() / "sensors/EKMC1691111.yaml");
  for (const std::size_t facet : pir::reference_facets(square, 1)) {
    CHECK(crossings(square, facet, 2).size() == 8);   // two rows, two columns
    CHECK(crossings(square, facet, 1).size() == 16);  // four zones in four ways
  }
  const SensorModelSpec dual = io::read_sensor_model(test::data_dir() / "sensors/HC-SR501.yaml");
  CHECK(crossings(dual, 0, 2).size() == 2);  // its strips are side by side
  CHECK(crossings(dual, 0, 1).size() == 8);
}

TEST_CASE("far away the power falls with the square of the distance and near by a zone is filled", "[pir][target]") {
  SensorModelSpec model = wall_lens();
  model.optics.blur_deg = 0.0;
  const double contrast = pir::band_radiance(pir::kelvin(24.0)) - pir::band_radiance(pir::kelvin(20.0));
  // The plate within the zone: aperture times contrast times the plate's own solid angle.
  for (const double distance_m : {24.0, 48.0}) {
    const auto power =
        crossings(model, 0, 1, 160000)[0].power({.target = {}, .distance_m = distance_m}, aperture_m2, tick_s);
    const double plate_sr = 0.25 * 0.7 / (distance_m * distance_m);
    CHECK(largest(power) == Approx(aperture_m2 * contrast * plate_sr).epsilon(0.04));
  }
  // The zone within the plate: aperture times contrast times the zone's solid angle.
  const auto power = crossings(model, 0, 1)[0].power({.target = {}, .distance_m = 1.5}, aperture_m2, tick_s);
  const double zone_sr = pir::solid_angle_sr(model, model.clusters[0].zones[0]);
  CHECK(largest(power) == Approx(aperture_m2 * contrast * zone_sr).epsilon(1e-6));
}
