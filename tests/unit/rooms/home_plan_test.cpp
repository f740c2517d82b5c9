// A flat that somebody has, from its file to a day of its residents.
#include <algorithm>
#include <array>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <map>
#include <set>

#include "files/write/gltf_writer.hpp"
#include "pirsim/flat.hpp"
#include "pirsim/look.hpp"
#include "pirsim/study.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"
#include "surveys/sight.hpp"

using namespace pirsim;
using namespace pirsim::dataset;

namespace {

constexpr const char* two_rooms = R"(pirsim_plan: 1
rooms:
  - {id: living, kind: living_room, x_m: [0, 4], y_m: [0, 4], furniture: [{kind: sofa, wall: left, y_m: 2}]}
  - {id: bath, kind: bath, x_m: [4, 6.5], y_m: [1, 4], furniture: [{kind: toilet, wall: right, y_m: 3}], sensors: [{corner: top_left}]}
doors:
  - {into: living, wall: bottom, x_m: 2}
  - {from: living, into: bath, y_m: 2}
)";

std::string two_rooms_with(const std::string& what, const std::string& instead) {
  std::string text = two_rooms;
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), instead);
}

HomePlanSpec plan_in(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "plan.yaml") << text;
  return read_home_plan(folder.path() / "plan.yaml");
}

DrawnFlat home_of(const HomePlanSpec& plan, int number = 1) {
  return draw_flat(plan, 1, number, test::shipped_sensors());
}

std::string plan_fault(const std::string& text) {
  try {
    static_cast<void>(home_of(plan_in(text)));
  } catch (const Error& error) {
    std::string told;
    for (const Issue& issue : error.issues()) told += to_string(issue) + '\n';
    return told.substr(told.find("plan.yaml"));
  }
  return "";
}

DrawnFlat shipped_home(int number = 1) { return home_of(read_home_plan(test::data("plans/my_flat.yaml")), number); }

const AreaSpec& area_named(const SceneSpec& scene, const std::string& id) {
  return *std::ranges::find(scene.areas, id, &AreaSpec::id);
}

}  // namespace

TEST_CASE("what a plan can't have is told with its place", "[home_plan]") {
  CHECK(plan_fault(two_rooms).empty());
  using Case = std::array<const char*, 3>;
  for (const auto& [what, instead, told] : std::initializer_list<Case>{
           {"kind: bath", "kind: bth", "plan.yaml:4:22: error: room: kind"},
           {"wall: left, y_m: 2", "wal: left, y_m: 2", "did you mean 'wall'?"},
           {"into: bath", "into: bth", "plan.yaml:7:5: error: into: no room 'bth' (did you mean 'bath'?)"},
           {"x_m: [4, 6.5]", "x_m: [3.9, 6.5]", "plan.yaml:4:5: error: 'bath' overlaps 'living'"},
           {"x_m: [4, 6.5]", "x_m: [4.1, 6.5]", "'bath' ends 10 cm from 'living'"},
           {"x_m: [4, 6.5]", "x_m: [4.5, 6.5]", "no wall is between 'living' and 'bath'"},
           {"x_m: [0, 4]", "x_m: [4, 0]", "the second number is less than the first"},
           {"y_m: 2}\n", "y_m: 0.5}\n", "a door of 0.90 m doesn't fit there"},
           {"y_m: 2}\n", "x_m: 4}\n", "x_m: the wall between 'living' and 'bath' runs along y"},
           {"y_m: 2}\n", "y_m: 2}\n  - {into: bath, wall: bottom, x_m: 4.6}\n", "leaf is in the way of door 'bath' ("},
           {"  - {from: living, into: bath, y_m: 2}\n", "", "no door leads to 'bath'"},
           {"wall: left, y_m: 2", "wall: left, y_m: 0.5", "plan.yaml:3:75: error: sofa isn't inside of its room"},
           {"wall: left, y_m: 2", "wall: bottom, x_m: 2", "sofa is in the way of door 'front'"},
           {"y_m: 3}", "y_m: 3}, {kind: shower, wall: right, y_m: 3.2}", "shower is where a toilet is"},
           {"y_m: 3}", "y_m: 3}, {kind: bed, wall: right}",
            "error: there was no place for a bed in 'bath'; leaving out"},
           {"wall: left, y_m: 2", "x_m: 2", "x_m: to which `wall` is its back?"},
           {"corner: top_left", "corner: top_left, model: EKMC1604112", "EKMC1604111"},
           {"corner: top_left", "height_m: 2", "height_m: it looks down from the ceiling"}}) {
    INFO(what << " -> " << instead);
    CHECK_THAT(plan_fault(two_rooms_with(what, instead)), contains(told));
  }
}

