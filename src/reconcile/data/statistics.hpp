// A dataset in numbers: the same numbers of measured and of simulated data.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reconcile/data/alignment.hpp"
#include "stats/matrix.hpp"

namespace pirsim::reconcile {

/// What the base model expects, row by row, and where and when people move.
struct Profile {
  struct Trial {
    std::size_t n_main = 0;
    std::vector<float> expected;     ///< (n_main x n_sensors) share of simulated datasets with motion
    std::vector<float> lead, tail;   ///< the same, of rows before the main part, the last one first, and after it
    std::vector<std::uint8_t> busy;  ///< (n_main) among the rows with most expected motion
    std::vector<float> movement;     ///< (n_main) expected motion of all sensors, less its mean
    double cycle_rows = 3.0;         ///< period of desk work
  };
  std::vector<Trial> trials;
};
/// runs: simulated by the base model in many realizations.
[[nodiscard]] Profile profile_of(const StudyFrame& frame, const ScriptSpec& script, std::span<const Series> runs);

/// Per cell (trial x sensor), over the main part unless it says otherwise; mean over a cell's runs.
enum class CellStatistic : std::uint8_t {
  seconds,          ///< with motion
  busy_seconds,     ///< of them, in rows where much motion is expected: changes of posture
  silent_seconds,   ///< in rows where this sensor is expected to be silent
  half_difference,  ///< first half less second half
  onsets,           ///< motion after none
  longest_run,      ///< rows with motion in a row
  isolated,         ///< single rows with motion
  single_gaps,      ///< single rows without
  double_gaps,      ///< two rows without
  again_after_1,    ///< share of the rows with motion that are followed by motion so many rows later
  again_after_2,
  again_after_3,
  again_after_4,
  again_after_6,
  longest_gap,
  dispersion,         ///< of the counts in blocks of ten rows, against chance
  period_power,       ///< greatest of the periodogram, periods of 8 rows and more, against chance
  cycle_strength,     ///< how much motion keeps to one phase of the arm's cycle, 0 to 1
  agreement,          ///< correlation with what the base model expects row by row
  lead_seconds,       ///< before the main part
  tail_seconds,       ///< after it
  late_tail_seconds,  ///< in the second half of that
  run_variance,       ///< of the seconds, from run to run
  sixth_1,            ///< seconds in the first sixth of the time
  sixth_6 = sixth_1 + 5,
  shift_s,  ///< by which motion comes later than expected, or earlier; 0 where it isn't like what is expected
  count
};
/// Per trial, over all sensors.
enum class TrialStatistic : std::uint8_t {
  lag_minus_4,  ///< covariance of motion and expected motion so many rows earlier
  lag_minus_2,
  lag_minus_1,
  lag_0,
  lag_1,
  lag_2,
  lag_3,
  lag_5,
  lag_8,
  lag_11,
  lag_15,
  any_active,  ///< rows with motion of at least one sensor
  two_active,
  three_active,
  coactivation,  ///< variance of the number of active sensors, against independent ones
  // Where nearly all simulated datasets have motion, in the whole run: who lacks it.
  joint_loss,       ///< covariance of two sensors' losses, mean over pairs
  loss_in_company,  ///< share lost where another sensor is sure to move, less that where none is likely to
  slice_1,          ///< seconds of all sensors in the first of eighteen parts of the time
  slice_18 = slice_1 + 17,
  count
};
inline constexpr std::size_t n_cell_statistics = static_cast<std::size_t>(CellStatistic::count);
inline constexpr std::size_t n_trial_statistics = static_cast<std::size_t>(TrialStatistic::count);
/// Of those that are told as they are, not of parts of the time.
[[nodiscard]] std::string name(CellStatistic statistic);
[[nodiscard]] std::string name(TrialStatistic statistic);

/// Ordered pairs of different sensors.
[[nodiscard]] inline std::size_t n_pairs(const StudyFrame& frame) noexcept {
  return frame.sensors.size() * (frame.sensors.size() - 1);
}
/// How many numbers one dataset has.
[[nodiscard]] std::size_t n_statistics(const StudyFrame& frame) noexcept;

/// A number for every statistic of a dataset, in blocks: of each cell, of each trial over all its sensors, and of each
/// ordered pair of sensors in a trial, that is the rows in which the second one has motion and the first one has none,
/// mean over runs. Values: a vector that keeps the numbers, or a span of those that somebody else keeps, as a row of a
/// table. A statistic of a dataset is NaN where the shape knows nothing; of sums there is CellStatistic::seconds alone.
template <typename Values>
class Statistics {
 public:
  Statistics() = default;
  /// values: (n_statistics)
  Statistics(const StudyFrame& frame, Values values)
      : n_trials_(frame.trials.size()), n_sensors_(frame.sensors.size()), values_(std::move(values)) {}

