// Tables by column: what a column is called, what it holds and means, and how a row tells it. Every table has one such
// list. Whoever writes, reads, checks or describes the table takes it from the list.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pirsim/sample.hpp"

namespace pirsim {

/// What the fields of a column are. A count is a whole number from 0; a moment is "2026-03-02T08:30:00".
enum class Holds { whole, count, bit, bits, number, text, date, moment };

/// In which rows of a table a column is.
enum class When {
  always,
  with_clock,  ///< if the script has a clock
  with_areas,  ///< if the scene has areas
  simulated    ///< not in measured rows: nobody knows it there
};

/// Of what a table has as many columns as there are.
enum class Each { sensor, area, door };

/// Begins the names of columns that hold the people of an area, and no sensor's.
inline constexpr std::string_view area_prefix = "people_";
[[nodiscard]] inline std::string column_of_area(std::string_view area) { return std::string(area_prefix).append(area); }
[[nodiscard]] inline bool is_column_of_area(std::string_view column) { return column.starts_with(area_prefix); }

/// The same of doors: 1 while one isn't shut.
inline constexpr std::string_view door_prefix = "door_";
[[nodiscard]] inline std::string column_of_door(std::string_view door) { return std::string(door_prefix).append(door); }
[[nodiscard]] inline bool is_column_of_door(std::string_view column) { return column.starts_with(door_prefix); }

/// Whose column it is by how its name begins; a sensor's if by nothing.
[[nodiscard]] inline Each owner_of(std::string_view column) {
  return is_column_of_area(column) ? Each::area : is_column_of_door(column) ? Each::door : Each::sensor;
}

struct ColumnInfo {
  std::string_view name;
  Holds holds = Holds::number;
  std::string_view meaning;  ///< Markdown, without a full stop where a page lists it
  std::string_view unit{};
  When when = When::always;
  std::string_view alias{};  ///< another name that readers accept
  int decimals = -1;         ///< to which tables round; -1: they don't
};

/// Who has columns in a table. areas: ids, then the name of the rest if there is one.
struct ColumnOwners {
  std::vector<std::string> sensors{}, areas{}, doors{};
};

/// One field. Text and bits belong to the row.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string_view, std::span<const std::uint8_t>>;

/// A column that a table has once has a `value`. One that it has for each sensor, area or door has `each`, and no name
/// of its own.
template <typename Row>
struct Column : ColumnInfo {
  Cell (*value)(const Row& row) = nullptr;
  Cell (*each)(const Row& row, std::size_t item) = nullptr;
  Each of = Each::sensor;
};

/// The list of the table that has such rows.
template <typename Row>
[[nodiscard]] std::span<const Column<Row>> columns_of();

// Rows that need more than what a run gives: who wrote them, and when.

struct OccupantLine {
  int replicate;
  std::string_view trial;
  const OccupantRow& row;
};

/// Of one sensor at one tick.
struct ZoneLine {
  int replicate;
  std::string_view trial;
  std::int64_t tick;
  std::string_view sensor;
  std::span<const std::uint8_t> zones;
};

struct TraceLine {
  int replicate;
  std::string_view trial;
  double time_s;
  std::string_view sensor;
  const TraceRow& row;
};

/// A row of a dataset's day.
struct DayLine {
  int room, day;
  const Sample& row;
  int arrivals, departures;
  std::span<const int> sensor_of_column;  ///< index of the room's sensor; -1: the room has none of that name
  std::span<const int> area_of_column{};  ///< the same of its areas
  std::span<const int> door_of_column{};  ///< and of its doors
};

struct DayOccupantLine {
  int room, day;
  const OccupantRow& row;
};

template <>
[[nodiscard]] std::span<const Column<Sample>> columns_of();
template <>
[[nodiscard]] std::span<const Column<OccupantLine>> columns_of();
template <>
[[nodiscard]] std::span<const Column<ZoneLine>> columns_of();
template <>
[[nodiscard]] std::span<const Column<TraceLine>> columns_of();
template <>
[[nodiscard]] std::span<const Column<DayLine>> columns_of();
template <>
[[nodiscard]] std::span<const Column<DayOccupantLine>> columns_of();

/// What a table is called by in its first line: the columns for which `is_there` holds, and one for each owner.
template <typename Row, typename IsThere>
[[nodiscard]] std::vector<std::string> column_names(const ColumnOwners& owners, IsThere is_there) {
  std::vector<std::string> names;
  for (const Column<Row>& column : columns_of<Row>()) {
    if (!is_there(column.when)) continue;
    if (column.each == nullptr) {
      names.emplace_back(column.name);
    } else if (column.of == Each::sensor) {
      names.insert(names.end(), owners.sensors.begin(), owners.sensors.end());
    } else if (column.of == Each::area) {
      for (const std::string& area : owners.areas) names.push_back(column_of_area(area));
    } else {
      for (const std::string& door : owners.doors) names.push_back(column_of_door(door));
    }
  }
  return names;
}
/// All of them, but those of areas if there are none.
template <typename Row>
[[nodiscard]] std::vector<std::string> column_names(const ColumnOwners& owners = {}) {
  return column_names<Row>(owners, [&](When when) { return when != When::with_areas || !owners.areas.empty(); });
}

}  // namespace pirsim
