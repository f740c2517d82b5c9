#include "rooms/tables.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "model/core/random.hpp"
#include "model/core/text.hpp"
#include "model/schema/check_scene.hpp"
#include "model/schema/columns.hpp"
#include "model/schema/words.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/response.hpp"
#include "pirsim/version.hpp"
#include "rooms/room_day.hpp"

// The tables of what was drawn: a list of columns for each, and the lines.

namespace pirsim::dataset {
namespace {

constexpr int decimals = 3;  ///< of what isn't a whole number

Cell whole(auto number) { return static_cast<std::int64_t>(number); }

constexpr auto room = [](const auto& line) -> Cell { return line.room; };
constexpr auto day = [](const auto& line) -> Cell { return line.day; };

struct RoomLine {
  int room;
  std::string part;
  const DescribedRoom& described;
};

constexpr Column<RoomLine> rooms[]{
    {room_column, room},
    {{"part", Holds::text, "train, validation or test_rooms; test_days are days of rooms in train."},
     [](const RoomLine& line) -> Cell { return line.part; }},
    {{"kind", Holds::text, "office, meeting or home; own: a scene of the recipe's author."},
     [](const RoomLine& line) -> Cell {
       return line.described.kind.empty() ? std::string_view("own") : std::string_view(line.described.kind);
     }},
    {{"scene", Holds::text, "glTF file of the room."},
     [](const RoomLine& line) -> Cell { return line.described.scene_file; }},
    {{"floor_m2", Holds::number, "Floor area.", "m2", When::always, {}, decimals},
     [](const RoomLine& line) -> Cell { return line.described.scene.floor.area_m2(); }},
    {{"doors", Holds::count, "Entrances.", "1"},
     [](const RoomLine& line) { return whole(line.described.scene.entrances.size()); }},
    {{"seats", Holds::count, "Seats.", "1"},
     [](const RoomLine& line) { return whole(line.described.scene.seats.size()); }},
    {{"sensors", Holds::count, "Sensors.", "1"},
     [](const RoomLine& line) { return whole(line.described.scene.sensors.size()); }},
    {{"staff", Holds::count, "People with a desk of their own here, or who live here.", "1"},
     [](const RoomLine& line) { return whole(line.described.staff); }},
};

struct SensorLine {
  int room;
  const SensorSpec& sensor;
  Response response;
  std::string_view area;

