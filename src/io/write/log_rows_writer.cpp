#include "io/write/log_rows_writer.hpp"

#include <algorithm>
#include <string>

#include "pirsim/csv.hpp"

namespace pirsim::io {
namespace {

/// Where a window ends, by the offset at its begin: windows end where the next one begins.
LogMoment end_of(const LogRows& rows, std::size_t window, const LogMoment& next) {
  if (window + 1 < rows.n_windows()) return rows.begin[window + 1];
  return next;
}

std::string header_of(const LogRows& rows, LogClock clock) {
  std::string line = "time_s";
  if (clock != LogClock::elapsed) line += ",time";
  if (!rows.people.empty()) line += ",people";
  for (const std::string& sensor : rows.sensors) line += ',' + csv_field(sensor);
  return line + '\n';
}

}  // namespace

void write_log_rows(const LogWindows& windows, const std::function<void(std::string_view)>& write) {
  constexpr std::size_t at_once = 4096;
  std::string text;
  double zero_s = 0.0;
  for (std::size_t first = 0; first < windows.size(); first += at_once) {
    LogRows rows = windows.rows(first, std::min(at_once, windows.size() - first));
    const bool has_clock = rows.clock != LogClock::elapsed;
    if (first == 0) {
      zero_s = has_clock ? rows.begin.front().seconds() : 0.0;
      text = header_of(rows, rows.clock);
    }
    const LogMoment after = windows.begin(first + rows.n_windows());
    for (std::size_t i = 0; i < rows.n_windows(); ++i) {
      const LogMoment end = end_of(rows, i, after);
      text += csv_number(static_cast<double>(end.us) / 1e6 - zero_s);
      if (has_clock) text += ',' + to_text(end, rows.clock);
      if (!rows.people.empty()) {
        text += ',';
        if (rows.people[i] != log_state::unknown_count) text += std::to_string(rows.people[i]);
      }
      for (std::size_t sensor = 0; sensor < rows.sensors.size(); ++sensor) {
        const std::uint8_t state = rows.at(i, sensor);
        text += state == log_state::unknown ? "," : state == log_state::on ? ",1" : ",0";
      }
      text += '\n';
    }
    write(text);
    text.clear();
  }
}

}  // namespace pirsim::io
