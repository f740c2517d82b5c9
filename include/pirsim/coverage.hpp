// Where does a sensor see? In a coverage study a target moves in every square of the floor, and each sensor's motion is
// counted. In a walk test somebody walks and sits at every point, in the manner of NEMA WD 7 (major and minor motion,
// cell by cell) and EN 50131-2-2 (walks in several directions): how surely are they noticed in time?
#pragma once

#include <cstdint>
#include <optional>
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

// Walk tests.

/// How many tries were possible at a point, and in how many of them any sensor reported motion in time.
struct Tries {
  int made = 0;
  int noticed = 0;
  int deaf = 0;  ///< of those not noticed, in which a sensor saw the person all the same
  [[nodiscard]] std::optional<double> probability() const {
    return made == 0 ? std::nullopt : std::optional(static_cast<double>(noticed) / made);
  }
};

struct PointResult {
  Tries major, minor;
};

struct SeatResult {
  std::string seat;
  bool noticed = false;
  bool deaf = false;  ///< not noticed, though a sensor sees the sitter
};

struct WalkTestResult {
  FloorGrid grid;
  std::vector<PointResult> points;  ///< (n_rows x n_columns), without tries off the floor
  std::vector<SeatResult> seats;
};

/// Runs a walk test. threads 0: all cores; changes nothing in the result. Throws Error(input) for a spec that the scene
/// can't serve.
[[nodiscard]] WalkTestResult run_walk_test(SceneSpec scene, WalkTestSpec spec, unsigned threads = 0,
                                           const RowDone& row_done = {});

}  // namespace pirsim
