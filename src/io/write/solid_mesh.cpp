#include "io/write/gltf_builder.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "geom/triangle_surface.hpp"

namespace pirsim::io {
namespace {

constexpr std::uint32_t sectors = 24;       ///< round the axis
constexpr std::uint32_t quarter_rings = 6;  ///< from a pole to the equator

/// A circle of vertices about the Y axis.
struct Ring {
  double polar;   ///< angle of its normals from +Y
  double offset;  ///< of the centre of its cap along Y
};

std::vector<Ring> rings_of(double half_length) {
  std::vector<Ring> rings;
  const double step = 0.5 * std::numbers::pi / quarter_rings;
  for (std::uint32_t i = 1; i <= quarter_rings; ++i) rings.push_back({i * step, half_length});
  // The equator is there twice if a cylinder lies between.
  for (std::uint32_t i = half_length > 0.0 ? 0 : 1; i < quarter_rings; ++i) {
    rings.push_back({0.5 * std::numbers::pi + i * step, -half_length});
  }
  return rings;
}

void add_vertex(SolidMesh& mesh, double radius, double offset, const Vec3& normal) {
  mesh.positions.push_back(radius * normal + Vec3(0.0, offset, 0.0));
  mesh.normals.push_back(normal);
}

/// A capsule along Y, or with half_length 0 a sphere.
SolidMesh round_solid(double radius, double half_length) {
  SolidMesh mesh;
  const std::vector<Ring> rings = rings_of(half_length);
  for (const Ring& ring : rings) {
    for (std::uint32_t i = 0; i < sectors; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / sectors;
      const double across = std::sin(ring.polar);
      add_vertex(mesh, radius, ring.offset,
                 {across * std::sin(azimuth), std::cos(ring.polar), across * std::cos(azimuth)});
    }
  }
  const auto top = static_cast<std::uint32_t>(mesh.positions.size());
  add_vertex(mesh, radius, half_length, {0.0, 1.0, 0.0});
  add_vertex(mesh, radius, -half_length, {0.0, -1.0, 0.0});
  const auto last_ring = static_cast<std::uint32_t>(rings.size() - 1) * sectors;
  for (std::uint32_t i = 0; i < sectors; ++i) {
    const std::uint32_t next = (i + 1) % sectors;
    mesh.indices.insert(mesh.indices.end(), {top, i, next});
    for (std::uint32_t ring = 0; ring < last_ring; ring += sectors) {
      const std::uint32_t below = ring + sectors;
      mesh.indices.insert(mesh.indices.end(), {ring + i, below + i, below + next, ring + i, below + next, ring + next});
    }
    mesh.indices.insert(mesh.indices.end(), {top + 1, last_ring + next, last_ring + i});
  }
  return mesh;
}

SolidMesh box(const Vec3& half_extents) {
  SolidMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 normal(0.0);
      Vec3 across(0.0);
      Vec3 along(0.0);
      normal[axis] = side;
      across[(axis + 1) % 3] = 1.0;
      along[(axis + 2) % 3] = side;  // so that normal = across x along
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const Vec3& corner : {-across - along, across - along, across + along, along - across}) {
        mesh.positions.push_back(half_extents * (normal + corner));
        mesh.normals.push_back(normal);
      }
      mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
  }
  return mesh;
}

/// The triangles as they are, each with corners of its own.
SolidMesh flat_shaded(const TriMesh& given) {
  SolidMesh mesh;
  for (const auto& [a, b, c] : given.triangles) {
    const std::array<Vec3, 3> corners{given.positions[a], given.positions[b], given.positions[c]};
    const Vec3 facing = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double length = glm::length(facing);
    if (length == 0.0) continue;
    for (const Vec3& corner : corners) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(corner);
      mesh.normals.push_back(facing / length);
    }
  }
  return mesh;
}

struct Tessellation {
  SolidMesh operator()(const Sphere& sphere) const { return round_solid(sphere.radius, 0.0); }
  SolidMesh operator()(const Capsule& capsule) const { return round_solid(capsule.radius, capsule.half_length); }
  SolidMesh operator()(const Box& solid) const { return box(solid.half_extents); }
  SolidMesh operator()(const MeshSolid& solid) const { return flat_shaded(solid.surface->mesh()); }
};

}  // namespace

SolidMesh tessellated(const Shape& shape) { return std::visit(Tessellation{}, shape); }

}  // namespace pirsim::io
