#include "body/walkable_floor.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "body/footprint.hpp"
#include "body/way_search.hpp"
#include "pirsim/error.hpp"

namespace pirsim::body {
namespace {

constexpr double cell_m = WalkableFloor::cell_m;
constexpr double max_cells = 2.5e7;  ///< assumed: an airport's hall of 1.2 km x 200 m just fits, in some 300 MB
constexpr double lead_m = 0.5;       ///< how far a start or goal may be from a walkable cell
/// How far the strip of an entrance reaches into the room. assumed: more than the depth of a door's reveal (0.1-0.5).
constexpr double strip_inside_m = 0.5;
/// How far the strip goes on behind the place where people wait. assumed: a body's length of room (0.3-1 m).
constexpr double strip_beyond_m = 0.5;
/// Keeps rounding from deciding between places that are mirror images of each other.
constexpr double rounding_m = 1e-9;

/// The way in and out through one entrance, a rectangle in the entrance's frame.
struct Strip {
  Frame entrance_from_world;
  double half_width_m;
  double outside_m;

  [[nodiscard]] bool contains(const Vec2& point, double height_m) const {
    const Vec3 p = entrance_from_world * Vec3(point.x, height_m, point.y);
    return std::abs(p.x) <= half_width_m && p.z >= -strip_inside_m && p.z <= outside_m + strip_beyond_m;
  }
};

bool finite(const Vec2& p) noexcept { return std::isfinite(p.x) && std::isfinite(p.y); }

double disc_distance(const Vec2& a, const Vec2& b, const Disc& disc) noexcept {
  return distance(disc.centre, a, b) - disc.radius_m;
}

}  // namespace

struct WalkableFloor::Impl {
  double clearance_m = 0.0;
  Vec2 lower{0.0};
  StepGrid grid;
  std::vector<std::uint8_t> on_floor;  ///< (rows x columns) 1 where the centre is on the floor or a strip
  std::vector<std::uint8_t> open;      ///< (rows x columns) 1 where the cell is walkable
  std::vector<int> parts;              ///< (rows x columns) labels of cells that are connected
  std::size_t n_meshes = 0;
  std::vector<Footprint> obstacles;

  void lay_grid(const FloorArea& floor, std::span<const EntranceSpec> entrances);
  void find_open_cells();
  void open_steps();
  /// Closes every step, near the rectangle, of which `too_near(a, b)` holds.
  template <typename TooNear>
  void close_steps(StepGrid& steps_left, const Vec2& rectangle_lower, const Vec2& rectangle_upper,
                   const TooNear& too_near) const;
  [[nodiscard]] StepGrid grid_around(std::span<const Disc> others) const;

