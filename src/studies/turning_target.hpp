// The turning crosses of a coverage study: posed once for all squares, and traced ray by ray against all poses at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pirsim/coverage.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/shapes.hpp"

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

// One ray against all poses of a bar, several poses at a time.

/// All poses of one capsule as posed by place(), laid out for lanes of poses; padded to whole lanes.
struct BarPoses {
  std::vector<float> ax, ay, az, bx, by, bz;
  float radius = 0.0F;
};

/// Half axes of a bar, relative to its middle, computed once: (n_poses).
[[nodiscard]] std::vector<Vec3> half_axes(const Capsule& bar, const std::vector<Quat>& rotation);
/// The poses of a bar with its middle at `middle`, the same bits as place() of each.
void pose_bar(const std::vector<Vec3>& half_axes, const Vec3& middle, double radius, BarPoses& poses);

/// Lanes of poses in a row of `n_poses`: how long `active` below is.
[[nodiscard]] std::size_t padded(std::size_t n_poses) noexcept;

/// active[pose] becomes 1 where entry_distance(ray, capsule of the pose, range) has a value. (padded n_poses)
void mark_active(const Ray& ray, float range, const BarPoses& poses, std::vector<std::uint8_t>& active) noexcept;

/// Whether the ray passes through a sphere within its range; a millimetre is added to be on the safe side of rounding.
[[nodiscard]] bool may_hit(const Ray& ray, float range, const Vec3& middle, double reach_m) noexcept;

}  // namespace pirsim::studies
