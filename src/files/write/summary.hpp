// A study's counts against measured ones: per cell (trial x sensor) and over all cells, and how well they predict them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/read/csv_reader.hpp"
#include "model/core/range.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/script.hpp"

namespace pirsim::studies {

/// Continuous ranked probability score of an ensemble of whole numbers (at least one): mean |x - y| - 1/2 mean |x -
/// x'|, over all pairs of members, each with itself too. 0 is perfect. In the unit of the values. Ref: [Gneiting2007]
/// equation 21.
[[nodiscard]] double crps(const Tally& ensemble, double observed);

/// One sensor in one trial, over all runs.
struct CellSummary {
  std::string trial;
  std::string sensor;
  Tally counts;  ///< of all runs: windows with motion
  std::int64_t runs = 0;
  int min = 0;  ///< of the counts; all three are 0 without a run
  int max = 0;
  double mean = 0.0;
  std::optional<MeasuredCell> measured;
  std::optional<bool> inside;  ///< min <= real <= max
  std::optional<double> crps;  ///< in counts; see crps()
};

/// What the count of cells inside their range hides.
struct OverallSummary {
  int cells = 0;                     ///< with a measured and a simulated count
  int inside = 0;                    ///< whose measured count lies in the simulated range
  double shuffled_inside = 0.0;      ///< expected `inside` when the measured counts are dealt to the cells at random
  double shuffled_inside_sd = 0.0;   ///< its standard deviation
  double real_total = 0.0;           ///< sum of the measured counts
  double simulated_total = 0.0;      ///< sum of the simulated means
  double bias = 0.0;                 ///< mean of simulated mean - measured count
  double mean_absolute_error = 0.0;  ///< of the simulated means
  std::optional<double> mean_crps;   ///< none where only ranges are known
};

/// People of one area, over the counted rows of some runs.
struct AreaSums {
  std::string area;
  std::int64_t rows = 0, occupied = 0;  ///< occupied: with somebody there
  std::int64_t person_rows = 0;         ///< of all people
  int most = 0;                         ///< at once

  void add(int people);
  void add(const AreaSums& other);
};

/// Collects the runs' counts, in memory that doesn't grow with their number. Cells are in the order of trials, then
/// sensors.
class Summary {
 public:
  /// measured: cells of other trials or sensors are left out.
  Summary(std::vector<std::string> trials, std::vector<std::string> sensors, std::vector<MeasuredCell> measured = {});

  /// counts: (n_sensors) windows with motion of one run. areas: the same for all runs. Throws Error(usage) for a trial
  /// that isn't in the study.
  void add_run(std::string_view trial, std::span<const int> counts, std::span<const AreaSums> areas = {});

  [[nodiscard]] std::vector<CellSummary> cells() const;
  [[nodiscard]] OverallSummary overall() const;
  /// The figures of the published simulation, from its ranges and means; none if the measured cells have none.
  [[nodiscard]] std::optional<OverallSummary> published() const;
  /// Over all trials; empty without areas.
  [[nodiscard]] const std::vector<AreaSums>& areas() const noexcept { return areas_; }
  [[nodiscard]] std::int64_t runs() const noexcept { return runs_; }
  [[nodiscard]] const std::vector<std::string>& trials() const noexcept { return trials_; }
  [[nodiscard]] const std::vector<std::string>& sensors() const noexcept { return sensors_; }

 private:
  std::vector<std::string> trials_, sensors_;
  std::vector<Tally> counts_;                          ///< (n_cells)
  std::vector<std::optional<MeasuredCell>> measured_;  ///< (n_cells)
  std::vector<AreaSums> areas_;
  std::int64_t runs_ = 0;
};

/// Per sensor, how many rows of one run report motion, and per area how many people they have, over the rows whose
/// phase the summary counts (all rows if it names none). Add each row, then read and start again.
class RunCounts {
 public:
  RunCounts(std::size_t n_sensors, SummarySpec spec, const std::vector<std::string>& areas = {});
  void add(const Sample& row);
  [[nodiscard]] std::span<const int> counts() const noexcept { return counts_; }
  [[nodiscard]] std::span<const AreaSums> areas() const noexcept { return areas_; }
  void reset();

 private:
  SummarySpec spec_;
  std::vector<int> counts_;
  std::vector<AreaSums> areas_;
};

/// A range and a value per cell: how many values lie in their range, and the expectation and standard deviation of
/// that number over all n! ways to deal the values to the ranges.
struct RangedValue {
  double value = 0.0, min = 0.0, max = 0.0;
};
struct InsideCount {
  int inside = 0;
  double shuffled_mean = 0.0, shuffled_sd = 0.0;
};
[[nodiscard]] InsideCount count_inside(std::span<const RangedValue> cells);

[[nodiscard]] std::string to_csv(const Summary& summary);       ///< a row a cell
[[nodiscard]] std::string to_text(const Summary& summary);      ///< aligned, for a terminal
[[nodiscard]] std::string to_markdown(const Summary& summary);  ///< the same tables for a document

}  // namespace pirsim::studies