  [[nodiscard]] Vec3 place() const { return sensor.world_from_sensor.origin; }
  [[nodiscard]] double tilt_deg() const {
    return degrees(std::asin(std::clamp(-sensor.world_from_sensor.forward().y, -1.0, 1.0)));
  }
  /// Of one that looks straight down, where its picture's upper edge points.
  [[nodiscard]] double heading_deg() const {
    const Frame& frame = sensor.world_from_sensor;
    return degrees(heading_of(floor_point(tilt_deg() > 89.9 ? frame.up() : frame.forward())));
  }
};

constexpr Column<SensorLine> sensors[]{
    {room_column, room},
    {{"sensor", Holds::text, "Name of the rows' column."},
     [](const SensorLine& line) -> Cell { return line.sensor.id; }},
    {{"model", Holds::text, "Which lens: a file of data/sensors of pirsim."},
     [](const SensorLine& line) -> Cell { return line.sensor.model; }},
    {{"response", Holds::text, "How it answers: zones or analog."},
     [](const SensorLine& line) -> Cell { return std::string_view(word_of(line.response)); }},
    {{"x_m", Holds::number, "Place in the room's scene.", "m", When::always, {}, decimals},
     [](const SensorLine& line) -> Cell { return line.place().x; }},
    {{"y_m", Holds::number, "Height.", "m", When::always, {}, decimals},
     [](const SensorLine& line) -> Cell { return line.place().y; }},
    {{"z_m", Holds::number, "Place in the room's scene.", "m", When::always, {}, decimals},
     [](const SensorLine& line) -> Cell { return line.place().z; }},
    {{"heading_deg",
      Holds::number,
      "Direction in which it looks, 0 along -z, positive to the left; of one that looks straight down, the direction "
      "of "
      "its picture's upper edge.",
      "deg",
      When::always,
      {},
      decimals},
     [](const SensorLine& line) -> Cell { return line.heading_deg(); }},
    {{"tilt_deg", Holds::number, "Of its axis below the horizon.", "deg", When::always, {}, decimals},
     [](const SensorLine& line) -> Cell { return line.tilt_deg(); }},
    {{"area", Holds::text, "Of the room, that it watches, or elsewhere; empty without areas.", {}, When::with_areas},
     [](const SensorLine& line) -> Cell { return line.area; }},
};

struct AreaLine {
  int room;
  std::string_view area;
  double floor_m2;
};

constexpr Column<AreaLine> areas[]{
    {room_column, room},
    {{"area", Holds::text, "Its people are in the rows' column people_ and this; elsewhere: of no area."},
     [](const AreaLine& line) -> Cell { return line.area; }},
    {{"floor_m2", Holds::number, "Of the floor.", "m2", When::always, {}, decimals},
     [](const AreaLine& line) -> Cell { return line.floor_m2; }},
};

struct DoorLine {
  int room;
  const DoorSpec& door;
  std::string_view area, beyond;
};

/// towards: -1 inwards, 1 outwards.
std::string_view area_beside(const DoorSpec& door, double towards, const SceneSpec& scene, const Areas& areas) {
  constexpr double beyond_wall_m = 0.3;  // assumed: thicker than half of any inner wall, nearer than the next room
  const Vec2 beside = floor_point(door.world_from_door * Vec3(0.0, 0.0, towards * beyond_wall_m));
  return scene.floor.contains(beside) ? areas.name_at(beside) : "outside";
}

constexpr Column<DoorLine> doors[]{
    {room_column, room},
    {{"door", Holds::text, "Its contact is the rows' column door_ and this."},
     [](const DoorLine& line) -> Cell { return std::string_view(line.door.id); }},
    {{"area", Holds::text, "Inwards: where its mark's -Z points.", {}, When::with_areas},
     [](const DoorLine& line) -> Cell { return line.area; }},
    {{"beyond", Holds::text, "The area on the other side, or outside.", {}, When::with_areas},
     [](const DoorLine& line) -> Cell { return line.beyond; }},
    {{"width_m", Holds::number, "Of the leaf.", "m", When::always, {}, decimals},
     [](const DoorLine& line) -> Cell { return line.door.width_m; }},
};

struct RecordLine {
  int room, day;
  std::string part;
  const RoomDayRecord& record;
};

constexpr Column<RecordLine> days[]{
    {room_column, room},
    {day_column, day},
    {{"date", Holds::date, "Calendar date."}, [](const RecordLine& line) -> Cell { return line.record.date; }},
    {{"part", Holds::text, "train, validation, test_days or test_rooms."},
     [](const RecordLine& line) -> Cell { return line.part; }},
    {{"rows", Holds::count, "Rows of this day.", "1"}, [](const RecordLine& line) { return whole(line.record.rows); }},
    {{"hours", Holds::number, "That they cover.", "h", When::always, {}, decimals},
     [](const RecordLine& line) -> Cell { return line.record.seconds / 3600.0; }},
    {{"ambient_c", Holds::number, "Of the air.", "degC", When::always, {}, decimals},
     [](const RecordLine& line) -> Cell { return line.record.ambient_c; }},
    {{"most_people", Holds::count, "At once.", "1"},
     [](const RecordLine& line) { return whole(line.record.most_people); }},
    {{"presence_share", Holds::number, "Share of rows with anybody there.", {}, When::always, {}, decimals},
     [](const RecordLine& line) -> Cell {
       if (line.record.rows == 0) return {};
       const auto empty = line.record.rows_by_people.find(0);
       const std::uint64_t absent = empty == line.record.rows_by_people.end() ? 0 : empty->second.all;
       return 1.0 - static_cast<double>(absent) / static_cast<double>(line.record.rows);
     }},
    {{"arrivals", Holds::count, "Of the day.", "1"},
     [](const RecordLine& line) { return whole(line.record.arrivals); }},
    {{"departures", Holds::count, "Of the day.", "1"},
     [](const RecordLine& line) { return whole(line.record.departures); }},
    {{"passes_through", Holds::count, "How often two people who found no way round each other went through each other.",
      "1"},
     [](const RecordLine& line) { return whole(line.record.passes_through); }},
    {{"failed", Holds::text, "Why the day has no rows, if it hasn't."},
     [](const RecordLine& line) -> Cell { return line.record.fault; }},
};

struct EffectLine {
  int room, day;
  const std::string &effect, &sensor, &parameter;
  Cell value;
};

constexpr Column<EffectLine> effects[]{
    {room_column, room},
    {day_column, day},
    {{"effect", Holds::text, "Entry of pirsim's catalogue of effects."},
     [](const EffectLine& line) -> Cell { return line.effect; }},
    {{"sensor", Holds::text, "The sensor that it acts on; empty: all, or the effect's own way."},
     [](const EffectLine& line) -> Cell { return line.sensor; }},
    {{"parameter", Holds::text, "Its name ends in its unit."},
     [](const EffectLine& line) -> Cell { return line.parameter; }},
    {{"value", Holds::text, "A number or a word."}, [](const EffectLine& line) { return line.value; }},
};

/// Makes tables of a dataset that has areas or none.
class TableMaker {
 public:
  explicit TableMaker(const ColumnOwners& owners) : has_areas_(!owners.areas.empty()) {}

