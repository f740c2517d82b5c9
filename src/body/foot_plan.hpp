// Where the feet are put while the body moves over the floor.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "body/route.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::body {

/// A place on the floor and the heading of who or what is there.
struct Placement {
  Vec2 position{0.0};
  double heading = 0.0;
  bool operator==(const Placement&) const = default;
  /// The point `forward` ahead and `right` to the side.
  [[nodiscard]] Placement shifted(double forward, double right) const noexcept;
};

/// The way of the body's middle, by distance: along a route, turning on the spot (distance in radians) or straight
/// without turning (a chair sliding).
class Track {
 public:
  Track() = default;
  /// A walk from `start` along the route from from_s to to_s, between which it has no sharp turn; what `start` is off
  /// the route is blended away within `step_m`. The heading is the route's, averaged over a step, since people turn
  /// into a corner before they reach it (so a bend in the last half step is not turned out fully).
  Track(const Route& route, double from_s, double to_s, const Placement& start, double step_m);
  /// Of a walk: faces so instead, at these distances (ascending) and evenly between them.
  void face(std::span<const double> at, std::span<const double> headings);
  static Track turn(const Placement& start, double angle);
  /// Stays there; the length only counts how far the feet are with their steps.
  static Track stay(const Placement& start, double length);
  static Track slide(const Placement& start, double direction, double distance_m);

  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] Placement at(double s) const noexcept;
  bool operator==(const Track&) const = default;

 private:
  [[nodiscard]] double mean_heading(double s) const noexcept;

  Placement start_;
  double length_ = 0.0;
  double turn_per_length_ = 0.0;  ///< +1 or -1 when turning on the spot
  Vec2 slide_direction_{0.0};
  std::optional<Route> route_;
  double from_s_ = 0.0;
  std::vector<double> headings_;  ///< along the route, radians without jumps, at multiples of spacing_
  double spacing_ = 0.0;
  double blend_length_ = 0.0;
};

/// Where, beyond from_s, a walker whose steps are step_m long has to stand and turn: at sharp turns, and amid bends too
/// tight for crossing legs. The route's length if nowhere.
[[nodiscard]] double next_pivot(const Route& route, double from_s, double step_m) noexcept;

/// A foot at one moment.
struct Footstep {
  Placement print;      ///< under the ankle
  double lift_m = 0.0;  ///< of the ankle above its height when standing
  double pitch = 0.0;   ///< radians, positive toes up
  bool operator==(const Footstep&) const = default;
};
using Feet = std::array<Footstep, 2>;  ///< left, right

/// How steps are made: paper section 2.2 for walking.
struct StepStyle {
  double step = 0.5;            ///< longest way of the body during one step (metres, or radians when turning)
  double lift_m = 0.15;         ///< of a foot that passes two such steps
  double pitch_per_lift = 0.0;  ///< radians per metre of lift
  int first_foot = 0;           ///< 0 left, 1 right
};

/// Alternating steps along a track. Footprints lie at distances 0, 0, l, 2l, ..., (M-1)l, L, L; while one foot stands
/// the other swings, and both take equally long. See docs/physics/humanoid.md.
class FootPlan {
 public:
  FootPlan() = default;
  /// The first foot of `start` to swing may already be in the air.
  FootPlan(const Feet& start, double length, const StepStyle& style, double half_stance_m);

  /// Ends the plan at the first footprint that leaves at least `braking` of way from s.
  void shorten(double s, double braking) noexcept;
  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] double step() const noexcept { return step_; }
  [[nodiscard]] int steps() const noexcept { return steps_; }
  [[nodiscard]] Feet feet(const Track& track, double s) const noexcept;
  bool operator==(const FootPlan&) const = default;

 private:
  [[nodiscard]] int interval(double s) const noexcept;
  [[nodiscard]] Placement print(const Track& track, std::size_t foot, double s) const noexcept;

  Feet start_{};
  double length_ = 0.0;
  double step_ = 0.0;
  int steps_ = 0;
  double half_stance_m_ = 0.0;  ///< from the track to either foot
  double lift_per_stride_ = 0.0;
  double pitch_per_lift_ = 0.0;
  int first_foot_ = 0;
};

/// 0 at and below 0, 1 at and above 1, without a kink in between.
[[nodiscard]] double smoothstep(double x) noexcept;
/// The same angle within (-pi, pi].
[[nodiscard]] double wrapped(double angle) noexcept;

}  // namespace pirsim::body
