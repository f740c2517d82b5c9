#include "geom/mesh_connectivity.hpp"

#include <algorithm>
#include <compare>
#include <limits>
#include <utility>

namespace pirsim::detail {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();

/// Neighbour of triangle t across its edge from corner i to i + 1, at [3 t + i]; nobody at a rim and where three or
/// more triangles meet.
std::vector<std::size_t> neighbours_across_edges(const std::vector<Triangle>& triangles) {
  struct Side {
    std::uint32_t low, high;
    std::size_t index;  ///< 3 t + i
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t index = 0; index < 3 * triangles.size(); ++index) {
    const auto [low, high] = std::minmax(triangles[index / 3][index % 3], triangles[index / 3][(index + 1) % 3]);
    sides.push_back({low, high, index});
  }
  std::sort(sides.begin(), sides.end());
  std::vector<std::size_t> neighbours(sides.size(), nobody);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].low == sides[first].low && sides[last].high == sides[first].high) ++last;
    if (last - first != 2) continue;
    neighbours[sides[first].index] = sides[first + 1].index / 3;
    neighbours[sides[first + 1].index] = sides[first].index / 3;
  }
  return neighbours;
}

bool has_directed_edge(const Triangle& triangle, std::uint32_t from, std::uint32_t to) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (triangle[i] == from && triangle[(i + 1) % 3] == to) return true;
  }
  return false;
}

/// The triangles patch by patch, each turned to agree with the one it is reached from.
std::vector<Triangle> consistently_wound(const std::vector<Triangle>& triangles) {
  const std::vector<std::size_t> neighbours = neighbours_across_edges(triangles);
  std::vector<bool> reached(triangles.size(), false), turned(triangles.size(), false);
  std::vector<std::size_t> order;
  order.reserve(triangles.size());
  for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
    if (reached[seed]) continue;
    reached[seed] = true;
    order.push_back(seed);
    for (std::size_t next = order.size() - 1; next < order.size(); ++next) {  // breadth first
      const std::size_t t = order[next];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t neighbour = neighbours[3 * t + i];
        if (neighbour == nobody || reached[neighbour]) continue;
        reached[neighbour] = true;
        const bool same_way = has_directed_edge(triangles[neighbour], triangles[t][i], triangles[t][(i + 1) % 3]);
        turned[neighbour] = same_way != turned[t];
        order.push_back(neighbour);
      }
    }
  }
  std::vector<Triangle> result;
  result.reserve(triangles.size());
  for (const std::size_t t : order) {
    result.push_back(triangles[t]);
    if (turned[t]) std::swap(result.back()[1], result.back()[2]);
  }
  return result;
}

}  // namespace

MeshConnectivity::MeshConnectivity(const TriMesh& mesh) {
  for (const Vec3& p : mesh.positions) {
    half_edges_.add_vertex(OpenMesh::Vec3f(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)));
  }
  for (const Triangle& triangle : consistently_wound(mesh.triangles)) {
    const auto vertex = [&](std::size_t corner) { return OpenMesh::VertexHandle(static_cast<int>(triangle[corner])); };
    const Corners corners{vertex(0), vertex(1), vertex(2)};
    if (attachable(corners)) {
      half_edges_.add_face(corners[0], corners[1], corners[2]);
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
