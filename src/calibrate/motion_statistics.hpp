// What motion tells of a room without counts, in a few numbers.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pirsim/counting.hpp"

namespace pirsim::calibrate {

struct StatisticInfo {
  std::string name, unit;
  enum class Scale {
    plain,
    logarithm  ///< of a length in readings: told in minutes
  } scale = Scale::plain;
};
/// A statistic in its unit.
[[nodiscard]] double told(const StatisticInfo& info, double value, double step_s);
/// Of a room with so many sensors.
[[nodiscard]] std::vector<StatisticInfo> statistics_of(int n_sensors);

/// (statistics) of each stretch that has enough motion to tell.
[[nodiscard]] std::vector<std::vector<double>> motion_statistics(std::span<const counting::Stretch> stretches,
                                                                 double step_s);

}  // namespace pirsim::calibrate
