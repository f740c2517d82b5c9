#include "pirsim/dataset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "files/disk/compression.hpp"
#include "model/core/random.hpp"
#include "rooms/recipe.hpp"
#include "rooms/room_day.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::dataset;
namespace fs = std::filesystem;

namespace {

/// Four rooms, three days of six minutes, ten in the meeting room.
const std::string short_recipe = R"(pirsim_recipe: 1
name: Short
seed: 5
rooms:
  - {count: 3, seats: [1, 3], width_m: [4, 5.5], depth_m: [3.5, 5], people: [1, 2]}
  - {count: 1, kind: meeting, seats: 4, sensors: [{mount: corner, count: 3}],
     schedule: {from: "09:00", to: "09:10", meetings: {fewest_a_day: 1, from: "09:00", to: "09:15",
                durations_min: [15], probabilities: [1], fewest_people: 3}}}
days: 3
sensing: {tick_rate_hz: 10, response: zones}
schedule: {from: "08:50", to: "08:56", arrival: {mean: "08:51", sd_min: 0.5}, staff: [{count: 1}, {role: manager, count: 1}]}
effects:
  - soft_zone_edges: {sigma_deg: [0.5, 1.0]}
  - {missed_triggers: {probability: [0.1, 0.2], sensor: each}, per: day}
split: {validation_rooms: 0.25, test_rooms: 0.25, test_days: 0.4}
pictures: 2
occupants: true
exports: [uci864, casas, energyplus]
)";

std::string unpacked(const fs::path& file) {
  io::DataReader reader(file);
  std::string text(1U << 16U, '\0'), all;
  while (const std::size_t n = reader.read(text.data(), text.size())) all.append(text, 0, n);
  return all;
}

std::vector<std::vector<std::string>> table(const std::string& text, char comma = ',') {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    auto& row = rows.emplace_back(1);
    for (const char c : line) {
      if (c == comma) {
        row.emplace_back();
      } else {
        row.back() += c;
      }
    }
  }
  return rows;
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files[entry.path().lexically_relative(folder).string()] = content(entry.path());
  }
  return files;
}

/// A dataset in a folder of its own.
struct Made {
  TemporaryFolder folder;
  RecipeSpec recipe;
  explicit Made(const std::string& text = short_recipe) : recipe(read_recipe(folder.write("recipe.yaml", text))) {}
  [[nodiscard]] fs::path out() const { return folder.path() / "out"; }
  [[nodiscard]] DatasetOptions options(unsigned threads = 1) const {
    DatasetOptions options;
    options.scenes = test::shipped_sensors();
    options.threads = threads;
    return options;
  }
  void make(const DatasetOptions& how) const { REQUIRE(make_room_days(recipe, out(), how)); }
  void finish() const {
    const bool is_whole = finish_dataset(recipe, out(), options());
    REQUIRE(is_whole);
  }
  [[nodiscard]] std::vector<std::uint32_t> missing() const {
    return missing_room_days(recipe, out(), test::shipped_sensors());
  }
  [[nodiscard]] fs::path day(const std::string& kind, int room, int day, const std::string& ending) const {
    return out() / day_path(kind, room, day, ending);
  }
};