  [[nodiscard]] Vec2 centre(int column, int row) const noexcept {
    return lower + cell_m * Vec2(column + 0.5, row + 0.5);
  }
  [[nodiscard]] Vec2 centre(int cell) const noexcept { return centre(cell % grid.columns, cell / grid.columns); }
  [[nodiscard]] int column_of(double x) const noexcept;  ///< -1 or columns outside
  [[nodiscard]] int row_of(double z) const noexcept;
  [[nodiscard]] bool floor_at(int column, int row) const noexcept;
  [[nodiscard]] bool floor_along(const Vec2& a, const Vec2& b) const noexcept;
  [[nodiscard]] bool clear(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept;
  [[nodiscard]] bool clear_of_obstacles(const Vec2& a, const Vec2& b, double keep_m) const noexcept;
  [[nodiscard]] bool walkable(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept {
    return floor_along(a, b) && clear(a, b, others);
  }
  [[nodiscard]] std::vector<int> leads(const Vec2& point, std::span<const Disc> others) const;
  /// find_way() where one can't go straight; labels: the parts of `grid_left`.
  [[nodiscard]] WayMemory::Way way_over(const StepGrid& grid_left, std::span<const int> labels, const Vec2& from,
                                        const Vec2& to, std::span<const Disc> others) const;
  [[nodiscard]] std::vector<int> cells_near(const Vec2& point) const;
  [[nodiscard]] std::vector<double> mesh_distances(const Vec2& point) const;
};

void WalkableFloor::Impl::lay_grid(const FloorArea& floor, std::span<const EntranceSpec> entrances) {
  std::vector<Strip> strips;
  Vec2 least(std::numeric_limits<double>::infinity());
  Vec2 most = -least;
  const auto reach_to = [&](const Vec2& p) { least = glm::min(least, p), most = glm::max(most, p); };
  if (!floor.empty()) reach_to(floor.lower()), reach_to(floor.upper());
  for (const EntranceSpec& entrance : entrances) {
    strips.push_back({inverse(entrance.world_from_entrance), 0.5 * entrance.width_m, entrance.outside_m});
    for (const double x : {-0.5 * entrance.width_m, 0.5 * entrance.width_m}) {
      for (const double z : {-strip_inside_m, entrance.outside_m + strip_beyond_m}) {
        reach_to(floor_point(entrance.world_from_entrance * Vec3(x, 0.0, z)));
      }
    }
  }
  if (!finite(least) || !finite(most)) return;
  // The grid is centred on what it covers, so that a mirrored room has a mirrored grid.
  const Vec2 cells = glm::max(glm::ceil((most - least) / cell_m - rounding_m), Vec2(1.0));
  if (cells.x * cells.y > max_cells) {
    const auto whole = [](double metres) { return std::to_string(std::llround(metres)); };
    throw Error(ErrorCode::infeasible, "the floor and its entrances span " + whole(most.x - least.x) + " m x " +
                                           whole(most.y - least.y) +
                                           " m: too large to find ways on (glTF's unit is the metre)");
  }
  lower = 0.5 * (least + most) - 0.5 * cell_m * cells;
  grid.columns = static_cast<int>(cells.x);
  grid.rows = static_cast<int>(cells.y);
  on_floor.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Vec2 p = centre(column, row);
      const bool on_strip = std::any_of(strips.begin(), strips.end(),
                                        [&](const Strip& strip) { return strip.contains(p, floor.height_m()); });
      on_floor.push_back(on_strip || floor.contains(p) ? 1 : 0);
    }
  }
}

int WalkableFloor::Impl::column_of(double x) const noexcept {
  return static_cast<int>(std::floor(std::clamp((x - lower.x) / cell_m, -1.0, static_cast<double>(grid.columns))));
}
int WalkableFloor::Impl::row_of(double z) const noexcept {
  return static_cast<int>(std::floor(std::clamp((z - lower.y) / cell_m, -1.0, static_cast<double>(grid.rows))));
}

bool WalkableFloor::Impl::floor_at(int column, int row) const noexcept {
  if (column < 0 || column >= grid.columns || row < 0 || row >= grid.rows) return false;
  return on_floor[static_cast<std::size_t>(row * grid.columns + column)] != 0;
}

void WalkableFloor::Impl::find_open_cells() {
  open = on_floor;
  for (const Footprint& obstacle : obstacles) {
    const int last_column = std::min(column_of(obstacle.upper.x + clearance_m), grid.columns - 1);
    const int last_row = std::min(row_of(obstacle.upper.y + clearance_m), grid.rows - 1);
    for (int row = std::max(row_of(obstacle.lower.y - clearance_m), 0); row <= last_row; ++row) {
      for (int column = std::max(column_of(obstacle.lower.x - clearance_m), 0); column <= last_column; ++column) {
        std::uint8_t& cell = open[static_cast<std::size_t>(row * grid.columns + column)];
        if (cell != 0 && distance(centre(column, row), obstacle) < clearance_m - rounding_m) cell = 0;
      }
    }
  }
}

void WalkableFloor::Impl::open_steps() {
  const auto is_open = [&](int column, int row) {
    return floor_at(column, row) && open[static_cast<std::size_t>(row * grid.columns + column)] != 0;
  };
  grid.open.assign(open.size(), 0);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!is_open(column, row)) continue;
      for (int direction = 0; direction < n_directions; ++direction) {
        const Step step = steps[static_cast<std::size_t>(direction)];
        // A diagonal step needs both cells that it passes between.
        if (is_open(column + step.column, row + step.row) && is_open(column + step.column, row) &&
            is_open(column, row + step.row)) {
          grid.open[static_cast<std::size_t>(row * grid.columns + column)] |=
              static_cast<std::uint8_t>(1U << direction);
        }
      }
    }
  }
  for (const Footprint& obstacle : obstacles) {
    close_steps(grid, obstacle.lower, obstacle.upper, [&](const Vec2& a, const Vec2& b) {
      // Both ends are clear, so a step that begins more than two cells off can't touch the obstacle's margin.
      return distance(a, obstacle) < clearance_m + 2.0 * cell_m && distance(a, b, obstacle) < clearance_m - rounding_m;
    });
  }
}

