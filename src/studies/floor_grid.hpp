// Squares of equal size over a floor area.
#pragma once

#include <cstdint>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim::studies {

/// Rows run along z, columns along x, both from the floor's lower corner; the grid is centred on the floor's bounding
/// rectangle, so that a symmetric floor has symmetric squares.
class FloorGrid {
 public:
  FloorGrid() = default;
  FloorGrid(const FloorArea& floor, double spacing_m);

  [[nodiscard]] std::size_t n_columns() const noexcept { return n_columns_; }
  [[nodiscard]] std::size_t n_rows() const noexcept { return n_rows_; }
  [[nodiscard]] std::size_t n_squares() const noexcept { return n_squares_; }  ///< whose centre is on the floor area
  [[nodiscard]] double spacing_m() const noexcept { return spacing_m_; }
  [[nodiscard]] Vec2 centre(std::size_t column, std::size_t row) const noexcept;
  [[nodiscard]] bool on_floor(std::size_t column, std::size_t row) const noexcept {
    return on_floor_[row * n_columns_ + column] != 0;
  }

 private:
  double spacing_m_ = 1.0;
  Vec2 middle_{0.0};
  std::size_t n_columns_ = 0, n_rows_ = 0, n_squares_ = 0;
  std::vector<std::uint8_t> on_floor_;  ///< (n_rows x n_columns)
};

}  // namespace pirsim::studies
