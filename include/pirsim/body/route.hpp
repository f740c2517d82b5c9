// A smooth way over the floor, parametrised by the distance walked.
#pragma once

#include <vector>

#include "pirsim/geom/frame.hpp"

namespace pirsim::body {

/// A polyline whose corners are rounded by arcs tangent to both legs; position and tangent are continuous in s.
class Route {
 public:
  Route() = default;
  /// points: at least one; repeated points are dropped. corner_radius_m is reduced where legs are too short.
  explicit Route(const std::vector<Vec2>& points, double corner_radius_m = 0.3);

  [[nodiscard]] double length_m() const noexcept { return length_m_; }
  [[nodiscard]] Vec2 position(double s) const noexcept;   ///< s in metres, clamped to [0, length]
  [[nodiscard]] double heading(double s) const noexcept;  ///< of the tangent, radians; see frame.hpp
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
  std::vector<Piece> pieces_;
  double length_m_ = 0.0;
};

}  // namespace pirsim::body
