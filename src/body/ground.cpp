#include "body/ground.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <string>
#include <utility>

#include "pirsim/error.hpp"

namespace pirsim::body {
namespace {

constexpr double cell_m = FloorCells::side_m;
constexpr double max_cells = 2.5e7;  ///< assumed: an airport's hall of 1.2 km x 200 m just fits, in some 500 MB
/// How far the strip of an entrance reaches into the room. assumed: more than the depth of a door's reveal (0.1-0.5).
constexpr double strip_inside_m = 0.5;
/// How far the strip goes on behind the place where people wait. assumed: a body's length of room (0.3-1 m).
constexpr double strip_beyond_m = 0.5;

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

void lay(FloorCells& grid, const FloorArea& floor, std::span<const EntranceSpec> entrances) {
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
  grid.lower = 0.5 * (least + most) - 0.5 * cell_m * cells;
  grid.columns = static_cast<int>(cells.x);
  grid.rows = static_cast<int>(cells.y);
  grid.on_floor.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Vec2 p = grid.centre(column, row);
      const bool on_strip = std::any_of(strips.begin(), strips.end(),
                                        [&](const Strip& strip) { return strip.contains(p, floor.height_m()); });
      grid.on_floor.push_back(on_strip || floor.contains(p) ? 1 : 0);
    }
  }
}

}  // namespace

int FloorCells::column_of(double x) const noexcept {
  return static_cast<int>(std::floor(std::clamp((x - lower.x) / side_m, -1.0, static_cast<double>(columns))));
}
int FloorCells::row_of(double z) const noexcept {
  return static_cast<int>(std::floor(std::clamp((z - lower.y) / side_m, -1.0, static_cast<double>(rows))));
}

bool FloorCells::floor_at(int column, int row) const noexcept {
  if (column < 0 || column >= columns || row < 0 || row >= rows) return false;
  return on_floor[static_cast<std::size_t>(row * columns + column)] != 0;
}

bool FloorCells::floor_along(const Vec2& a, const Vec2& b) const noexcept {
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
  double next_x = left_x == 0 ? 2.0 : (lower.x + side_m * (column + (side_x > 0 ? 1 : 0)) - a.x) / way.x;
  double next_z = left_z == 0 ? 2.0 : (lower.y + side_m * (row + (side_z > 0 ? 1 : 0)) - a.y) / way.y;
  while (left_x + left_z > 0) {
    if (left_z == 0 || (left_x > 0 && next_x < next_z)) {
      column += side_x;
      next_x += side_m / std::abs(way.x);
      --left_x;
    } else {
      row += side_z;
      next_z += side_m / std::abs(way.y);
      --left_z;
    }
    if (!floor_at(column, row)) return false;
  }
  return true;
}

Ground::Ground(const FloorArea& floor, std::span<const EntranceSpec> entrances, std::span<const TriMesh> meshes,
               double reach_m) {
  auto cells = std::make_shared<FloorCells>();
  cells->n_meshes = meshes.size();
  cells->obstacles = Obstacles(footprints(meshes, floor.height_m() + solid_from_m, floor.height_m() + solid_to_m));
  lay(*cells, floor, entrances);
  cells_ = std::move(cells);
  measure_cells(reach_m + 2.0 * cell_m);  // a step may begin beyond and come near on its way
  measure_steps(reach_m);
}

void Ground::measure_cells(double reach_m) {
  room_m_.assign(cells_->on_floor.size(), std::numeric_limits<double>::infinity());
  for (const Footprint& obstacle : cells_->obstacles.all()) {
    cells_->each_near(obstacle.lower, obstacle.upper, reach_m, [&](int cell) {
      double& room = room_m_[static_cast<std::size_t>(cell)];
      const Vec2 centre = cells_->centre(cell);
      if (distance_bound(centre, centre, obstacle) < room) room = std::min(room, distance(centre, obstacle));
    });
  }
}

/// Both ends of a step between walkable cells have room; what is left to know is where it passes a corner.
void Ground::measure_steps(double reach_m) {
  for (int row = 0; row < cells_->rows; ++row) {
    for (int column = 0; column < cells_->columns; ++column) {
      const double room_here_m = room_at(column, row);
      if (room_here_m <= 0.0 || room_here_m > reach_m + 2.0 * cell_m) continue;
      for (int direction = 0; direction < n_directions / 2; ++direction) {
        const Step step = steps[static_cast<std::size_t>(direction)];
        if (!cells_->floor_at(column, row) || !cells_->floor_at(column + step.column, row + step.row)) continue;
        const double at_ends_m = std::min(room_here_m, room_at(column + step.column, row + step.row));
        const double room_m =
            room_between(cells_->centre(column, row), cells_->centre(column + step.column, row + step.row), reach_m);
        if (room_m < at_ends_m) narrow_steps_.push_back({row * cells_->columns + column, direction, room_m});
      }
    }
  }
}

/// Infinite beyond the reach.
double Ground::room_between(const Vec2& a, const Vec2& b, double reach_m) const {
  double room_m = std::numeric_limits<double>::infinity();
  (void)cells_->obstacles.any_near(a, b, reach_m, [&](const Footprint& obstacle) {
    // Rounding may tell the two ways apart; a step is taken both ways or not at all.
    if (distance_bound(a, b, obstacle) < std::min(room_m, reach_m))
      room_m = std::min({room_m, distance(a, b, obstacle), distance(b, a, obstacle)});
    return false;
  });
  return room_m;
}

std::vector<std::uint8_t> Ground::open_cells(double clearance_m) const {
  std::vector<std::uint8_t> open = cells_->on_floor;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (room_m_[i] < clearance_m - rounding_m) open[i] = 0;
  }
  return open;
}

StepGrid Ground::steps_between(std::span<const std::uint8_t> open, double clearance_m) const {
  StepGrid grid{cells_->columns, cells_->rows, std::vector<std::uint8_t>(open.size(), 0)};
  const auto is_open = [&](int column, int row) {
    return column >= 0 && column < grid.columns && row >= 0 && row < grid.rows &&
           open[static_cast<std::size_t>(row * grid.columns + column)] != 0;
  };
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
  for (const NarrowStep& step : narrow_steps_) {
    if (step.room_m < clearance_m - rounding_m) grid.close(step.cell, step.direction);
  }
  return grid;
}

}  // namespace pirsim::body
