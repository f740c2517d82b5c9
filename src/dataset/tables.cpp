// The tables of what was drawn: a list of columns for each, and the lines.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "dataset/description.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/response.hpp"
#include "schema/areas.hpp"
#include "schema/columns.hpp"
#include "schema/words.hpp"

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

}  // namespace pirsim::dataset
