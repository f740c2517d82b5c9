// A triangle mesh that rays are traced against, as a body part may be one.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim {

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
