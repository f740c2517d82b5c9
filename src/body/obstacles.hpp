// What is in the way of walkers, found by place.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "body/footprint.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::body {

/// Keeps rounding from deciding between places that are mirror images of each other.
inline constexpr double rounding_m = 1e-9;

/// Footprints in the squares that they touch, so that a question costs what is near and not what there is.
class Obstacles {
 public:
  Obstacles() = default;
  explicit Obstacles(std::vector<Footprint> footprints);

  [[nodiscard]] const std::vector<Footprint>& all() const noexcept { return footprints_; }

  /// Whether visit(footprint) is true of one. Visits all that come within reach_m of the segment ab, some that don't,
  /// and some more than once.
  template <class Visit>
  [[nodiscard]] bool any_near(const Vec2& a, const Vec2& b, double reach_m, const Visit& visit) const {
    constexpr double to_spare_m = 1e-6;
    const double reach = reach_m + to_spare_m;
    const double lowest = std::min(a.y, b.y) - reach, highest = std::max(a.y, b.y) + reach;
    for (std::size_t row = row_of(lowest), last = row_of(highest); row <= last && row < n_rows_; ++row) {
      const auto [left, right] = crossing(a, b, row, reach);
      for (std::size_t column = column_of(left - reach), end = column_of(right + reach); column <= end; ++column) {
        for (const std::uint32_t index : in_square(row * n_columns_ + column)) {
          if (visit(footprints_[index])) return true;
        }
      }
    }
    return false;
  }

  /// Does the segment ab keep that far from all, but for a rounding?
  [[nodiscard]] bool clear(const Vec2& a, const Vec2& b, double keep_m) const noexcept;

 private:
  struct Interval {
    double left, right;
  };
  /// The x of that part of ab which is within `reach` of the row.
  [[nodiscard]] Interval crossing(const Vec2& a, const Vec2& b, std::size_t row, double reach) const noexcept;
  [[nodiscard]] std::size_t row_of(double z) const noexcept { return place(z - corner_.y, n_rows_); }
  [[nodiscard]] std::size_t column_of(double x) const noexcept { return place(x - corner_.x, n_columns_); }
  /// The last one or the first one of what lies outside.
  [[nodiscard]] std::size_t place(double from_corner_m, std::size_t n) const noexcept {
    return static_cast<std::size_t>(std::clamp(from_corner_m / side_m_, 0.0, static_cast<double>(n - 1)));
  }
  [[nodiscard]] std::span<const std::uint32_t> in_square(std::size_t square) const noexcept {
    return std::span(indices_).subspan(begins_[square], begins_[square + 1] - begins_[square]);
  }
  template <class Visit>
  void each_square(const Footprint& footprint, const Visit& visit) const;

  std::vector<Footprint> footprints_;
  Vec2 corner_{0.0};
  double side_m_ = 0.5;  ///< the least: somewhat more than walkers keep clear
  std::size_t n_columns_ = 0, n_rows_ = 0;
  std::vector<std::size_t> begins_;     ///< (n_squares + 1) in indices_
  std::vector<std::uint32_t> indices_;  ///< of footprints, square by square
};

}  // namespace pirsim::body
