#include "model/geom/mesh.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/geometry.hpp"

// Half-edge connectivity of a triangle mesh, through OpenMesh. Private to geom.

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

namespace pirsim {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

/// Multiplicative hashing with the golden ratio.
std::size_t hash_of(std::int64_t a, std::int64_t b, std::int64_t c) noexcept {
  const auto mix = [](std::size_t h, std::int64_t v) {
    h = (h ^ static_cast<std::size_t>(v)) * 0x9E3779B97F4A7C15ULL;
    return h ^ (h >> 29U);
  };
  return mix(mix(mix(0, a), b), c);
}
struct HashTriangle {
  std::size_t operator()(const Triangle& t) const noexcept { return hash_of(t[0], t[1], t[2]); }
};

/// Finds an earlier point within the tolerance through a grid of cells.
class PointGrid {
 public:
  explicit PointGrid(double tolerance_m) : tolerance_(tolerance_m), cell_(std::max(8.0 * tolerance_m, 1e-6)) {}

  /// Index of the first point so near, or of `point` itself, which is then added.
  std::uint32_t find_or_add(const Vec3& point, std::vector<Vec3>& points) {
    const Cell lower = cell_of(point - tolerance_), upper = cell_of(point + tolerance_);
    std::uint32_t nearest = no_vertex;
    for (std::int64_t x = lower.x; x <= upper.x; ++x) {
      for (std::int64_t y = lower.y; y <= upper.y; ++y) {
        for (std::int64_t z = lower.z; z <= upper.z; ++z) {
          const auto found = cells_.find({x, y, z});
          if (found == cells_.end()) continue;
          for (const std::uint32_t i : found->second) {
            if (glm::distance(points[i], point) <= tolerance_) nearest = std::min(nearest, i);
          }
        }
      }
    }
    if (nearest != no_vertex) return nearest;
    points.push_back(point);
    const auto index = static_cast<std::uint32_t>(points.size() - 1);
    cells_[cell_of(point)].push_back(index);
    return index;
  }

 private:
  struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Cell& c) const noexcept { return hash_of(c.x, c.y, c.z); }
  };
  [[nodiscard]] Cell cell_of(const Vec3& p) const {
    const auto at = [&](double v) { return static_cast<std::int64_t>(std::floor(v / cell_)); };
    return {at(p.x), at(p.y), at(p.z)};
  }

  double tolerance_;
  double cell_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> cells_;
};

/// Thinner than the tolerance: its height over the longest edge.
bool has_no_area(const Triangle& t, const std::vector<Vec3>& p, double tolerance) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  const Vec3 a = p[t[1]] - p[t[0]], b = p[t[2]] - p[t[0]];
  const double longest = std::max({glm::length(a), glm::length(b), glm::length(b - a)});
  return glm::length(glm::cross(a, b)) <= tolerance * longest;
}

/// Edges that exactly one triangle has.
std::size_t count_boundary_edges(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(std::minmax(t[i], t[(i + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  std::size_t count = 0;
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last = std::find_if(first, edges.end(), [&](const auto& edge) { return edge != *first; });
    if (last - first == 1) ++count;
    first = last;
  }
  return count;
}

void drop_unused_vertices(TriMesh& mesh) {
  std::vector<std::uint32_t> renumbered(mesh.positions.size(), no_vertex);
  std::vector<Vec3> used;
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) {
      if (renumbered[v] == no_vertex) {
        renumbered[v] = static_cast<std::uint32_t>(used.size());
        used.push_back(mesh.positions[v]);
      }
      v = renumbered[v];
    }
  }
  mesh.positions = std::move(used);
}

double twice_signed_area(const std::vector<Vec2>& loop) {
  double sum = 0.0;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
    sum += loop[j].x * loop[i].y - loop[i].x * loop[j].y;
  }
  return sum;
}

}  // namespace

CleanMesh clean(const TriMesh& mesh, double tolerance_m) {
  CleanMesh result;
  result.mesh.name = mesh.name;
  result.mesh.temperature_c = mesh.temperature_c;
  PointGrid grid(tolerance_m);
  std::vector<std::uint32_t> welded;
  welded.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) welded.push_back(grid.find_or_add(p, result.mesh.positions));
  result.audit.welded_vertices = mesh.positions.size() - result.mesh.positions.size();

  std::unordered_set<Triangle, HashTriangle> seen;
  seen.reserve(mesh.triangles.size());
  for (const Triangle& given : mesh.triangles) {
    const Triangle triangle{welded[given[0]], welded[given[1]], welded[given[2]]};
    if (has_no_area(triangle, result.mesh.positions, tolerance_m)) {
      ++result.audit.degenerate_triangles;
      continue;
    }
    Triangle key = triangle;
    std::sort(key.begin(), key.end());
    if (!seen.insert(key).second) {
      ++result.audit.duplicate_triangles;
      continue;
    }
    result.mesh.triangles.push_back(triangle);
  }
  drop_unused_vertices(result.mesh);
  result.audit.non_manifold_triangles = detail::MeshConnectivity(result.mesh).non_manifold_triangles();
  result.audit.boundary_edges = count_boundary_edges(result.mesh.triangles);
  return result;
}

