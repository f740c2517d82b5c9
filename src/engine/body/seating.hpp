// The way from standing onto a seat: a controlled fall about the knees, then sliding with the chair.
#pragma once

#include <optional>
#include <string>

#include "engine/body/gait.hpp"
#include "engine/body/skeleton.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::body {

/// A seat as the body needs it.
struct SeatPlace {
  Frame world_from_seat;                 ///< pelvis rests at the origin, facing -Z
  double floor_height_m = 0.0;           ///< y of the floor under the feet
  std::optional<double> table_height_m;  ///< y of what the forearms rest on; none: hands on the thighs
  /// How far to the left the chair is turned while somebody sits down or rises, where there is no room behind it.
  double approach_turn = 0.0;
  /// How far before the seat's point the ankles stay at least: what one sits on reaches so far that they have to.
  double feet_ahead_m = 0.0;
  bool operator==(const SeatPlace&) const = default;
};

/// Height of the hip joints above the floor of a person who stands upright; a little below 0.530 H, since knees that
/// are locked could not begin to bend smoothly.
[[nodiscard]] double standing_hip_height_m(const Measures& measures) noexcept;

/// Pelvis and feet by two measures of progress: `fall` from 0 (standing) to 1 (at the seat's height) and then
/// `slide_m` from 0 to slide_length_m (at the seat).
class Seating {
 public:
  Seating() = default;
  /// Throws Error(infeasible) if the seat's height can't be sat on, Error(internal) if the person stands elsewhere
  /// than before or behind the seat on its axis, or faces another way.
  Seating(const Humanoid& humanoid, const SeatPlace& seat, const Placement& standing, const Feet& feet);

  [[nodiscard]] const SeatPlace& seat() const noexcept { return seat_; }
  [[nodiscard]] double slide_length_m() const noexcept { return sliding_.length(); }
  [[nodiscard]] Placement pelvis(double fall, double slide_m) const noexcept;
  [[nodiscard]] double hip_height_m(double fall) const noexcept;  ///< above the floor
  [[nodiscard]] Feet feet(double slide_m) const noexcept { return shuffling_.feet(sliding_, feet_share_ * slide_m); }
  /// Of who sits, radians from the vertical.
  [[nodiscard]] double seated_thigh_angle() const noexcept { return resting_angle_; }
  bool operator==(const Seating&) const = default;

 private:
  [[nodiscard]] double thigh_angle(double fall) const noexcept;  ///< radians from the vertical, in the fall
  [[nodiscard]] double angle_with_feet_ahead(const Measures& measures, double ahead_m) const noexcept;

  SeatPlace seat_;
  Placement from_;    ///< where the person stands
  Placement before_;  ///< the same, put right: on the seat's axis and facing as it does
  double thigh_m_ = 0.0;
  double knee_ahead_m_ = 0.0;  ///< of the ankle
  double knee_height_m_ = 0.0;
  double standing_angle_ = 0.0;
  double seated_angle_ = 0.0;
  double resting_angle_ = 0.0;
  double feet_share_ = 1.0;  ///< of the slide, by which the feet follow
  Track sliding_;
  FootPlan shuffling_;
};

/// Where to stand before sitting down there: how far before the seat's pelvis point (along the facing direction) a
/// person stands who falls back into it without moving the chair.
[[nodiscard]] double fall_back_m(const Humanoid& humanoid, const SeatPlace& seat) noexcept;

// Which heights of seats a person can sit down on.

/// What is wrong with the seat's height for this person, with the heights that would do; nothing if it can be sat on.
[[nodiscard]] std::optional<std::string> unfit_height(const Humanoid& humanoid, const SeatPlace& seat);

// How somebody lies, and the way there from the edge of what they lie on.

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
