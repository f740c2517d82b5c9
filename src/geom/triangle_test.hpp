// The one ray test of triangles, in double precision; Embree only leaves triangles of a room out. Embree's own test
// lets a ray that is aimed exactly at a vertex slip through now and then (6 in 10,000 measured with 3.13.5 and
// RTC_SCENE_FLAG_ROBUST), and its distances depend on the instruction set.
#pragma once

#include <glm/geometric.hpp>
#include <limits>

#include "pirsim/shapes.hpp"

namespace pirsim {

/// How far beyond its edges a triangle reaches, as a share of its size: a nanometre in a room, a million times double
/// precision's rounding. So no ray finds a way between two triangles that share an edge.
inline constexpr double edge_overlap = 1e-9;

/// Distance to the triangle in lengths of `direction`, negative behind the origin; infinity for a
/// miss. Ref: [Moller1997], without culling. Mirroring x changes no bit.
[[nodiscard]] inline float distance_to_triangle(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b,
                                                const Vec3& c) noexcept {
  constexpr float miss = std::numeric_limits<float>::infinity();
  const Vec3 side_1 = b - a, side_2 = c - a;
  const Vec3 p = glm::cross(direction, side_2);
  const double determinant = glm::dot(side_1, p);
  if (determinant == 0.0) return miss;  // edge-on
  const Vec3 from_corner = origin - a;
  const double u = glm::dot(from_corner, p) / determinant;
  const Vec3 q = glm::cross(from_corner, side_1);
  const double v = glm::dot(direction, q) / determinant;
  const bool is_inside = u >= -edge_overlap && v >= -edge_overlap && u + v <= 1.0 + edge_overlap;
  return is_inside ? static_cast<float>(glm::dot(side_2, q) / determinant) : miss;
}

[[nodiscard]] inline float distance_to_triangle(const Ray& ray, const Vec3f& a, const Vec3f& b,
                                                const Vec3f& c) noexcept {
  return distance_to_triangle(Vec3(ray.origin), Vec3(ray.direction), Vec3(a), Vec3(b), Vec3(c));
}

}  // namespace pirsim