  /// fill: writes the lines.
  template <typename Row, std::size_t n>
  Table operator()(const Column<Row> (&all)[n], auto fill) const {
    std::vector<Column<Row>> columns(std::begin(all), std::end(all));
    std::erase_if(columns, [&](const ColumnInfo& column) { return column.when == When::with_areas && !has_areas_; });
    std::ostringstream text;
    io::TableWriter<Row> csv(text, std::span<const Column<Row>>(columns));
    fill(csv);
    return {text.str(), {columns.begin(), columns.end()}};
  }

 private:
  bool has_areas_;
};

}  // namespace

std::map<std::string, Table> tables(const Description& described) {
  const auto add_rooms = [&](auto& csv) {
    for (const DescribedRoom& one : described.rooms)
      csv.write({one.number, one.part == Part::test_days ? "train" : name_of(one.part), one});
  };
  const auto add_sensors = [&](auto& csv) {
    for (const DescribedRoom& one : described.rooms) {
      const Areas areas(one.scene);
      const std::vector<SensorSpec>& all = one.scene.sensors;
      for (std::size_t i = 0; i < all.size(); ++i)
        csv.write(
            {one.number, all[i], response_of(one.scene, described.recipe.sensing, all[i]), areas.name_of_sensor(i)});
    }
  };
  const auto add_areas = [&](auto& csv) {
    for (const DescribedRoom& one : described.rooms) {
      const Areas areas(one.scene);
      for (std::size_t i = 0; i < areas.size(); ++i) csv.write({one.number, areas.names()[i], areas.areas_m2()[i]});
    }
  };
  const auto add_doors = [&](auto& csv) {
    for (const DescribedRoom& one : described.rooms) {
      const Areas areas(one.scene);
      for (const DoorSpec& door : one.scene.doors)
        csv.write(
            {one.number, door, area_beside(door, -1.0, one.scene, areas), area_beside(door, 1.0, one.scene, areas)});
    }
  };
  const auto add_days = [&](auto& csv) {
    for (std::size_t i = 0; i < described.days.size(); ++i) {
      const RoomDayRecord& record = described.days[i];
      csv.write({record.room, record.day, name_of(described.parts[i]), record});
    }
  };
  const auto add_effects = [&](auto& csv) {
    const std::string all;
    for (const RoomDayRecord& record : described.days) {
      for (const EffectSpec& effect : record.effects) {
        const auto chosen = effect.choices.find("sensor");
        const std::string& sensor = chosen == effect.choices.end() ? all : chosen->second;
        for (const auto& [name, value] : effect.parameters)
          csv.write({record.room, record.day, effect.name, sensor, name, value});
        for (const auto& [name, choice] : effect.choices) {
          if (name != "sensor")
            csv.write({record.room, record.day, effect.name, sensor, name, std::string_view(choice)});
        }
      }
    }
  };
  const TableMaker table_of(described.columns);
  std::map<std::string, Table> made{{"rooms.csv", table_of(rooms, add_rooms)},
                                    {"sensors.csv", table_of(sensors, add_sensors)},
                                    {"days.csv", table_of(days, add_days)},
                                    {"effects.csv", table_of(effects, add_effects)}};
  if (!described.columns.areas.empty()) made.emplace("areas.csv", table_of(areas, add_areas));
  if (!described.columns.doors.empty()) made.emplace("doors.csv", table_of(doors, add_doors));
  return made;
}

namespace {

using Json = nlohmann::ordered_json;

/// Of Table Schema.
std::string type_of(Holds holds) {
  switch (holds) {
    case Holds::whole:
    case Holds::count:
    case Holds::bit:
      return "integer";
    case Holds::number:
      return "number";
    case Holds::date:
      return "date";
    case Holds::moment:
      return "datetime";
    case Holds::text:
    case Holds::bits:
      break;
  }
  return "string";
}

Json field(const ColumnInfo& column, std::string_view name) {
  Json one{{"name", name}, {"type", type_of(column.holds)}, {"description", column.meaning}};
  if (column.holds == Holds::moment) one["format"] = "%Y-%m-%dT%H:%M:%S";
  if (!column.unit.empty()) one["unit"] = column.unit;
  if (column.holds == Holds::bit) one["constraints"] = {{"minimum", 0}, {"maximum", 1}};
  if (column.holds == Holds::count) one["constraints"] = {{"minimum", 0}};
  return one;
}

template <typename Row>
Json fields_of(const ColumnOwners& owners) {
  Json fields = Json::array();
  for (const Column<Row>& column : pirsim::columns_of<Row>()) {
    if (column.each != nullptr && column.of == Each::sensor) {
      for (const std::string& sensor : owners.sensors) fields.push_back(field(column, sensor));
    } else if (column.each != nullptr && column.of == Each::area) {
      for (const std::string& area : owners.areas) fields.push_back(field(column, column_of_area(area)));
    } else if (column.each != nullptr) {
      for (const std::string& door : owners.doors) fields.push_back(field(column, column_of_door(door)));
    } else if (column.when != When::with_areas || !owners.areas.empty()) {
      fields.push_back(field(column, column.name));
    }
  }
  return fields;
}

/// Letters, digits and hyphens, as package names are.
std::string slug(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool fits = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (fits) result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!fits && !result.empty() && result.back() != '-') result += '-';
  }
  while (result.ends_with('-')) result.pop_back();
  return result.empty() ? "dataset" : result;
}

