// How sensitive each sensor is among those of its make.
#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/study/study_in_force.hpp"
#include "pirsim/response.hpp"
#include "support/catch.hpp"

using namespace pirsim;

namespace {

SceneSpec scene_of(std::size_t n_sensors, const SensitivitySpec& make) {
  SceneSpec scene;
  scene.sensor_models["M"].sensitivity = make;
  scene.sensors.resize(n_sensors);
  for (SensorSpec& sensor : scene.sensors) sensor.model = "M";
  return scene;
}

constexpr std::uint64_t seed = 7;
constexpr SensitivitySpec papirs{.mean = 1.36, .sd = 0.1};

}  // namespace

TEST_CASE("a guaranteed unit is as rated, a typical one as the mean", "[units]") {
  const SceneSpec scene = scene_of(2, papirs);
  CHECK(unit_sensitivity(scene, Units::guaranteed, seed, 1) == 1.0);
  CHECK(unit_sensitivity(scene, Units::typical, seed, 1) == 1.36);
  CHECK(unit_sensitivity(scene_of(1, {}), Units::drawn, seed, 0) == 1.0);  // a make that doesn't say
}

TEST_CASE("drawn units are log-normal about their make's mean", "[units]") {
  constexpr std::size_t n = 40000;
  const SceneSpec scene = scene_of(n, papirs);
  std::vector<double> logs;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double unit = unit_sensitivity(scene, Units::drawn, seed, i);
    sum += unit;
    logs.push_back(std::log(unit));
  }
  const double mean = sum / n;
  const double standard_error = 1.36 * papirs.sd / std::sqrt(static_cast<double>(n));  // 0.0007
  CHECK(std::abs(mean - 1.36) < 4.0 * standard_error);
  CHECK(std::abs(mean - 1.36 * std::exp(0.5 * papirs.sd * papirs.sd)) > 4.0 * standard_error);  // must fail: the median
  std::ranges::sort(logs);
  const auto quantile = [&](double p) { return logs[static_cast<std::size_t>(p * n)]; };
  CHECK(quantile(0.8413) - quantile(0.5) == Approx(papirs.sd).epsilon(0.03));
  CHECK(quantile(0.5) - quantile(0.1587) == Approx(papirs.sd).epsilon(0.03));
  // Nearly all are at least as sensitive as guaranteed, and less than twice.
  CHECK(quantile(0.005) > 0.0);
  CHECK(quantile(0.995) < std::log(2.0));
}

TEST_CASE("units multiply the gains of the study in force, each sensor's own, whatever the other sensors", "[units]") {
  SceneSpec scene = scene_of(3, papirs);
  scene.sensors[1].gain = 2.0;
  ScriptSpec script;
  script.seed = seed;
  const auto gains = [&](Units units) {
    script.sensing.units = units;
    std::vector<double> found;
    for (const SensorSpec& sensor : as_given(scene, script).scene.sensors) found.push_back(sensor.gain);
    return found;
  };
  CHECK(gains(Units::guaranteed) == std::vector{1.0, 2.0, 1.0});
  CHECK(gains(Units::typical) == std::vector{1.36, 2.0 * 1.36, 1.36});
  const std::vector<double> drawn = gains(Units::drawn);
  CHECK(drawn == gains(Units::drawn));
  CHECK(drawn[0] != drawn[2]);
  CHECK(drawn[1] == 2.0 * unit_sensitivity(scene, Units::drawn, seed, 1));
  scene.sensors.pop_back();
  CHECK(gains(Units::drawn) == std::vector{drawn[0], drawn[1]});
  script.seed = seed + 1;
  CHECK(gains(Units::drawn)[0] != drawn[0]);
}
