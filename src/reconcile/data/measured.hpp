// The names and times of a study, and what was measured in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/reconcile.hpp"
#include "pirsim/sample.hpp"
#include "reconcile/data/units.hpp"

namespace pirsim::reconcile {

/// The names and times that measured and simulated data share.
struct StudyFrame {
  std::vector<std::string> trials;
  std::vector<std::string> sensors;
  std::vector<std::string> counted_phases;  ///< whose rows are compared in time; empty: all rows
  double window_s = 1.0;
  Units units{};  ///< where the trials above are parts of days; else empty

  /// Runs of every trial that make one dataset.
  [[nodiscard]] int n_days() const noexcept { return units.empty() ? 1 : static_cast<int>(units.n_days); }
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

/// Whole runs (days 1, 2, ... of each dataset, by their replicates) in the frame's units, if it has any. A unit's rows
/// are those of all days, one after the other; an unknown row stands where they don't follow each other.
[[nodiscard]] std::vector<Series> in_units(const StudyFrame& frame, std::vector<Series> runs);

/// As pirsim/reconcile.hpp has them, for a study whose names and times are known.
[[nodiscard]] Measured read_measured(const std::filesystem::path& file, const StudyFrame& frame);
[[nodiscard]] Measured parse_measured(std::string_view text, const std::string& file, const StudyFrame& frame);

}  // namespace pirsim::reconcile