Json resource(const std::string& name, const std::string& title, Json paths, Json fields) {
  return {{"name", name},
          {"title", title},
          {"profile", "tabular-data-resource"},
          {"path", std::move(paths)},
          {"format", "csv"},
          {"mediatype", "text/csv"},
          {"encoding", "utf-8"},
          {"schema", {{"fields", std::move(fields)}, {"missingValues", {""}}}}};
}

/// The rows, or the occupants, of one part; null if there are none.
Json resource_of_part(const Description& described, Part part, const std::string& folder) {
  Json paths = Json::array(), files = Json::array();
  for (std::size_t i = 0; i < described.days.size(); ++i) {
    if (described.parts[i] != part) continue;
    for (const WrittenFile& file : described.days[i].files) {
      if (!file.path.starts_with(folder + '/')) continue;
      paths.push_back(file.path);
      files.push_back({{"path", file.path}, {"bytes", file.bytes}, {"hash", "sha256:" + file.sha256}});
    }
  }
  if (paths.empty()) return {};
  const bool is_rows = folder == "rows";
  Json one = resource((is_rows ? "" : folder + "_") + name_of(part),
                      (is_rows ? "Rows: " : "Who is where: ") + name_of(part), std::move(paths),
                      is_rows ? fields_of<DayLine>(described.columns) : fields_of<DayOccupantLine>(described.columns));
  // Neither `bytes` nor `hash` of the whole: readers take them of what is unpacked and joined.
  one["files"] = std::move(files);
  return one;
}

}  // namespace

std::string data_package(const Description& described, const std::map<std::string, Table>& tables) {
  Json resources = Json::array();
  for (const std::string folder : {"rows", "occupants"}) {
    for (const Part part : {Part::train, Part::validation, Part::test_days, Part::test_rooms}) {
      Json one = resource_of_part(described, part, folder);
      if (!one.is_null()) resources.push_back(std::move(one));
    }
  }
  for (const auto& [name, table] : tables) {
    const std::string stem = name.substr(0, name.find('.'));
    Json fields = Json::array();
    for (const ColumnInfo& column : table.columns) fields.push_back(field(column, column.name));
    Json one = resource(stem, "One line each: " + stem, name, std::move(fields));
    one["bytes"] = table.text.size();
    one["hash"] = "sha256:" + sha256(table.text);
    resources.push_back(std::move(one));
  }
  const Json package{{"profile", "data-package"},
                     {"name", slug(described.recipe.name)},
                     {"title", described.recipe.name},
                     {"description",
                      "Simulated passive-infrared motion sensors in rooms with people, and the true number of people. "
                      "Made by pirsim; README.md has the figures."},
                     {"version", version()},
                     {"keywords", {"passive infrared", "occupancy", "people counting", "simulation"}},
                     {"contributors", {{{"title", program()}, {"role", "wrangler"}}}},
                     {"provenance", described.provenance},
                     {"recipe", {{"path", "recipe.yaml"}, {"hash", "sha256:" + sha256(described.recipe.text)}}},
                     {"resources", std::move(resources)}};
  return package.dump(1) + '\n';
}

