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
  simulated    ///< not in measured rows: nobody knows it there
};

struct ColumnInfo {
  std::string_view name;
  Holds holds = Holds::number;
  std::string_view meaning;  ///< Markdown, without a full stop where a page lists it
  std::string_view unit{};
  When when = When::always;
  std::string_view alias{};  ///< another name that readers accept
  int decimals = -1;         ///< to which tables round; -1: they don't
};

/// One field. Text and bits belong to the row.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string_view, std::span<const std::uint8_t>>;

/// A column that a table has once has a `value`. One that it has for each sensor has `each`, and no name of its own.
template <typename Row>
struct Column : ColumnInfo {
  Cell (*value)(const Row& row) = nullptr;
  Cell (*each)(const Row& row, std::size_t item) = nullptr;
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

/// What a table is called by in its first line: the columns for which `is_there` holds, and one for each of `sensors`.
template <typename Row, typename IsThere>
[[nodiscard]] std::vector<std::string> column_names(const std::vector<std::string>& sensors, IsThere is_there) {
  std::vector<std::string> names;
  for (const Column<Row>& column : columns_of<Row>()) {
    if (!is_there(column.when)) continue;
    if (column.each != nullptr) {
      names.insert(names.end(), sensors.begin(), sensors.end());
    } else {
      names.emplace_back(column.name);
    }
  }
  return names;
}
/// All of them.
template <typename Row>
[[nodiscard]] std::vector<std::string> column_names(const std::vector<std::string>& sensors = {}) {
  return column_names<Row>(sensors, [](When) { return true; });
}

}  // namespace pirsim