namespace {

/// One thing a line, so that a remedy is one line's change.
std::vector<std::string> lines_of_plan(const std::string& washbasin, const std::string& door) {
  return {"pirsim_plan: 1",
          "rooms:",
          "  - {id: hall, kind: corridor, x_m: [0, 2], y_m: [-2, 0]}",
          "  - id: bath",
          "    kind: bath",
          "    x_m: [0, 2]",
          "    y_m: [0, 2.5]",
          "    furniture:",
          "      - {kind: washbasin, wall: right, " + washbasin + "}",
          "      - {kind: toilet, wall: left, y_m: 2}",
          "doors:",
          "  - {into: hall, wall: bottom}",
          "  - {from: hall, into: bath, " + door + "}"};
}

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

/// What the message says helps, done by hand: "`key: value` ... (line 9) helps", "leaving out the place of ... (line
/// 9)".
std::vector<std::string> as_advised(std::vector<std::string> lines, const std::string& message) {
  const auto number = [&] { return std::stoul(message.substr(message.rfind("(line ") + 6)); };
  const auto drop = [](std::string& line, const std::string& key) {
    const std::size_t at = line.find(", " + key + ": ");
    if (at == std::string::npos) return;
    const std::size_t end = line.find_first_of(",}", line.find(": ", at) + 2);
    line.erase(at, end - at);
  };
  const std::string advice = message.substr(message.rfind("; ") + 2);
  if (advice.starts_with("a door `")) {
    lines.push_back("  - " + advice.substr(8, advice.rfind('`') - 8));
  } else if (advice.starts_with("`")) {
    const std::string pair = advice.substr(1, advice.find('`', 1) - 1);
    std::string& line = lines.at(number() - 1);
    drop(line, pair.substr(0, pair.find(':')));
    if (advice.find("without a place") != std::string::npos) drop(line, "x_m"), drop(line, "y_m");
    line.insert(line.rfind('}'), ", " + pair);
  } else if (advice.starts_with("leaving out the place of")) {
    drop(lines.at(number() - 1), "x_m"), drop(lines.at(number() - 1), "y_m");
  } else if (advice.starts_with("leaving out `")) {
    drop(lines.at(number() - 1), advice.substr(13, advice.find('`', 13) - 13));
  } else {
    REQUIRE(advice.starts_with("leaving out the "));
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(number() - 1));
  }
  return lines;
}

}  // namespace

TEST_CASE("a plan's fault has its place, what is in the way, and a remedy that works", "[home_plan][seconds]") {
  using Case = std::array<std::string, 4>;
  for (const auto& [washbasin, door, place, told] :
       std::initializer_list<Case>{{"y_m: 1.4", "x_m: 0.6, hinge: left", "", ""},
                                   {"y_m: 0.95", "x_m: 0.6, hinge: right", "9:9", "the open leaf of door 'bath' is 0."},
                                   {"y_m: 0.9", "x_m: 1.5", "9:9", "washbasin is in the way of door 'bath'"},
                                   {"y_m: 2.4", "x_m: 0.6", "9:9", "washbasin isn't inside of its room"},
                                   {"y_m: 1.5}\n      - {kind: shelf, wall: right, y_m: 1.4", "x_m: 0.6", "10:9",
                                    "shelf is where a washbasin is"},
                                   {"y_m: 1.4", "x_m: 1.9", "13:5", "doesn't fit there"},
                                   {"y_m: 1.4", "y_m: 0.6", "13:5", "runs along x"},
                                   {"y_m: 1.4}\n      - {kind: bed, wall: top", "x_m: 0.6", "10:9",
                                    "there was no place for a bed in 'bath'"}}) {
    const std::vector<std::string> lines = lines_of_plan(washbasin, door);
    INFO(text_of(lines));
    const std::string fault = plan_fault(text_of(lines));
    if (told.empty()) {
      CHECK(fault.empty());
      continue;
    }
    CHECK_THAT(fault, contains("plan.yaml:" + place + ": error: ") && contains(told) && contains(" helps"));
    if (washbasin.find("kind") != std::string::npos) continue;  // a line more
    CHECK(plan_fault(text_of(as_advised(lines, fault.substr(0, fault.find('\n'))))).empty());
  }
  CHECK_THAT(plan_fault(text_of(lines_of_plan("y_m: 0.95", "x_m: 0.6, hinge: right"))),
             contains("; `hinge: left` at door 'bath' (line 13) helps"));
  std::vector<std::string> shut_off = lines_of_plan("y_m: 1.4", "x_m: 0.6");
  shut_off.pop_back();
  const std::string fault = plan_fault(text_of(shut_off));
  CHECK_THAT(fault, contains("plan.yaml:4:5: error: no door leads to 'bath'; a door `{from: hall, into: bath}` helps"));
  CHECK(plan_fault(text_of(as_advised(shut_off, fault.substr(0, fault.find('\n'))))).empty());
}

