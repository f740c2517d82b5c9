#include "geom/triangle_surface.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "pirsim/error.hpp"

namespace pirsim {
namespace {

/// Metres by which spheres are larger than what they hold: a thousand times what triangles reach over their edges and
/// what rounding takes, at the size of a body.
constexpr double padding = 1e-6;

/// The point of a triangle nearest to `p`. Ref: [Ericson2005], section 5.1.5.
Vec3 nearest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = glm::dot(ab, p - a), d2 = glm::dot(ac, p - a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = glm::dot(ab, p - b), d4 = glm::dot(ac, p - b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + ab * (d1 / (d1 - d3));
  const double d5 = glm::dot(ab, p - c), d6 = glm::dot(ac, p - c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  return a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc));
}

}  // namespace

TriangleSurface::TriangleSurface(TriMesh mesh) : mesh_(std::move(mesh)) {
  check();
  lower_ = upper_ = corners(0).a;
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const auto [a, b, c] = corners(i);
    lower_ = glm::min(lower_, glm::min(a, glm::min(b, c)));
    upper_ = glm::max(upper_, glm::max(a, glm::max(b, c)));
  }
  grow(0, mesh_.triangles.size());
}

void TriangleSurface::check() const {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::usage, "mesh '" + mesh_.name + "' " + why);
  };
  if (mesh_.triangles.empty()) refuse("has no triangles");
  for (const Vec3& p : mesh_.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) refuse("has a vertex that isn't finite");
  }
  for (const auto& triangle : mesh_.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= mesh_.positions.size()) refuse("has a triangle with a vertex that doesn't exist");
    }
  }
}

TriangleSurface::Corners TriangleSurface::corners(std::size_t triangle) const noexcept {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  return {mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]};
}

TriangleSurface::BoundingSphere TriangleSurface::bounding_sphere(std::size_t begin, std::size_t end) const noexcept {
  Vec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
  double square = 0.0;
  const auto for_each_corner = [&](const auto& function) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [a, b, c] = corners(i);
      for (const Vec3& p : {a, b, c}) function(p);
    }
  };
  for_each_corner([&](const Vec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); });
  const Vec3 centre = 0.5 * (lower + upper);
  for_each_corner([&](const Vec3& p) { square = std::max(square, glm::dot(p - centre, p - centre)); });
  return {centre, std::sqrt(square) + padding, begin, end, 0};
}

void TriangleSurface::grow(std::size_t begin, std::size_t end) {
  const std::size_t node = spheres_.size();
  spheres_.push_back(bounding_sphere(begin, end));
  if (!spheres_[node].is_leaf()) {
    Vec3 sum(0.0), sum_of_squares(0.0);
    const auto middle_of = [&](const auto& t) {
      return (mesh_.positions[t[0]] + mesh_.positions[t[1]] + mesh_.positions[t[2]]) / 3.0;
    };
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 middle = middle_of(mesh_.triangles[i]) - spheres_[node].centre;
      sum += middle, sum_of_squares += middle * middle;
    }
    const Vec3 spread = sum_of_squares - sum * sum / static_cast<double>(end - begin);
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    const auto at = [&](std::size_t i) { return mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(i); };
    std::stable_sort(at(begin), at(end),
                     [&](const auto& s, const auto& t) { return middle_of(s)[axis] < middle_of(t)[axis]; });
    const std::size_t half = begin + (end - begin) / 2;
    grow(begin, half);
    grow(half, end);
  }
  spheres_[node].next = spheres_.size();
}

template <typename MayConcern, typename LookAt>
void TriangleSurface::visit(const MayConcern& may_concern, const LookAt& look_at) const noexcept {
  for (std::size_t node = 0; node < spheres_.size();) {
    const BoundingSphere& sphere = spheres_[node];
    if (!may_concern(sphere)) {
      node = sphere.next;
      continue;
    }
    for (std::size_t i = sphere.begin; sphere.is_leaf() && i < sphere.end; ++i) look_at(corners(i));
    ++node;
  }
}

std::optional<float> TriangleSurface::first_hit(const Vec3& origin, const Vec3& direction, float t_max) const noexcept {
  if (!(t_max > 0.0F)) return std::nullopt;
  float nearest = t_max;
  const double square_length = glm::dot(direction, direction);
  const auto may_hit = [&](const BoundingSphere& sphere) {
    const Vec3 offset = sphere.centre - origin;
    const double along = std::clamp(glm::dot(offset, direction) / square_length, 0.0, static_cast<double>(nearest));
    const Vec3 miss = offset - direction * along;
    return glm::dot(miss, miss) <= sphere.radius * sphere.radius;
  };
  visit(may_hit, [&](const Corners& triangle) {
    const float distance = distance_to_triangle(origin, direction, triangle.a, triangle.b, triangle.c);
    if (distance >= 0.0F && distance < nearest) nearest = distance;
  });
  return nearest < t_max ? std::optional(nearest) : std::nullopt;
}

Vec3 TriangleSurface::normal_near(const Vec3& point) const noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 normal(0.0, 1.0, 0.0);
  const auto may_be_nearer = [&](const BoundingSphere& sphere) {
    return glm::distance(point, sphere.centre) - sphere.radius < nearest;
  };
  visit(may_be_nearer, [&](const Corners& triangle) {
    const Vec3 facing = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const double distance = glm::distance(point, nearest_point(point, triangle.a, triangle.b, triangle.c));
    if (!(distance < nearest) || facing == Vec3(0.0)) return;
    nearest = distance;
    normal = glm::normalize(facing);
  });
  return normal;
}

}  // namespace pirsim
