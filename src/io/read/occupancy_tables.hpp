// The tables behind an occupancy. Private to io.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "io/read/csv_reader.hpp"
#include "io/read/time_column.hpp"
#include "pirsim/occupancy.hpp"
#include "schema/clock.hpp"

namespace pirsim::io {

// Each fills what was read of the file, or tells faults with their place in it, each kind once.

/// Numbers of people at moments.
void read_counts(const CsvTable& table, CountsSpec& counts, Diagnostics& faults);
/// Rows as `--occupants` writes them, to stays.
void read_places(const CsvTable& table, PlacesSpec& places, Diagnostics& faults);
/// Rows of tracked people.
void read_positions(const CsvTable& table, PositionsSpec& positions, Diagnostics& faults);

// What they share.

/// A study's rows have many runs, and then time begins anew.
void require_one_run(const CsvTable& table, const TimeColumn& time, RepeatedFaults& faults);

/// By either name; both are a fault.
[[nodiscard]] std::optional<std::size_t> column_called(const CsvTable& table, std::string_view name,
                                                       std::string_view other, Diagnostics& faults);
/// Columns of a person, and of where they are on the floor, if the table has them.
struct PersonColumns {
  PersonColumns(const CsvTable& table, Diagnostics& faults);
  std::optional<std::size_t> id, x, z;
};
/// False, which is told, for a row of nobody.
[[nodiscard]] bool names_somebody(const CsvTable& table, std::size_t row, const PersonColumns& columns,
                                  RepeatedFaults& faults);
/// None where the table doesn't say, and after a fault, which is told.
[[nodiscard]] std::optional<Vec2> point_in(const CsvTable& table, std::size_t row, const PersonColumns& columns,
                                           Diagnostics& faults);

/// Data whose first moment is a clock's count from there.
template <typename Shift>
[[nodiscard]] std::string begin_of(const TimeColumn& time, double first_s, const Shift& shift) {
  if (!time.is_clock()) return {};
  const RunClock begin{std::llround(first_s)};
  shift(-static_cast<double>(begin.begin_s));
  return begin.text(0.0);
}

}  // namespace pirsim::io
