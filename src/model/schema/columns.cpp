#include "model/schema/columns.hpp"

#include <algorithm>

#include "pirsim/sample.hpp"

namespace pirsim {
namespace {

// Values that rows of several tables tell.
constexpr auto replicate = [](const auto& line) -> Cell { return line.replicate; };
constexpr auto trial = [](const auto& line) -> Cell { return line.trial; };
constexpr auto room = [](const auto& line) -> Cell { return line.room; };
constexpr auto day = [](const auto& line) -> Cell { return line.day; };
constexpr auto time_s = [](const auto& line) -> Cell { return line.row.time_s; };
constexpr auto clock = [](const auto& line) -> Cell { return line.row.clock; };
constexpr auto person = [](const auto& line) -> Cell { return line.row.person; };
constexpr auto where = [](const auto& line) -> Cell {
  return std::string_view(line.row.where == OccupantRow::Where::inside ? "inside" : "outside");
};
constexpr auto area = [](const auto& line) -> Cell { return line.row.area; };
constexpr auto activity = [](const auto& line) -> Cell { return line.row.activity; };
constexpr auto seat = [](const auto& line) -> Cell { return line.row.seat; };
constexpr auto x_m = [](const auto& line) -> Cell { return line.row.place_m.x; };
constexpr auto z_m = [](const auto& line) -> Cell { return line.row.place_m.y; };

/// Empty where nobody knows.
Cell bit_cell(std::uint8_t bit) { return bit < unknown_bit ? Cell(std::int64_t{bit}) : Cell(); }
Cell people_cell(int people) { return people < 0 ? Cell() : Cell(std::int64_t{people}); }

constexpr int millimetres = 3;  ///< decimals of a metre

constexpr Column<Sample> rows[]{
    {{"replicate", Holds::count, "from 1"}, replicate},
    {{"trial", Holds::text, "as the script names it", {}, When::always, "seat"}, trial},
    {{"time_s", Holds::number, "end of the window, seconds since the run began", "s"},
     [](const Sample& row) -> Cell { return row.time_s; }},
    {{"time",
      Holds::moment,
      "only with a [`begin`](script.md#a-clock) or a [schedule](script.md#schedules): date and time at `time_s`, as "
      "`2026-03-02T08:30:00`",
      {},
      When::with_clock},
     [](const Sample& row) -> Cell { return row.clock; }},
    {{"phase", Holds::text, "what goes on at `time_s`, by the rules [below](#phase)"},
     [](const Sample& row) -> Cell { return row.phase; }},
    {{"people", Holds::count,
      "number of people whose pelvis is over the floor area at `time_s`, by their positions and not by the script", "1",
      When::simulated},
     [](const Sample& row) { return people_cell(row.people); }},
    {{"one per area", Holds::count,
      "only with [areas](scene.md#areas): `people_` and the area's id; how many of `people` are in it. "
      "`people_elsewhere`, if some of the floor is in no area: how many are there. They sum to `people`",
      "1", When::simulated},
     nullptr,
     [](const Sample& row, std::size_t area) { return people_cell(row.people_of_areas[area]); },
     Each::area},
    {{"one per door",
      Holds::bit,
      "only with [doors](scene.md#doors): `door_` and the door's id; 1 while it isn't shut, at `time_s`",
      {},
      When::simulated},
     nullptr,
     [](const Sample& row, std::size_t door) { return bit_cell(row.doors[door]); },
     Each::door},
    {{"one per sensor", Holds::bit,
      "1 if the sensor saw motion in (time_s - window, time_s]; empty where nobody knows, in rows of logs"},
     nullptr,
     [](const Sample& row, std::size_t sensor) { return bit_cell(row.bits[sensor]); }},
};

constexpr Column<OccupantLine> occupants[]{
    {{"replicate", Holds::count, "as in the row of the same window"}, replicate},
    {{"trial", Holds::text, "as in the row of the same window"}, trial},
    {{"time_s", Holds::number, "as in the row of the same window", "s"}, time_s},
    {{"time", Holds::moment, "as in the row of the same window; empty without a [clock](script.md#a-clock)"}, clock},
    {{"person", Holds::text,
      "the name in the script; with a schedule by role: `staff_1`, ..., `manager_1`, ..., `administrator_1`, ..., "
      "`guest_1`, ..., `cleaner`; with a household its residents' ids and `visitor`; with counts `occupant_1`, ..."},
     person},
    {{"where", Holds::text, "`inside` if the pelvis is over the floor area, otherwise `outside` (in a doorway)"},
     where},
    {{"area",
      Holds::text,
      "only with [areas](scene.md#areas): the id of the area that somebody `inside` is in, or `elsewhere`; empty for "
      "who "
      "is `outside`",
      {},
      When::with_areas},
     area},
    {{"activity", Holds::text,
      "the action's `phase` or, without one, `working`, `walking`, `turning`, `standing`, `sitting_down`, `seated`, "
      "`rising`; schedules add `visiting`, `phone_call`, `presenting` and `cleaning`, "
      "[households](script.md#households) what people do at home"},
     activity},
    {{"seat", Holds::text,
      "the seat that the person has taken, from setting out for it until walking away from it; otherwise empty"},
     seat},
    {{"x_m", Holds::number, "position of the pelvis, to a millimetre", "m", When::always, {}, millimetres}, x_m},
    {{"z_m", Holds::number, "position of the pelvis, to a millimetre", "m", When::always, {}, millimetres}, z_m},
};

constexpr Column<ZoneLine> zones[]{
    {{"replicate", Holds::count, "from 1"}, replicate},
    {{"trial", Holds::text, "as the script names it"}, trial},
    {{"tick", Holds::count, "from 1"}, [](const ZoneLine& line) -> Cell { return line.tick; }},
    {{"sensor", Holds::text, "its name"}, [](const ZoneLine& line) -> Cell { return line.sensor; }},
    {{"zones", Holds::bits, "a string of 0 and 1 in the order of the sensor's data file"},
     [](const ZoneLine& line) -> Cell { return line.zones; }},
};

constexpr Column<TraceLine> trace[]{
    {{"replicate", Holds::count, "from 1"}, replicate},
    {{"trial", Holds::text, "as the script names it"}, trial},
    {{"time_s", Holds::number, "end of the tick, seconds since the run began", "s"},
     [](const TraceLine& line) -> Cell { return line.time_s; }},
    {{"sensor", Holds::text, "its name"}, [](const TraceLine& line) -> Cell { return line.sensor; }},
    {{"power_w", Holds::number, "the power beyond that of an empty room", "W"},
     [](const TraceLine& line) -> Cell { return line.row.power_w; }},
    {{"signal_v", Holds::number, "the amplifier's voltage about its offset", "V"},
     [](const TraceLine& line) -> Cell { return line.row.signal_v; }},
    {{"output", Holds::bit, "the comparator's bit"}, [](const TraceLine& line) -> Cell { return line.row.output; }},
    {{"zone", Holds::count,
      "the zone that has the largest share of the signal, from 1 in the order of the sensor's file; empty while "
      "nothing "
      "but noise is in the signal"},
     [](const TraceLine& line) -> Cell {
       if (line.row.part.empty()) return {};
       return static_cast<std::int64_t>(line.row.zone) + 1;
     }},
    {{"person", Holds::text, "who is seen in that zone"}, person},
    {{"part", Holds::text, "the part of the body that is seen there"},
     [](const TraceLine& line) -> Cell { return line.row.part; }},
    {{"share_v", Holds::number, "their share of the signal", "V"},
     [](const TraceLine& line) -> Cell { return line.row.share_v; }},
};

constexpr ColumnInfo time_info{"time", Holds::moment,
                               "Local wall-clock time at the end of the window that the row covers, ISO 8601."},
    time_s_info{"time_s", Holds::number, "The same, from the beginning of the simulated part of the day.", "s"};

constexpr Column<DayLine> day_rows[]{
    {room_column, room},
    {day_column, day},
    {time_info, clock},
    {time_s_info, time_s},
    {{"people", Holds::count, "People over the floor area at the end of the window: the truth to be estimated.", "1"},
     [](const DayLine& line) -> Cell { return line.row.people; }},
    {{"presence", Holds::bit, "1 if anybody is there at the end of the window."},
     [](const DayLine& line) -> Cell { return line.row.people > 0 ? 1 : 0; }},
    {{"arrivals", Holds::count, "People who are over the floor now and weren't at the end of the window before.", "1"},
     [](const DayLine& line) -> Cell { return line.arrivals; }},
    {{"departures", Holds::count, "People who were over the floor at the end of the window before and aren't now.",
      "1"},
     [](const DayLine& line) -> Cell { return line.departures; }},
    {{"one per area", Holds::count,
      "People in this area at the end of the window; the areas' people sum to all. Empty: this room has no such area.",
      "1"},
     nullptr,
     [](const DayLine& line, std::size_t column) -> Cell {
       const int area = line.area_of_column[column];
       if (area < 0) return {};
       return line.row.people_of_areas[static_cast<std::size_t>(area)];
     },
     Each::area},
    {{"one per door", Holds::bit,
      "1 while this door isn't shut, at the end of the window. Empty: this room has no such door."},
     nullptr,
     [](const DayLine& line, std::size_t column) -> Cell {
       const int door = line.door_of_column[column];
       if (door < 0) return {};
       return line.row.doors[static_cast<std::size_t>(door)];
     },
     Each::door},
    {{"one per sensor", Holds::bit,
      "1 if this sensor saw motion in the window. A motion sensor (Brick: Motion_Sensor), not an occupancy sensor: "
      "nobody who keeps still is seen. Empty: this room has no such sensor; see the resource sensors."},
     nullptr,
     [](const DayLine& line, std::size_t column) -> Cell {
       const int sensor = line.sensor_of_column[column];
       if (sensor < 0) return {};
       return line.row.bits[static_cast<std::size_t>(sensor)];
     }},
};

constexpr Column<DayOccupantLine> day_occupants[]{
    {room_column, room},
    {day_column, day},
    {time_info, clock},
    {time_s_info, time_s},
    {{"person", Holds::text, "Who it is, on all days of this room."}, person},
    {{"where", Holds::text, "inside: over the floor area; outside: in or behind a doorway."}, where},
    {{"area",
      Holds::text,
      "Of somebody inside: the area of the room, or elsewhere; empty without areas.",
      {},
      When::with_areas},
     area},
    {{"activity", Holds::text, "What the person does."}, activity},
    {{"seat", Holds::text, "The seat that is theirs at the moment, or empty."}, seat},
    {{"x_m", Holds::number, "Of the pelvis in the room's scene.", "m", When::always, {}, millimetres}, x_m},
    {{"z_m", Holds::number, "Of the pelvis in the room's scene.", "m", When::always, {}, millimetres}, z_m},
};

constexpr ColumnInfo sums[]{
    {"trial", Holds::text, "as the script names it", {}, When::always, "seat"},
    {"sensor", Holds::text, "as the scene names it"},
    {"replicate", Holds::count, "number of the run"},
    {"seconds", Holds::number, "with motion, in the counted phases", "s", When::always, "real"},
    {"min_sim", Holds::count, "the least that others simulated"},
    {"max_sim", Holds::count, "the most that others simulated"},
    {"mean_sim", Holds::number, "the mean of what others simulated"},
    {"in_range", Holds::bit, "1 if the measured sum lies within what others simulated"},
};

template <typename Row>
bool has(std::string_view name) {
  return std::ranges::any_of(columns_of<Row>(), [&](const Column<Row>& column) {
    return column.each == nullptr && (name == column.name || (!name.empty() && name == column.alias));
  });
}

}  // namespace

template <>
std::span<const Column<Sample>> columns_of() {
  return rows;
}
template <>
std::span<const Column<OccupantLine>> columns_of() {
  return occupants;
}
template <>
std::span<const Column<ZoneLine>> columns_of() {
  return zones;
}
template <>
std::span<const Column<TraceLine>> columns_of() {
  return trace;
}
template <>
std::span<const Column<DayLine>> columns_of() {
  return day_rows;
}
template <>
std::span<const Column<DayOccupantLine>> columns_of() {
  return day_occupants;
}

std::span<const ColumnInfo> sum_columns() { return sums; }

bool is_column_name(std::string_view name) {
  return has<Sample>(name) || has<DayLine>(name) || owner_of(name) != Each::sensor;
}

}  // namespace pirsim