std::string faults_of(const std::string& text) {
  const TemporaryFolder folder;
  try {
    static_cast<void>(read_recipe(folder.write("r.yaml", text)));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a recipe's keys: what its reader adds is none, an entry may stand alone, a group takes what all have",
          "[dataset]") {
  const std::string start = "pirsim_recipe: 1\n", rooms = "rooms: [{count: 1}]\n";
  for (const char* key : {"overrides", "data_directories", "originals", "given", "text", "file"})
    CHECK_THAT(faults_of(start + rooms + key + ": [a]\n"), contains("unknown key '" + std::string(key) + "'"));
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) { return read_recipe(folder.write("one.yaml", start + text)); };
  const RecipeSpec one =
      read("rooms: [{desks: rows, sensors: [{mount: corner, model: AMN31111}]}]\nexports: casas\npictures: 0\n");
  CHECK(one.rooms[0].rooms.orders == std::vector{DeskOrder::rows});
  CHECK(one.rooms[0].rooms.sensors[0].models == std::vector<std::string>{"AMN31111"});
  CHECK(one.exports == std::vector{Export::casas});
  CHECK(one.pictures == 0);
  const RecipeSpec shared = read("people: [1, 3]\nrooms: [{count: 2}, {people: 2}]\n");
  CHECK(shared.rooms[0].people == CountRange{1, 3});
  CHECK(shared.rooms[1].people == CountRange{2, 2});
  const RecipeSpec none = read(rooms + "exports: []\n");
  CHECK_FALSE(none.rooms[0].people);
  CHECK(none.exports.empty());
  CHECK(none.pictures == 6);
  CHECK_THAT(faults_of(start + "rooms: [{desks: []}]\n"), contains("isn't empty"));
  CHECK_THAT(faults_of(start + rooms + "exports: [casas, casas]\n"), contains("named twice"));
  CHECK_THAT(faults_of(start + rooms + "people: [3, 1]\n"), contains("less than the first"));
  CHECK_THAT(faults_of(start + rooms + "people: [1, 2, 3]\n"), contains("[least, most]"));
}

TEST_CASE("threads, shards and resuming change no byte of a dataset", "[dataset][seconds]") {
  const Made one, other;
  one.make(one.options());
  one.finish();
  CHECK(std::distance(fs::directory_iterator(one.out() / "pictures"), {}) == 2);
  auto second = other.options(2), first = other.options(1);
  second.shard = Shard{2, 2};
  first.shard = Shard{1, 2};
  other.make(second);
  CHECK(other.missing().size() == 6);
  CHECK_THROWS_WITH(other.finish(), contains("6 of 12 room-days"));
  other.make(first);
  // Torn: a line that broke off, and rows that were lost of two days.
  const fs::path journal = other.out() / "shard-0001-of-0002.journal";
  fs::resize_file(journal, fs::file_size(journal) - 100);  // of room 2, day 3
  fs::remove(other.day("rows", 1, 2, ".csv.gz"));
  fs::remove(other.day("rows", 3, 3, ".csv.gz"));
  CHECK(other.missing() == std::vector<std::uint32_t>{1, 5, 8});
  auto again = other.options(2);
  again.start = DatasetOptions::Start::resume;
  std::uint32_t made = 0;
  again.observer.begin = [&](DatasetObserver::Stage stage, std::uint32_t total) {
    if (stage == DatasetObserver::Stage::making_days) made = total;
  };
  other.make(again);
  CHECK(made == 3);
  other.finish();
  const auto a = files_of(one.out()), b = files_of(other.out());
  CHECK(a.size() > 50);
  CHECK(a == b);
}

TEST_CASE("no room and no day is in two parts, whatever the numbers", "[dataset]") {
  for (const int rooms : {3, 4, 7, 20}) {
    for (const int days : {2, 5, 7, 12}) {
      for (const std::uint64_t seed : {1, 2, 3}) {
        RecipeSpec recipe;
        recipe.seed = seed;
        recipe.days = days;
        recipe.rooms.push_back({.count = rooms, .rooms = {}, .scenes = {}, .schedule = {}, .people = {}, .where = {}});
        const std::vector<Part> parts = parts_of(recipe);
        std::set<int> trained, validated, tested;
        std::set<int> days_trained, days_tested;
        for (int room = 1; room <= rooms; ++room) {
          for (int day = 1; day <= days; ++day) {
            const Part part = parts[static_cast<std::size_t>((room - 1) * days + day - 1)];
            if (part == Part::train || part == Part::test_days) trained.insert(room);
            if (part == Part::validation) validated.insert(room);
            if (part == Part::test_rooms) tested.insert(room);
            if (part == Part::train) days_trained.insert(day);
            if (part == Part::test_days) days_tested.insert(day);
          }
        }
        CHECK(trained.size() + validated.size() + tested.size() == static_cast<std::size_t>(rooms));
        CHECK((!trained.empty() && !validated.empty() && !tested.empty()));
        // The days to test on are later than all that is trained on, and one of them is a working day.
        CHECK(*days_trained.rbegin() < *days_tested.begin());
        CHECK(*days_tested.begin() % 7 <= 5);
      }
    }
  }
}

