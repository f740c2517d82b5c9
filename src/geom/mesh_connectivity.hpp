// Half-edge connectivity of a triangle mesh, through OpenMesh. Private to geom.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <cstdint>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim::detail {

/// The manifold part of a mesh, and the triangles that a half-edge structure can't hold. OpenMesh reports such
/// triangles on a global error stream, which a library must not write to; so they are told apart beforehand by the
/// same topological conditions that OpenMesh tests.
class MeshConnectivity {
 public:
  /// Triangles must have three different vertices. Which way round they are given doesn't matter: within the
  /// structure neighbours agree.
  explicit MeshConnectivity(const TriMesh& mesh);

  [[nodiscard]] std::size_t non_manifold_triangles() const noexcept { return non_manifold_triangles_; }
  /// Closed rims as vertex indices, each with the surface on its left, in order of the first half-edge.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> boundary_loops() const;

 private:
  using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<>;
  using Corners = std::array<OpenMesh::VertexHandle, 3>;

  [[nodiscard]] bool attachable(const Corners& corners) const;
  [[nodiscard]] bool has_free_gap(OpenMesh::HalfedgeHandle inner_prev, OpenMesh::HalfedgeHandle inner_next) const;

  HalfEdgeMesh half_edges_;
  std::size_t non_manifold_triangles_ = 0;
};

}  // namespace pirsim::detail
