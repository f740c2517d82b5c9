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
constexpr SensitivitySpec papirs{.median = 1.4, .installation_sd = 0.7, .sd = 0.1};

}  // namespace

TEST_CASE("a guaranteed unit is as rated, a typical one the median, a low one what nine in ten exceed", "[units]") {
  const SceneSpec scene = scene_of(2, papirs);
  CHECK(unit_sensitivity(scene, Units::guaranteed, seed, 1) == 1.0);
  CHECK(unit_sensitivity(scene, Units::typical, seed, 1) == 1.4);
  CHECK(unit_sensitivity(scene, Units::low, seed, 1) == Approx(0.565).epsilon(0.01));
  CHECK(unit_sensitivity(scene_of(1, {}), Units::drawn, seed, 0) == 1.0);  // a make that doesn't say
}

TEST_CASE("sensors of a room share its installation, and differ by their units", "[units]") {
  constexpr std::size_t n_rooms = 20000;
  const SceneSpec scene = scene_of(2, papirs);
  std::vector<double> logs, apart;
  for (std::uint64_t room = 0; room < n_rooms; ++room) {
    const double one = unit_sensitivity(scene, Units::drawn, room, 0),
                 other = unit_sensitivity(scene, Units::drawn, room, 1);
    logs.push_back(std::log(one / papirs.median));
    apart.push_back(std::log(one / other));
  }
  const auto spread = [](std::vector<double> values) {
    std::ranges::sort(values);
    const auto quantile = [&](double p) {
      return values[static_cast<std::size_t>(p * static_cast<double>(values.size()))];
    };
    return std::pair{quantile(0.5), 0.5 * (quantile(0.8413) - quantile(0.1587))};
  };
  const auto [middle, sd] = spread(logs);
  const auto [no_shift, units_sd] = spread(apart);
  constexpr double standard_error = 1.2533 * 0.707 / 141.4;  // of a median: 0.006
  CHECK(std::abs(middle) < 4.0 * standard_error);
  CHECK(std::abs(middle - 0.5 * 0.5) > 4.0 * standard_error);  // must fail: the mean
  CHECK(sd == Approx(std::hypot(0.7, 0.1)).epsilon(0.03));
  CHECK(std::abs(no_shift) < 0.005);
  CHECK(units_sd == Approx(0.1 * std::sqrt(2.0)).epsilon(0.03));
  std::ranges::sort(logs);
  CHECK(std::exp(logs[n_rooms / 10]) * papirs.median ==
        Approx(unit_sensitivity(scene, Units::low, seed, 0)).epsilon(0.03));
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
  CHECK(gains(Units::typical) == std::vector{1.4, 2.0 * 1.4, 1.4});
  const std::vector<double> drawn = gains(Units::drawn);
  CHECK(drawn == gains(Units::drawn));
  CHECK(drawn[0] != drawn[2]);
  CHECK(drawn[1] == 2.0 * unit_sensitivity(scene, Units::drawn, seed, 1));
  scene.sensors.pop_back();
  CHECK(gains(Units::drawn) == std::vector{drawn[0], drawn[1]});
  script.seed = seed + 1;
  CHECK(gains(Units::drawn)[0] != drawn[0]);
}
