#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "model/schema/check_scene.hpp"
#include "pirsim/dataset.hpp"
#include "rooms/flat_layout.hpp"
#include "rooms/recipe.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::dataset;

namespace {

RecipeSpec read(const std::string& text) {
  const TemporaryFolder folder;
  return read_recipe(folder.write("r.yaml", text));
}

RecipeSpec homes(const std::string& keys) {
  return read("pirsim_recipe: 1\nrooms:\n  - {kind: home, count: 40, " + keys + "}\ndays: 2\n");
}

std::string home_faults(const std::string& keys) {
  try {
    static_cast<void>(homes(keys));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

HouseholdSpec household_of(const RecipeSpec& recipe, int room, int day = 1) {
  const SceneSpec scene = room_of(recipe, room, test::shipped_sensors());
  return *script_of(recipe, scene, room, day).trials.front().schedule->household;
}

/// Of comma-separated text, a line a row.
std::vector<std::vector<std::string>> cells_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    for (rows.emplace_back(); std::getline(fields, line, ',');) rows.back().push_back(line);
  }
  return rows;
}

/// How often a column becomes 1, from 0 on.
int rises(const std::vector<std::vector<std::string>>& rows, const std::string& name) {
  const auto found = std::ranges::find(rows.front(), name);
  REQUIRE(found != rows.front().end());
  const auto column = static_cast<std::size_t>(found - rows.front().begin());
  int n = 0;
  std::string before = "0";
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::string& now = rows[i].at(column);
    n += now == "1" && before == "0" ? 1 : 0;
    before = now;
  }
  return n;
}

