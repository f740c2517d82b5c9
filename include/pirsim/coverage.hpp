// Where does a sensor see? A target moves in every square of the floor, and each sensor's motion is counted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pirsim/geometry.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/survey.hpp"

namespace pirsim {

/// Windows with motion, in [0, n_windows].
using MotionCount = std::uint16_t;

struct CoverageMap {
  FloorGrid grid;
  std::vector<std::string> sensors;
  int n_windows = 0;
  std::vector<MotionCount> counts;  ///< (n_rows x n_columns x n_sensors); zeros off the floor

  [[nodiscard]] MotionCount count(std::size_t column, std::size_t row, std::size_t sensor) const noexcept {
    return counts[(row * grid.n_columns() + column) * sensors.size() + sensor];
  }
};

/// Runs a coverage study. threads 0: all cores; changes no count. Throws Error(input) for a spec that the scene can't
/// serve: a name in `without` that no mesh has, an unknown effect or sensor.
[[nodiscard]] CoverageMap run_coverage(SceneSpec scene, CoverageSpec spec, unsigned threads = 0,
                                       const RowDone& row_done = {});

}  // namespace pirsim