template <typename TooNear>
void WalkableFloor::Impl::close_steps(StepGrid& steps_left, const Vec2& rectangle_lower, const Vec2& rectangle_upper,
                                      const TooNear& too_near) const {
  const double reach = clearance_m + cell_m;
  const int last_column = std::min(column_of(rectangle_upper.x + reach), grid.columns - 1);
  const int last_row = std::min(row_of(rectangle_upper.y + reach), grid.rows - 1);
  for (int row = std::max(row_of(rectangle_lower.y - reach), 0); row <= last_row; ++row) {
    for (int column = std::max(column_of(rectangle_lower.x - reach), 0); column <= last_column; ++column) {
      const int cell = row * grid.columns + column;
      for (int direction = 0; direction < n_directions; ++direction) {
        std::uint8_t& bits = steps_left.open[static_cast<std::size_t>(cell)];
        const Step step = steps[static_cast<std::size_t>(direction)];
        if ((bits >> direction & 1) == 0) continue;
        if (!too_near(centre(column, row), centre(column + step.column, row + step.row))) continue;
        bits &= static_cast<std::uint8_t>(~(1U << direction));
        steps_left.open[static_cast<std::size_t>(cell + step.row * grid.columns + step.column)] &=
            static_cast<std::uint8_t>(~(1U << opposite(direction)));
      }
    }
  }
}

StepGrid WalkableFloor::Impl::grid_around(std::span<const Disc> others) const {
  StepGrid steps_left = grid;
  for (const Disc& disc : others) {
    close_steps(steps_left, disc.centre - disc.radius_m, disc.centre + disc.radius_m,
                [&](const Vec2& a, const Vec2& b) { return disc_distance(a, b, disc) < clearance_m - rounding_m; });
  }
  return steps_left;
}

/// Every cell that the segment passes has its centre on the floor. Ref: [AmanatidesWoo1987].
bool WalkableFloor::Impl::floor_along(const Vec2& a, const Vec2& b) const noexcept {
  if (!finite(a) || !finite(b)) return false;
  int column = column_of(a.x);
  int row = row_of(a.y);
  if (!floor_at(column, row)) return false;
  const Vec2 way = b - a;
  const int side_x = way.x > 0.0 ? 1 : -1;
  const int side_z = way.y > 0.0 ? 1 : -1;
  int left_x = std::abs(column_of(b.x) - column);
  int left_z = std::abs(row_of(b.y) - row);
  // The share of the way at which the next border in x and in z is crossed.
  double next_x = left_x == 0 ? 2.0 : (lower.x + cell_m * (column + (side_x > 0 ? 1 : 0)) - a.x) / way.x;
  double next_z = left_z == 0 ? 2.0 : (lower.y + cell_m * (row + (side_z > 0 ? 1 : 0)) - a.y) / way.y;
  while (left_x + left_z > 0) {
    if (left_z == 0 || (left_x > 0 && next_x < next_z)) {
      column += side_x;
      next_x += cell_m / std::abs(way.x);
      --left_x;
    } else {
      row += side_z;
      next_z += cell_m / std::abs(way.y);
      --left_z;
    }
    if (!floor_at(column, row)) return false;
  }
  return true;
}