TEST_CASE("rooms of every kind can be drawn with what is usual, with nothing and with one thing, and be walked through",
          "[home_plan][seconds]") {
  int n_drawn = 0, n_refused = 0;
  for (const char* kind : {"living_room", "kitchen", "bedroom", "study", "bath", "corridor"}) {
    for (const std::string furniture :
         {"", ", furniture: []", ", furniture: [{kind: table}]", ", furniture: [{kind: bed, wall: top}]",
          ", furniture: [{kind: toilet, wall: top}]", ", furniture: [{kind: shelf, wall: top}]"}) {
      for (const bool has_other : {false, true}) {
        if (has_other && furniture.find("{") != std::string::npos) continue;
        const std::string other = "  - {id: other, kind: corridor, x_m: [4, 6], y_m: [0, 4], furniture: []}\n";
        const std::string text = std::string("pirsim_plan: 1\nrooms:\n  - {id: r, kind: ") + kind +
                                 ", x_m: [0, 4], y_m: [0, 4]" + furniture + "}\n" + (has_other ? other : "") +
                                 "doors:\n  - {into: r, wall: left}\n" +
                                 (has_other ? "  - {from: r, into: other, width_m: 0.8}\n" : "");
        INFO(text);
        const SceneSpec scene = home_of(plan_in(text)).scene;
        if (furniture == ", furniture: []") CHECK((scene.seats.empty() && scene.places.empty()));
        for (const int n_people : {0, 2}) {
          ScriptSpec walks = test::script_of({});
          for (int i = 0; i < n_people; ++i)
            walks.trials.front().people.push_back(test::person(
                i == 0 ? "ann" : "ben", {test::act(action::Enter{"entrance"}), test::act(action::Wait{5.0}),
                                         test::act(action::Leave{"entrance"})}));
          walks.trials.front().duration_s = 20.0;
          const RunResult result = run_once(compile(scene, walks), 0);
          CHECK_FALSE(result.fault);
        }
        for (const char* residents : {"[]", "[{id: ann}]"}) {
          try {
            static_cast<void>(compile(
                scene,
                test::shipped_script("flat_week.yaml", {"sensing.response=zones",
                                                        std::string("schedule.household.residents=") + residents})));
            ++n_drawn;
          } catch (const Error& error) {
            CHECK(std::string(error.what()).size() > 20);
            CHECK(error.code() != ErrorCode::internal);
            ++n_refused;
          }
        }
      }
    }
  }
  CHECK(n_drawn > 5);  // where there is a bed
  CHECK(n_refused > 10);
}

