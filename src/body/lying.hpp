// How somebody lies, and the way there from the edge of what they lie on.
#pragma once

#include "body/seating.hpp"
#include "body/skeleton.hpp"

namespace pirsim::body {

/// A bed as the body needs it.
struct LyingPlace {
  Frame world_from_place;  ///< the pelvis lies over the origin, the head towards +Z; y is the surface's height
  SeatPlace edge;          ///< where one sits down before, and gets up from
  bool operator==(const LyingPlace&) const = default;
};

/// What the posture of somebody who lies depends on beside that of the sitter on the edge. Doubles only, as Outline.
struct LyingOutline {
  double progress = 0.0;   ///< 0 sitting on the edge, 1 lying
  double surface_m = 0.0;  ///< y in the world
  Placement place;         ///< of the pelvis when lying, facing the feet; 0 while progress is 0, as the rest
  double roll = 0.0;       ///< radians about the trunk's axis: 0 on the back, positive towards the left side
  double raise = 0.0;      ///< radians of the trunk above the level: half-lying
  double curl = 0.0;       ///< 0 legs stretched, 1 drawn up
  bool operator==(const LyingOutline&) const = default;
};

/// Turns the pose of the sitter on the edge, `pose`, into that of who lies down: hips, ankles and arms. Nothing of
/// trunk, head and arms, and once they are up of the legs, comes below the surface.
void lie_down(Pose& pose, const Humanoid& humanoid, const LyingOutline& lying) noexcept;
/// Share of the way from the edge to the place that the pelvis has gone.
[[nodiscard]] double moved_over(double progress) noexcept;
/// The pelvis' height above the surface of who sits on the edge.
[[nodiscard]] double edge_height_m(const Humanoid& humanoid) noexcept;

}  // namespace pirsim::body
