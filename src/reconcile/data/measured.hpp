// What was measured in the real room, checked against the study that it is compared with.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/sample.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim::reconcile {

/// The names and times that measured and simulated data share.
struct StudyFrame {
  std::vector<std::string> trials;
  std::vector<std::string> sensors;
  std::vector<std::string> counted_phases;  ///< whose rows are compared in time; empty: all rows
  double window_s = 1.0;

  [[nodiscard]] std::size_t n_cells() const noexcept { return trials.size() * sensors.size(); }
  bool operator==(const StudyFrame&) const = default;
};
[[nodiscard]] StudyFrame frame_of(const SceneSpec& scene, const ScriptSpec& script);
/// Every trial of a study, by index.
[[nodiscard]] std::vector<std::size_t> all_trials(const StudyFrame& frame);

inline constexpr std::uint8_t unknown_bit = 2;

/// The rows of one run of one trial, one after the other without a gap. The main part, which is compared in time, goes
/// from the first to the last row in a counted phase.
struct Series {
  std::size_t trial = 0;  ///< index into StudyFrame::trials
  int replicate = 1;
  std::size_t main_begin = 0, main_end = 0;  ///< rows
  std::vector<std::uint8_t> bits;            ///< (n_rows x n_sensors) 0, 1 or unknown_bit

  [[nodiscard]] std::size_t n_rows(std::size_t n_sensors) const noexcept { return bits.size() / n_sensors; }
  bool operator==(const Series&) const = default;
};

/// None if the trial isn't in the study or no row lies in a counted phase.
[[nodiscard]] std::optional<Series> series_of(const StudyFrame& frame, int replicate, std::string_view trial,
                                              const std::vector<Sample>& samples);

struct Measured {
  enum class Kind {
    series,  ///< a bit a window
    sums     ///< seconds with motion in the counted phases only
  };
  /// Seconds of one cell in one repetition.
  struct Sum {
    std::size_t trial = 0, sensor = 0;
    int replicate = 1;
    double seconds = 0.0;
  };
  Kind kind = Kind::series;
  std::vector<Series> runs;        ///< of series: by trial, then replicate, numbered from 1 in every trial
  std::vector<Sum> sums;           ///< of sums; cells that aren't there weren't measured
  std::vector<std::string> notes;  ///< sentences: what was done with which rows
  std::string file;                ///< its name, for messages
  std::string digest;              ///< SHA-256 of the file
  bool tells_phases = true;        ///< or all rows are taken for the counted ones

  [[nodiscard]] int n_replicates() const noexcept;        ///< the greatest number of runs of a trial
  [[nodiscard]] std::vector<std::size_t> trials() const;  ///< ascending; of which anything was measured
};

/// Reads pirsim's own rows (docs/formats/rows.md), or sums with the columns trial (or seat), sensor, seconds (or real)
/// and, if it is there, replicate. Empty fields are missing values. Throws Error: io (no such file), input (all faults
/// with file:line:column: unknown names, other values than 0 and 1, rows that aren't a window apart, too little data).
[[nodiscard]] Measured read_measured(const std::filesystem::path& file, const StudyFrame& frame);
[[nodiscard]] Measured parse_measured(std::string_view text, const std::string& file, const StudyFrame& frame);

}  // namespace pirsim::reconcile
