#include "io/read/time_column.hpp"

#include <cmath>

#include "core/text.hpp"
#include "schema/clock.hpp"

namespace pirsim::io {

TimeColumn::TimeColumn(const CsvTable& table, const std::string& wanted, Diagnostics& faults) : table_(table) {
  if (!wanted.empty()) {
    column_ = table.required_column(wanted, faults);
  } else {
    const bool has_rows = table.n_rows() > 0;
    for (const char* name : {"time", "time_s", "t"}) {
      const auto column = column_ ? std::nullopt : table.column(name);
      if (column && !(has_rows && table.text(0, *column).empty())) column_ = column;
    }
    if (table.column("t") && table.column("time_s"))
      faults.error(table.header_place(), "columns 't' and 'time_s' mean the same: give one of them");
    const auto date = table.column("Date"), time = table.column("Time");
    if (!column_ && date && time) column_ = time, date_ = date;
    if (!column_) {
      std::string names;
      for (const std::string& name : table.names()) names += (names.empty() ? "" : ", ") + name;
      faults.error(table.header_place(), "no column `time`, `time_s` or `t`, nor `Date` and `Time`; there are " +
                                             names + ": say `time: COLUMN` in the script");
    }
  }
  if (column_ && table.n_rows() > 0) is_clock_ = clock_from(text(0)).has_value();
}

std::string TimeColumn::text(std::size_t row) const {
  return (date_ ? table_.text(row, *date_) + 'T' : std::string()) + table_.text(row, *column_);
}

std::optional<double> TimeColumn::seconds(std::size_t row, Diagnostics& faults) const {
  if (is_clock_) {
    if (const auto moment = clock_from(text(row))) return static_cast<double>(moment->begin_s);
    faults.error(where(row), "expected a local date and time, e.g. 2026-03-02T07:00:00, got '" + text(row) + "'");
    return std::nullopt;
  }
  constexpr double farthest_s = 1e10;  // 300 years
  Diagnostics found;
  const auto number = date_ ? std::nullopt : table_.number(row, *column_, found);
  if (number && std::abs(*number) <= farthest_s) return number;
  faults.error(where(row),
               "expected seconds, or a local date and time, e.g. 2026-03-02T07:00:00, got '" + text(row) + "'");
  return std::nullopt;
}

}  // namespace pirsim::io
