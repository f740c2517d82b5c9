#include "io/write/log_rows_writer.hpp"

#include <algorithm>
#include <sstream>
#include <string>

#include "pirsim/csv.hpp"

namespace pirsim::io {
namespace {

std::vector<std::string> columns_of_log(const LogRows& rows) {
  std::vector<std::string> names{"time_s"};
  if (rows.clock != LogClock::elapsed) names.emplace_back("time");
  if (!rows.people.empty()) names.emplace_back("people");
  names.insert(names.end(), rows.sensors.begin(), rows.sensors.end());
  return names;
}

}  // namespace

void write_log_rows(const LogWindows& windows, const std::function<void(std::string_view)>& write) {
  constexpr std::size_t at_once = 4096;
  std::ostringstream text;
  std::optional<CsvWriter> table;
  double zero_s = 0.0;
  Sample row;
  for (std::size_t first = 0; first < windows.size(); first += at_once) {
    const LogRows rows = windows.rows(first, std::min(at_once, windows.size() - first));
    const bool has_clock = rows.clock != LogClock::elapsed;
    if (!table) {
      zero_s = has_clock ? rows.begin.front().seconds() : 0.0;
      table.emplace(text, columns_of_log(rows));
    }
    const LogMoment after = windows.begin(first + rows.n_windows());
    for (std::size_t i = 0; i < rows.n_windows(); ++i) {
      // Windows end where the next one begins, by the offset there.
      const LogMoment& end = i + 1 < rows.n_windows() ? rows.begin[i + 1] : after;
      row.time_s = static_cast<double>(end.us) / 1e6 - zero_s;
      row.clock = to_text(end, rows.clock);
      row.people = rows.people.empty() ? log_state::unknown_count : rows.people[i];
      const auto bits = rows.motion.begin() + static_cast<std::ptrdiff_t>(i * rows.sensors.size());
      row.bits.assign(bits, bits + static_cast<std::ptrdiff_t>(rows.sensors.size()));
      table->write(row);
    }
    write(text.view());
    text.str({});
  }
}

}  // namespace pirsim::io
