#include "surveys/placement.hpp"

#include <bit>
#include <filesystem>
#include <glm/geometric.hpp>
#include <set>
#include <tuple>

#include "pirsim/geometry.hpp"
#include "pirsim/io.hpp"
#include "pirsim/model.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

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

PlacementSpec by_area() {
  PlacementSpec spec;
  spec.coverage = fine();
  return spec;
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

  const PlacementSearch search = search_placement(two_islands(), by_area(), along_the_islands(2, 200));
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
  const PlacementSearch search = search_placement(two_islands(), by_area(), along_the_islands(2, 1));
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
  CHECK(report.text.find("noticed  surely  deaf  unseen") != std::string::npos);
  CHECK(report.text.find("left: a turning target there isn't seen: ") != std::string::npos);
  CHECK(report.text.find("at work: deaf: left, unseen: ") != std::string::npos);
}

namespace {

SceneSpec meeting_room() { return io::read_scene(test::data_dir() / "rooms/meeting_room.gltf"); }

/// Ten desks in a meeting room under ceiling sensors that hang lengthwise or over the sensors' wall.
PlacementSpec by_seats(int n_sensors, int places) {
  PlacementSpec spec;
  spec.by = PlacementAim::seats;
  spec.coverage.sensing.tick_rate_hz = 10;
  spec.coverage.sensing.ticks_per_window = 10;
  spec.coverage.spacing_m = 0.5;
  spec.coverage.duration_s = 2.0;
  spec.models["EKMC1601111"] = {};
  spec.search = {n_sensors,
                 "EKMC1601111",
                 {{{0.5, 2.6, -1.2}, {6.5, 2.6, -1.2}, 0.0, 90.0}, {{0.5, 2.6, -3.2}, {6.5, 2.6, -3.2}, 0.0, 90.0}},
                 places};
  return spec;
}

}  // namespace

TEST_CASE("by seats, no other subset of the tried places is better", "[placement][seconds]") {
  constexpr int n_places = 8, n_sensors = 2;
  PlacementSpec spec = by_seats(n_sensors, n_places);
  SceneSpec scene = meeting_room();
  const PlacementReport report = run_placements(scene, spec);
  scene.sensor_models = report.best.sensor_models;
  // Seats noticed, then those surely noticed, then area.
  using Good = std::tuple<std::size_t, std::size_t, double>;
  const auto good = [](const SeatsAtWork& seats, double area_m2) {
    return Good{seats.noticed.size(), seats.surely.size(), area_m2};
  };
  Good most;
  for (unsigned subset = 0; subset < 1U << n_places; ++subset) {
    if (std::popcount(subset) != n_sensors) continue;
    std::vector<double> shares;
    for (int i = 0; i < n_places; ++i) {
      if ((subset >> i & 1U) != 0) shares.push_back((i + 0.5) / n_places);
    }
    const SensorSetSpec set = sensors_along(*spec.search, shares, "");
    const Good tried = good(seats_at_work(scene, spec, set), score(scene, spec.coverage, set).seen_area_m2);
    most = std::max(most, tried);
  }
  const PlacementScore& found = report.search->found;
  CHECK(good(found.at_work, found.seen_area_m2) >= most);
  CHECK(std::get<0>(most) > 0);
  CHECK(report.ranked[0].at_work.noticed.size() >= report.search->even.at_work.noticed.size());
  CHECK(report.text.find("8 places tried: ") != std::string::npos);
}

TEST_CASE("what sensors notice together is what they notice one by one", "[placement][seconds]") {
  PlacementSpec spec = by_seats(3, 3);
  SceneSpec scene = meeting_room();
  scene.sensor_models = run_placements(scene, spec).best.sensor_models;
  const std::vector<double> shares{0.1, 0.4, 0.9};
  std::set<std::string> one_by_one;
  for (const double share : shares) {
    for (const auto& seat : seats_at_work(scene, spec, sensors_along(*spec.search, {share}, "")).noticed)
      one_by_one.insert(seat);
  }
  const SeatsAtWork together = seats_at_work(scene, spec, sensors_along(*spec.search, shares, ""));
  CHECK(std::set<std::string>(together.noticed.begin(), together.noticed.end()) == one_by_one);
  const Cover cover = cover_of(scene, spec, *spec.search, shares, 1, [] {});
  const std::uint64_t of_a_seat = cover.worth.front();
  CHECK(cover.worth_of({0, 1, 2}) / of_a_seat == one_by_one.size());
}

TEST_CASE("by seats a set counts as many as `check` tells of its sensors", "[placement][seconds]") {
  PlacementSpec spec = by_seats(3, 3);
  spec.search.reset();
  spec.sets = {{"as built", {}}};
  const PlacementReport report = run_placements(meeting_room(), spec);
  ScriptSpec script;
  script.sensing = spec.coverage.sensing;
  script.trials = {{}};  // nobody works at a desk, so `check` has the usual worker
  script.trials[0].id = "empty";
  script.trials[0].duration_s = 10.0;
  const WorkReport checked = check_study(compile(meeting_room(), script)).work;
  CHECK(report.ranked[0].at_work.noticed == checked.by_any().noticed);
  CHECK(report.ranked[0].at_work.deaf == checked.by_any().deaf);
  CHECK(checked.seats.size() == 10);
}

