#include "pirsim/geometry.hpp"

#include <algorithm>
#include <cmath>

#include "pirsim/error.hpp"

namespace pirsim {

FloorGrid::FloorGrid(const FloorArea& floor, double spacing_m)
    : spacing_m_(spacing_m), middle_(0.5 * (floor.lower() + floor.upper())) {
  constexpr double most_squares = 2e7;
  const Vec2 size = (floor.upper() - floor.lower()) / spacing_m;
  if (size.x * size.y > most_squares) throw Error(ErrorCode::infeasible, "the grid has more than 20 million squares");
  n_columns_ = static_cast<std::size_t>(std::ceil(size.x));
  n_rows_ = static_cast<std::size_t>(std::ceil(size.y));
  for (std::size_t row = 0; row < n_rows_; ++row) {
    for (std::size_t column = 0; column < n_columns_; ++column) {
      on_floor_.push_back(floor.contains(centre(column, row)) ? 1 : 0);
    }
  }
  n_squares_ = static_cast<std::size_t>(std::ranges::count(on_floor_, 1));
}

Vec2 FloorGrid::centre(std::size_t column, std::size_t row) const noexcept {
  const auto from_middle = [](std::size_t index, std::size_t count) {
    return static_cast<double>(index) - (static_cast<double>(count) - 1.0) / 2.0;
  };
  return {middle_.x + spacing_m_ * from_middle(column, n_columns_), middle_.y + spacing_m_ * from_middle(row, n_rows_)};
}

}  // namespace pirsim
