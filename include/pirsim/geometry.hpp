// Points, frames, triangle meshes and floors. The world frame is glTF's: right-handed, metres, +Y up, floor in XZ.
// Everything that looks or faces somewhere (sensors, seats, people) does so along its local -Z, with +Y up and
// +X to its right. SI units and radians inside; degrees only at the border, through radians() and degrees().
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace pirsim {

inline constexpr double pi = std::numbers::pi;
[[nodiscard]] constexpr double radians(double degrees) noexcept { return degrees * (pi / 180.0); }
[[nodiscard]] constexpr double degrees(double radians) noexcept { return radians * (180.0 / pi); }

using Vec2 = glm::dvec2;  ///< (x, z) on the floor, metres
using Vec3 = glm::dvec3;  ///< metres, or a unit direction
using Quat = glm::dquat;  ///< unit rotation
using Vec3f = glm::vec3;  ///< single precision: what rays are traced in

/// Rigid motion; `world_from_seat * p_seat` is a point in the world. No scale.
struct Frame {
  Quat rotation{1.0, 0.0, 0.0, 0.0};
  Vec3 origin{0.0};

  [[nodiscard]] Vec3 operator*(const Vec3& point) const { return rotation * point + origin; }
  [[nodiscard]] Frame operator*(const Frame& inner) const {
    return {glm::normalize(rotation * inner.rotation), rotation * inner.origin + origin};
  }
  [[nodiscard]] Vec3 forward() const { return rotation * Vec3(0, 0, -1); }
  [[nodiscard]] Vec3 up() const { return rotation * Vec3(0, 1, 0); }
  [[nodiscard]] Vec3 right() const { return rotation * Vec3(1, 0, 0); }
  bool operator==(const Frame&) const = default;
};

[[nodiscard]] inline Frame inverse(const Frame& a_from_b) {
  const Quat rotation = glm::conjugate(a_from_b.rotation);
  return {rotation, rotation * -a_from_b.origin};
}

/// Heading: radians about +Y, 0 facing -Z, positive turning left (counter-clockwise seen from above).
[[nodiscard]] inline Quat rotation_from_heading(double heading) { return glm::angleAxis(heading, Vec3(0, 1, 0)); }
[[nodiscard]] inline double heading_of(const Vec2& direction_xz) {
  return std::atan2(-direction_xz.x, -direction_xz.y);
}
[[nodiscard]] inline double heading_of(const Frame& frame) {
  const Vec3 forward = frame.forward();
  return heading_of(Vec2(forward.x, forward.z));
}
/// Unit (x, z) of a heading.
[[nodiscard]] inline Vec2 direction_of(double heading) { return {-std::sin(heading), -std::cos(heading)}; }

[[nodiscard]] inline Vec2 floor_point(const Vec3& p) { return {p.x, p.z}; }

// The floor on which people walk and are counted: a polygon with holes in the XZ plane at one height.

class FloorArea {
 public:
  FloorArea() = default;
  /// loops: closed polygons in (x, z), inside by the even-odd rule; height_m: y of the floor.
  FloorArea(std::vector<std::vector<Vec2>> loops, double height_m);

  /// Even-odd rule; a point on an edge counts for exactly one of two areas that share the edge.
  [[nodiscard]] bool contains(const Vec2& point) const noexcept;
  [[nodiscard]] double area_m2() const;
  [[nodiscard]] double height_m() const noexcept { return height_m_; }
  [[nodiscard]] Vec2 lower() const noexcept { return lower_; }  ///< corner of the bounding rectangle
  [[nodiscard]] Vec2 upper() const noexcept { return upper_; }
  [[nodiscard]] const std::vector<std::vector<Vec2>>& loops() const noexcept { return loops_; }
  [[nodiscard]] bool empty() const noexcept { return loops_.empty(); }
  bool operator==(const FloorArea&) const = default;

 private:
  std::vector<std::vector<Vec2>> loops_;
  double height_m_ = 0.0;
  Vec2 lower_{0.0}, upper_{0.0};
};

// Triangle meshes, and their clean-up through OpenMesh.

enum class Solidity {
  solid,  ///< hides from sensors and must be walked round
  screen  ///< hides, but nobody minds it: stands for what people move with them, a chair's back
};

/// Indexed triangles. positions: (n_vertices) world metres; triangles: (n_triangles x 3) indices.
struct TriMesh {
  std::string name;
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles{};
  Solidity solidity = Solidity::solid;
  std::optional<double> temperature_c = std::nullopt;  ///< of its surface, where it differs from the room's
};

/// What clean-up found in a mesh.
struct MeshAudit {
  std::size_t welded_vertices = 0;         ///< vertices merged into an equal one
  std::size_t degenerate_triangles = 0;    ///< triangles of no area, dropped
  std::size_t duplicate_triangles = 0;     ///< same three vertices again, dropped
  std::size_t non_manifold_triangles = 0;  ///< triangles that OpenMesh can't attach as a manifold; kept as occluders
  std::size_t boundary_edges = 0;          ///< 0 for a closed surface
};

struct CleanMesh {
  TriMesh mesh;
  MeshAudit audit;
};

/// Welds vertices closer than `tolerance_m`, drops triangles without area and duplicates, and reports what a
/// half-edge structure can't hold. Nothing that occludes is lost.
[[nodiscard]] CleanMesh clean(const TriMesh& mesh, double tolerance_m = 1e-6);

/// Boundary loops of a mesh projected onto the floor, (x, z) in order; outer loops counter-clockwise seen from
/// above (from +Y), holes clockwise. Throws Error(input) for a mesh whose boundary isn't a set of simple loops.
[[nodiscard]] std::vector<std::vector<Vec2>> boundary_loops_xz(const TriMesh& mesh);

/// Squares of equal size over a floor area. Rows run along z, columns along x, both from the floor's lower corner; the
/// grid is centred on the floor's bounding rectangle, so that a symmetric floor has symmetric squares.
class FloorGrid {
 public:
  FloorGrid() = default;
  FloorGrid(const FloorArea& floor, double spacing_m);

  [[nodiscard]] std::size_t n_columns() const noexcept { return n_columns_; }
  [[nodiscard]] std::size_t n_rows() const noexcept { return n_rows_; }
  [[nodiscard]] std::size_t n_squares() const noexcept { return n_squares_; }  ///< whose centre is on the floor area
  [[nodiscard]] double spacing_m() const noexcept { return spacing_m_; }
  [[nodiscard]] Vec2 centre(std::size_t column, std::size_t row) const noexcept;
  [[nodiscard]] bool on_floor(std::size_t column, std::size_t row) const noexcept {
    return on_floor_[row * n_columns_ + column] != 0;
  }

 private:
  double spacing_m_ = 1.0;
  Vec2 middle_{0.0};
  std::size_t n_columns_ = 0, n_rows_ = 0, n_squares_ = 0;
  std::vector<std::uint8_t> on_floor_;  ///< (n_rows x n_columns)
};

}  // namespace pirsim
