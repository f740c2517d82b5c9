#include "control/row_source.hpp"

#include <algorithm>

#include "control/row_file.hpp"

namespace pirsim::control {
namespace {

namespace fs = std::filesystem;

bool is_table(const fs::path& file) {
  return std::ranges::any_of(io::table_endings(),
                             [&](const std::string& ending) { return file.string().ends_with(ending); });
}

/// Of a dataset: those below `rows`.
std::vector<fs::path> tables_in(const fs::path& folder) {
  std::vector<fs::path> files;
  const fs::path rows = folder / "rows";
  if (fs::is_directory(rows)) {
    for (const auto& entry : fs::recursive_directory_iterator(rows)) {
      if (entry.is_regular_file() && is_table(entry.path())) files.push_back(entry.path());
    }
  }
  if (files.empty())
    throw Error(ErrorCode::input, {folder.string()}, "no dataset: there are no tables in its folder `rows`");
  std::ranges::sort(files);
  return files;
}

bool same(const ColumnOwners& a, const ColumnOwners& b) {
  return a.sensors == b.sensors && a.areas == b.areas && a.doors == b.doors;
}

}  // namespace

RowFiles::RowFiles(std::span<const fs::path> paths) {
  for (const fs::path& path : paths) {
    if (!fs::is_directory(path)) {
      files_.push_back(path);
      continue;
    }
    const std::vector<fs::path> tables = tables_in(path);
    files_.insert(files_.end(), tables.begin(), tables.end());
  }
  RowFile first(files_.front());
  about_.columns = first.columns();
  about_.people = first.people();
  Sample row, next;
  if (!first.next(row)) throw Error(ErrorCode::input, {files_.front().string()}, "there are no rows");
  // The first row ends a window after the run began, if it is a run's first one.
  about_.window_s = row.time_s;
  if (first.next(next) && next.time_s > row.time_s) about_.window_s = next.time_s - row.time_s;
}

void RowFiles::each(const TakeRow& take) const {
  Sample row;
  for (const fs::path& path : files_) {
    RowFile file(path);
    if (!same(file.columns(), about_.columns)) {
      throw Error(ErrorCode::input, {path.string()},
                  "its sensors, areas or doors aren't those of " + files_.front().string());
    }
    while (file.next(row)) take(row, {});
  }
}

LogSamples::LogSamples(const Log& log, std::optional<double> window_s) : log_(log) {
  for (const LogTrack& track : log.sensors) about_.columns.sensors.push_back(track.name);
  about_.window_s = window_s.value_or(log.has_readings() ? static_cast<double>(log.interval_us) * 1e-6 : 1.0);
  about_.people = log.people ? People::known : People::unknown;
}

void LogSamples::each(const TakeRow& take) const {
  constexpr std::size_t at_once = 100'000, to_seconds = 19, to_date = 10;
  const LogWindows windows(log_, about_.window_s);
  Sample row;
  row.replicate = 1;
  for (std::size_t first = 0; first < windows.size(); first += at_once) {
    const LogRows rows = windows.rows(first, at_once);
    for (std::size_t i = 0; i < rows.n_windows(); ++i) {
      const auto begin = rows.motion.begin() + static_cast<std::ptrdiff_t>(i * rows.sensors.size());
      row.bits.assign(begin, begin + static_cast<std::ptrdiff_t>(rows.sensors.size()));
      row.people = rows.people.empty() ? -1 : rows.people[i];
      row.time_s = static_cast<double>(first + i + 1) * about_.window_s;
      if (rows.clock == LogClock::elapsed) {
        take(row, {});
        continue;
      }
      row.clock = to_text(windows.begin(first + i + 1), rows.clock).substr(0, to_seconds);
      take(row, to_text(rows.begin[i], rows.clock).substr(0, to_date));
    }
  }
}

}  // namespace pirsim::control