TEST_CASE("sets are ranked by noticed seats before area, and by area alone if so asked", "[placement]") {
  PlacementScore wide, useful;
  wide.set.id = "wide";
  wide.seen_area_m2 = 9.0;
  useful.set.id = "useful";
  useful.seen_area_m2 = 1.0;
  useful.at_work.noticed = {"S1"};
  CHECK(ranked({wide, useful}, PlacementAim::seats)[0].set.id == "useful");
  CHECK(ranked({useful, wide}, PlacementAim::area)[0].set.id == "wide");
  wide.at_work.noticed = {"S2"};
  useful.at_work.surely = {"S1"};
  CHECK(ranked({wide, useful}, PlacementAim::seats)[0].set.id == "useful");
  wide.at_work.surely = {"S2"};
  CHECK(ranked({useful, wide}, PlacementAim::seats)[0].set.id == "wide");
}

TEST_CASE("the scene with the best set, written and read back, has the same sensors and the same seats noticed",
          "[placement][seconds]") {
  PlacementSpec spec = by_seats(2, 6);
  const PlacementReport report = run_placements(meeting_room(), spec);
  const TemporaryFolder folder;
  io::write_scene(folder.path() / "better.gltf", report.best);
  const SceneSpec back =
      io::read_scene(folder.path() / "better.gltf", {.sensor_directories = {test::data_dir() / "sensors"}});
  const std::vector<SensorSpec>& sensors = report.ranked[0].set.sensors;
  REQUIRE(back.sensors.size() == sensors.size());
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    CHECK(back.sensors[i].id == sensors[i].id);
    CHECK(back.sensors[i].model == sensors[i].model);
    CHECK(glm::distance(back.sensors[i].world_from_sensor.origin, sensors[i].world_from_sensor.origin) < 1e-9);
    CHECK(glm::distance(back.sensors[i].world_from_sensor.forward(), sensors[i].world_from_sensor.forward()) < 1e-9);
  }
  CHECK(seats_at_work(back, spec, {}).noticed == report.ranked[0].at_work.noticed);
}

TEST_CASE("by seats, a scene without seats is refused where the study says so", "[placement]") {
  SceneSpec scene = meeting_room();
  scene.seats.clear();
  PlacementSpec spec = by_seats(2, 4);
  spec.by_where = {"study.yaml", 2, 5};
  try {
    static_cast<void>(run_placements(scene, spec));
    FAIL("not refused");
  } catch (const Error& error) {
    CHECK(std::string(error.what()).find("study.yaml:2:5: error: by: seats: ") != std::string::npos);
    CHECK(error.code() == ErrorCode::input);
  }
}

TEST_CASE("in each area hangs what sees most of it, of all corners, the ceiling and all models", "[placement]") {
  SceneSpec scene = two_islands();
  scene.seats.clear();
  SensorModelSpec wide = scene.sensor_models.at("needle");
  wide.id = "wide";
  for (const double x : {-0.15, 0.15}) {
    ZoneSpec zone = wide.clusters[0].zones[0];
    for (Vec2& corner : zone.corners) corner.x += x;
    wide.clusters[0].zones.push_back(zone);
  }
  scene.sensor_models["wide"] = wide;
  TriMesh ceiling;
  ceiling.positions = {{0, 2.6F, -1}, {9, 2.6F, -1}, {9, 2.6F, 1}, {0, 2.6F, 1}};
  ceiling.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(ceiling);
  PlacementSpec spec = by_area();
  spec.coverage.spacing_m = 0.25;
  CHECK_THROWS_WITH(best_in_each_area(scene, spec, {"wide"}), contains("it has no areas"));

  const std::vector<std::vector<Vec2>> islands = scene.floor.loops();
  for (std::size_t i = 0; i < 2; ++i) scene.areas.push_back({i == 0 ? "west" : "east", FloorArea({islands[i]}, 0.0)});
  const SensorSetSpec found = best_in_each_area(scene, spec, {"needle", "wide"});
  REQUIRE(found.sensors.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    SceneSpec alone = scene;  // nothing else is looked at
    alone.areas = {scene.areas[i]};
    alone.floor = scene.areas[i].outline;
    const auto seen_m2 = [&](const SensorSpec& sensor) {
      return score(alone, spec.coverage, {"one", {sensor}}).seen_area_m2;
    };
    const Vec2 middle(i == 0 ? 1.5 : 7.5, 0.0);
    std::vector<Frame> places{mounted({middle.x, 2.58, 0.0}, 0, 90)};
    for (const double x : {-0.4, 0.4})
      for (const double z : {-0.4, 0.4})
        places.push_back(mounted({middle.x + x, 2.2, z}, degrees(heading_of(Vec2(-x, -z))), 20));
    double best = 0.0, best_of_needles = 0.0;
    for (const Frame& place : places) {
      best = std::max(best, seen_m2({"A", "wide", place}));
      best_of_needles = std::max(best_of_needles, seen_m2({"A", "needle", place}));
    }
    REQUIRE(best_of_needles < best);
    CHECK(found.sensors[i].area == scene.areas[i].id);
    CHECK(found.sensors[i].model == "wide");
    CHECK(seen_m2(found.sensors[i]) == Approx(best));
  }
}

TEST_CASE("a mounted sensor looks along its yaw, tilted down", "[placement]") {
  const Frame frame = mounted({1, 2, 3}, 90.0, 30.0);
  CHECK(glm::distance(frame.forward(), Vec3(-std::cos(radians(30.0)), -0.5, 0.0)) < 1e-12);
  CHECK(frame.right().y == Approx(0.0).margin(1e-12));
}