namespace {

constexpr std::array all_parts{Part::train, Part::validation, Part::test_days, Part::test_rooms};

std::string hours(double seconds) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(seconds < 360'000.0 ? 1 : 0) << seconds / 3600.0;
  return text.str();
}
double share(const MotionCount& count) {
  return count.all == 0 ? 0.0 : static_cast<double>(count.with_motion) / static_cast<double>(count.all);
}

struct PartSums {
  std::set<int> rooms;
  int days = 0, failed = 0;
  double seconds = 0.0;
  std::uint64_t rows = 0, occupied = 0, arrivals = 0;
};

PartSums sums_of(const Description& described, Part part) {
  PartSums sums;
  for (std::size_t i = 0; i < described.days.size(); ++i) {
    const RoomDayRecord& day = described.days[i];
    if (described.parts[i] != part) continue;
    sums.rooms.insert(day.room);
    ++sums.days;
    sums.failed += day.fault.empty() ? 0 : 1;
    sums.seconds += day.seconds;
    sums.rows += day.rows;
    sums.arrivals += day.arrivals;
    for (const auto& [people, count] : day.rows_by_people) sums.occupied += people > 0 ? count.all : 0;
  }
  return sums;
}

std::string table_of_parts(const Description& described) {
  std::string text =
      "| part | rooms | room-days | hours | rows | with anybody there | arrivals "
      "|\n|---|---:|---:|---:|---:|---:|---:|\n";
  for (const Part part : all_parts) {
    const PartSums sums = sums_of(described, part);
    if (sums.days == 0) continue;
    const double occupied = sums.rows == 0 ? 0.0 : static_cast<double>(sums.occupied) / static_cast<double>(sums.rows);
    text += "| `" + name_of(part) + "` | " + std::to_string(sums.rooms.size()) + " | " + std::to_string(sums.days) +
            (sums.failed > 0 ? " (" + std::to_string(sums.failed) + " without rows)" : "") + " | " +
            hours(sums.seconds) + " | " + std::to_string(sums.rows) + " | " + percent(occupied, 1) + " | " +
            std::to_string(sums.arrivals) + " |\n";
  }
  return text;
}

std::string table_of_counts(const Description& described) {
  std::map<int, MotionCount> rows, readings;
  std::uint64_t all = 0;
  for (const RoomDayRecord& day : described.days) {
    for (const auto& [people, count] : day.rows_by_people) {
      rows[people].all += count.all;
      rows[people].with_motion += count.with_motion;
      all += count.all;
    }
    for (const auto& [people, count] : day.readings_by_people) {
      readings[people].all += count.all;
      readings[people].with_motion += count.with_motion;
    }
  }
  const bool has_readings = rows_per_reading(described.recipe.sensing).has_value();
  std::string text = "| people | share of rows | rows with motion at any sensor |";
  text += has_readings ? " 30 s with motion at any sensor |\n|---:|---:|---:|---:|\n" : "\n|---:|---:|---:|\n";
  for (const auto& [people, count] : rows) {
    text += "| " + std::to_string(people) + " | " +
            percent(static_cast<double>(count.all) / static_cast<double>(all), 1) + " | " + percent(share(count), 1) +
            " |" + (has_readings ? ' ' + percent(share(readings[people]), 1) + " |" : "") + '\n';
  }
  return text;
}

std::string about_rooms(const Description& described) {
  const auto extent = [&](const auto& value) {
    auto least = value(described.rooms.front()), most = least;
    for (const DescribedRoom& room : described.rooms) {
      least = std::min(least, value(room));
      most = std::max(most, value(room));
    }
    std::ostringstream text;
    text << least;
    if (most != least) text << " to " << most;
    return text.str();
  };
  const auto squares = [](const DescribedRoom& room) { return std::round(room.scene.floor.area_m2()); };
  return extent(squares) + " m2, with " + extent([](const DescribedRoom& r) { return r.scene.seats.size(); }) +
         " seats and " + extent([](const DescribedRoom& r) { return r.scene.sensors.size(); }) + " sensors";
}

/// How to run a day again; scenes of the recipe's author stay where they are.
std::string rooms_and_scripts(const Description& described) {
  const auto is_drawn = [](const DescribedRoom& room) { return !room.kind.empty(); };
  const auto drawn = std::ranges::find_if(described.rooms, is_drawn);
  std::string text = "- ";
  if (drawn != described.rooms.end()) text += "`rooms/`: the rooms as glTF; ";
  text += "`scripts/`: who does what on each day.";
  if (!std::ranges::all_of(described.rooms, is_drawn))
    text += " The recipe's own scenes aren't part of the dataset; the lines below name them with their hashes.";
  const DescribedRoom& shown = drawn == described.rooms.end() ? described.rooms.front() : *drawn;
  return text + " A day again, to look at: " +
         markdown_code("pirsim --scene " + shown.scene_file + " --script scripts/" + room_name(shown.number) +
                       "/day_01.yaml") +
         ", whose replicate 1 is day 1.\n";
}

}  // namespace

