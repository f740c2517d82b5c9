// A virtual walk test: at every point of the floor, how surely is a walker or a sitter's arm noticed in time?
// In the manner of NEMA WD 7 (major and minor motion, cell by cell) and EN 50131-2-2 (walks in several directions).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pirsim/geometry.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/survey.hpp"

namespace pirsim {

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
