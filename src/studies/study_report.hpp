// A study's counts and time series as a page for a reader.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/report.hpp"
#include "pirsim/study.hpp"
#include "studies/day_report.hpp"
#include "studies/summary.hpp"

namespace pirsim::studies {

/// Collects what the page shows beside the summary: the first replicate's rows.
class StudyReport {
 public:
  explicit StudyReport(const Model& model);

  void add_run(const RunResult& result);
  /// Days are shown with where people were.
  [[nodiscard]] bool needs_occupants() const noexcept;
  /// Of days of a schedule: people and sensors over the day, and so on. Otherwise: histograms a trial and sensor as in
  /// [Stefansson2021] Figure 8, with the summary's measured counts as lines, and the first replicate's time series as
  /// in Figure 9.
  [[nodiscard]] io::Report finish(const Summary& summary) const;

 private:
  struct Trial {
    std::string id;
    std::vector<Sample> samples;    ///< of the first replicate
    std::optional<DayReport> days;  ///< of a schedule
  };
  [[nodiscard]] io::SeriesChart series_of(const Trial& trial) const;

  const Model* model_;
  std::vector<std::string> sensors_;
  std::vector<Trial> trials_;
};

}  // namespace pirsim::studies