TEST_CASE("the description tells each file with its hash, its columns and its part", "[dataset][seconds]") {
  const Made made;
  made.make(made.options(2));
  made.finish();
  const auto package = nlohmann::json::parse(content(made.out() / "datapackage.json"));
  const std::vector<Part> parts = parts_of(made.recipe);
  std::set<std::string> told;
  std::size_t n_rows = 0;
  for (const auto& resource : package.at("resources")) {
    std::vector<std::string> columns;
    for (const auto& field : resource.at("schema").at("fields")) {
      columns.push_back(field.at("name"));
      CHECK(field.at("description").get<std::string>().size() > 4);
    }
    const bool is_part = resource.contains("files");
    const auto paths = is_part ? resource.at("path") : nlohmann::json::array({resource.at("path")});
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const std::string path = paths[i];
      INFO(path);
      CHECK(told.insert(path).second);
      const auto& whole = is_part ? resource.at("files").at(i) : resource;
      CHECK(whole.at("hash") == "sha256:" + sha256(content(made.out() / path)));
      CHECK(whole.at("bytes") == fs::file_size(made.out() / path));
      const auto rows = table(unpacked(made.out() / path));
      CHECK(rows.front() == columns);
      for (const auto& row : rows) REQUIRE(row.size() == columns.size());
      if (!path.starts_with("rows/")) continue;
      n_rows += rows.size() - 1;
      for (std::size_t k = 1; k < rows.size(); ++k) {
        const int room = std::stoi(rows[k][0]), day = std::stoi(rows[k][1]);
        const Part part = parts[static_cast<std::size_t>((room - 1) * made.recipe.days + day - 1)];
        REQUIRE(resource.at("name") == name_of(part));
        REQUIRE((rows[k][4] == "0") == (rows[k][5] == "0"));
      }
    }
  }
  CHECK(n_rows == 9 * 360 + 3 * 600);
  for (const auto& [file, bytes] : files_of(made.out())) {
    if (file.ends_with(".csv.gz")) CHECK(told.contains(file));
  }
  const std::string readme = content(made.out() / "README.md");
  CHECK_THAT(readme, contains("1.4 hours") && contains("4 rooms") && contains("`test_rooms`"));
}

TEST_CASE("people are those who arrived and haven't left", "[dataset]") {
  const Made made;
  made.make(made.options(2));
  int arrivals = 0;
  for (int room = 1; room <= 4; ++room) {
    const auto rows = table(unpacked(made.day("rows", room, 1, ".csv.gz")));
    int there = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      arrivals += std::stoi(rows[i][6]);
      there += std::stoi(rows[i][6]) - std::stoi(rows[i][7]);
      REQUIRE(there == std::stoi(rows[i][4]));
    }
    // The drawn room has fewer sensors than the columns have room for: two of three.
    CHECK(rows[0].back() == "PIR3");
    CHECK(rows[1].back() == (room == 4 ? "0" : ""));
  }
  CHECK(arrivals > 2);
}

