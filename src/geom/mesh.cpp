#include "pirsim/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "geom/mesh_connectivity.hpp"
#include "pirsim/error.hpp"

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
