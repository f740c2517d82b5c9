// The floor as it is for walkers of all sizes: its cells, what stands on it, and how much room there is.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "body/obstacles.hpp"
#include "body/way_search.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::body {

/// The floor area and the strips that lead out through the entrances as cells, and what is in the way of walkers.
struct FloorCells {
  static constexpr double side_m = 0.1;

  Vec2 lower{0.0};
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> on_floor;  ///< (rows x columns) 1 where the centre is on the floor or a strip
  std::size_t n_meshes = 0;
  Obstacles obstacles;

  [[nodiscard]] Vec2 centre(int column, int row) const noexcept {
    return lower + side_m * Vec2(column + 0.5, row + 0.5);
  }
  [[nodiscard]] Vec2 centre(int cell) const noexcept { return centre(cell % columns, cell / columns); }
  [[nodiscard]] int column_of(double x) const noexcept;  ///< -1 or columns outside
  [[nodiscard]] int row_of(double z) const noexcept;
  [[nodiscard]] bool floor_at(int column, int row) const noexcept;
  /// Every cell that the segment passes has its centre on the floor. Ref: [AmanatidesWoo1987].
  [[nodiscard]] bool floor_along(const Vec2& a, const Vec2& b) const noexcept;
  /// Those whose centre may be within reach_m of the rectangle.
  template <class Visit>
  void each_near(const Vec2& rectangle_lower, const Vec2& rectangle_upper, double reach_m, const Visit& visit) const {
    const int last_column = std::min(column_of(rectangle_upper.x + reach_m), columns - 1);
    const int last_row = std::min(row_of(rectangle_upper.y + reach_m), rows - 1);
    for (int row = std::max(row_of(rectangle_lower.y - reach_m), 0); row <= last_row; ++row) {
      for (int column = std::max(column_of(rectangle_lower.x - reach_m), 0); column <= last_column; ++column) {
        visit(row * columns + column);
      }
    }
  }
};

/// How far cells, and steps between them, are from everything solid: worked out once for people of all sizes.
class Ground {
 public:
  /// reach_m: the most that anybody keeps clear of. Throws Error(infeasible) where the floor has too many cells.
  Ground(const FloorArea& floor, std::span<const EntranceSpec> entrances, std::span<const TriMesh> meshes,
         double reach_m);

  [[nodiscard]] const std::shared_ptr<const FloorCells>& cells() const noexcept { return cells_; }
  // Of who keeps clearance_m, which is reach_m at most.
  /// (rows x columns) 1 where the cell is walkable.
  [[nodiscard]] std::vector<std::uint8_t> open_cells(double clearance_m) const;
  /// Those that are walkable throughout. open: open_cells().
  [[nodiscard]] StepGrid steps_between(std::span<const std::uint8_t> open, double clearance_m) const;

 private:
  void measure_cells(double reach_m);
  void measure_steps(double reach_m);
  [[nodiscard]] double room_at(int column, int row) const noexcept {
    return room_m_[static_cast<std::size_t>(row * cells_->columns + column)];
  }
  [[nodiscard]] double room_between(const Vec2& a, const Vec2& b, double reach_m) const;
  /// Has less room on its way than at its ends.
  struct NarrowStep {
    int cell, direction;
    double room_m;
  };

  std::shared_ptr<const FloorCells> cells_;
  std::vector<double> room_m_;  ///< (rows x columns) from a cell's centre to what is solid; infinite beyond the reach
  std::vector<NarrowStep> narrow_steps_;
};

}  // namespace pirsim::body
