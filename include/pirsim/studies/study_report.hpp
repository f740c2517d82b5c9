// A study's counts and time series as a page for a reader.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pirsim/io/report.hpp"
#include "pirsim/sim/study.hpp"
#include "pirsim/studies/summary.hpp"

namespace pirsim::studies {

/// Collects what the page shows: every run's counts, and the first replicate's rows.
class StudyReport {
 public:
  explicit StudyReport(const Model& model);

  /// counts: (n_sensors) as added to the summary.
  void add_run(const RunResult& result, std::span<const int> counts);
  /// Histograms a trial and sensor as in [Stefansson2021] Figure 8, with the summary's measured counts as lines, and
  /// the first replicate's time series as in Figure 9.
  [[nodiscard]] io::Report finish(const Summary& summary) const;

 private:
  struct Trial {
    std::string id;
    std::vector<std::vector<int>> counts;  ///< (n_sensors x n_runs)
    std::vector<Sample> samples;           ///< of the first replicate
  };
  [[nodiscard]] io::SeriesChart series_of(const Trial& trial) const;

  const Model* model_;
  std::vector<std::string> sensors_;
  std::vector<Trial> trials_;
};

}  // namespace pirsim::studies