  [[nodiscard]] auto& cell(std::size_t trial, std::size_t sensor, CellStatistic statistic) const noexcept {
    return values_[(trial * n_sensors_ + sensor) * n_cell_statistics + static_cast<std::size_t>(statistic)];
  }
  /// (n_sensors x n_cell_statistics)
  [[nodiscard]] auto cells(std::size_t trial) const noexcept {
    const std::size_t n = n_sensors_ * n_cell_statistics;
    return std::span(values_).subspan(trial * n, n);
  }
  [[nodiscard]] auto& trial(std::size_t trial, TrialStatistic statistic) const noexcept {
    return values_[before_trials() + trial * n_trial_statistics + static_cast<std::size_t>(statistic)];
  }
  /// first != second.
  [[nodiscard]] auto& pair(std::size_t trial, std::size_t first, std::size_t second) const noexcept {
    return pairs(trial)[first * (n_sensors_ - 1) + (second < first ? second : second - 1)];
  }
  /// (n_pairs) by the first sensor, then the second.
  [[nodiscard]] auto pairs(std::size_t trial) const noexcept {
    const std::size_t n = n_sensors_ * (n_sensors_ - 1);
    return std::span(values_).subspan(before_trials() + n_trials_ * n_trial_statistics + trial * n, n);
  }
  [[nodiscard]] const Values& values() const noexcept { return values_; }

 private:
  [[nodiscard]] std::size_t before_trials() const noexcept { return n_trials_ * n_sensors_ * n_cell_statistics; }
  std::size_t n_trials_ = 0, n_sensors_ = 0;
  Values values_;  ///< cells, trials, pairs
};
/// The statistics of one dataset.
using DatasetStatistics = Statistics<std::span<const float>>;

/// Seconds with motion of a cell; NaN if they aren't known.
[[nodiscard]] double seconds_of(const DatasetStatistics& dataset, std::size_t trial, std::size_t sensor);
/// Those of all datasets (n x n_statistics) that have them: a counted phase may not come in some.
[[nodiscard]] std::vector<double> seconds_of(const StudyFrame& frame, const stats::Matrix<float>& datasets,
                                             std::size_t trial, std::size_t sensor);

/// Places among a dataset's statistics that hold the same one: of all cells, of all trials, of a pair in all trials.
[[nodiscard]] std::vector<std::vector<std::size_t>> alike_places(const StudyFrame& frame);

/// (n_statistics) of simulated or measured series; runs that the shape doesn't have are left out.
[[nodiscard]] std::vector<float> statistics_of(const StudyFrame& frame, const DataShape& shape, const Profile& profile,
                                               std::span<const Series> runs);
/// (n_statistics) of measured data of either kind.
[[nodiscard]] std::vector<float> statistics_of(const StudyFrame& frame, const DataShape& shape, const Profile& profile,
                                               const Measured& measured);

// Statistics of one sensor's bits in one run. Private to reconcile.

/// One sensor's main part with what is expected of it: (n_main) each, bits 0, 1 or unknown_bit.
struct BitSeries {
  std::span<const std::uint8_t> bits;
  std::span<const float> expected;
  std::span<const std::uint8_t> busy;
  double cycle_rows = 3.0;
};

/// A number for every statistic of one cell.
struct CellValues {
  std::array<double, n_cell_statistics> values{};
  [[nodiscard]] double& operator[](CellStatistic s) noexcept { return values[static_cast<std::size_t>(s)]; }
  [[nodiscard]] double operator[](CellStatistic s) const noexcept { return values[static_cast<std::size_t>(s)]; }
};

/// Those of the main part; the others stay as they are.
void add_main_statistics(const BitSeries& series, double window_s, CellValues& values);

/// Rows in which sensors are nearly sure to move: what they lose in company and alone.
class SureRows {
 public:
  explicit SureRows(std::size_t n_sensors);
  /// expected, bits: (n_sensors) of one row; an unknown bit tells nothing.
  void add(std::span<const float> expected, std::span<const std::uint8_t> bits);
  [[nodiscard]] double joint_loss() const;       ///< 0 where no two sensors are sure together
  [[nodiscard]] double loss_in_company() const;  ///< 0 where no sensor is sure in company, or none alone

 private:
  struct Pair {
    double rows = 0.0, first_lost = 0.0, second_lost = 0.0, both_lost = 0.0;
  };
  struct Share {
    double rows = 0.0, lost = 0.0;
  };
  std::size_t n_sensors_;
  std::vector<Pair> pairs_;  ///< (n_sensors x n_sensors) the first below the second
  Share company_, alone_;
};

// How closely two numbers go together. Private to reconcile.

/// Pearson's coefficient of pairs that come one by one.
class Correlation {
 public:
  void add(double a, double b) noexcept {
    n_ += 1.0;
    a_ += a;
    b_ += b;
    aa_ += a * a;
    bb_ += b * b;
    ab_ += a * b;
  }
  /// 0 if one of the two doesn't vary.
  [[nodiscard]] double value() const {
    const double variance = (n_ * aa_ - a_ * a_) * (n_ * bb_ - b_ * b_);
    return variance > 1e-9 ? (n_ * ab_ - a_ * b_) / std::sqrt(variance) : 0.0;
  }

 private:
  double n_ = 0.0, a_ = 0.0, b_ = 0.0, aa_ = 0.0, bb_ = 0.0, ab_ = 0.0;
};

}  // namespace pirsim::reconcile
