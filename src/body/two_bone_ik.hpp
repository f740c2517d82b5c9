// Where the middle joint of two bones lies.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "pirsim/geometry.hpp"

namespace pirsim::body {

/// The circle on which the middle joint can lie: centre, radius (0 where the bones are stretched or folded).
struct ElbowCircle {
  Vec3 centre{0.0};
  Vec3 axis{0.0};  ///< unit, root to end
  double radius = 0.0;
};
[[nodiscard]] inline ElbowCircle elbow_circle(const Vec3& root, const Vec3& end, double upper, double lower) noexcept {
  const Vec3 way = end - root;
  const double distance = std::max(glm::length(way), 1e-9);
  const Vec3 axis = way / distance;
  const double reach = std::clamp(distance, std::abs(upper - lower) + 1e-9, upper + lower);
  const double along = (upper * upper - lower * lower + reach * reach) / (2.0 * reach);
  return {root + along * axis, axis, std::sqrt(std::max(0.0, upper * upper - along * along))};
}

/// The middle joint, bent towards `pole` (a direction that isn't parallel to root-end).
[[nodiscard]] inline Vec3 two_bone_joint(const Vec3& root, const Vec3& end, double upper, double lower,
                                         const Vec3& pole) noexcept {
  const ElbowCircle circle = elbow_circle(root, end, upper, lower);
  return circle.centre + circle.radius * glm::normalize(pole - glm::dot(pole, circle.axis) * circle.axis);
}

}  // namespace pirsim::body
