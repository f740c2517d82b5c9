// Shortest ways over a grid of cells.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pirsim::body {

/// Which of its eight neighbours can be reached from each cell; cells count row by row.
struct StepGrid {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> open;  ///< (rows x columns) bit d is set if the step in direction d can be taken
};

struct Step {
  int column = 0;
  int row = 0;
};
inline constexpr int n_directions = 8;
/// Direction d + 4 is the way back of d; even directions are straight, odd ones diagonal.
inline constexpr std::array<Step, n_directions> steps{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
[[nodiscard]] constexpr int opposite(int direction) noexcept { return (direction + 4) % n_directions; }

/// A* with the octile distance; a straight step costs 1, a diagonal one sqrt 2. Of equally good cells the one of
/// the lowest index goes first. The cells from start to goal, both included; empty if there is no way.
[[nodiscard]] std::vector<int> shortest_way(const StepGrid& grid, int start, int goal);

/// A label per cell, equal for cells that are connected (the lowest index of them).
[[nodiscard]] std::vector<int> connected_parts(const StepGrid& grid);

}  // namespace pirsim::body