TEST_CASE("what a plan's beds, seats and places are called doesn't depend on the order of its rooms", "[home_plan]") {
  const auto names_in = [](const HomePlanSpec& plan) {
    const SceneSpec scene = home_of(plan).scene;
    std::map<std::string, std::string> found;  // name, and the area where it is
    const auto add = [&](const std::string& id, const Frame& frame) {
      for (const AreaSpec& area : scene.areas)
        if (area.outline.contains(floor_point(frame.origin))) found[id] = area.id;
    };
    for (const SeatSpec& seat : scene.seats) add(seat.id, seat.world_from_seat);
    for (const PlaceSpec& place : scene.places) add(place.id, place.world_from_place);
    return found;
  };
  HomePlanSpec plan = read_home_plan(test::data("plans/my_flat.yaml"));
  const auto names = names_in(plan);
  CHECK(names.at("bed_bedroom_left") == "bedroom");
  CHECK(names.at("bed_child") == "child");
  CHECK(names.at("toilet") == "toilet");
  CHECK(names.at("sofa_1") == "living_room");
  std::ranges::reverse(plan.rooms);
  CHECK(names_in(plan) == names);
}

TEST_CASE("a plan that nobody can walk through is refused, and names what isn't reached", "[home_plan]") {
  const auto shelf = [](const std::string& size) {
    return two_rooms_with("y_m: 3}", "y_m: 3}, {kind: shelf, wall: bottom, y_m: 2.44, " + size + '}');
  };
  CHECK_THAT(plan_fault(shelf("x_m: 5.27, width_m: 2.4")), contains("toilet"));  // from wall to wall
  CHECK(plan_fault(shelf("x_m: 4.67, width_m: 1.2")).empty());
  CHECK(plan_fault(two_rooms_with("y_m: 2}\n", "y_m: 2}\n  - {into: bath, wall: bottom, x_m: 5.5}\n")).empty());
}

TEST_CASE("things are where the page has them", "[home_plan]") {
  const SceneSpec scene = home_of(plan_in(two_rooms)).scene;
  CHECK(scene.floor.area_m2() == Approx(16.0 + 7.5));
  CHECK(scene.floor.contains({5.0, -2.0}));
  CHECK_FALSE(scene.floor.contains({5.0, -0.5}));  // where the flat isn't a rectangle
  CHECK(area_named(scene, "bath").outline.area_m2() == Approx(7.5));
  REQUIRE(scene.doors.size() == 2);
  CHECK(scene.doors[0].id == "front");
  CHECK(glm::distance(floor_point(scene.doors[1].world_from_door.origin), Vec2(4.0, -2.0)) < 1e-9);
  const Vec3 through = scene.doors[1].world_from_door * Vec3(0, 0, -1);
  CHECK(through.x == Approx(5.0));
  const SeatSpec& toilet = *std::ranges::find(scene.seats, "toilet", &SeatSpec::id);
  CHECK(toilet.world_from_seat.origin.x == Approx(6.5 - 0.48));
  CHECK(toilet.world_from_seat.origin.z == Approx(-3.0));
  CHECK(toilet.world_from_seat.forward().x == Approx(-1.0));
  const SensorSpec& sensor = *std::ranges::find(scene.sensors, "PIR_bath", &SensorSpec::id);
  CHECK(glm::distance(floor_point(sensor.world_from_sensor.origin), Vec2(4.1, -3.95)) < 1e-9);
  CHECK(sensor.world_from_sensor.forward().x > 0.0);
  CHECK(sensor.world_from_sensor.forward().z > 0.0);
}

TEST_CASE("rooms of one area have no wall between them, others have", "[home_plan]") {
  // A ray through the middle of the wall, beside the door.
  const auto walls_at = [](const SceneSpec& scene, const Vec2& p) {
    return std::ranges::count_if(scene.meshes, [&](const TriMesh& mesh) {
      Vec3 low(1e9), high(-1e9);
      for (const auto& at : mesh.positions) low = glm::min(low, Vec3(at)), high = glm::max(high, Vec3(at));
      return low.x < p.x && p.x < high.x && low.z < p.y && p.y < high.z && low.y < 1.0 && high.y > 1.0;
    });
  };
  CHECK(walls_at(home_of(plan_in(two_rooms)).scene, {4.0, -3.5}) == 1);
  std::string joined = two_rooms_with("id: bath", "id: bath, area: living");
  joined.resize(joined.find("  - {from"));
  const SceneSpec scene = home_of(plan_in(joined)).scene;
  CHECK(walls_at(scene, {4.0, -3.5}) == 0);
  REQUIRE(scene.areas.size() == 1);
  CHECK(scene.areas[0].outline.area_m2() == Approx(23.5));
}

