// Days that nobody scripted, in the parts that are compared: what a trial is where people do the same thing on purpose.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/schema/clock.hpp"
#include "pirsim/reconcile.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/script.hpp"

namespace pirsim::reconcile {

/// Which rows of a study's runs are compared together: those of one stretch of the data in which so many people are
/// there, or in which somebody may come or go. Presence is what data and simulation have in common there, so that
/// nobody who came unexpectedly is taken for a fault of a sensor.
struct DayParts {
  static constexpr std::uint16_t none = 0xFFFF;
  static constexpr std::int32_t not_sure = -1;

  std::string trial;                     ///< of the script: the only one
  std::size_t n_days = 0;                ///< runs that make one dataset; 0: runs are compared as a whole
  std::size_t n_rows = 0;                ///< of a run
  std::vector<std::uint16_t> of_row;     ///< (n_days x n_rows) a part, or none
  std::vector<std::int32_t> people;      ///< (n_days x n_rows) there all the time, or not_sure
  std::vector<std::string> names;        ///< (n_parts)
  std::vector<std::int64_t> begins_s{};  ///< (n_days) of the clock, since 1970; empty without a clock

  [[nodiscard]] bool empty() const noexcept { return n_days == 0; }
  bool operator==(const DayParts&) const = default;
};

/// Of a study whose only trial has an occupancy; empty for any other.
[[nodiscard]] DayParts day_parts_of(const ScriptSpec& script);

/// Throws Error(input) for a script that draws who is there, as a schedule does: no data tell its days from others.
void require_known_presence(const ScriptSpec& script);

// The names and times of a study, and what was measured in it.

/// The names and times that measured and simulated data share.
struct StudyFrame {
  std::vector<std::string> trials;
  std::vector<std::string> sensors;
  std::vector<std::string> counted_phases;  ///< whose rows are compared in time; empty: all rows
  double window_s = 1.0;
  DayParts day_parts{};  ///< where the trials above are parts of days; else empty

  /// Runs of every trial that make one dataset.
  [[nodiscard]] int n_days() const noexcept { return day_parts.empty() ? 1 : static_cast<int>(day_parts.n_days); }
  /// Of the script's trials, as whole runs have them.
  [[nodiscard]] StudyFrame of_whole_runs() const;
  [[nodiscard]] std::size_t n_cells() const noexcept { return trials.size() * sensors.size(); }
  /// Its place among the cells: by trial, then sensor.
  [[nodiscard]] std::size_t cell(std::size_t trial, std::size_t sensor) const noexcept {
    return trial * sensors.size() + sensor;
  }
  bool operator==(const StudyFrame&) const = default;
};
[[nodiscard]] StudyFrame frame_of(const SceneSpec& scene, const ScriptSpec& script);
/// Every trial of a study, by index.
[[nodiscard]] std::vector<std::size_t> all_trials(const StudyFrame& frame);

/// None if the trial isn't in the study or no row lies in a counted phase.
[[nodiscard]] std::optional<Series> series_of(const StudyFrame& frame, int replicate, std::string_view trial,
                                              const std::vector<Sample>& samples);

/// Whole runs (days 1, 2, ... of each dataset, by their replicates) in the frame's parts of days, if it has any. A
/// part's rows are those of all days, one after the other; an unknown row stands where they don't follow each other.
[[nodiscard]] std::vector<Series> in_day_parts(const StudyFrame& frame, std::vector<Series> runs);

/// Whether a file is a log rather than pirsim's own rows or sums: its first line has times and neither `time_s` nor
/// sums, or it is a database. Pipes are read once, by whoever parses rows: they are none.
[[nodiscard]] bool is_log(const std::filesystem::path& file);
/// As pirsim/reconcile.hpp has it, for a study whose names and times are known.
[[nodiscard]] Measured parse_measured(std::string_view text, const std::string& file, const StudyFrame& frame);

}  // namespace pirsim::reconcile
