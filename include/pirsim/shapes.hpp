// Solids in single precision, primitive ones and meshes, and the one exact ray test of each. Every tracer decides with
// these functions, so that all tracers give the same bit; an acceleration structure may only leave candidates out.
#pragma once

#include <glm/mat3x3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <variant>

#include "pirsim/geometry.hpp"

namespace pirsim {

class TriangleSurface;

/// `direction` has unit length, so that distances are metres.
struct Ray {
  Vec3f origin{0.0F};
  Vec3f direction{0.0F, 0.0F, -1.0F};
};

// Solids in their own frame, centred on the origin.
struct Sphere {
  double radius = 0.0;
  bool operator==(const Sphere&) const = default;
};
/// Along local Y; `half_length` is from the centre to the centre of an end cap.
struct Capsule {
  double radius = 0.0;
  double half_length = 0.0;
  bool operator==(const Capsule&) const = default;
};
struct Box {
  Vec3 half_extents{0.0};
  bool operator==(const Box&) const = default;
};
/// Any surface, closed or not, in its own frame; never null. Equal if it is the same surface in memory.
struct MeshSolid {
  std::shared_ptr<const TriangleSurface> surface;
  bool operator==(const MeshSolid&) const = default;
};
using Shape = std::variant<Sphere, Capsule, Box, MeshSolid>;

// Solids placed in the world, as the ray tests want them.
struct PosedSphere {
  Vec3f centre{0.0F};
  float radius = 0.0F;
};
struct PosedCapsule {
  Vec3f a{0.0F};  ///< centre of one end cap
  Vec3f b{0.0F};  ///< centre of the other
  float radius = 0.0F;
};
struct PosedBox {
  Vec3f centre{0.0F};
  glm::mat3 axes{1.0F};  ///< columns: the box's unit axes in the world
  Vec3f half_extents{0.0F};
};
/// The surface outlives this and every tracer that has seen it.
struct PosedMesh {
  const TriangleSurface* surface = nullptr;
  Vec3f origin{0.0F};
  glm::mat3 axes{1.0F};  ///< columns: the surface's unit axes in the world
};
using PosedShape = std::variant<PosedSphere, PosedCapsule, PosedBox, PosedMesh>;

struct Bounds {
  Vec3f lower{0.0F};
  Vec3f upper{0.0F};
};

[[nodiscard]] PosedShape place(const Shape& shape, const Frame& world_from_shape);
/// Axis-aligned box around the solid (not padded).
[[nodiscard]] Bounds bounds(const PosedShape& shape) noexcept;
/// The box along the mesh's own axes that it fills (not padded).
[[nodiscard]] PosedBox box_around(const PosedMesh& mesh) noexcept;

/// Distance in metres along the ray at which it enters the solid, if 0 <= distance < t_max; 0 if it starts inside. A
/// mesh is its surface: it is entered at the nearest triangle, seen from either side.
[[nodiscard]] std::optional<float> entry_distance(const Ray& ray, const PosedSphere& sphere, float t_max) noexcept;
[[nodiscard]] std::optional<float> entry_distance(const Ray& ray, const PosedCapsule& capsule, float t_max) noexcept;
[[nodiscard]] std::optional<float> entry_distance(const Ray& ray, const PosedBox& box, float t_max) noexcept;
[[nodiscard]] std::optional<float> entry_distance(const Ray& ray, const PosedMesh& mesh, float t_max) noexcept;
[[nodiscard]] std::optional<float> entry_distance(const Ray& ray, const PosedShape& shape, float t_max) noexcept;

/// Outward unit normal at a surface point of the solid (for pictures); of a mesh, the nearest triangle's, whose corners
/// run counter-clockwise seen from outside.
[[nodiscard]] Vec3f surface_normal(const PosedShape& shape, const Vec3f& point) noexcept;

}  // namespace pirsim
