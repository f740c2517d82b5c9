// A smooth way over the floor, parametrised by the distance walked.
#pragma once

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

}  // namespace pirsim::body