TEST_CASE("the exports say what the rows say", "[dataset][seconds]") {
  const Made made;
  made.make(made.options(2));
  made.finish();
  const auto rows = table(unpacked(made.day("rows", 4, 1, ".csv.gz")));
  constexpr std::size_t people = 4, first_sensor = 8, n_sensors = 3, n_rows = 600;
  REQUIRE(rows.size() == n_rows + 1);

  SECTION("UCI 864: a reading every 30 s") {
    const auto wide = table(content(made.day("exports/uci864", 4, 1, ".csv")));
    CHECK(wide[0] ==
          std::vector<std::string>{"Date", "Time", "PIR1_PIR", "PIR2_PIR", "PIR3_PIR", "Room_Occupancy_Count"});
    REQUIRE(wide.size() == 1 + n_rows / 30);
    for (std::size_t i = 1; i < wide.size(); ++i) {
      CHECK(wide[i][0] == "2026/03/02");
      CHECK(wide[i][1] == rows[30 * i][2].substr(11));
      CHECK(wide[i].back() == rows[30 * i][people]);
      for (std::size_t s = 0; s < n_sensors; ++s) {
        bool any = false;
        for (std::size_t k = 30 * (i - 1) + 1; k <= 30 * i; ++k) any = any || rows[k][first_sensor + s] == "1";
        CHECK(wide[i][2 + s] == (any ? "1" : "0"));
      }
    }
  }
  SECTION("CASAS: an event a change") {
    std::vector<std::array<bool, n_sensors>> bits(n_rows + 1);
    std::map<std::string, std::size_t> row_at;
    for (std::size_t i = 1; i <= n_rows; ++i) row_at[rows[i][2]] = i;
    int open = 0;
    for (const auto& event : table(content(made.day("exports/casas", 4, 1, ".txt")), ' ')) {
      REQUIRE((event.size() == 4 || event.size() == 6));  // without a label and with one
      if (event.size() == 6) open += event[5] == "begin" ? 1 : -1;
      const std::size_t sensor = static_cast<std::size_t>(event[2].back() - '1');
      for (std::size_t i = row_at.at(event[0] + "T" + event[1]); i <= n_rows; ++i) bits[i][sensor] = event[3] == "ON";
    }
    std::size_t differing = 0, on = 0;
    for (std::size_t i = 1; i < n_rows; ++i) {  // the last row is closed by an OFF
      for (std::size_t s = 0; s < n_sensors; ++s) {
        differing += bits[i][s] != (rows[i][first_sensor + s] == "1") ? 1 : 0;
        on += bits[i][s] ? 1 : 0;
      }
    }
    CHECK(open == 0);
    CHECK(differing == 0);
    CHECK(on > 0);
  }
  SECTION("EnergyPlus: a year of hours") {
    const auto year = table(content(made.out() / "exports/energyplus/presence.csv"));
    REQUIRE(year.size() == 8761);
    CHECK(year[0][6] == "room_0004_presence");
    double present = 0.0, all = 0.0;
    for (std::size_t i = 1; i <= n_rows; ++i) {
      present += rows[i][people] != "0" ? 1.0 : 0.0;
      all += std::stod(rows[i][people]);
    }
    // Monday, 2 March 2026, is day 60 from 0; its tenth hour is the one that was simulated in part.
    const auto& hour = year[1 + 60 * 24 + 9];
    CHECK(std::stod(hour[6]) == Approx(present / n_rows).margin(0.0006));
    CHECK(std::stod(hour[7]) == Approx(all / n_rows).margin(0.0006));
    const auto& sunday = year[1 + 66 * 24 + 9];
    CHECK(sunday[6] == "0");
  }
}

TEST_CASE("a row that ends on the hour counts for the hour before", "[dataset]") {
  const Made made(
      "pirsim_recipe: 1\nrooms: [{count: 1, seats: 2, people: 2}]\ndays: 1\nsensing: {tick_rate_hz: 10, response: "
      "zones}\nschedule: {from: \"08:56\", to: \"09:00\", arrival: {mean: \"08:57\", sd_min: 0.1}, staff: [{count: "
      "2}]}\n");
  const Room room(1, room_of(made.recipe, 1, test::shipped_sensors()), {});
  ColumnOwners columns;
  for (const SensorSpec& sensor : room.scene().sensors) columns.sensors.push_back(sensor.id);
  const RoomDay day = simulate(made.recipe, room, 1, columns);
  REQUIRE(day.record.rows == 240);
  double present = 0.0, people = 0.0;
  for (const auto& [n, rows] : day.record.rows_by_people) {
    present += n > 0 ? static_cast<double>(rows.all) : 0.0;
    people += n * static_cast<double>(rows.all);
  }
  CHECK(present > 60.0);
  CHECK(day.record.presence[8] == Approx(present / 240.0));
  CHECK(day.record.people[8] == Approx(people / 240.0));
  CHECK(day.record.presence[9] == 0.0);
}