TEST_CASE(
    "the shipped plan is seven rooms, the same each time, and another one by number where it leaves something open",
    "[home_plan]") {
  const DrawnFlat flat = shipped_home();
  CHECK(flat.scene.areas.size() == 7);
  CHECK(flat.scene.floor.area_m2() == Approx(63.0));
  CHECK(flat.residents == 3);
  CHECK(io::scene_text(flat.scene, {}) == io::scene_text(shipped_home().scene, {}));
  CHECK(io::scene_text(flat.scene, {}) != io::scene_text(shipped_home(2).scene, {}));
  CHECK(flat.scene.sensors.size() == 7);
}

TEST_CASE("residents of the shipped plan live a day in all of its rooms, whatever the threads",
          "[home_plan][seconds]") {
  ScriptSpec script =
      test::shipped_script("flat_week.yaml", {"replicates=1", "sensing.tick_rate_hz=5", "sensing.response=zones"});
  const SceneSpec scene = shipped_home().scene;
  const Model model = compile(scene, std::move(script));
  std::vector<RunResult> results;
  for (const unsigned threads : {1U, 2U})
    run_study(model, {.threads = threads}, [&](const RunResult& result) { results.push_back(result); });
  REQUIRE(results.size() == 2);
  CHECK_FALSE(results[0].fault);
  CHECK(results[0].samples.size() == 86'400);
  CHECK(std::ranges::equal(results[0].samples, results[1].samples, {}, &Sample::bits, &Sample::bits));
  std::set<std::string> visited;
  for (const Sample& sample : results[0].samples) {
    for (std::size_t i = 0; i < scene.areas.size(); ++i)
      if (sample.people_of_areas[i] > 0) visited.insert(scene.areas[i].id);
  }
  for (const char* room : {"living_room", "kitchen", "corridor", "toilet", "bedroom", "bath"})
    CHECK(visited.contains(room));
}

TEST_CASE("check counts beds and stoves as it does seats, and says which no sensor notices", "[home_plan][seconds]") {
  SceneSpec scene = shipped_home().scene;
  const auto noticed = [](const SceneSpec& of) {
    const CheckReport report =
        check_study(compile(of, test::shipped_script("flat_week.yaml", {"sensing.response=zones"})));
    CHECK(report.work.seats.size() == of.seats.size() + of.places.size());
    const SeatsAtWork seats = report.work.by_any();
    return std::set<std::string>(seats.noticed.begin(), seats.noticed.end());
  };
  const std::set<std::string> before = noticed(scene);
  CHECK(before.contains("stove"));
  std::erase_if(scene.sensors, [](const SensorSpec& sensor) { return sensor.area == "kitchen"; });
  CHECK_FALSE(noticed(scene).contains("stove"));
}

TEST_CASE("a sensor that hardly sees its own room is told, one that sees a tenth of it isn't", "[home_plan][seconds]") {
  const SceneSpec scene = shipped_home().scene;
  const CheckReport report =
      check_study(compile(scene, test::shipped_script("flat_week.yaml", {"sensing.response=zones"})));
  SightReport sight = report.sight;
  std::size_t of_areas = 0;
  for (SensorSight& sensor : sight.sensors) {
    CAPTURE(sensor.sensor);
    CHECK(sensor.area == sensor.sensor.substr(std::string("PIR_").size()));
    CHECK(sensor.area_seen > sensor.area_places / 10);
    CHECK(sensor.area_seen <= sensor.places);
    of_areas += sensor.area_places;
  }
  CHECK(of_areas == sight.places);  // each room has one sensor
  CHECK(studies::warnings(sight, scene).empty());
  sight.sensors.front().area_places = 40;
  sight.sensors.front().area_seen = 4;
  CHECK(studies::warnings(sight, scene).empty());
  sight.sensors.front().area_seen = 3;
  const std::vector<Issue> told = studies::warnings(sight, scene);
  REQUIRE(told.size() == 1);
  CHECK_THAT(told.front().message, contains("sees a standing person in 3 of 40 places of its area 'living_room'"));
}
