// Level surfaces and walls of a model, on squares.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <utility>

#include "studies/suggested_floor.hpp"

namespace pirsim::studies {
namespace {

// All assumed, for rooms that people live and work in; tried on the models of docs/validation/foreign_models.md.
constexpr double level_part = 0.98;    ///< least upward part of a level surface's normal (tried 0.9-0.99)
constexpr double same_floor_m = 0.08;  ///< thresholds and carpets (0.05-0.1)
constexpr double head_m = 1.7;         ///< where walls are cut: above furniture, below lintels (1.5-1.9)
constexpr double knee_m = 0.3;         ///< where a sill is (0.2-0.5)
constexpr double least_ceiling_m = 1.9, most_ceiling_m = 8.0;
constexpr double filled_hole_m2 = 3.0;  ///< of a floor, where furniture stands (1-5)

using Meshes = std::span<const TriMesh* const>;
using Corners = std::array<Vec3, 3>;

void each_triangle(Meshes meshes, const auto& visit) {
  for (const TriMesh* mesh : meshes) {
    for (const auto& [a, b, c] : mesh->triangles)
      visit(Corners{mesh->positions[a], mesh->positions[b], mesh->positions[c]});
  }
}
Vec3 area_vector(const Corners& t) { return 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]); }
bool is_level(const Corners& t) {
  const Vec3 area = area_vector(t);
  return std::abs(area.y) >= level_part * glm::length(area);
}
double lowest(const Corners& t) { return std::min({t[0].y, t[1].y, t[2].y}); }
double highest(const Corners& t) { return std::max({t[0].y, t[1].y, t[2].y}); }

/// Where triangles cross a height.
void take_section(Cells& cells, const CellGrid& grid, Meshes meshes, double height_m) {
  each_triangle(meshes, [&](const Corners& t) {
    if (lowest(t) > height_m || highest(t) <= height_m) return;
    std::vector<Vec2> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &p = t[i], &q = t[(i + 1) % 3];
      if ((p.y <= height_m) == (q.y <= height_m)) continue;
      ends.push_back(floor_point(p + (height_m - p.y) / (q.y - p.y) * (q - p)));
    }
    if (ends.size() == 2) take_line(cells, grid, ends[0], ends[1]);
  });
}

void take_seen_from_above(Cells& cells, const CellGrid& grid, Meshes meshes, double from_m, double to_m) {
  // assumed: floors above one another some hundreds of times; what is made to take longer is left out
  constexpr double most_times = 1000.0;
  double left_m2 = most_times * static_cast<double>(grid.size()) * grid.side_m * grid.side_m;
  each_triangle(meshes, [&](const Corners& t) {
    if (lowest(t) < from_m || highest(t) > to_m || !is_level(t) || left_m2 <= 0.0) return;
    left_m2 -= std::abs(area_vector(t).y);
    take_triangle(cells, grid, floor_point(t[0]), floor_point(t[1]), floor_point(t[2]));
  });
}

CellGrid grid_of(Meshes meshes, double height_m, double side_m) {
  constexpr double margin_m = 0.5;
  constexpr std::size_t most_cells = 3'000'000;
  Vec2 lower(std::numeric_limits<double>::max()), upper(std::numeric_limits<double>::lowest());
  each_triangle(meshes, [&](const Corners& t) {
    if (std::abs(lowest(t) - height_m) > same_floor_m || !is_level(t)) return;
    for (const Vec3& p : t) lower = glm::min(lower, floor_point(p)), upper = glm::max(upper, floor_point(p));
  });
  if (lower.x > upper.x) lower = upper = Vec2(0.0);
  return {lower, upper, margin_m, side_m, most_cells};
}

}  // namespace

FloorMaps maps_of(Meshes meshes, double height_m, double side_m) {
  FloorMaps maps{grid_of(meshes, height_m, side_m), {}, {}, {}, {}, {}, {}};
  for (Cells* cells : {&maps.floor, &maps.walls, &maps.sills, &maps.ceiling, &maps.low})
    cells->assign(maps.grid.size(), 0);
  double top_m = height_m;
  each_triangle(meshes, [&](const Corners& t) { top_m = std::max(top_m, highest(t)); });
  const double cut_m = height_m + std::min(head_m, 0.85 * (top_m - height_m));  // walls of some models are cut lower
  take_seen_from_above(maps.floor, maps.grid, meshes, height_m - same_floor_m, height_m + same_floor_m);
  take_seen_from_above(maps.ceiling, maps.grid, meshes, height_m + least_ceiling_m, height_m + most_ceiling_m);
  take_seen_from_above(maps.low, maps.grid, meshes, height_m + same_floor_m, height_m + head_m);
  take_section(maps.walls, maps.grid, meshes, cut_m);
  take_section(maps.sills, maps.grid, meshes, height_m + knee_m);
  Cells floor_and_walls = maps.floor;
  for (std::size_t i = 0; i < floor_and_walls.size(); ++i) floor_and_walls[i] |= maps.walls[i];
  fill_holes(maps.grid, floor_and_walls, filled_hole_m2);
  maps.blocked.assign(maps.grid.size(), 0);
  for (std::size_t i = 0; i < maps.blocked.size(); ++i) {
    if (floor_and_walls[i] != 0) maps.floor[i] = 1;
    maps.blocked[i] = maps.walls[i] != 0 || floor_and_walls[i] == 0 ? 1 : 0;
  }
  return maps;
}

std::vector<double> level_heights_m(Meshes meshes) {
  constexpr double bin_m = 0.02, least_m2 = 1.0, least_part = 0.1;
  constexpr double surely_m2 = 8.0;  // assumed (5-12): a room's floor, however large the ground around it is
  constexpr std::size_t most = 12;
  std::map<long, double> areas;  // by bin
  each_triangle(meshes, [&](const Corners& t) {
    if (is_level(t)) areas[std::lround((t[0].y + t[1].y + t[2].y) / 3.0 / bin_m)] += std::abs(area_vector(t).y);
  });
  std::vector<std::pair<double, long>> levels;
  for (const auto& [bin, area] : areas) levels.emplace_back(-area, bin);
  std::ranges::sort(levels);
  std::vector<double> heights;
  for (const auto& [area, bin] : levels) {
    const double height_m = static_cast<double>(bin) * bin_m;
    const auto is_near = [&](double known) { return std::abs(known - height_m) <= 1.5 * same_floor_m; };
    const double least = std::clamp(-least_part * levels.front().first, least_m2, surely_m2);
    if (-area < least || heights.size() == most) break;
    if (std::ranges::none_of(heights, is_near)) heights.push_back(height_m);
  }
  std::ranges::sort(heights);
  return heights;
}

}  // namespace pirsim::studies