std::string readme(const Description& described) {
  const RecipeSpec& recipe = described.recipe;
  double seconds = 0.0;
  std::uint64_t passes = 0;
  int most_people = 0, failed = 0;
  for (const RoomDayRecord& day : described.days) {
    seconds += day.seconds;
    passes += day.passes_through;
    most_people = std::max(most_people, day.most_people);
    failed += day.fault.empty() ? 0 : 1;
  }
  std::string text = "# " + markdown_text(recipe.name) + "\n";
  text += hours(seconds) + " hours of passive-infrared motion sensors in " + std::to_string(described.rooms.size()) +
          (described.rooms.size() == 1 ? " room" : " rooms") + " (" + about_rooms(described) + "), " +
          std::to_string(recipe.days) + (recipe.days == 1 ? " day" : " days") +
          " each, with the true number of people, " + std::to_string(most_people) +
          " at most. All of it is simulated: nobody was watched.\n\n";
  text += table_of_parts(described) + '\n';
  text +=
      "No room of `train` is in `validation` or `test_rooms`, no day of `train` is in `test_days`, and no row is split "
      "from "
      "its day.\n\n";
  text += "How often a sensor sees motion, by the number of people at the end of that time:\n\n" +
          table_of_counts(described) + '\n';
  for (std::size_t i = 0; i < described.pictures.size(); ++i)
    text += "![Room " + std::to_string(i + 1) + " without its front walls: seats, doors and sensors](" +
            described.pictures[i] + ")\n";
  if (!described.pictures.empty()) text += '\n';
  text += "## What is where\n";
  text +=
      "- `datapackage.json`: every file with its columns, units and hash "
      "([Frictionless](https://specs.frictionlessdata.io)).\n";
  text +=
      "- `rows/`: a file a room and day, a line a window; the columns are explained in `datapackage.json`. A sensor's "
      "column tells *motion*, not occupancy: who keeps still isn't seen.\n";
  text +=
      "- `rooms.csv`, `sensors.csv`, `days.csv`, `effects.csv`: what each room, sensor and day is, which part it "
      "belongs "
      "to, and which effects were drawn for it.\n";
  if (!described.columns.areas.empty())
    text += "- `areas.csv`: the named parts of each room's floor; rows count the people of each.\n";
  if (!described.columns.doors.empty())
    text += "- `doors.csv`: which areas each door joins; rows have a column of its contact.\n";
  text += rooms_and_scripts(described);
  if (recipe.occupants == Occupants::told)
    text += "- `occupants/`: who is where and does what, a line a window and person.\n";
  if (recipe.frames == Frames::taken)
    text +=
        "- `frames/`: what thermal arrays read, [frame, y, x] in degrees Celsius, a NumPy file a room, day and "
        "array.\n";
  if (!recipe.exports.empty()) text += "- `exports/`: the same data in other tools' shapes.\n";
  text += "- `recipe.yaml`: what it was made from.\n\n";
  if (failed > 0)
    text +=
        std::to_string(failed) + " room-days have no rows since they couldn't be simulated; `days.csv` says why.\n\n";
  if (passes > 0)
    text += "Two people who found no way round each other went through each other " + std::to_string(passes) +
            " times.\n\n";
  std::string command = "pirsim dataset recipe.yaml -o DIR";
  for (const std::string& change : recipe.overrides) command += " --set '" + change + "'";
  text += "## How it was made, and how to cite it\n" + markdown_code(command) + " of " + program() +
          " makes the same bytes again. Cite pirsim, a headless simulator of passive-infrared motion "
          "sensors, version " +
          version() + ", with the recipe's hash:\n\n    " + described.provenance + '\n';
  return text;
}

}  // namespace pirsim::dataset