TEST_CASE("a year of an EnergyPlus schedule takes days of a weekday by turns", "[dataset]") {
  RoomProfile room{"r", {}};
  for (int k = 1; k <= 2; ++k) {
    DayProfile day;
    day.people[8] = k;
    day.presence[8] = 1.0;
    room.weekdays[0].push_back(day);  // two Mondays
  }
  const auto year = table(to_energyplus(std::vector{room}, 2026));
  REQUIRE(year.size() == 8761);
  double sum = 0.0;
  int weekend = 0;
  for (std::size_t i = 1; i < year.size(); ++i) {
    const std::size_t date = (i - 1) / 24, hour = (i - 1) % 24;
    const std::size_t weekday = (date + 3) % 7;  // 1 January 2026 is a Thursday
    if (hour != 8) continue;
    sum += std::stod(year[i][1]);
    if (weekday >= 5) weekend += year[i][1] == "0" ? 1 : 100;
  }
  CHECK(weekend == 104);
  CHECK(sum / 261.0 == Approx(1.5).margin(0.02));  // of 261 working days
  // 2028 has a 29 February, and the schedule still 8760 hours.
  CHECK(table(to_energyplus(std::vector{room}, 2028)).size() == 8761);
}

TEST_CASE("effects are drawn within their ranges, a room's for all of its days", "[dataset]") {
  const Made made;
  std::set<double> sigmas, probabilities;
  for (int room = 1; room <= 4; ++room) {
    const SceneSpec scene = room_of(made.recipe, room, test::shipped_sensors());
    for (int day = 1; day <= 3; ++day) {
      const ScriptSpec script = script_of(made.recipe, scene, room, day);
      REQUIRE(script.effects.size() == 1 + scene.sensors.size());
      const double sigma = script.effects[0].parameters.at("sigma_deg");
      CHECK((sigma >= 0.5 && sigma <= 1.0));
      sigmas.insert(sigma);
      for (std::size_t i = 1; i < script.effects.size(); ++i) {
        CHECK(script.effects[i].choices.at("sensor") == scene.sensors[i - 1].id);
        const double p = script.effects[i].parameters.at("probability");
        CHECK((p >= 0.1 && p <= 0.2));
        probabilities.insert(p);
      }
      const auto& staff = script.trials.front().schedule->staff;
      CHECK(staff.size() <= std::min<std::size_t>(2, scene.seats.size()));
    }
  }
  CHECK(sigmas.size() == 4);
  CHECK(probabilities.size() == 3 * (3 * 2 + 3));
}

TEST_CASE("a chance is the share of rooms that an effect is in, and no other draw depends on it", "[dataset]") {
  RecipeSpec recipe;
  recipe.rooms.push_back({.count = 400, .rooms = {}, .scenes = {}, .schedule = {}, .people = {}, .where = {}});
  SceneSpec scene;
  scene.sensors = {{"PIR1", "m", {}}};
  VariedEffectSpec rare{"missed_triggers", VariedEffectSpec::Per::room, 0.3, {}, {}, {}};
  VariedEffectSpec always{"range_scale", VariedEffectSpec::Per::room, 1.0, {{"scale", {0.9, 1.1}}}, {}, {}};
  recipe.effects = {rare, always};
  RecipeSpec without = recipe;
  without.effects[0].chance = 0.0;
  int there = 0;
  for (int room = 1; room <= 400; ++room) {
    const auto some = script_of(recipe, scene, room, 1).effects, none = script_of(without, scene, room, 1).effects;
    REQUIRE(none.size() == 1);
    there += some.size() == 2 ? 1 : 0;
    CHECK(some.back().parameters == none.back().parameters);
  }
  // Binomial: standard error sqrt(0.3 x 0.7 / 400) = 0.023; four of them.
  CHECK(std::abs(there / 400.0 - 0.3) < 0.092);
}

TEST_CASE("a recipe that is changed as it is read is another one, and says how it was changed", "[dataset]") {
  const TemporaryFolder folder;
  const auto file = folder.write("recipe.yaml", "pirsim_recipe: 1\nrooms: [{}]\n");
  const std::vector<std::string> changes{"sensing.response=zones"};
  const RecipeSpec plain = read_recipe(file), changed = read_recipe(file, changes);
  CHECK(changed.sensing.response == Response::zones);
  CHECK(plain.sensing.response == std::nullopt);
  CHECK(changed.text == plain.text + "\n# --set sensing.response=zones\n");
}

