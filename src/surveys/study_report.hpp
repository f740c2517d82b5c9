// What happened in each area of a scene over some runs, and how often the sensors that watch it saw motion.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/write/summary.hpp"
#include "model/schema/check_scene.hpp"
#include "pirsim/model.hpp"
#include "pirsim/study.hpp"
#include "show/report.hpp"
#include "surveys/coverage.hpp"

namespace pirsim::studies {

class AreaTally {
 public:
  explicit AreaTally(const Model& model);

  void add_run(const RunResult& result);
  [[nodiscard]] bool empty() const noexcept { return sums_.empty(); }
  /// A line an area.
  [[nodiscard]] io::Table table() const;

 private:
  const Model* model_;
  Areas areas_;  ///< as the scene is drawn
  double window_s_;
  int runs_ = 0;
  std::vector<AreaSums> sums_;                     ///< (n_areas)
  std::vector<std::vector<std::size_t>> sensors_;  ///< (n_areas) that watch each
  std::vector<std::int64_t> with_motion_;          ///< (n_areas) rows in which one of these saw motion
};

/// "kitchen (PIR1, PIR2)"
[[nodiscard]] std::string with_sensors(const SceneSpec& scene, const Areas& areas, std::size_t area);

// Pages for a reader: a coverage study's maps and figures, a study's counts and time series.

/// A map of all sensors: in each square the count of the sensor that reported motion most often there.
[[nodiscard]] io::MapChart map_of_all(const CoverageStudy& study, const CoverageMap& map);

[[nodiscard]] io::Report coverage_report(const CoverageStudy& study, const CoverageMap& map,
                                         const CoverageFigures& figures);

/// Days of a schedule, or other long runs: people and sensors over the day, motion by number of people, where people
/// were. Of one trial; keeps sums alone, so that a year takes no more memory than a day.
class DayReport {
 public:
  explicit DayReport(const Model& model);

  /// With occupants. Days on which nobody comes are left out. Runs of one trial all have a clock or none.
  void add_run(const RunResult& result);
  [[nodiscard]] io::ReportSection section(const std::string& heading) const;
  /// Did anybody come?
  [[nodiscard]] bool has_moment() const noexcept { return !busiest_.people.empty(); }
  /// Who did what when most people were there.
  [[nodiscard]] io::ReportSection moment_section(const std::string& heading) const;

 private:
  struct Bin {
    double windows = 0.0, people = 0.0;
    int fewest = 0, most = 0;
    std::vector<double> motion;           ///< (n_sensors) windows
    std::vector<double> people_of_areas;  ///< (n_areas)
  };
  struct Count {
    std::vector<double> windows, motion;  ///< (n_sensors)
  };
  struct Moment {
    std::string time;
    std::vector<OccupantRow> people;
  };
  void note_moment(const RunResult& result);
  [[nodiscard]] io::LineChart people_chart() const;
  [[nodiscard]] io::LineChart area_chart() const;
  [[nodiscard]] io::LineChart sensor_chart(std::size_t sensor) const;
  [[nodiscard]] io::GridChart count_chart() const;
  [[nodiscard]] io::MapChart floor_chart() const;
  [[nodiscard]] Bin& bin_at(double time_s);
  /// point_of(bin): of each that has windows, without its time, which is set and told before its hint.
  template <typename PointOf>
  [[nodiscard]] io::LineChart::Line line_over_time(PointOf point_of) const;
  [[nodiscard]] std::string over_runs() const;
  [[nodiscard]] io::LineChart chart_over_time(const std::string& title, const std::string& note,
                                              const std::string& y_label) const;

  const Model* model_;
  double window_s_;
  bool has_clock_ = false;
  double from_h_ = 0.0;  ///< of the day, or of the run if it has no clock
  double longest_s_ = 0.0;
  std::vector<Bin> bins_;
  std::vector<Count> by_people_;  ///< (most people + 1) of the area that a sensor watches, or of the room
  std::size_t columns_ = 0;       ///< of the floor's squares
  std::vector<double> squares_;   ///< person-seconds
  Moment busiest_;
  AreaTally areas_;
  std::vector<std::optional<std::size_t>> watched_;  ///< (n_sensors) the area of each, if it is over one
  int days_ = 0;
};

/// Collects what the page shows beside the summary: the first replicate's rows.
class StudyReport {
 public:
  explicit StudyReport(const Model& model);

  void add_run(const RunResult& result);
  /// Long runs are shown with where people were.
  [[nodiscard]] bool needs_occupants() const noexcept;
  /// Of days of a schedule and of other runs of hours: people and sensors over the day, and so on. Otherwise:
  /// histograms a trial and sensor as in [Stefansson2021] Figure 8, with the summary's measured counts as lines, and
  /// the first replicate's time series as in Figure 9.
  [[nodiscard]] io::Report finish(const Summary& summary) const;

 private:
  struct Trial {
    std::string id;
    std::vector<Sample> samples;    ///< of the first replicate
    AreaTally areas;                ///< of short runs; days have their own
    std::optional<DayReport> days;  ///< of a schedule, or of runs that last for hours
  };
  [[nodiscard]] io::SeriesChart series_of(const Trial& trial) const;

  const Model* model_;
  std::vector<std::string> sensors_;
  std::vector<Trial> trials_;
};

}  // namespace pirsim::studies
