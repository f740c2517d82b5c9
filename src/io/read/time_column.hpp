// When a row of a table is: a column of local times or of seconds, or one of dates beside one of times.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/read/csv_reader.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {

class TimeColumn {
 public:
  /// wanted: the column's name, or "": `time`, `time_s`, `t`, or `Date` and `Time`, the first of these that the table
  /// has and fills. The table outlives this. A missing one is told.
  TimeColumn(const CsvTable& table, const std::string& wanted, Diagnostics& faults);

  [[nodiscard]] bool is_found() const noexcept { return column_.has_value(); }
  /// Are they local times, whose seconds count since 1970-01-01T00:00? Otherwise they are plain seconds.
  [[nodiscard]] bool is_clock() const noexcept { return is_clock_; }
  /// Where a row's fault stands.
  [[nodiscard]] Where where(std::size_t row) const { return table_.where(row, *column_); }
  /// None after a fault, which is told.
  [[nodiscard]] std::optional<double> seconds(std::size_t row, Diagnostics& faults) const;

 private:
  [[nodiscard]] std::string text(std::size_t row) const;

  const CsvTable& table_;
  std::optional<std::size_t> column_, date_;
  bool is_clock_ = false;
};

}  // namespace pirsim::io
