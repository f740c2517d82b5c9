#include "body/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace pirsim::body {
namespace {

/// A footprint of less area is a line (m2): what rounding makes of a vertical triangle of a few metres.
constexpr double line_area_m2 = 1e-9;

double cross(const Vec2& a, const Vec2& b) noexcept { return a.x * b.y - a.y * b.x; }

/// The part of a convex polygon where side * (y - height) >= 0. Ref: [SutherlandHodgman1974].
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, double height, double side) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double da = side * (a.y - height);
    const double db = side * (b.y - height);
    if (da >= 0.0) kept.push_back(a);
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) kept.push_back(glm::mix(a, b, da / (da - db)));
  }
  return kept;
}

Footprint seen_from_above(const std::vector<Vec3>& polygon, std::uint32_t mesh) {
  Footprint footprint{.n_corners = static_cast<std::uint32_t>(polygon.size()), .mesh = mesh};
  double twice_area = 0.0;
  footprint.lower = footprint.upper = floor_point(polygon.front());
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 corner = floor_point(polygon[i]);
    footprint.corners[i] = corner;
    footprint.lower = glm::min(footprint.lower, corner);
    footprint.upper = glm::max(footprint.upper, corner);
    if (i >= 2) twice_area += cross(footprint.corners[i - 1] - footprint.corners[0], corner - footprint.corners[0]);
  }
  footprint.covers_area = 0.5 * std::abs(twice_area) > line_area_m2;
  return footprint;
}

bool contains(const Footprint& footprint, const Vec2& point) noexcept {
  if (!footprint.covers_area) return false;
  bool left = false;
  bool right = false;
  for (std::uint32_t i = 0; i < footprint.n_corners; ++i) {
    const Vec2& a = footprint.corners[i];
    const Vec2& b = footprint.corners[(i + 1) % footprint.n_corners];
    const double side = cross(b - a, point - a);
    left = left || side > 0.0;
    right = right || side < 0.0;
  }
  return !(left && right);
}

double distance(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) noexcept {
  const bool crossing =
      cross(b - a, c - a) * cross(b - a, d - a) < 0.0 && cross(d - c, a - c) * cross(d - c, b - c) < 0.0;
  if (crossing) return 0.0;
  return std::min({body::distance(a, c, d), body::distance(b, c, d), body::distance(c, a, b), body::distance(d, a, b)});
}

}  // namespace

std::vector<Footprint> footprints(std::span<const TriMesh> meshes, double lower_m, double upper_m) {
  std::vector<Footprint> result;
  for (std::uint32_t mesh = 0; mesh < meshes.size(); ++mesh) {
    const std::vector<Vec3>& positions = meshes[mesh].positions;
    for (const auto& [a, b, c] : meshes[mesh].triangles) {
      const std::vector<Vec3> triangle{positions[a], positions[b], positions[c]};
      const std::vector<Vec3> slab = clipped(clipped(triangle, lower_m, 1.0), upper_m, -1.0);
      if (!slab.empty()) result.push_back(seen_from_above(slab, mesh));
    }
  }
  return result;
}

double distance(const Vec2& point, const Vec2& a, const Vec2& b) noexcept {
  const Vec2 ab = b - a;
  const double length2 = glm::dot(ab, ab);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(point - a, ab) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(point, a + t * ab);
}

double distance(const Vec2& point, const Footprint& footprint) noexcept {
  if (contains(footprint, point)) return 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < footprint.n_corners; ++i) {
    const Vec2& next = footprint.corners[(i + 1) % footprint.n_corners];
    nearest = std::min(nearest, distance(point, footprint.corners[i], next));
  }
  return nearest;
}

double distance(const Vec2& a, const Vec2& b, const Footprint& footprint) noexcept {
  if (contains(footprint, a)) return 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < footprint.n_corners; ++i) {
    const Vec2& next = footprint.corners[(i + 1) % footprint.n_corners];
    nearest = std::min(nearest, distance(a, b, footprint.corners[i], next));
  }
  return nearest;
}

double distance_bound(const Vec2& a, const Vec2& b, const Footprint& footprint) noexcept {
  const double right = std::min(a.x, b.x) - footprint.upper.x;
  const double left = footprint.lower.x - std::max(a.x, b.x);
  const double behind = std::min(a.y, b.y) - footprint.upper.y;
  const double before = footprint.lower.y - std::max(a.y, b.y);
  return std::max({right, left, behind, before});
}

}  // namespace pirsim::body
