// Walk tests whose answer is known: one ray straight down from the ceiling.
#include "surveys/walk_test.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "model/schema/fields.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

/// An empty floor of 12 x 12 m round the origin; 2.6 m above it one needle of a zone straight down.
SceneSpec needle_at(const Vec2& place) {
  SceneSpec scene;
  scene.name = "needle";
  scene.floor = FloorArea({{{-6, -6}, {6, -6}, {6, 6}, {-6, 6}}}, 0.0);
  SensorModelSpec model;
  model.id = "needle";
  ZoneSpec zone;
  zone.corners = {Vec2(-1e-4, -1e-4), Vec2(1e-4, -1e-4), Vec2(1e-4, 1e-4), Vec2(-1e-4, 1e-4)};
  model.clusters = {{Vec2(0.0), 5.0, 1, {zone}}};
  scene.sensor_models["needle"] = model;
  scene.sensors = {{"PIR", "needle", Frame{glm::angleAxis(radians(-90.0), Vec3(1, 0, 0)), {place.x, 2.6, place.y}}}};
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

constexpr double length_m = 0.381, half_width_m = 0.0381, cell_m = 0.9144;

WalkTestSpec nema() {
  WalkTestSpec spec = io::read_walk_test(test::data_dir() / "studies/nema_wd7.yaml");
  spec.sensing.response = Response::zones;
  spec.sensing.rays_per_zone = RaysPerZone::one;
  return spec;
}

WalkTestSpec nema(ArmSwing plane) {
  WalkTestSpec spec = nema();
  spec.arm->swings = {plane};
  return spec;
}

Vec3 tip_of(const Frame& box) { return box.origin + box.rotation * Vec3(0.0, 0.0, -length_m / 2); }
Vec3 axis_of(const Frame& box) { return box.origin + box.rotation * Vec3(0.0, 0.0, length_m / 2); }

double degrees_between(const Vec3& a, const Vec3& b) {
  return degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

WalkTestSpec read(const std::string& text) {
  const TemporaryFolder folder;
  return io::read_walk_test(folder.write("w.yaml", "pirsim_walk_test: 1\n" + text));
}

}  // namespace

TEST_CASE("of four walks through a point beside the needle, those along the line to it are noticed", "[walk]") {
  const WalkTest test(needle_at(Vec2(0.0)), four_walks(6.0));
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
  const WalkTest test(needle_at(Vec2(0.0)), four_walks(1.2));
  CHECK(major_at(test, {0.8, 0.0}).noticed == 1);
}

TEST_CASE("walks that would leave the floor or go through things aren't tried", "[walk]") {
  const WalkTest test(needle_at(Vec2(0.0)), four_walks(2.0));
  CHECK(major_at(test, {5.5, 0.0}).made == 2);  // along the edge only
  CHECK(major_at(test, {5.95, 5.95}).made == 0);
}

TEST_CASE("a sitter's arms are noticed under the needle only, and still arms never", "[walk]") {
  WalkTestSpec spec = four_walks(2.0);
  const auto noticed = [&](const Vec2& point) {
    const WalkTest test(needle_at(Vec2(0.0)), spec);
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
  SceneSpec scene = needle_at(Vec2(0.0));
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
  SceneSpec scene = needle_at(Vec2(0.0));
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
  const WalkTest test(needle_at(Vec2(0.0)), spec);
  const WalkTestResult one = run_walk_test(test, 1), four = run_walk_test(test, 4);
  CHECK(to_csv(test, one) == to_csv(test, four));
  CHECK(to_csv(test, one).find("0.0000,0.0000,4,4,pass") != std::string::npos);
  CHECK(to_csv(test, one).find("4.0000,4.0000,4,0,fail") != std::string::npos);
}

TEST_CASE("the walker stands at one edge of the cell, goes to the other, and stands there for two seconds", "[walk]") {
  const WalkTest test(needle_at({3, 3}), nema());
  const auto& poses = test.crossing().poses;
  const auto pelvis = [&](std::size_t tick) { return poses[tick].front().origin; };
  CHECK(pelvis(0).z == Approx(cell_m / 2).margin(1e-9));
  CHECK(pelvis(poses.size() - 1).z == Approx(-cell_m / 2).margin(1e-6));
  double fastest_m_s = 0.0;
  std::size_t last_moving = 0;
  for (std::size_t tick = 1; tick < poses.size(); ++tick) {
    CHECK(std::abs(pelvis(tick).z) < cell_m / 2 + 1e-6);
    const double step_m = pelvis(tick - 1).z - pelvis(tick).z;
    fastest_m_s = std::max(fastest_m_s, step_m * 50.0);
    if (glm::distance(pelvis(tick), pelvis(tick - 1)) > 1e-12) last_moving = tick;
  }
  CHECK(poses.size() - 1 - last_moving >= 99);  // 2 s of 50 ticks
  CHECK(poses.size() - 1 - last_moving <= 101);
  CHECK(fastest_m_s < 1.25 * 1.2192);
  CHECK(fastest_m_s > 0.7);
}

TEST_CASE("the arm turns by 90 degrees in a second, there and back, 36 inches above the floor", "[walk]") {
  const WalkTest test(needle_at({3, 3}), nema());
  REQUIRE(test.minor_motions().size() == 2);
  const auto& level = test.minor_motions()[0].poses;
  const auto& upright = test.minor_motions()[1].poses;
  REQUIRE(level.size() == 201);
  for (const auto* poses : {&level, &upright}) {
    for (std::size_t tick = 1; tick < poses->size(); ++tick) {
      const Frame &before = (*poses)[tick - 1].front(), &now = (*poses)[tick].front();
      CHECK(glm::distance(axis_of(now), Vec3(0.0, 0.9144, 0.0)) < 1e-12);
      const double turned = degrees_between(tip_of(before) - axis_of(before), tip_of(now) - axis_of(now));
      CHECK(turned == Approx(tick <= 100 ? 90.0 / 50 : 0.0).margin(1e-5));
    }
  }
  const double side_m = length_m / std::sqrt(2.0);  // 45 degrees to either side of -Z
  CHECK(glm::distance(tip_of(level[0].front()), Vec3(side_m, 0.9144, -side_m)) < 1e-9);
  CHECK(glm::distance(tip_of(level[50].front()), Vec3(-side_m, 0.9144, -side_m)) < 1e-9);
  CHECK(glm::distance(tip_of(level[100].front()), tip_of(level[0].front())) < 1e-9);
  CHECK(glm::distance(tip_of(upright[0].front()), Vec3(0.0, 0.9144, -length_m)) < 1e-9);
  CHECK(glm::distance(tip_of(upright[50].front()), Vec3(0.0, 0.9144 + length_m, 0.0)) < 1e-9);
}

TEST_CASE("an arm that swings level is noticed by a needle in its sector, and by no other", "[walk]") {
  const WalkTest test(needle_at({0, 0}), nema(ArmSwing::horizontal));
  WalkTester tester(test);
  int inside = 0;
  for (double x = -0.6; x <= 0.6; x += 0.083) {
    for (double z = -0.6; z <= 0.6; z += 0.083) {
      const double r = std::hypot(x, z);
      int expected = 0;
      bool is_clear = std::abs(r - length_m) > 0.01;
      for (int i = 0; i < 4 && r > half_width_m + 0.01; ++i) {
        // The needle is at (-x, -z) as the arm sees it. Headings turn left: 0 is -Z, 90 degrees is -X.
        const double off_deg = std::abs(std::remainder(degrees(std::atan2(x, z)) - 90.0 * i, 360.0));
        const double widened_deg = degrees(std::asin(half_width_m / r));
        is_clear =
            is_clear && std::abs(off_deg - 45.0 - widened_deg) > 3.0 && std::abs(off_deg - 45.0 + widened_deg) > 1.0;
        expected += r < length_m && off_deg < 45.0 + widened_deg ? 1 : 0;
      }
      if (!is_clear || r <= half_width_m + 0.01) continue;
      INFO(x << ' ' << z);
      const Tries minor = tester.try_point({x, z}, 0).minor;
      CHECK(minor.made == 4);
      CHECK(minor.noticed == expected);
      inside += expected > 0 ? 1 : 0;
    }
  }
  CHECK(inside > 30);
}

TEST_CASE("an arm that swings up leaves a needle that met it while it lay, and no other notices it", "[walk]") {
  const WalkTest test(needle_at({0, 0}), nema(ArmSwing::vertical));
  WalkTester tester(test);
  // Ahead of the axis by more than half its width: the arm lies there, and is gone once it stands.
  CHECK(tester.try_point({0.0, 0.2}, 0).minor.noticed == 1);  // of four headings -Z alone points there
  CHECK(tester.try_point({0.2, 0.0}, 0).minor.noticed == 1);
  CHECK(tester.try_point({0.2, 0.2}, 0).minor.noticed == 0);   // between two headings
  CHECK(tester.try_point({0.0, 0.45}, 0).minor.noticed == 0);  // beyond its tip
  // Over the axis it stands where it lay: seen in all tries, noticed in none.
  const Tries over = tester.try_point({0.0, 0.001}, 0).minor;
  CHECK(over.made == 4);
  CHECK(over.noticed + over.deaf == 4);
  CHECK(over.deaf >= 1);
}

TEST_CASE("a walker is noticed in the cells whose middle lines a needle meets, and not in those beyond", "[walk]") {
  const WalkTest test(needle_at({0, 0}), nema());
  WalkTester tester(test);
  CHECK(tester.try_point({0.0, 0.0}, 0).major.noticed == 4);
  CHECK(tester.try_point({0.42, 0.0}, 0).major.noticed == 2);    // to and fro along x
  CHECK(tester.try_point({cell_m, 0.0}, 0).major.noticed == 0);  // half a cell beyond the edge
  CHECK(tester.try_point({cell_m, cell_m}, 0).major.noticed == 0);
}

TEST_CASE("sensors that see nothing cover no cell, and the outputs speak of an arm", "[walk]") {
  SceneSpec scene = needle_at({20, 20});
  scene.seats = {{"desk", Frame{{1, 0, 0, 0}, {1.0, 0.5, 1.0}}}};
  const WalkTest test(scene, nema());
  const WalkTestResult result = run_walk_test(test, 1);
  REQUIRE(result.points.size() == 196);  // 14 x 14 cells
  for (const PointResult& point : result.points) CHECK(point.major.noticed + point.minor.noticed == 0);
  const std::string text = to_text(test, result);
  INFO(text);
  CHECK(text.find("walker noticed before a stop of 2 s ends in at least 100 % of 4 directions: 0 of 192 points pass") !=
        std::string::npos);
  CHECK(text.find("swinging arm noticed within 4 s in at least 50 % of 4 directions, horizontally and vertically: "
                  "0 of 196 points pass") != std::string::npos);
  CHECK(text.find("sensors saw the arm in 0") != std::string::npos);
  CHECK(text.find("seats in squares that fail: desk") != std::string::npos);
  const io::Report page = walk_test_report(test, result);
  CHECK(page.sections[0].heading == "Major motion: walking");
  CHECK(page.sections[1].heading == "Minor motion: a swinging arm");
}

TEST_CASE("an arm is tried over a desk, and not inside a cupboard", "[walk]") {
  SceneSpec scene = needle_at({0, 0});
  const auto box = [](const std::string& name, double x, double top) {
    TriMesh mesh{name, {}};
    for (const double y : {0.0, top}) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const auto& [dx, dz] : {std::pair(-0.4, -0.4), {0.4, -0.4}, {0.4, 0.4}, {-0.4, 0.4}})
        mesh.positions.emplace_back(x + dx, y, dz);
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t next = (i + 1) % 4;
      mesh.triangles.push_back({i, next, i + 4});
      mesh.triangles.push_back({next, next + 4, i + 4});
    }
    return mesh;
  };
  scene.meshes = {box("desk", 2.0, 0.74), box("cupboard", -2.0, 1.8)};
  const WalkTest test(scene, nema());
  WalkTester tester(test);
  CHECK(tester.try_point({2.0, 0.0}, 0).minor.made == 8);
  CHECK(tester.try_point({2.0, 0.0}, 0).major.made == 0);
  CHECK(tester.try_point({-2.38, 0.0}, 0).minor.made == 0);
  CHECK(tester.try_point({-3.0, 0.0}, 0).minor.made == 8);
}

