// Days of a schedule as pictures: people and sensors over the day, motion by number of people, where people were.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/report.hpp"
#include "pirsim/study.hpp"

namespace pirsim::studies {

/// Of one trial. Keeps sums alone, so that a year takes no more memory than a day.
class DayReport {
 public:
  DayReport(const Model& model, const ScheduleSpec& schedule);

  /// With occupants. Days on which nobody comes are left out.
  void add_run(const RunResult& result);
  [[nodiscard]] io::ReportSection section(const std::string& heading) const;

 private:
  struct Bin {
    double windows = 0.0, people = 0.0;
    int fewest = 0, most = 0;
    std::vector<double> motion;  ///< (n_sensors) windows
  };
  struct Count {
    double windows = 0.0;
    std::vector<double> motion;  ///< (n_sensors) windows
  };
  struct Moment {
    std::string clock;
    std::vector<OccupantRow> people;
  };
  void note_moment(const RunResult& result);
  [[nodiscard]] io::LineChart people_chart() const;
  [[nodiscard]] io::LineChart sensor_chart(std::size_t sensor) const;
  [[nodiscard]] io::GridChart count_chart() const;
  [[nodiscard]] io::MapChart floor_chart() const;
  [[nodiscard]] double hour_of(std::size_t bin) const;

  const Model* model_;
  double from_h_, to_h_;
  std::vector<Bin> bins_;
  std::vector<Count> by_people_;  ///< (most people + 1)
  std::size_t columns_ = 0;       ///< of the floor's squares
  std::vector<double> squares_;   ///< person-seconds
  Moment busiest_;
  int days_ = 0;
};

}  // namespace pirsim::studies
