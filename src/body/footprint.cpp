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

constexpr double same_line_m = 1e-9;  ///< what rounding makes of points on one line

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

/// Leaves the two ends of a line.
void make_line(Footprint& footprint, const Vec2& along) {
  const auto before = [&](const Vec2& a, const Vec2& b) { return glm::dot(a, along) < glm::dot(b, along); };
  const auto end = footprint.corners.begin() + footprint.n_corners;
  const auto [first, last] = std::minmax_element(footprint.corners.begin(), end, before);
  footprint.corners = {*first, *last};
  footprint.n_corners = 2;
  footprint.lower = glm::min(footprint.corners[0], footprint.corners[1]);
  footprint.upper = glm::max(footprint.corners[0], footprint.corners[1]);
}

/// The direction of a line footprint of any number of corners: from the first corner to the one farthest from it.
Vec2 direction_of_line(const Footprint& footprint) {
  Vec2 longest(0.0);
  for (std::uint32_t i = 1; i < footprint.n_corners; ++i) {
    const Vec2 way = footprint.corners[i] - footprint.corners[0];
    if (glm::dot(way, way) > glm::dot(longest, longest)) longest = way;
  }
  return longest;
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
  if (!footprint.covers_area) make_line(footprint, direction_of_line(footprint));
  return footprint;
}

/// Two lines of one obstacle that overlap become one: a wall is two triangles, each above most of the same line.
bool join(Footprint& line, const Footprint& next) {
  if (line.covers_area || next.covers_area || line.mesh != next.mesh) return false;
  const Vec2 way = direction_of_line(line);
  const double length = glm::length(way);
  if (length < same_line_m) return false;
  for (const Vec2& p : {next.corners[0], next.corners[1]}) {
    if (std::abs(cross(way, p - line.corners[0])) > same_line_m * length) return false;
  }
  const double a = glm::dot(next.corners[0] - line.corners[0], way),
               b = glm::dot(next.corners[1] - line.corners[0], way);
  if (std::max(a, b) < 0.0 || std::min(a, b) > length * length) return false;
  line.corners[2] = next.corners[0];
  line.corners[3] = next.corners[1];
  line.n_corners = 4;
  make_line(line, way);
  return true;
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

double between_edges(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) noexcept {
  const bool crossing =
      cross(b - a, c - a) * cross(b - a, d - a) < 0.0 && cross(d - c, a - c) * cross(d - c, b - c) < 0.0;
  if (crossing) return 0.0;
  return std::min({body::distance(a, c, d), body::distance(b, c, d), body::distance(c, a, b), body::distance(d, a, b)});
}

}  // namespace

std::vector<Footprint> footprints(std::span<const TriMesh> meshes, double lower_m, double upper_m) {
  constexpr double touching_m = 1e-3;  // what rounding makes of a lintel that begins where the heights end
  std::vector<Footprint> result;
  for (std::uint32_t mesh = 0; mesh < meshes.size(); ++mesh) {
    if (meshes[mesh].solidity == Solidity::screen) continue;
    const std::vector<Vec3>& positions = meshes[mesh].positions;
    for (const auto& [a, b, c] : meshes[mesh].triangles) {
      const std::vector<Vec3> triangle{positions[a], positions[b], positions[c]};
      const std::vector<Vec3> slab = clipped(clipped(triangle, lower_m, 1.0), upper_m, -1.0);
      const auto is_above = [&](const Vec3& p) { return p.y >= upper_m - touching_m; };
      if (slab.empty() || std::ranges::all_of(triangle, is_above)) continue;
      const Footprint footprint = seen_from_above(slab, mesh);
      if (result.empty() || !join(result.back(), footprint)) result.push_back(footprint);
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
  if (!footprint.covers_area) return distance(point, footprint.corners[0], footprint.corners[1]);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < footprint.n_corners; ++i) {
    const Vec2& next = footprint.corners[(i + 1) % footprint.n_corners];
    nearest = std::min(nearest, distance(point, footprint.corners[i], next));
  }
  return nearest;
}

double distance(const Vec2& a, const Vec2& b, const Footprint& footprint) noexcept {
  if (contains(footprint, a)) return 0.0;
  if (!footprint.covers_area) return between_edges(a, b, footprint.corners[0], footprint.corners[1]);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < footprint.n_corners; ++i) {
    const Vec2& next = footprint.corners[(i + 1) % footprint.n_corners];
    nearest = std::min(nearest, between_edges(a, b, footprint.corners[i], next));
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
