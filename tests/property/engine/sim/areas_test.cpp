// People counted by area: the counts sum to all people, and say where each of them is.
#include <algorithm>
#include <map>
#include <random>

#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

/// Crossing numbers along -x, unlike FloorArea::contains().
bool is_inside(const std::vector<Vec2>& loop, const Vec2& p) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
    if ((a.y <= p.y) == (b.y <= p.y)) continue;
    if (a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) < p.x) inside = !inside;
  }
  return inside;
}

/// Of each row, by the positions that the occupants' table has.
void check_rows(const SceneSpec& scene, const RunResult& result, const std::vector<std::string>& names) {
  std::map<double, std::vector<int>> by_place;
  for (const OccupantRow& row : result.occupants) {
    if (row.where == OccupantRow::Where::outside) {
      CHECK(row.area.empty());
      continue;
    }
    std::size_t area = 0;
    while (area < scene.areas.size() && !is_inside(scene.areas[area].outline.loops().front(), row.place_m)) ++area;
    REQUIRE(area < names.size());
    REQUIRE(row.area == names[area]);
    auto& counts = by_place[row.time_s];
    counts.resize(names.size());
    ++counts[area];
  }
  for (const Sample& row : result.samples) {
    int sum = 0;
    for (const int n : row.people_of_areas) sum += n;
    REQUIRE(sum == row.people);
    const auto known = by_place.find(row.time_s);
    REQUIRE(row.people_of_areas == (known == by_place.end() ? std::vector<int>(names.size(), 0) : known->second));
  }
}

}  // namespace

TEST_CASE("the people of areas sum to all people and are those whose places lie in them", "[areas]") {
  const SceneSpec scene = shipped_scene("two_rooms.gltf");
  const Model model = compile(scene, shipped_script("two_rooms.yaml", {"sensing.response=zones"}));
  CHECK(model.areas() == std::vector<std::string>{"living_room", "bedroom"});
  std::map<std::string, int> seen;
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    const RunResult result = run_once(model, run, Record::samples, Trace::none, Occupants::told);
    REQUIRE_FALSE(result.fault);
    check_rows(scene, result, model.areas());
    for (const OccupantRow& row : result.occupants) ++seen[row.area];
  }
  CHECK(seen["living_room"] > 50);
  CHECK(seen["bedroom"] > 50);
  CHECK(seen[""] > 0);  // in the doorway
}

TEST_CASE("people on the rest of the floor are counted elsewhere", "[areas]") {
  SceneSpec scene = shipped_scene("two_rooms.gltf");
  scene.areas[1].outline = FloorArea({{{5.5, 0.0}, {8.0, 0.0}, {8.0, -4.0}, {5.5, -4.0}}}, 0.0);
  const Model model = compile(scene, shipped_script("two_rooms.yaml", {"sensing.response=zones"}));
  REQUIRE(model.areas() == std::vector<std::string>{"living_room", "bedroom", "elsewhere"});
  const RunResult result = run_once(model, 0, Record::samples, Trace::none, Occupants::told);
  check_rows(scene, result, model.areas());
  CHECK(std::ranges::any_of(result.occupants, [](const OccupantRow& row) { return row.area == "elsewhere"; }));
}

TEST_CASE("a room drawn mirrored has its areas mirrored", "[areas]") {
  const SceneSpec scene = shipped_scene("two_rooms.gltf");
  const auto counts = [&](std::vector<std::string> overrides) {
    overrides.emplace_back("sensing.response=zones");
    const Model model = compile(scene, shipped_script("two_rooms.yaml", overrides));
    std::vector<std::vector<int>> rows;
    for (const Sample& row : run_once(model, 0).samples) rows.push_back(row.people_of_areas);
    return rows;
  };
  CHECK(counts({"effects=[{mirrored_room: {mirrored: 1}}]"}) == counts({}));
}

TEST_CASE("areas change nothing but the columns of their own", "[areas]") {
  SceneSpec scene = shipped_scene("two_rooms.gltf");
  const Model with = compile(scene, shipped_script("two_rooms.yaml"));
  scene.areas.clear();
  const Model without = compile(scene, shipped_script("two_rooms.yaml"));
  std::vector<std::string> columns = with.columns();
  CHECK(columns[5] == "people_living_room");
  CHECK(columns[6] == "people_bedroom");
  columns.erase(columns.begin() + 5, columns.begin() + 7);
  CHECK(columns == without.columns());
  RunResult a = run_once(with, 1), b = run_once(without, 1);
  for (Sample& row : a.samples) row.people_of_areas.clear();
  CHECK(a.samples == b.samples);
}

namespace {

/// What the first sensor sees of a meeting on foot of two in the living room, while others meet at these places.
std::vector<std::uint8_t> seen_of_meeting(const std::vector<std::string>& others) {
  std::string people;
  std::vector<std::string> places{"[1.2, -3.2]", "[1.2, -2.4]"};
  places.insert(places.end(), others.begin(), others.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    people += "  - {id: p" + std::to_string(i) + ", style: natural, actions: [{appear: {at_xz_m: " + places[i] +
              ", heading_deg: 180}}, {wait: {duration_s: 600, activity: meeting}}]}\n";
  }
  const std::string script = "pirsim_script: 1\nseed: 5\nduration_s: 600\nsensing: {response: zones}\npeople:\n";
  const RunResult result =
      run_once(compile(shipped_scene("two_rooms.gltf"), io::parse_script(script + people, "meeting.yaml")), 0);
  std::vector<std::uint8_t> bits;
  for (const Sample& row : result.samples) bits.push_back(row.bits[0]);
  return bits;
}

}  // namespace

TEST_CASE("who meets in one area talks among themselves, whoever meets in another", "[areas]") {
  const auto alone = seen_of_meeting({});
  CHECK(std::ranges::count(alone, 1) > 20);
  CHECK(seen_of_meeting({"[6.0, -0.8]", "[7.0, -0.8]"}) == alone);
  CHECK(seen_of_meeting({"[3.0, -0.8]", "[3.6, -0.8]"}) != alone);  // in the same room
}