bool WalkableFloor::Impl::clear(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept {
  const double limit = clearance_m - rounding_m;
  for (const Disc& disc : others) {
    if (disc_distance(a, b, disc) < limit) return false;
  }
  return clear_of_obstacles(a, b, clearance_m);
}

bool WalkableFloor::Impl::clear_of_obstacles(const Vec2& a, const Vec2& b, double keep_m) const noexcept {
  const double limit = keep_m - rounding_m;
  return std::none_of(obstacles.begin(), obstacles.end(), [&](const Footprint& obstacle) {
    return distance_bound(a, b, obstacle) < limit && distance(a, b, obstacle) < limit;
  });
}

/// Walkable cells within lead_m of the point, nearest first, ties by index.
std::vector<int> WalkableFloor::Impl::cells_near(const Vec2& point) const {
  std::vector<std::pair<double, int>> found;
  for (int row = std::max(row_of(point.y - lead_m), 0); row <= std::min(row_of(point.y + lead_m), grid.rows - 1);
       ++row) {
    const int last_column = std::min(column_of(point.x + lead_m), grid.columns - 1);
    for (int column = std::max(column_of(point.x - lead_m), 0); column <= last_column; ++column) {
      const int cell = row * grid.columns + column;
      const double away = glm::distance(point, centre(cell));
      if (open[static_cast<std::size_t>(cell)] != 0 && away <= lead_m) found.emplace_back(away, cell);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<int> cells;
  for (const auto& [away, cell] : found) cells.push_back(cell);
  return cells;
}

/// How far the point is from each mesh, clearance_m at most: what a lead from there has to keep.
std::vector<double> WalkableFloor::Impl::mesh_distances(const Vec2& point) const {
  std::vector<double> distances(n_meshes, clearance_m);
  for (const Footprint& obstacle : obstacles) {
    double& nearest = distances[obstacle.mesh];
    if (distance_bound(point, point, obstacle) < nearest) nearest = std::min(nearest, distance(point, obstacle));
  }
  return distances;
}

/// The cells to which one can go straight from the point: without coming nearer to a mesh or another person than
/// the point is, as far as it is within their clearance.
std::vector<int> WalkableFloor::Impl::leads(const Vec2& point, std::span<const Disc> others) const {
  std::vector<int> cells = cells_near(point);
  const std::vector<double> kept = mesh_distances(point);
  const bool starts_on_floor = floor_along(point, point);
  const auto barred = [&](int cell) {
    const Vec2 end = centre(cell);
    if (starts_on_floor && !floor_along(point, end)) return true;
    for (const Disc& disc : others) {
      const double keep = std::min(disc_distance(point, point, disc), clearance_m);
      if (disc_distance(end, end, disc) < clearance_m - rounding_m) return true;
      if (disc_distance(point, end, disc) < keep - rounding_m) return true;
    }
    return std::any_of(obstacles.begin(), obstacles.end(), [&](const Footprint& obstacle) {
      const double keep = kept[obstacle.mesh] - rounding_m;
      return distance_bound(point, end, obstacle) < keep && distance(point, end, obstacle) < keep;
    });
  };
  cells.erase(std::remove_if(cells.begin(), cells.end(), barred), cells.end());
  return cells;
}

WalkableFloor::WalkableFloor(const FloorArea& floor, std::span<const EntranceSpec> entrances,
                             std::span<const TriMesh> obstacles, double clearance_m)
    : known_ways_(std::make_shared<WayMemory>()) {
  auto impl = std::make_shared<Impl>();
  impl->clearance_m = clearance_m;
  impl->n_meshes = obstacles.size();
  impl->obstacles = footprints(obstacles, floor.height_m() + solid_from_m, floor.height_m() + solid_to_m);
  impl->lay_grid(floor, entrances);
  impl->find_open_cells();
  impl->open_steps();
  impl->parts = connected_parts(impl->grid);
  impl_ = std::move(impl);
}

bool WalkableFloor::walkable(const Vec2& point) const noexcept { return impl_->walkable(point, point, {}); }
bool WalkableFloor::walkable(const Vec2& a, const Vec2& b, std::span<const Disc> others) const noexcept {
  return impl_->walkable(a, b, others);
}

double WalkableFloor::clearance_m() const noexcept { return impl_->clearance_m; }

bool WalkableFloor::has_room(const Vec2& a, const Vec2& b, double clearance_m) const noexcept {
  return impl_->floor_along(a, b) && impl_->clear_of_obstacles(a, b, clearance_m);
}

WayMemory::Way WalkableFloor::Impl::way_over(const StepGrid& grid_left, std::span<const int> labels, const Vec2& from,
                                             const Vec2& to, std::span<const Disc> others) const {
  const std::vector<int> goals = leads(to, others);
  for (const int start : leads(from, others)) {
    const auto goal = std::find_if(goals.begin(), goals.end(), [&](int cell) {
      return labels[static_cast<std::size_t>(cell)] == labels[static_cast<std::size_t>(start)];
    });
    if (goal == goals.end()) continue;
    // An end that isn't walkable keeps its lead; everything else is pulled tight.
    std::vector<Vec2> way;
    if (walkable(from, from, others)) way.push_back(from);
    for (const int cell : shortest_way(grid_left, start, *goal)) way.push_back(centre(cell));
    if (walkable(to, to, others)) way.push_back(to);
    way = pulled_tight(std::move(way), [&](const Vec2& a, const Vec2& b) { return walkable(a, b, others); });
    if (way.front() != from) way.insert(way.begin(), from);
    if (way.back() != to) way.push_back(to);
    return way;
  }
  return std::nullopt;
}

std::optional<std::vector<Vec2>> WalkableFloor::find_way(const Vec2& from, const Vec2& to,
                                                         std::span<const Disc> others) const {
  if (!finite(from) || !finite(to)) return std::nullopt;
  if (from == to || walkable(from, to, others)) return std::vector<Vec2>{from, to};
  if (others.empty()) {
    return known_ways_->way(from, to, [&] { return impl_->way_over(impl_->grid, impl_->parts, from, to, {}); });
  }
  WayMemory::Others key;
  for (const Disc& disc : others) key.push_back({disc.centre.x, disc.centre.y, disc.radius_m});
  const auto left = known_ways_->left_by(std::move(key), [&] {
    StepGrid grid = impl_->grid_around(others);
    std::vector<int> parts = connected_parts(grid);
    return StepsLeft{std::move(grid), std::move(parts)};
  });
  return impl_->way_over(left->grid, left->parts, from, to, others);
}

}  // namespace pirsim::body
