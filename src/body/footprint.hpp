// What an obstacle covers of the floor, and plane distances.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim::body {

inline constexpr double solid_from_m = 0.1;  ///< above the floor: a walker steps over what is lower
inline constexpr double solid_to_m = 2.0;    ///< above the floor: a walker passes under what is higher

/// The part of a triangle between two heights, seen from above: a convex polygon, or the two ends of a line
/// under a vertical triangle.
struct Footprint {
  static constexpr std::size_t max_corners = 5;  ///< a triangle cut by two planes
  std::array<Vec2, max_corners> corners{};
  std::uint32_t n_corners = 0;
  std::uint32_t mesh = 0;  ///< index of the obstacle that it is part of
  bool covers_area = false;
  Vec2 lower{0.0};
  Vec2 upper{0.0};
};

/// The footprints of all triangles that reach into heights [lower_m, upper_m] (world y); what only touches upper_m from
/// above doesn't: a lintel at 2.00 m is a usual one. Lines that overlap the line
/// before them, of the same mesh, are one with it.
[[nodiscard]] std::vector<Footprint> footprints(std::span<const TriMesh> meshes, double lower_m, double upper_m);

[[nodiscard]] double distance(const Vec2& point, const Vec2& a, const Vec2& b) noexcept;  ///< to the segment ab
[[nodiscard]] double distance(const Vec2& point, const Footprint& footprint) noexcept;    ///< 0 inside
/// Between the segment ab and the footprint, 0 where they touch.
[[nodiscard]] double distance(const Vec2& a, const Vec2& b, const Footprint& footprint) noexcept;
/// A lower bound of the distance between the segment ab and the footprint (that of their bounding boxes, per axis).
[[nodiscard]] double distance_bound(const Vec2& a, const Vec2& b, const Footprint& footprint) noexcept;

}  // namespace pirsim::body
