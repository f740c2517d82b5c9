// Windows of a log as rows.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "files/read/row_reader.hpp"
#include "pirsim/control.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {

/// CSV in pieces: time_s and time of a window's end, people if the log has a count, a column a sensor; what isn't known
/// is empty. time_s counts from the first window's begin, or as the log does.
void write_log_rows(const LogWindows& windows, const std::function<void(std::string_view)>& write);

}  // namespace pirsim::io

// Rows from wherever they are: runs, datasets, logs.

namespace pirsim::control {

/// What rows have, before the first of them is given.
struct RowsAbout {
  ColumnOwners columns;
  double window_s = 0.0;
  People people = People::known;
};

/// Gets each row, and the day that it belongs to, or no text.
using TakeRow = std::function<void(const Sample& row, std::string_view day)>;

/// Tables of runs, in order; a folder is a dataset, all of its days. Each is opened once. Throws Error: io, input.
class RowFiles {
 public:
  explicit RowFiles(std::span<const std::filesystem::path> paths);
  [[nodiscard]] const RowsAbout& about() const noexcept { return about_; }
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const noexcept { return files_; }
  /// Once. Where rows are missing in a run, rows of which nothing is known; returns how many. begin: before the first
  /// row of each file.
  std::int64_t each(const TakeRow& take, const std::function<void()>& begin);

 private:
  std::vector<std::filesystem::path> files_;
  std::unique_ptr<io::RowReader> first_;
  RowsAbout about_;
};

/// A log in windows; the log outlives it. window_s: none: its readings' interval, or a second of events.
class LogSamples {
 public:
  LogSamples(const Log& log, std::optional<double> window_s);
  [[nodiscard]] const RowsAbout& about() const noexcept { return about_; }
  /// As RowFiles; returns 0: what is missing a log tells itself.
  std::int64_t each(const TakeRow& take, const std::function<void()>& begin) const;

 private:
  const Log& log_;
  RowsAbout about_;
};

}  // namespace pirsim::control
