// Squares of a level plane: which are taken, how far the others are from them, into which regions narrow gaps cut them,
// and what outlines those have. Squares are numbered row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim {

struct CellGrid {
  Vec2 corner{0.0};  ///< (x, z) of the lower corner of square 0
  double side_m = 1.0;
  std::size_t n_columns = 0, n_rows = 0;

  /// Over a rectangle with a margin, in squares of side_m, or larger ones if there would be more than `most`.
  CellGrid(const Vec2& lower, const Vec2& upper, double margin_m, double wanted_side_m, std::size_t most);

  [[nodiscard]] std::size_t size() const noexcept { return n_columns * n_rows; }
  [[nodiscard]] Vec2 centre(std::size_t cell) const noexcept;
  /// The square that a point lies in, or the nearest one.
  [[nodiscard]] std::size_t at(const Vec2& point) const noexcept;
  /// Those left, right, below and above that exist.
  void each_neighbour(std::size_t cell, const auto& visit) const {
    const std::size_t column = cell % n_columns, row = cell / n_columns;
    if (column > 0) visit(cell - 1);
    if (column + 1 < n_columns) visit(cell + 1);
    if (row > 0) visit(cell - n_columns);
    if (row + 1 < n_rows) visit(cell + n_columns);
  }
};

/// (n_cells) 1 or 0.
using Cells = std::vector<std::uint8_t>;

/// Takes every square that a line passes through.
void take_line(Cells& cells, const CellGrid& grid, const Vec2& from, const Vec2& to);
/// Takes every square whose centre a triangle covers.
void take_triangle(Cells& cells, const CellGrid& grid, const Vec2& a, const Vec2& b, const Vec2& c);

/// (n_cells) from each centre to the nearest centre of a taken square; 0 for these, infinite if there are none.
[[nodiscard]] std::vector<double> distances_m(const CellGrid& grid, const Cells& taken);

/// All squares no farther than a distance from what is taken; the opposite: from what isn't.
[[nodiscard]] Cells grown(const CellGrid& grid, const Cells& taken, double by_m);
[[nodiscard]] Cells shrunk(const CellGrid& grid, Cells taken, double by_m);

/// Squares that aren't taken and share sides.
struct CellHole {
  std::vector<std::size_t> cells;
  bool is_at_edge = false;  ///< of the grid
};
[[nodiscard]] std::vector<CellHole> holes_of(const CellGrid& grid, const Cells& taken);
/// Takes what is enclosed, up to a size.
void fill_holes(const CellGrid& grid, Cells& taken, double most_m2);

/// Where two regions meet.
struct RegionGap {
  int a = 0, b = 0;  ///< regions, a < b
  std::size_t cell = 0;
  double width_m = 0.0;  ///< between what is on both sides of its middle
};
struct Regions {
  std::vector<int> of_cell;  ///< (n_cells) number of its region; -1 for taken squares
  int count = 0;
  std::vector<RegionGap> gaps;  ///< by regions, the widest first
};
struct RegionLimits {
  double widest_gap_m = 1.25;     ///< what is wider doesn't part regions
  double least_narrowing = 0.87;  ///< nor what is wider than so much of the narrower region
};
/// Floods the map from its widest places on. distance_m: of distances_m().
[[nodiscard]] Regions regions_of(const CellGrid& grid, const std::vector<double>& distance_m,
                                 const RegionLimits& limits);

/// Outer outlines of what is taken, one of each part whose squares share sides, counter-clockwise seen from above;
/// corners that are within tolerance_m of the line between others are left out.
[[nodiscard]] std::vector<std::vector<Vec2>> outlines_of(const CellGrid& grid, const Cells& taken, double tolerance_m);

}  // namespace pirsim

// Rooms of a model: where one can stand at a height, cut at gaps as wide as a door. Private to studies.

namespace pirsim::studies {

/// An opening; `to` is -1 for the outside.
struct FloorGap {
  int from = 0, to = -1;
  Vec2 at{0.0};
  Vec2 inwards{0.0};
  double width_m = 0.0;
  int leaf = -1;  ///< what shuts it, by its place among the leaves; -1: nothing
};
/// A box on the floor plan that may be the leaf of a door: thin, and as high as one.
struct Leaf {
  Vec2 middle{0.0};
  Vec2 across{0.0};  ///< through the opening, of length 1
  double width_m = 0.0, thickness_m = 0.0;
};

struct FloorPlan {
  double height_m = 0.0;
  CellGrid grid{{}, {}, 0.0, 1.0, 1};
  std::vector<int> room_of_cell;  ///< (n_cells) -1: none
  int n_rooms = 0;
  std::vector<FloorGap> gaps;
  bool is_open = false;      ///< the only way in is a side without walls
  bool is_bare = false;      ///< nothing is inside of walls or below a ceiling, and the largest region is taken
  double standing_m2 = 0.0;  ///< of rooms, where one can stand upright
  double covered_m2 = 0.0;   ///< of it, below a ceiling
  [[nodiscard]] int room_at(const Vec2& place) const { return room_of_cell[grid.at(place)]; }
};

/// What a plan is made from.
struct FloorMaps {
  CellGrid grid;
  Cells floor, walls, sills, ceiling;
  Cells low;      ///< where something is above the floor, too low to stand below
  Cells blocked;  ///< walls, and where there is no floor
};
enum class FloorFrom { surfaces, walls };  ///< walls: all that they enclose, whatever is below
[[nodiscard]] FloorMaps maps_of(std::span<const TriMesh* const> meshes, double height_m, double side_m,
                                FloorFrom from = FloorFrom::surfaces);

/// Heights of large level surfaces, from below.
[[nodiscard]] std::vector<double> level_heights_m(std::span<const TriMesh* const> meshes);

/// meshes: in the room's frame. Of the leaves those count that part two regions, or one from the outside.
[[nodiscard]] FloorPlan floor_plan_at(std::span<const TriMesh* const> meshes, std::span<const Leaf> leaves,
                                      double height_m, double side_m, FloorFrom from = FloorFrom::surfaces);

/// Outlines of the whole floor, inner walls included.
[[nodiscard]] std::vector<std::vector<Vec2>> floor_outlines(const FloorPlan& plan);
/// The outline of one room; none overlap. Empty for a room that is too narrow to have one.
[[nodiscard]] std::vector<Vec2> room_outline(const FloorPlan& whole, int room);

}  // namespace pirsim::studies
