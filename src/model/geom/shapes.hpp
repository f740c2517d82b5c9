// Triangles against boxes, and closed surfaces of triangles in boxes.
#pragma once

#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "pirsim/geometry.hpp"
#include "pirsim/shapes.hpp"

namespace pirsim {

// The one ray test of triangles, in double precision; Embree only leaves triangles of a room out. Embree's own test
// lets a ray that is aimed exactly at a vertex slip through now and then (6 in 10,000 measured with 3.13.5 and
// RTC_SCENE_FLAG_ROBUST), and its distances depend on the instruction set.

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

/// Immutable and safe to share between threads. A tree of spheres leaves out triangles that a query can't concern; what
/// it finds is what a loop over all triangles finds.
class TriangleSurface {
 public:
  /// Throws Error(usage) for a mesh without triangles, with a vertex that isn't finite or an index that is none.
  explicit TriangleSurface(TriMesh mesh);

  /// The triangles, in the order that the tree brought them into.
  [[nodiscard]] const TriMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const Vec3& lower() const noexcept { return lower_; }
  [[nodiscard]] const Vec3& upper() const noexcept { return upper_; }

  /// Distance to the nearest triangle in lengths of `direction` (which is 1 but for rounding), if
  /// 0 <= distance < t_max; triangles have no back.
  [[nodiscard]] std::optional<float> first_hit(const Vec3& origin, const Vec3& direction, float t_max) const noexcept;
  /// Unit normal of the triangle nearest to `point`.
  [[nodiscard]] Vec3 normal_near(const Vec3& point) const noexcept;

 private:
  /// Around triangles [begin, end), both halves of which follow as nodes of their own unless it is a leaf.
  struct BoundingSphere {
    Vec3 centre{0.0};
    double radius = 0.0;
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t next = 0;  ///< the first node that isn't below this one
    [[nodiscard]] bool is_leaf() const noexcept { return end - begin <= most_in_leaf; }
  };
  static constexpr std::size_t most_in_leaf = 4;

  struct Corners {
    Vec3 a, b, c;
  };
  [[nodiscard]] Corners corners(std::size_t triangle) const noexcept;
  void check() const;
  void grow(std::size_t begin, std::size_t end);
  [[nodiscard]] BoundingSphere bounding_sphere(std::size_t begin, std::size_t end) const noexcept;
  /// Calls `look_at` with the corners of all triangles but those in spheres that can't concern the query.
  template <typename MayConcern, typename LookAt>
  void visit(const MayConcern& may_concern, const LookAt& look_at) const noexcept;

  TriMesh mesh_;
  Vec3 lower_{0.0};
  Vec3 upper_{0.0};
  std::vector<BoundingSphere> spheres_;  ///< depth first
};

}  // namespace pirsim