TEST_CASE("analog sensors notice a warm arm, and none as warm as the room", "[walk]") {
  SceneSpec scene = needle_at({0, 0});
  scene.sensor_models = {
      {"EKMC1601111", io::find_sensor_model("EKMC1601111", test::data_dir() / "rooms/meeting_room.gltf")}};
  scene.sensors[0].model = "EKMC1601111";
  WalkTestSpec spec = nema();
  spec.sensing.response = Response::analog;
  const auto noticed = [&](double temperature_c) {
    spec.arm->temperature_c = temperature_c;
    const WalkTest test(scene, spec);
    return WalkTester(test).try_point({0.6, 0.4}, 0).minor.noticed;
  };
  CHECK(noticed(33.5) >= 4);
  CHECK(noticed(spec.sensing.ambient_c) == 0);
}

TEST_CASE("faults of walks that stop and of arms are told", "[walk]") {
  const auto fault = [](const std::string& text) {
    try {
      static_cast<void>(read(text));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(fault("major_motion: {within_s: 2, stop_s: 2}\n"), contains("leave out within_s"));
  CHECK_THAT(fault("minor_motion: {seat_height_m: 0.5, arm: {}}\n"), contains("in whose place an arm swings"));
  CHECK_THAT(fault("minor_motion: {arm: {swings: [horizontl]}}\n"), contains("did you mean 'horizontal'?"));
  CHECK_THAT(fault("minor_motion: {arm: {swings: []}}\n"), contains("swings"));
  CHECK(read("major_motion: {stop_s: 2}\n").stop_s == 2.0);
  CHECK(read("major_motion: {within_s: 3}\n").stop_s == std::nullopt);
  CHECK(read("minor_motion: {arm: {}}\n").arm.has_value());
  CHECK_FALSE(read("name: plain\n").arm.has_value());
}
