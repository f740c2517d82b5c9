#include "body/obstacles.hpp"

#include <glm/common.hpp>
#include <utility>

namespace pirsim::body {

Obstacles::Obstacles(std::vector<Footprint> footprints) : footprints_(std::move(footprints)) {
  if (footprints_.empty()) return;
  Vec2 lower = footprints_.front().lower, upper = footprints_.front().upper;
  for (const Footprint& footprint : footprints_) {
    lower = glm::min(lower, footprint.lower);
    upper = glm::max(upper, footprint.upper);
  }
  corner_ = lower;
  // Larger squares where footprints are large, so that the table grows with their number alone.
  constexpr double most_squares_each = 16.0;
  const auto n_touched = [&](const Vec2& size) { return (size.x / side_m_ + 1.0) * (size.y / side_m_ + 1.0); };
  for (;; side_m_ *= 2.0) {
    double n = n_touched(upper - lower);
    for (const Footprint& footprint : footprints_) n += n_touched(footprint.upper - footprint.lower);
    if (n <= most_squares_each * static_cast<double>(footprints_.size()) + 4096.0) break;
  }
  n_columns_ = static_cast<std::size_t>((upper.x - lower.x) / side_m_) + 1;
  n_rows_ = static_cast<std::size_t>((upper.y - lower.y) / side_m_) + 1;
  begins_.assign(n_columns_ * n_rows_ + 1, 0);
  for (const Footprint& footprint : footprints_) each_square(footprint, [&](std::size_t at) { ++begins_[at + 1]; });
  for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
  indices_.resize(begins_.back());
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  for (std::uint32_t i = 0; i < footprints_.size(); ++i) {
    each_square(footprints_[i], [&](std::size_t at) { indices_[next[at]++] = i; });
  }
}

template <class Visit>
void Obstacles::each_square(const Footprint& footprint, const Visit& visit) const {
  for (std::size_t row = row_of(footprint.lower.y); row <= row_of(footprint.upper.y); ++row) {
    for (std::size_t column = column_of(footprint.lower.x); column <= column_of(footprint.upper.x); ++column) {
      visit(row * n_columns_ + column);
    }
  }
}

Obstacles::Interval Obstacles::crossing(const Vec2& a, const Vec2& b, std::size_t row, double reach) const noexcept {
  if (a.y == b.y) return {std::min(a.x, b.x), std::max(a.x, b.x)};
  const double begin = corner_.y + side_m_ * static_cast<double>(row);
  const auto x_at = [&](double z) { return a.x + std::clamp((z - a.y) / (b.y - a.y), 0.0, 1.0) * (b.x - a.x); };
  const double first = x_at(begin - reach), last = x_at(begin + side_m_ + reach);
  return {std::min(first, last), std::max(first, last)};
}

bool Obstacles::clear(const Vec2& a, const Vec2& b, double keep_m) const noexcept {
  const double limit = keep_m - rounding_m;
  return !any_near(a, b, keep_m, [&](const Footprint& footprint) {
    return distance_bound(a, b, footprint) < limit && distance(a, b, footprint) < limit;
  });
}

}  // namespace pirsim::body
