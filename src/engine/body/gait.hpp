// A smooth way over the floor, parametrised by the distance walked.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim::body {

/// A polyline whose corners are rounded by arcs tangent to both legs; position and tangent are continuous in s,
/// except at sharp turns: there the walker stops and turns in place.
///
/// An arc cuts its corner, by max_corner_cut_m at most (the radius shrinks with the angle to ensure it, and each
/// arc stays within the half of its legs that is next to the corner). Whoever plans the polyline with a clearance
/// of c keeps c - max_corner_cut_m on the route.
class Route {
 public:
  /// Largest distance between a corner and its arc. assumed: half a cell of the walkable floor (0.02-0.1 m).
  static constexpr double max_corner_cut_m = 0.05;
  /// A larger change of direction is a sharp turn, never an arc. assumed: three quarters of pi (2.1-2.7 rad);
  /// the radius that max_corner_cut_m leaves there, 3 cm, is no walk any more.
  static constexpr double sharpest_arc_rad = 2.356194490192345;

  Route() = default;
  /// points: at least one; repeated points are dropped. corner_radius_m (>= 0) is reduced where legs are too short
  /// or the corner would be cut too much; with 0 every corner is a sharp turn.
  /// Throws Error(usage) for no points, for numbers that aren't finite and for a negative radius.
  explicit Route(const std::vector<Vec2>& points, double corner_radius_m = 0.3);

  [[nodiscard]] double length_m() const noexcept { return length_m_; }
  [[nodiscard]] Vec2 position(double s) const noexcept;  ///< s in metres, clamped to [0, length]
  /// Of the tangent, radians; see heading_of(). Not wrapped to a turn, so that it is continuous; at a sharp turn the
  /// direction in which the route goes on. 0 for a route of no length.
  [[nodiscard]] double heading(double s) const noexcept;
  [[nodiscard]] double curvature(double s) const noexcept;  ///< 1/m, positive turning left
  /// The s of every sharp turn, ascending.
  [[nodiscard]] const std::vector<double>& sharp_turns_s() const noexcept { return sharp_turns_s_; }
  bool operator==(const Route&) const = default;

 private:
  /// A straight leg (curvature 0) or an arc.
  struct Piece {
    double begin_s = 0.0;
    Vec2 start{0.0};
    double heading = 0.0;    ///< at the start
    double curvature = 0.0;  ///< 1/m, positive turning left
    bool operator==(const Piece&) const = default;
  };
  void add(const Vec2& start, double heading, double curvature, double length);
  [[nodiscard]] double clamped(double s) const noexcept;
  [[nodiscard]] const Piece& piece_at(double s) const noexcept;  ///< requires a piece and a clamped s

  std::vector<Piece> pieces_;
  std::vector<double> sharp_turns_s_;
  double length_m_ = 0.0;
};

// Where the feet are put while the body moves over the floor.

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

// A way as somebody was seen to go it: walks, with standstills between them.

/// Straight from each point to the next, evenly in time.
class FollowedPath {
 public:
  /// times_s: ascending, at least one; points: as many; headings: as many, radians, or none: as the way goes.
  FollowedPath(std::span<const double> times_s, std::span<const Vec2> points, std::span<const double> headings);

  /// A walk without a rest.
  struct Leg {
    std::vector<double> times_s, walked_m;  ///< both ascending, the latter from 0 to the route's length
    std::vector<double> headings;           ///< at these; or none
    Route route;
    [[nodiscard]] double walked_at(double time_s) const noexcept;
  };

  [[nodiscard]] double first_s() const noexcept { return first_s_; }
  [[nodiscard]] double last_s() const noexcept { return last_s_; }
  [[nodiscard]] const Placement& start() const noexcept { return start_; }
  [[nodiscard]] const std::vector<Leg>& legs() const noexcept { return legs_; }
  /// How many of the legs have begun before that moment.
  [[nodiscard]] std::size_t n_begun(double time_s) const noexcept;

 private:
  double first_s_ = 0.0, last_s_ = 0.0;
  Placement start_;
  std::vector<Leg> legs_;
};

}  // namespace pirsim::body
