// Rows from wherever they are: runs, datasets, logs.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "pirsim/control.hpp"
#include "pirsim/log.hpp"

namespace pirsim::control {

/// What rows have, before the first of them is given.
struct RowsAbout {
  ColumnOwners columns;
  double window_s = 0.0;
  People people = People::known;
};

/// Gets each row, and the day that it belongs to, or no text.
using TakeRow = std::function<void(const Sample& row, std::string_view day)>;

/// Tables of runs, in order; a folder is a dataset, all of its days. Throws Error: io, input.
class RowFiles {
 public:
  explicit RowFiles(std::span<const std::filesystem::path> paths);
  [[nodiscard]] const RowsAbout& about() const noexcept { return about_; }
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const noexcept { return files_; }
  void each(const TakeRow& take) const;

 private:
  std::vector<std::filesystem::path> files_;
  RowsAbout about_;
};

/// A log in windows; the log outlives it. window_s: none: its readings' interval, or a second of events.
class LogSamples {
 public:
  LogSamples(const Log& log, std::optional<double> window_s);
  [[nodiscard]] const RowsAbout& about() const noexcept { return about_; }
  void each(const TakeRow& take) const;

 private:
  const Log& log_;
  RowsAbout about_;
};

}  // namespace pirsim::control
