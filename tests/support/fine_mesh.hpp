// Solids as fine meshes, to compare the two with each other.
#pragma once

#include <memory>
#include <numbers>
#include <utility>

#include "model/geom/shapes.hpp"
#include "support/random_scene.hpp"

namespace pirsim::testing {

inline MeshSolid mesh_solid(TriMesh mesh) { return {std::make_shared<const TriangleSurface>(std::move(mesh))}; }

/// A capsule along Y (or a sphere: half_length 0), inscribed, of 2 n rings of 4 n flat faces. With the step
/// s = pi / 2 n it is missed by r (1 - cos^2(s / 2)) <= r s^2 / 4 at most.
inline TriMesh round_mesh(double radius, double half_length, std::uint32_t n) {
  TriMesh mesh{"round", {}, {}};
  const std::uint32_t sectors = 4 * n;
  const double step = 0.5 * std::numbers::pi / n;
  const auto add_ring = [&](double polar, double offset) {
    for (std::uint32_t i = 0; i < sectors; ++i) {
      mesh.positions.emplace_back(radius * std::sin(polar) * std::sin(i * step), offset + radius * std::cos(polar),
                                  radius * std::sin(polar) * std::cos(i * step));
    }
  };
  for (std::uint32_t i = 0; i <= n; ++i) add_ring(i * step, half_length);
  for (std::uint32_t i = n; i <= 2 * n; ++i) add_ring(i * step, -half_length);
  const auto n_vertices = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t ring = 0; ring + sectors < n_vertices; ring += sectors) {
    for (std::uint32_t i = 0; i < sectors; ++i) {
      const std::uint32_t next = (i + 1) % sectors, below = ring + sectors;
      mesh.triangles.push_back({ring + i, below + i, below + next});
      mesh.triangles.push_back({ring + i, below + next, ring + next});
    }
  }
  return clean(mesh).mesh;  // the poles and a sphere's equator make triangles without area
}

inline constexpr std::uint32_t fine = 24;  ///< rings from pole to equator

inline MeshSolid meshed(const Shape& shape, std::uint32_t n) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return mesh_solid(round_mesh(sphere->radius, 0.0, n));
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return mesh_solid(round_mesh(capsule->radius, capsule->half_length, n));
  }
  const Vec3& half = std::get<Box>(shape).half_extents;
  return mesh_solid(box_mesh(-half, half));
}
inline MeshSolid fine_mesh(const Shape& shape) { return meshed(shape, fine); }
/// Metres by which fine_mesh() misses the solid at most.
inline double fineness(const Shape& shape) {
  const double step = 0.5 * std::numbers::pi / fine;
  const auto* sphere = std::get_if<Sphere>(&shape);
  const auto* capsule = std::get_if<Capsule>(&shape);
  return 0.25 * step * step * (sphere != nullptr ? sphere->radius : capsule != nullptr ? capsule->radius : 0.0);
}

/// Triangles of any kind and size within half a metre, from needles to plates; open and crossing each other.
inline TriMesh triangle_soup(Draw& draw, std::uint32_t n_triangles) {
  TriMesh mesh{"soup", {}, {}};
  for (std::uint32_t i = 0; i < n_triangles; ++i) {
    const Vec3 middle = draw.inside(Vec3(-0.25), Vec3(0.25));
    const double size = draw.between(0.01, 0.2);
    for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(middle + size * draw.direction());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

inline TriMesh mirrored(TriMesh mesh) {
  for (Vec3& position : mesh.positions) position = mirrored(position);
  return mesh;
}

}  // namespace pirsim::testing