int times(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("each home has a household of its own within the ranges, the same on all of its days", "[dataset][home]") {
  const RecipeSpec recipe = homes(
      "rooms: [1, 3], residents: [1, 3], household: {works: 0.5, age_years: [30, 50], visits_a_week: [1, 2], "
      "shift_min: [-60, 60], dinner: {mean: \"20:00\", sd_min: 15}}");
  std::set<std::size_t> residents;
  std::set<double> wakes;
  int workers = 0, all = 0;
  for (int room = 1; room <= 40; ++room) {
    const HouseholdSpec household = household_of(recipe, room);
    CHECK(household == household_of(recipe, room, 2));
    residents.insert(household.residents.size());
    wakes.insert(household.wakes.mean_h);
    CHECK((household.visits_a_week >= 1.0 && household.visits_a_week <= 2.0));
    const double shift_h = household.wakes.mean_h - HouseholdSpec{}.wakes.mean_h;
    CHECK(std::abs(shift_h) <= 1.0);
    CHECK(household.dinner.mean_h == Approx(20.0 + shift_h));  // all clocks together
    CHECK(household.dinner.sd_min == 15.0);
    for (const ResidentSpec& resident : household.residents) {
      CHECK((resident.age_years >= 30.0 && resident.age_years <= 50.0));
      workers += resident.occupation == Occupation::works ? 1 : 0;
      ++all;
    }
  }
  CHECK(residents == std::set<std::size_t>{1, 2, 3});
  CHECK(wakes.size() > 20);
  // Binomial: four standard errors of about sqrt(0.25 / all).
  CHECK(std::abs(workers - 0.5 * all) < 4.0 * std::sqrt(0.25 * all));
}

TEST_CASE("some of a recipe's residents work at home where it says so, and nobody else is another", "[dataset][home]") {
  const RecipeSpec plain = homes("residents: [1, 3], household: {works: 0.5}");
  const RecipeSpec some = homes("residents: [1, 3], household: {works: 0.5, works_at_home: 0.3}");
  int at_desks = 0, all = 0;
  for (int room = 1; room <= 40; ++room) {
    HouseholdSpec without = household_of(plain, room), with = household_of(some, room);
    for (std::size_t i = 0; i < with.residents.size(); ++i, ++all) {
      if (with.residents[i].occupation != Occupation::works_at_home) continue;
      CHECK(without.residents[i].occupation == Occupation::at_home);
      with.residents[i].occupation = Occupation::at_home;
      ++at_desks;
    }
    CHECK(with == without);
  }
  CHECK(std::abs(at_desks - 0.3 * all) < 4.0 * std::sqrt(0.3 * 0.7 * all));
  CHECK_THAT(home_faults("household: {works: 0.5, works_at_home: 0.6}"),
             contains("is more than 1 together with `works`"));
}

TEST_CASE("what one home is doesn't depend on how many there are", "[dataset][home]") {
  const RecipeSpec many = homes("residents: [1, 3]");
  RecipeSpec few = many;
  few.rooms.front().count = 5;
  CHECK(household_of(many, 4) == household_of(few, 4));
}

TEST_CASE("the CASAS log of a home says who does what, whether or not occupants are told", "[dataset][home][seconds]") {
  const TemporaryFolder folder;
  const RecipeSpec recipe = read_recipe(folder.write("r.yaml", R"(pirsim_recipe: 1
rooms:
  - {kind: home, rooms: 1, residents: 1}
days: 1
sensing: {tick_rate_hz: 5, response: zones}
exports: [casas]
rows: .csv
)"));
  DatasetOptions options;
  options.scenes = test::shipped_sensors();
  const auto out = folder.path() / "out";
  REQUIRE(make_room_days(recipe, out, options));
  REQUIRE(finish_dataset(recipe, out, options));
  const std::string log = content(out / "exports/casas/room_0001/day_01.txt");
  for (const char* activity : {"sleeping", "toilet", "washing", "eating"}) {
    CHECK_THAT(log, contains("resident_1_" + std::string(activity) + " begin"));
    CHECK_THAT(log, contains("resident_1_" + std::string(activity) + " end"));
  }
  CHECK_THAT(log, contains("door_bath OPEN"));
  CHECK_FALSE(std::filesystem::exists(out / "occupants"));
  // The rows have the same sensors and doors, and people by area. Lines with two labels stand twice.
  const auto rows = cells_of(content(out / "rows/room_0001/day_01.csv"));
  std::istringstream lines(log);
  std::string once;
  for (std::string line, before; std::getline(lines, line); before = line.substr(0, line.find(" resident_"))) {
    if (line.substr(0, line.find(" resident_")) != before) once += line + '\n';
  }
  for (const std::string area : {"living_room", "bath"}) {
    CHECK(rises(rows, "PIR_" + area) > 0);
    CHECK(rises(rows, "PIR_" + area) == times(once, " PIR_" + area + " ON"));
    CHECK(rises(rows, "people_" + area) > 0);
  }
  CHECK(rises(rows, "door_bath") == times(once, " door_bath OPEN"));
  CHECK_THAT(content(out / "sensors.csv"), contains("1,PIR_bath,EKMC1604111,zones,") && contains(",bath\n"));
  CHECK_THAT(content(out / "areas.csv"), contains("1,living_room,"));
  CHECK_THAT(content(out / "doors.csv"), contains("room,door,area,beyond,width_m\n") &&
                                             contains("1,bath,bath,living_room,") &&
                                             contains("1,front,living_room,outside,"));
  CHECK_THAT(content(out / "rooms.csv"), contains("1,train,home,rooms/room_0001.gltf"));
}

TEST_CASE("a dataset has columns for all that its homes have, and for nothing that none can have",
          "[dataset][home][seconds]") {
  // Each list has all kinds that so many homes of these ranges happen to show.
  const std::pair<const char*, int> ranges[]{{"rooms: [1, 4], residents: 1, sensors_at: [room, doorway]", 30},
                                             {"rooms: 1, layout: open", 8},
                                             {"rooms: 2, layout: hall, sensors_at: doorway, own_kitchen: 0", 8}};
  for (const auto& [keys, n_homes] : ranges) {
    INFO(keys);
    const RecipeSpec recipe = homes(keys);
    std::set<std::string> areas, doors, sensors;
    for (int room = 1; room <= n_homes; ++room) {
      const SceneSpec scene = room_of(recipe, room, test::shipped_sensors());
      const Areas marked(scene);
      areas.insert(marked.names().begin(), marked.names().end());
      for (const DoorSpec& door : scene.doors) doors.insert(door.id);
      for (const SensorSpec& sensor : scene.sensors) sensors.insert(sensor.id);
    }
    const ColumnOwners columns = columns_of(recipe.rooms.front().home->flats);
    CHECK(std::set(columns.areas.begin(), columns.areas.end()) == areas);
    CHECK(std::set(columns.doors.begin(), columns.doors.end()) == doors);
    CHECK(std::set(columns.sensors.begin(), columns.sensors.end()) == sensors);
  }
}

TEST_CASE("faults of homes in a recipe are told with their place and the nearest name", "[dataset][home]") {
  CHECK(home_faults("rooms: 2").empty());
  CHECK_THAT(home_faults("rooms: 9"), contains("r.yaml:3:36") && contains("rooms"));
  CHECK_THAT(home_faults("seats: 2"), contains("seats"));
  CHECK_THAT(home_faults("people: 2"), contains("`residents`"));
  CHECK_THAT(home_faults("schedule: {from: 8}"), contains("`household`"));
  CHECK_THAT(home_faults("first_day: 2026-02-30"), contains("r.yaml:3:") && contains("2026-02-30"));
  CHECK_THAT(home_faults("household: {work: 1}"), contains("works"));
  CHECK_THAT(home_faults("household: {works: 1.5}"), contains("works"));
  CHECK_THAT(home_faults("household: {age_years: [5, 20]}"), contains("age_years"));
  CHECK_THAT(home_faults("household: {shift_min: [-600, 0]}"), contains("shift_min"));
  CHECK_THAT(home_faults("household: {residents: [{id: ann}]}"), contains("residents"));
  CHECK_THAT(home_faults("household: {goes_to_bed: {mean: \"06:00\"}}"), contains("goes_to_bed"));
  CHECK_THAT(home_faults("household: []"), contains("household"));
}