std::vector<std::vector<Vec2>> boundary_loops_xz(const TriMesh& mesh) {
  const TriMesh surface = clean(mesh).mesh;
  const detail::MeshConnectivity connectivity(surface);
  const auto refuse = [&](const std::string& why) -> void {
    throw Error(ErrorCode::input, "mesh '" + mesh.name + "' has no outline on the floor: " + why);
  };
  if (connectivity.non_manifold_triangles() > 0)
    refuse("some of its triangles overlap or share an edge with two others");
  std::vector<std::vector<Vec2>> loops;
  std::vector<bool> on_a_loop(surface.positions.size(), false);
  for (const auto& rim : connectivity.boundary_loops()) {
    std::vector<Vec2>& loop = loops.emplace_back();
    for (const std::uint32_t v : rim) {
      if (on_a_loop[v]) refuse("its rim touches itself");
      on_a_loop[v] = true;
      loop.push_back(floor_point(surface.positions[v]));
    }
  }
  if (loops.empty())
    refuse(surface.triangles.empty() ? "it has no triangles" : "it is closed; a flat open surface is needed");
  for (std::vector<Vec2>& loop : loops) {
    // A loop within an even number of others is an outline. Counter-clockwise seen from +Y is a negative area in
    // (x, z), because z points down when x points right.
    const auto holds = [&](const std::vector<Vec2>& other) {
      return &other != &loop && FloorArea({other}, 0.0).contains(loop.front());
    };
    const bool outer = std::count_if(loops.begin(), loops.end(), holds) % 2 == 0;
    if ((twice_signed_area(loop) < 0.0) != outer) std::reverse(loop.begin(), loop.end());
  }
  return loops;
}

}  // namespace pirsim

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

namespace pirsim {
namespace {

using Segment = std::pair<Vec2, Vec2>;
using Key = std::pair<double, double>;
Key key_of(const Vec2& p) { return {p.x, p.y}; }

/// Where an edge meets the plane: the same bits from both triangles that share it.
Vec2 crossing(Vec3 a, Vec3 b, double height_m) {
  if (std::tie(a.x, a.y, a.z) > std::tie(b.x, b.y, b.z)) std::swap(a, b);
  return floor_point(glm::mix(a, b, (height_m - a.y) / (b.y - a.y)));
}

std::vector<Segment> segments_of(const TriMesh& mesh, double height_m) {
  std::vector<Segment> segments;
  for (const auto& triangle : mesh.triangles) {
    std::vector<Vec2> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = mesh.positions[triangle[i]], &b = mesh.positions[triangle[(i + 1) % 3]];
      if ((a.y > height_m) == (b.y > height_m)) continue;
      ends.insert(a.y > height_m ? ends.end() : ends.begin(), crossing(a, b, height_m));  // from up to down
    }
    if (ends.size() == 2 && ends[0] != ends[1]) segments.emplace_back(ends[0], ends[1]);
  }
  return segments;
}

/// Segments put together end to end.
class Chains {
 public:
  explicit Chains(std::vector<Segment> segments) : segments_(std::move(segments)), used_(segments_.size()) {
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      at_[key_of(segments_[i].first)].push_back(i);
      at_[key_of(segments_[i].second)].push_back(i);
    }
  }

  MeshSection put_together() {
    MeshSection section;
    const auto add = [&](std::vector<Vec2> chain) {
      if (chain.front() != chain.back()) return section.lines.push_back(std::move(chain));
      chain.pop_back();
      if (chain.size() >= 3) section.loops.push_back(std::move(chain));
    };
    // Lines begin at their ends; what is left then are loops.
    for (const auto& [place, meeting] : at_) {
      if (meeting.size() % 2 == 1 && !used_[meeting.front()]) add(follow({place.first, place.second}));
    }
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (!used_[i]) add(follow(segments_[i].first));
    }
    return section;
  }

 private:
  std::vector<Vec2> follow(const Vec2& from) {
    std::vector<Vec2> chain{from};
    while (true) {
      const std::vector<std::size_t>& meeting = at_.at(key_of(chain.back()));
      const auto next = std::ranges::find_if(meeting, [&](std::size_t i) { return !used_[i]; });
      if (next == meeting.end()) return chain;
      used_[*next] = true;
      const auto& [a, b] = segments_[*next];
      chain.push_back(chain.back() == a ? b : a);
    }
  }

  std::vector<Segment> segments_;
  std::vector<bool> used_;
  std::map<Key, std::vector<std::size_t>> at_;
};

}  // namespace

MeshSection section_of(const TriMesh& mesh, double height_m) {
  return Chains(segments_of(mesh, height_m)).put_together();
}

double mean_thickness_m(const std::vector<std::vector<Vec2>>& loops) {
  double length = 0.0;
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) length += glm::distance(loop[i], loop[(i + 1) % loop.size()]);
  }
  return length > 0.0 ? FloorArea(loops, 0.0).area_m2() / (0.5 * length) : 0.0;
}

}  // namespace pirsim
