#include "logs/log_rows.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "files/disk/compression.hpp"
#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
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

/// Its bits and people.
void take_window(const LogRows& rows, std::size_t window, Sample& row) {
  row.people = rows.people.empty() ? log_state::unknown_count : rows.people[window];
  row.bits.resize(rows.sensors.size());
  for (std::size_t i = 0; i < row.bits.size(); ++i) row.bits[i] = rows.at(window, i);
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
    for (std::size_t i = 0; i < rows.n_windows(); ++i) {
      const LogMoment end = windows.begin(first + i + 1);
      row.time_s = static_cast<double>(end.us) / 1e6 - zero_s;
      row.clock = to_text(end, rows.clock);
      take_window(rows, i, row);
      table->write(row);
    }
    write(text.view());
    text.str({});
  }
}

}  // namespace pirsim::io

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
  std::error_code none;  // of a link that leads nowhere, a folder that may not be read
  for (const auto& entry : fs::recursive_directory_iterator(folder / "rows", none)) {
    if (entry.is_regular_file(none) && is_table(entry.path())) files.push_back(entry.path());
  }
  if (files.empty())
    throw Error(ErrorCode::input, {folder.string()}, "no dataset: there are no tables in its folder `rows`");
  std::ranges::sort(files);
  return files;
}

bool same(const ColumnOwners& a, const ColumnOwners& b) {
  return a.sensors == b.sensors && a.areas == b.areas && a.doors == b.doors;
}

/// Rows of a log, which are of no run: their days are dates.
bool tells_dates_alone(const io::RowFormat& format) {
  using Format = io::RowFormat;
  const auto runs = {Format::replicate, Format::room, Format::trial, Format::day};
  return format.has(Format::time) && std::ranges::none_of(runs, [&](auto column) { return format.has(column); });
}

std::string date_of_begin(const Sample& row, double window_s) {
  constexpr std::size_t to_date = 10;
  const auto end = clock_from(row.clock);
  return end ? end->text(-window_s).substr(0, to_date) : std::string();
}

}  // namespace

RowFiles::RowFiles(std::span<const fs::path> paths) {
  std::error_code unknown;  // of pipes nothing is known
  for (const fs::path& path : paths) {
    if (!fs::is_directory(path, unknown)) {
      files_.push_back(path);
      continue;
    }
    const std::vector<fs::path> tables = tables_in(path);
    files_.insert(files_.end(), tables.begin(), tables.end());
  }
  for (auto file = files_.begin(); file != files_.end(); ++file) {
    const auto is_it = [&](const fs::path& other) {
      return fs::is_regular_file(other, unknown) && fs::equivalent(*file, other, unknown);
    };
    if (std::find_if(files_.begin(), file, is_it) != file)
      throw Error(ErrorCode::usage, "'" + file->string() + "' is given twice");
  }
  first_ = std::make_unique<io::RowReader>(files_.front());
  about_.columns = first_->format().columns();
  about_.people = first_->format().has(io::RowFormat::people) ? People::known : People::unknown;
  about_.window_s = first_->step_s();
  if (about_.window_s > 0.0) return;
  Sample faulty;
  static_cast<void>(first_->next(faulty));  // says what is wrong with rows of which none can be read
  throw Error(ErrorCode::input, {files_.front().string()}, "there are no rows");
}

std::int64_t RowFiles::each(const TakeRow& take, const std::function<void()>& begin) {
  std::int64_t n_missing = 0;
  Sample row;
  std::optional<double> told_to_s;  // of a log, whose parts are given in order
  for (const fs::path& path : files_) {
    const std::unique_ptr<io::RowReader> file = first_ ? std::move(first_) : std::make_unique<io::RowReader>(path);
    const auto refuse = [&](const std::string& why) { throw Error(ErrorCode::input, {path.string()}, why); };
    if (!same(file->format().columns(), about_.columns))
      refuse("its sensors, areas or doors aren't those of " + files_.front().string());
    if (file->format().has(io::RowFormat::people) != (about_.people == People::known))
      refuse("only one of it and " + files_.front().string() + " has a column 'people'");
    if (file->step_s() > 0.0 && std::abs(file->step_s() - about_.window_s) > 1e-6) {
      refuse("its rows are " + shortest_number(file->step_s()) + " s apart, those of " + files_.front().string() + " " +
             shortest_number(about_.window_s) + " s: give rows of one length");
    }
    begin();
    const bool is_log = tells_dates_alone(file->format());
    for (bool is_first = true; file->next_of_all(row); is_first = false) {
      if (is_log) {
        const auto end_s = static_cast<double>(clock_from(row.clock)->begin_s);
        if (is_first && told_to_s && end_s - about_.window_s < *told_to_s)
          refuse("it begins before the file given before it ends: give each part of a log once, in order of time");
        told_to_s = end_s;
      }
      take(row, is_log ? date_of_begin(row, about_.window_s) : std::string());
      n_missing += file->is_filled() ? 1 : 0;
    }
  }
  return n_missing;
}

LogSamples::LogSamples(const Log& log, std::optional<double> window_s) : log_(log) {
  for (const LogTrack& track : log.sensors) about_.columns.sensors.push_back(track.name);
  about_.window_s = window_s.value_or(log.has_readings() ? static_cast<double>(log.interval_us) * 1e-6 : 1.0);
  about_.people = log.people ? People::known : People::unknown;
}

std::int64_t LogSamples::each(const TakeRow& take, const std::function<void()>& /*begin*/) const {
  constexpr std::size_t at_once = 100'000, to_seconds = 19, to_date = 10;
  const LogWindows windows(log_, about_.window_s);
  Sample row;
  row.replicate = 1;
  for (std::size_t first = 0; first < windows.size(); first += at_once) {
    const LogRows rows = windows.rows(first, at_once);
    for (std::size_t i = 0; i < rows.n_windows(); ++i) {
      io::take_window(rows, i, row);
      row.time_s = static_cast<double>(first + i + 1) * about_.window_s;
      if (rows.clock == LogClock::elapsed) {
        take(row, {});
        continue;
      }
      row.clock = to_text(windows.begin(first + i + 1), rows.clock).substr(0, to_seconds);
      take(row, to_text(rows.begin[i], rows.clock).substr(0, to_date));
    }
  }
  return 0;
}

}  // namespace pirsim::control
