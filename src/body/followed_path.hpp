// A way as somebody was seen to go it: walks, with standstills between them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "body/foot_plan.hpp"
#include "body/route.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::body {

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
