// Walk tests whose answer is known: one ray straight down from the ceiling.
#include "surveys/walk_test.hpp"

#include "pirsim/geometry.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

/// An empty floor of 12 x 12 m round the origin; a sensor 2.6 m above (0, 0) with one needle of a zone straight down.
SceneSpec needle_over_the_middle() {
  SceneSpec scene;
  scene.name = "needle";
  scene.floor = FloorArea({{{-6, -6}, {6, -6}, {6, 6}, {-6, 6}}}, 0.0);
  SensorModelSpec model;
  model.id = "needle";
  ZoneSpec zone;
  zone.corners = {Vec2(-1e-4, -1e-4), Vec2(1e-4, -1e-4), Vec2(1e-4, 1e-4), Vec2(-1e-4, 1e-4)};
  model.clusters = {{Vec2(0.0), 5.0, 1, {zone}}};
  scene.sensor_models["needle"] = model;
  scene.sensors = {{"PIR", "needle", Frame{glm::angleAxis(radians(-90.0), Vec3(1, 0, 0)), {0.0, 2.6, 0.0}}}};
  return scene;
}

WalkTestSpec four_walks(double within_s) {
  WalkTestSpec spec;
  spec.sensing.response = Response::zones;
  spec.sensing.rays_per_zone = RaysPerZone::one;
  spec.path_m = 2.0;
  spec.major = {within_s, 0.5, 4};
  spec.minor = {6.0, 0.5, 4};
  return spec;
}

Tries major_at(const WalkTest& test, const Vec2& point) { return WalkTester(test).try_point(point, 0).major; }

}  // namespace

TEST_CASE("of four walks through a point beside the needle, those along the line to it are noticed", "[walk]") {
  const WalkTest test(needle_over_the_middle(), four_walks(6.0));
  // 0.8 m beside: walks of 1 m either side along x pass under the needle, walks along z pass 0.8 m clear of it.
  CHECK(major_at(test, {0.8, 0.0}).made == 4);
  CHECK(major_at(test, {0.8, 0.0}).noticed == 2);
  CHECK(major_at(test, {0.0, -0.8}).noticed == 2);
  CHECK(major_at(test, {0.0, 0.0}).noticed == 4);
  CHECK(major_at(test, {0.8, 0.8}).noticed == 0);
  CHECK(major_at(test, {2.0, 0.0}).noticed == 0);  // half a path and more than a reach away
}

TEST_CASE("a stated time cuts off the walk that reaches the needle too late", "[walk]") {
  // The needle is 0.2 m and 1.8 m into the two walks along x; in 1.2 s at 1 m/s, 1.2 m less the start are walked.
  const WalkTest test(needle_over_the_middle(), four_walks(1.2));
  CHECK(major_at(test, {0.8, 0.0}).noticed == 1);
}

TEST_CASE("walks that would leave the floor or go through things aren't tried", "[walk]") {
  const WalkTest test(needle_over_the_middle(), four_walks(2.0));
  CHECK(major_at(test, {5.5, 0.0}).made == 2);  // along the edge only
  CHECK(major_at(test, {5.95, 5.95}).made == 0);
}

TEST_CASE("a sitter's arms are noticed under the needle only, and still arms never", "[walk]") {
  WalkTestSpec spec = four_walks(2.0);
  const auto noticed = [&](const Vec2& point) {
    const WalkTest test(needle_over_the_middle(), spec);
    return WalkTester(test).try_point(point, 0).minor;
  };
  // A forearm's hand moves 0.1 m to and fro about half a metre ahead: near the sitter some direction sweeps it
  // through the needle, far away none does.
  int most = 0;
  for (double distance = 0.3; distance < 0.8; distance += 0.02) most = std::max(most, noticed({distance, 0.2}).noticed);
  CHECK(most > 0);
  CHECK(noticed({1.5, 0.0}).made == 4);
  CHECK(noticed({1.5, 0.0}).noticed == 0);
  spec.arm_amplitude_m = 0.0;
  for (double distance = 0.3; distance < 0.8; distance += 0.02) CHECK(noticed({distance, 0.2}).noticed == 0);
}

