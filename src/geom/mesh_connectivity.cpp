#include "geom/mesh_connectivity.hpp"

#include <algorithm>

namespace pirsim::detail {

MeshConnectivity::MeshConnectivity(const TriMesh& mesh) {
  for (const Vec3& p : mesh.positions) {
    half_edges_.add_vertex(OpenMesh::Vec3f(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)));
  }
  for (const auto& triangle : mesh.triangles) {
    const auto vertex = [&](int corner) { return OpenMesh::VertexHandle(static_cast<int>(triangle[corner])); };
    const Corners as_given{vertex(0), vertex(1), vertex(2)};
    const Corners turned{vertex(0), vertex(2), vertex(1)};
    if (attachable(as_given)) {
      half_edges_.add_face(as_given[0], as_given[1], as_given[2]);
    } else if (attachable(turned)) {
      half_edges_.add_face(turned[0], turned[1], turned[2]);
    } else {
      ++non_manifold_triangles_;
    }
  }
}

bool MeshConnectivity::attachable(const Corners& corners) const {
  std::array<OpenMesh::HalfedgeHandle, 3> edges;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!half_edges_.is_boundary(corners[i])) return false;  // the fan round this vertex is closed already
    edges[i] = half_edges_.find_halfedge(corners[i], corners[(i + 1) % 3]);
    if (edges[i].is_valid() && !half_edges_.is_boundary(edges[i])) return false;  // this side has a triangle already
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto prev = edges[i];
    const auto next = edges[(i + 1) % 3];
    if (prev.is_valid() && next.is_valid() && half_edges_.next_halfedge_handle(prev) != next &&
        !has_free_gap(prev, next)) {
      return false;
    }
  }
  return true;
}

bool MeshConnectivity::has_free_gap(OpenMesh::HalfedgeHandle inner_prev, OpenMesh::HalfedgeHandle inner_next) const {
  // Another patch of the fan lies between the two edges; it has to move to a gap elsewhere round the vertex.
  auto boundary_prev = half_edges_.opposite_halfedge_handle(inner_next);
  do {
    boundary_prev = half_edges_.opposite_halfedge_handle(half_edges_.next_halfedge_handle(boundary_prev));
  } while (!half_edges_.is_boundary(boundary_prev));
  return boundary_prev != inner_prev;
}

std::vector<std::vector<std::uint32_t>> MeshConnectivity::boundary_loops() const {
  std::vector<std::vector<std::uint32_t>> loops;
  std::vector<bool> visited(half_edges_.n_halfedges(), false);
  for (const auto start : half_edges_.halfedges()) {
    if (!half_edges_.is_boundary(start) || visited[static_cast<std::size_t>(start.idx())]) continue;
    std::vector<std::uint32_t> loop;
    OpenMesh::HalfedgeHandle edge = start;
    do {
      visited[static_cast<std::size_t>(edge.idx())] = true;
      loop.push_back(static_cast<std::uint32_t>(half_edges_.to_vertex_handle(edge).idx()));
      edge = half_edges_.next_halfedge_handle(edge);
    } while (edge != start);
    std::reverse(loop.begin(), loop.end());  // a boundary half-edge runs with the surface on its right
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace pirsim::detail
