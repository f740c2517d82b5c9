// The turning crosses of a coverage study, posed once for all squares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pirsim/shapes.hpp"
#include "pirsim/survey.hpp"

namespace pirsim::studies {

/// Bars that turn about a common middle.
struct TurningCross {
  Vec3 middle{0.0};                         ///< relative to the square's centre on the floor
  double reach_m = 0.0;                     ///< from the middle to the farthest surface point
  Capsule bar;                              ///< every bar's solid
  std::vector<std::vector<Quat>> rotation;  ///< (n_bars x n_poses) world from bar
};

/// What turns alike in every square. Poses repeat after n_poses() ticks.
class TurningTarget {
 public:
  /// Poses of the ticks [0, n_ticks]; fewer if they repeat exactly before. n_ticks > 0.
  TurningTarget(const XShapesSpec& spec, int tick_rate_hz, std::int64_t n_ticks);

  [[nodiscard]] const std::vector<TurningCross>& crosses() const noexcept { return crosses_; }
  [[nodiscard]] std::size_t n_poses() const noexcept { return n_poses_; }
  /// World-space solids at a tick: what a tracer is given. `foot`: the square's centre on the floor.
  [[nodiscard]] std::vector<PosedShape> solids(const Vec3& foot, std::int64_t tick) const;

 private:
  std::vector<TurningCross> crosses_;
  std::size_t n_poses_ = 0;
};

}  // namespace pirsim::studies