TEST_CASE("a sitter right under the needle covers it for good: seen in every try, noticed in none", "[walk]") {
  WalkTestSpec spec = four_walks(2.0);
  spec.sensing.response = Response::zones;
  SceneSpec scene = needle_over_the_middle();
  scene.seats = {{"under", Frame{{1, 0, 0, 0}, {0.0, 0.5, 0.0}}}, {"beside", Frame{{1, 0, 0, 0}, {1.5, 0.5, 0.0}}}};
  spec.spacing_m = 6.0;
  const WalkTest test(scene, spec);
  const Tries under = WalkTester(test).try_point({0.0, 0.0}, 0).minor,
              beside = WalkTester(test).try_point({1.5, 0.0}, 0).minor;
  CHECK(under.made == 4);
  CHECK(under.noticed == 0);
  CHECK(under.deaf == 4);
  CHECK(beside.noticed == 0);
  CHECK(beside.deaf == 0);
  const WalkTestResult result = run_walk_test(test, 1);
  CHECK(result.seats[0].deaf);
  CHECK_FALSE(result.seats[1].deaf);
  CHECK(to_text(test, result).find("noticed: none; seen, but not noticed: under; unseen: beside") != std::string::npos);
  CHECK(to_csv(test, result).find("minor,minor_deaf\n") != std::string::npos);
  // An analog sensor sees by its zones, too, though it doesn't answer by them. Still arms send it no signal.
  spec.sensing.response = Response::analog;
  spec.arm_amplitude_m = 0.0;
  const WalkTest still(scene, spec);
  CHECK(WalkTester(still).try_point({0.0, 0.0}, 0).minor.deaf == 4);
  CHECK(WalkTester(still).try_point({1.5, 0.0}, 0).minor.deaf == 0);
}

TEST_CASE("who sits at a seat faces as the seat does: the same from all sides of the needle, nothing facing away",
          "[walk]") {
  SceneSpec scene = needle_over_the_middle();
  constexpr int n_sides = 4, n_distances = 25;
  for (const double facing : {0.0, pi}) {  // towards the needle, then away from it
    for (int i = 0; i < n_distances; ++i) {
      for (int side = 0; side < n_sides; ++side) {
        const double heading = 0.5 * pi * side;
        const Vec3 at = rotation_from_heading(heading) * Vec3(0.2, 0.5, 0.3 + 0.02 * i);
        scene.seats.push_back(
            {"S" + std::to_string(scene.seats.size()), Frame{rotation_from_heading(heading + facing), at}});
      }
    }
  }
  WalkTestSpec spec = four_walks(2.0);
  spec.spacing_m = 6.0;
  const WalkTest test(scene, spec);
  const WalkTestResult result = run_walk_test(test, 1);
  int noticed = 0, away = 0;
  for (int i = 0; i < 2 * n_distances; ++i) {
    const auto of_side = [&](int side) { return result.seats[static_cast<std::size_t>(n_sides * i + side)].noticed; };
    for (int side = 1; side < n_sides; ++side) CHECK(of_side(side) == of_side(0));
    (i < n_distances ? noticed : away) += of_side(0) ? 1 : 0;
  }
  CHECK(noticed > 0);
  CHECK(away == 0);
}

TEST_CASE("a walk test gives the same result for any number of threads, and says so point by point", "[walk]") {
  WalkTestSpec spec = four_walks(2.0);
  spec.spacing_m = 0.8;
  spec.minor.directions = 1;
  const WalkTest test(needle_over_the_middle(), spec);
  const WalkTestResult one = run_walk_test(test, 1), four = run_walk_test(test, 4);
  CHECK(to_csv(test, one) == to_csv(test, four));
  CHECK(to_csv(test, one).find("0.0000,0.0000,4,4,pass") != std::string::npos);
  CHECK(to_csv(test, one).find("4.0000,4.0000,4,0,fail") != std::string::npos);
}
