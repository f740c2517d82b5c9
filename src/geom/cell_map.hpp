// Squares of a level plane: which are taken, how far the others are from them, into which regions narrow gaps cut them,
// and what outlines those have. Squares are numbered row by row.
#pragma once

#include <cstddef>
#include <cstdint>
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
