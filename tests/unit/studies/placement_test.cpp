#include "studies/placement.hpp"

#include <glm/geometric.hpp>

#include "pirsim/geometry.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

/// Two floors of 1 x 1 m, round x = 1.5 and x = 7.5, under a line on which sensors with one needle of a zone, looking
/// straight down, can hang.
SceneSpec two_islands() {
  SceneSpec scene;
  scene.name = "islands";
  scene.floor =
      FloorArea({{{1, -0.5}, {2, -0.5}, {2, 0.5}, {1, 0.5}}, {{7, -0.5}, {8, -0.5}, {8, 0.5}, {7, 0.5}}}, 0.0);
  SensorModelSpec model;
  model.id = "needle";
  ZoneSpec zone;
  zone.corners = {Vec2(-1e-4, -1e-4), Vec2(1e-4, -1e-4), Vec2(1e-4, 1e-4), Vec2(-1e-4, 1e-4)};
  model.clusters = {{Vec2(0.0), 5.0, 1, {zone}}};
  scene.sensor_models["needle"] = model;
  scene.seats = {{"left", Frame{{1, 0, 0, 0}, {1.6, 0.5, 0.0}}}, {"right", Frame{{1, 0, 0, 0}, {7.4, 0.5, 0.0}}}};
  return scene;
}

CoverageSpec fine() {
  CoverageSpec spec;
  spec.sensing.response = Response::zones;
  spec.sensing.rays_per_zone = RaysPerZone::one;
  spec.spacing_m = 0.05;
  spec.duration_s = 4.0;
  return spec;
}

PlacementSearchSpec along_the_islands(int n_sensors, int evaluations) {
  return {n_sensors, "needle", {{{0, 2.6, 0}, {10, 2.6, 0}, 0.0, 90.0}}, evaluations};
}

double area_with(const std::vector<double>& shares) {
  return score(two_islands(), fine(), sensors_along(along_the_islands(2, 1), shares, "")).seen_area_m2;
}

}  // namespace

TEST_CASE("the search finds what is best by construction: one sensor over each island", "[placement]") {
  double best = 0.0;  // of one sensor, tried every centimetre
  for (int i = 100; i < 200; ++i) best = std::max(best, area_with({i / 1000.0, 0.5}));
  REQUIRE(best > 0.05);
  REQUIRE(area_with({0.15, 0.155}) < 1.5 * best);  // both over one island are worse

  const PlacementSearch search = search_placement(two_islands(), fine(), along_the_islands(2, 200));
  CHECK(search.found.seen_area_m2 > 0.95 * 2.0 * best);
  CHECK(search.even.seen_area_m2 < best * 1.01);  // 2.5 and 7.5: one of them over an island
  CHECK(search.evaluations <= 200);
  std::vector<double> xs;
  for (const SensorSpec& sensor : search.found.set.sensors) xs.push_back(sensor.world_from_sensor.origin.x);
  std::ranges::sort(xs);
  CHECK(std::abs(xs[0] - 1.5) < 0.5);
  CHECK(std::abs(xs[1] - 7.5) < 0.5);
}

TEST_CASE("a search without time to look is even spacing, and gains nothing", "[placement]") {
  const PlacementSearch search = search_placement(two_islands(), fine(), along_the_islands(2, 1));
  CHECK(search.found.seen_area_m2 == search.even.seen_area_m2);
  CHECK(search.found.set.sensors[0].world_from_sensor.origin.x == Approx(2.5));
  CHECK(search.found.set.sensors[1].world_from_sensor.origin.x == Approx(7.5));
}

TEST_CASE("sets are ranked by what they see, overlap and blind seats are told", "[placement]") {
  const auto set = [](const std::string& id, double x1, double x2) {
    return SensorSetSpec{
        id, {{"A", "needle", mounted({x1, 2.6, 0}, 0, 90)}, {"B", "needle", mounted({x2, 2.6, 0}, 0, 90)}}};
  };
  std::vector<PlacementScore> scores;
  for (const SensorSetSpec& s : {set("none", 4, 5), set("twice the same", 1.5, 1.5), set("one each", 1.5, 7.5)}) {
    scores.push_back(score(two_islands(), fine(), s));
  }
  const auto best_first = ranked(scores);
  CHECK(best_first[0].set.id == "one each");
  CHECK(best_first[2].set.id == "none");
  CHECK(best_first[0].overlap == 0.0);
  CHECK(best_first[1].overlap == 1.0);
  CHECK(best_first[0].seen_area_m2 == Approx(2.0 * best_first[1].seen_area_m2));
  CHECK(best_first[0].blind_seats.empty());
  CHECK(best_first[1].blind_seats == std::vector<std::string>{"right"});
  CHECK(best_first[2].blind_fraction == 1.0);
}

TEST_CASE("a needle into a sitter's middle sees them and is deaf to their work, which is told of each set",
          "[placement]") {
  SceneSpec scene = two_islands();
  PlacementSpec spec;
  spec.coverage = fine();
  spec.coverage.spacing_m = 0.5;
  spec.coverage.sensing.response = Response::zones;
  const auto over = [](double x) { return SensorSpec{"A", "needle", mounted({x, 2.6, 0}, 0, 90)}; };
  spec.sets = {{"left", {over(1.6)}}, {"nobody", {over(4.5)}}};
  const PlacementReport report = run_placements(scene, spec);
  for (const PlacementScore& score : report.ranked) {
    INFO(score.set.id);
    CHECK(score.at_work.noticed.empty());
    CHECK(score.at_work.deaf ==
          (score.set.id == "left" ? std::vector<std::string>{"left"} : std::vector<std::string>{}));
    CHECK(score.at_work.unseen.size() == (score.set.id == "left" ? 1 : 2));
  }
  CHECK(report.text.find("noticed  deaf  unseen") != std::string::npos);
  CHECK(report.text.find("; left)") != std::string::npos);
}

TEST_CASE("a mounted sensor looks along its yaw, tilted down", "[placement]") {
  const Frame frame = mounted({1, 2, 3}, 90.0, 30.0);
  CHECK(glm::distance(frame.forward(), Vec3(-std::cos(radians(30.0)), -0.5, 0.0)) < 1e-12);
  CHECK(frame.right().y == Approx(0.0).margin(1e-12));
}
