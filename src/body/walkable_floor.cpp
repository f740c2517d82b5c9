#include "body/walkable_floor.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "body/ground.hpp"
#include "body/way_search.hpp"
#include "pirsim/error.hpp"

namespace pirsim::body {
namespace {

constexpr double lead_m = 0.5;  ///< how far a start or goal may be from a walkable cell

bool finite(const Vec2& p) noexcept { return std::isfinite(p.x) && std::isfinite(p.y); }

double disc_distance(const Vec2& a, const Vec2& b, const Disc& disc) noexcept {
  return distance(disc.centre, a, b) - disc.radius_m;
}

}  // namespace

struct WalkableFloor::Impl {
  double clearance_m = 0.0;
  std::shared_ptr<const FloorCells> cells;
  std::vector<std::uint8_t> open;  ///< (rows x columns) 1 where the cell is walkable
  StepGrid grid;
  std::vector<int> parts;  ///< (rows x columns) labels of cells that are connected

  [[nodiscard]] StepGrid grid_around(std::span<const Disc> others) const;
  [[nodiscard]] bool clear(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept;
  [[nodiscard]] bool walkable(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept {
    return cells->floor_along(a, b) && clear(a, b, others);
  }
  /// Whether one can go from a point to a cell near it.
  class Lead;
  struct Ends {
    int start, goal;
  };
  /// The cells near `from` and `to` between which a way over the grid leads. labels: its parts.
  [[nodiscard]] std::optional<Ends> ends(std::span<const int> labels, const Vec2& from, const Vec2& to,
                                         std::span<const Disc> others) const;
  /// find_way() where one can't go straight; labels: the parts of `grid_left`.
  [[nodiscard]] WayMemory::Way way_over(const StepGrid& grid_left, std::span<const int> labels, const Vec2& from,
                                        const Vec2& to, std::span<const Disc> others) const;
  [[nodiscard]] std::vector<int> cells_near(const Vec2& point) const;
  [[nodiscard]] std::vector<double> mesh_distances(const Vec2& point) const;
};

StepGrid WalkableFloor::Impl::grid_around(std::span<const Disc> others) const {
  StepGrid left = grid;
  for (const Disc& disc : others) {
    const auto too_near = [&](int cell, int direction) {
      return disc_distance(cells->centre(cell), cells->centre(left.neighbour(cell, direction)), disc) <
             clearance_m - rounding_m;
    };
    cells->each_near(disc.centre - disc.radius_m, disc.centre + disc.radius_m, clearance_m + WalkableFloor::cell_m,
                     [&](int cell) {
                       for (int direction = 0; direction < n_directions; ++direction) {
                         if (left.is_open(cell, direction) && too_near(cell, direction)) left.close(cell, direction);
                       }
                     });
  }
  return left;
}

bool WalkableFloor::Impl::clear(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept {
  const double limit = clearance_m - rounding_m;
  for (const Disc& disc : others) {
    if (disc_distance(a, b, disc) < limit) return false;
  }
  return cells->obstacles.clear(a, b, clearance_m);
}

/// Walkable cells within lead_m of the point, nearest first, ties by index.
std::vector<int> WalkableFloor::Impl::cells_near(const Vec2& point) const {
  std::vector<std::pair<double, int>> found;
  cells->each_near(point, point, lead_m, [&](int cell) {
    const double away = glm::distance(point, cells->centre(cell));
    if (open[static_cast<std::size_t>(cell)] != 0 && away <= lead_m) found.emplace_back(away, cell);
  });
  std::sort(found.begin(), found.end());
  std::vector<int> nearest;
  for (const auto& [away, cell] : found) nearest.push_back(cell);
  return nearest;
}

/// How far the point is from each mesh, clearance_m at most: what a lead from there has to keep.
std::vector<double> WalkableFloor::Impl::mesh_distances(const Vec2& point) const {
  std::vector<double> distances(cells->n_meshes, clearance_m);
  (void)cells->obstacles.any_near(point, point, clearance_m, [&](const Footprint& obstacle) {
    double& nearest = distances[obstacle.mesh];
    if (distance_bound(point, point, obstacle) < nearest) nearest = std::min(nearest, distance(point, obstacle));
    return false;
  });
  return distances;
}

/// Straight, and without coming nearer to a mesh or another person than the point is, as far as it is within their
/// clearance.
class WalkableFloor::Impl::Lead {
 public:
  Lead(const Impl& floor, const Vec2& point, std::span<const Disc> others)
      : floor_(floor),
        point_(point),
        others_(others),
        kept_(floor.mesh_distances(point)),
        starts_on_floor_(floor.cells->floor_along(point, point)) {}

  [[nodiscard]] bool is_open(int cell) const {
    const Vec2 end = floor_.cells->centre(cell);
    if (starts_on_floor_ && !floor_.cells->floor_along(point_, end)) return false;
    for (const Disc& disc : others_) {
      const double keep = std::min(disc_distance(point_, point_, disc), floor_.clearance_m);
      if (disc_distance(end, end, disc) < floor_.clearance_m - rounding_m) return false;
      if (disc_distance(point_, end, disc) < keep - rounding_m) return false;
    }
    return !floor_.cells->obstacles.any_near(point_, end, floor_.clearance_m, [&](const Footprint& obstacle) {
      const double keep = kept_[obstacle.mesh] - rounding_m;
      return distance_bound(point_, end, obstacle) < keep && distance(point_, end, obstacle) < keep;
    });
  }

 private:
  const Impl& floor_;
  Vec2 point_;
  std::span<const Disc> others_;
  std::vector<double> kept_;
  bool starts_on_floor_;
};

std::optional<WalkableFloor::Impl::Ends> WalkableFloor::Impl::ends(std::span<const int> labels, const Vec2& from,
                                                                   const Vec2& to, std::span<const Disc> others) const {
  const auto part_of = [&](int cell) { return labels[static_cast<std::size_t>(cell)]; };
  const std::vector<int> starts = cells_near(from), goals = cells_near(to);
  const Lead from_start(*this, from, others), to_goal(*this, to, others);
  std::vector<int> left;  // parts that one can get to from the start, but not to the goal
  for (const int start : starts) {
    if (std::ranges::find(left, part_of(start)) != left.end() || !from_start.is_open(start)) continue;
    const auto goal =
        std::ranges::find_if(goals, [&](int cell) { return part_of(cell) == part_of(start) && to_goal.is_open(cell); });
    if (goal != goals.end()) return Ends{start, *goal};
    left.push_back(part_of(start));
  }
  return std::nullopt;
}

WalkableFloor::WalkableFloor(const Ground& ground, double clearance_m) : known_ways_(std::make_shared<WayMemory>()) {
  auto impl = std::make_shared<Impl>();
  impl->clearance_m = clearance_m;
  impl->cells = ground.cells();
  impl->open = ground.open_cells(clearance_m);
  impl->grid = ground.steps_between(impl->open, clearance_m);
  impl->parts = connected_parts(impl->grid);
  impl_ = std::move(impl);
}

WalkableFloor::WalkableFloor(const FloorArea& floor, std::span<const EntranceSpec> entrances,
                             std::span<const TriMesh> obstacles, double clearance_m)
    : WalkableFloor(Ground(floor, entrances, obstacles, clearance_m), clearance_m) {}

bool WalkableFloor::walkable(const Vec2& point) const noexcept { return impl_->walkable(point, point, {}); }
bool WalkableFloor::walkable(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept {
  return impl_->walkable(a, b, others);
}

double WalkableFloor::clearance_m() const noexcept { return impl_->clearance_m; }

bool WalkableFloor::has_room(const Vec2& a, const Vec2& b, double clearance_m) const noexcept {
  return impl_->cells->floor_along(a, b) && impl_->cells->obstacles.clear(a, b, clearance_m);
}

WayMemory::Way WalkableFloor::Impl::way_over(const StepGrid& grid_left, std::span<const int> labels, const Vec2& from,
                                             const Vec2& to, std::span<const Disc> others) const {
  const auto found = ends(labels, from, to, others);
  if (!found) return std::nullopt;
  // An end that isn't walkable keeps its lead; everything else is pulled tight.
  std::vector<Vec2> way;
  if (walkable(from, from, others)) way.push_back(from);
  for (const int cell : shortest_way(grid_left, found->start, found->goal)) way.push_back(cells->centre(cell));
  if (walkable(to, to, others)) way.push_back(to);
  way = pulled_tight(std::move(way), [&](const Vec2& a, const Vec2& b) { return walkable(a, b, others); });
  if (way.front() != from) way.insert(way.begin(), from);
  if (way.back() != to) way.push_back(to);
  return way;
}

std::shared_ptr<const StepsLeft> WalkableFloor::steps_left(std::span<const Disc> others) const {
  WayMemory::Others key;
  for (const Disc& disc : others) key.push_back({disc.centre.x, disc.centre.y, disc.radius_m});
  return known_ways_->left_by(std::move(key), [&] {
    StepGrid grid = impl_->grid_around(others);
    std::vector<int> parts = connected_parts(grid);
    return StepsLeft{std::move(grid), std::move(parts)};
  });
}

std::optional<std::vector<Vec2>> WalkableFloor::find_way(const Vec2& from, const Vec2& to,
                                                         std::span<const Disc> others) const {
  if (!finite(from) || !finite(to)) return std::nullopt;
  if (from == to || walkable(from, to, others)) return std::vector<Vec2>{from, to};
  if (others.empty()) {
    return known_ways_->way(from, to, [&] { return impl_->way_over(impl_->grid, impl_->parts, from, to, {}); });
  }
  const auto left = steps_left(others);
  return impl_->way_over(left->grid, left->parts, from, to, others);
}

bool WalkableFloor::has_way(const Vec2& from, const Vec2& to, std::span<const Disc> others) const {
  if (!finite(from) || !finite(to)) return false;
  if (from == to || walkable(from, to, others)) return true;
  if (others.empty()) return impl_->ends(impl_->parts, from, to, {}).has_value();
  return impl_->ends(steps_left(others)->parts, from, to, others).has_value();
}

}  // namespace pirsim::body