TEST_CASE("a folder of another recipe is refused, and damage is told", "[dataset]") {
  Made made;
  made.make(made.options(2));
  RecipeSpec other = made.recipe;
  other.text += "# another\n";
  CHECK_THROWS_WITH(make_room_days(other, made.out(), made.options()), contains("another dataset"));
  const fs::path rows = made.day("rows", 2, 2, ".csv.gz");
  std::string bytes = content(rows);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  std::ofstream(rows, std::ios::binary) << bytes;
  CHECK_THROWS_WITH(made.finish(), contains("day_02.csv.gz") && contains("isn't what was written"));
}

TEST_CASE("the user's own scenes are rooms like others", "[dataset][seconds]") {
  const std::string own = (test::data_dir() / "rooms" / "meeting_room.gltf").string();
  const Made made("pirsim_recipe: 1\nrooms: [{scenes: [" + own + "], people: 2}, {count: 1}]\ndays: 1\n" +
                  "sensing: {tick_rate_hz: 10}\n" +
                  "schedule: {from: '09:00', to: '09:02', arrival: {mean: '09:00', sd_min: 1}, staff: [{count: 2}]}\n" +
                  "effects: [dual_polarity, missed_triggers]\n");
  std::vector<Issue> told;
  DatasetOptions options = made.options(2);
  options.tell = [&](const Issue& issue) { told.push_back(issue); };
  made.make(options);
  REQUIRE(told.size() == 1);  // the sensors are analog
  CHECK_THAT(to_string(told.front()), contains("recipe.yaml:6:") && contains("dual_polarity does nothing here"));
  made.finish();
  CHECK_THAT(content(made.out() / "sensors.csv"), contains("1,PIR1,EKMC1604111,analog,"));
  const auto rows = table(unpacked(made.day("rows", 1, 1, ".csv.gz")));
  CHECK(rows.size() == 121);
  CHECK(rows[0].back() == "PIR5");
  CHECK(content(made.out() / "rooms.csv").find("meeting_room.gltf") != std::string::npos);
  CHECK_FALSE(fs::exists(made.out() / "rooms/room_0001.gltf"));
  CHECK_THAT(content(made.out() / "README.md"), contains("own scenes aren't part") && contains("rooms/room_0002.gltf"));
}

TEST_CASE("faults of a recipe are told with their place and the nearest name", "[dataset]") {
  CHECK_THAT(faults_of("pirsim_recipe: 1\nroms: []\n"), contains("r.yaml:2:1") && contains("rooms"));
  CHECK_THAT(faults_of("pirsim_recipe: 2\nrooms: [{}]\n"), contains("r.yaml:1:16") && contains("version"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms:\n  - {cuont: 3}\n"), contains("r.yaml:3:6") && contains("count"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{}]\neffects:\n  - soft_zone_edge\n"),
             contains("r.yaml:4:5") && contains("soft_zone_edges"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{}]\neffects:\n  - soft_zone_edges: {sigm_deg: 1}\n"),
             contains("r.yaml:4:5") && contains("sigma_deg"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{}]\neffects:\n  - soft_zone_edges: {sigma_deg: [1, 1e9]}\n"),
             contains("r.yaml:4:5"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{}]\neffects:\n  - missed_triggers: {probability: [0.2, 0.1]}\n"),
             contains("r.yaml:4:36") && contains("less than the first"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{}]\nexports: [casa]\n"),
             contains("r.yaml:3:11") && contains("casas"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{}]\nexports: [casas, uci864, casas]\n"),
             contains("r.yaml:3:26") && contains("twice"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms:\n  - scenes: [nowhere.gltf]\n"),
             contains("r.yaml:3:14") && contains("nowhere.gltf"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{count: 3}]\nsplit: {validation_rooms: 0.5, test_rooms: 0.5}\n"),
             contains("r.yaml:3:8") && contains("no room is left"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{}]\nexports: [uci864]\nsensing: {window_s: 7}\n"),
             contains("r.yaml:3:10") && contains("30 s"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{count: 100000}, {count: 100000}]\ndays: 3660\n"),
             contains("r.yaml:2:8") && contains("1000000 room-days"));
  CHECK_THAT(faults_of("pirsim_recipe: 1\nrooms: [{}]\nschedule: {staf: []}\n"), contains("r.yaml:3:12"));
}
