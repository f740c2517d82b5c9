// Outlines of a floor plan.
#include <algorithm>
#include <limits>
#include <vector>

#include "studies/suggested_floor.hpp"

namespace pirsim::studies {
namespace {

/// Cuts a slit from every hole that has other rooms in it to the outside: an outline has no holes.
void open_holes(const FloorPlan& plan, int room, Cells& cells) {
  constexpr std::size_t half_width = 1;
  for (const CellHole& hole : holes_of(plan.grid, cells)) {
    const auto is_other = [&](std::size_t cell) {
      return plan.room_of_cell[cell] >= 0 && plan.room_of_cell[cell] != room;
    };
    if (hole.is_at_edge || std::ranges::none_of(hole.cells, is_other)) continue;
    const std::size_t top = *std::ranges::min_element(hole.cells);
    for (std::size_t at = top; at >= plan.grid.n_columns; at -= plan.grid.n_columns) {
      for (std::size_t c = at - half_width; c <= at + half_width; ++c) cells[c] = 0;
    }
  }
}

/// The part of a plan round one room: the rest needs no time.
FloorPlan part_round(const FloorPlan& plan, int room) {
  constexpr std::size_t margin = 4;
  const CellGrid& grid = plan.grid;
  std::size_t left = grid.n_columns, right = 0, top = grid.n_rows, bottom = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (plan.room_of_cell[i] != room) continue;
    left = std::min(left, i % grid.n_columns), right = std::max(right, i % grid.n_columns);
    top = std::min(top, i / grid.n_columns), bottom = std::max(bottom, i / grid.n_columns);
  }
  left -= std::min(left, margin), top -= std::min(top, margin);
  right = std::min(right + margin, grid.n_columns - 1), bottom = std::min(bottom + margin, grid.n_rows - 1);
  FloorPlan part = plan;
  part.grid.corner = grid.corner + grid.side_m * Vec2(static_cast<double>(left), static_cast<double>(top));
  part.grid.n_columns = right + 1 - left, part.grid.n_rows = bottom + 1 - top;
  part.room_of_cell.clear();
  for (std::size_t row = top; row <= bottom; ++row) {
    const auto first = plan.room_of_cell.begin() + static_cast<std::ptrdiff_t>(row * grid.n_columns);
    part.room_of_cell.insert(part.room_of_cell.end(), first + static_cast<std::ptrdiff_t>(left),
                             first + static_cast<std::ptrdiff_t>(right + 1));
  }
  return part;
}

}  // namespace

std::vector<std::vector<Vec2>> floor_outlines(const FloorPlan& plan) {
  constexpr double half_wall_m = 0.25;  // assumed: of the thickest inner walls (0.1-0.3)
  Cells rooms(plan.grid.size());
  for (std::size_t i = 0; i < rooms.size(); ++i) rooms[i] = plan.room_of_cell[i] >= 0 ? 1 : 0;
  Cells whole = shrunk(plan.grid, grown(plan.grid, rooms, half_wall_m), half_wall_m);
  for (std::size_t i = 0; i < rooms.size(); ++i) whole[i] |= rooms[i];
  fill_holes(plan.grid, whole, std::numeric_limits<double>::infinity());
  return outlines_of(plan.grid, whole, 1.2 * plan.grid.side_m);
}

std::vector<Vec2> room_outline(const FloorPlan& whole, int room) {
  const FloorPlan plan = part_round(whole, room);
  const double side_m = plan.grid.side_m;
  Cells cells(plan.grid.size());
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = plan.room_of_cell[i] == room ? 1 : 0;
  // A square off the walls and the neighbours, so that outlines without their lesser corners don't meet.
  cells = grown(plan.grid, shrunk(plan.grid, cells, 2.2 * side_m), 1.0 * side_m);
  open_holes(plan, room, cells);
  std::vector<std::vector<Vec2>> outlines = outlines_of(plan.grid, cells, 0.75 * side_m);
  if (outlines.empty()) return {};
  const auto size = [](const std::vector<Vec2>& loop) { return FloorArea({loop}, 0.0).area_m2(); };
  return *std::ranges::max_element(outlines, {}, size);
}

}  // namespace pirsim::studies
