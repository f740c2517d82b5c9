// Statistics of one sensor's bits in one run. Private to reconcile.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "reconcile/data/statistics.hpp"

namespace pirsim::reconcile {

/// One sensor's main part with what is expected of it: (n_main) each, bits 0, 1 or unknown_bit.
struct BitSeries {
  std::span<const std::uint8_t> bits;
  std::span<const float> expected;
  std::span<const std::uint8_t> busy;
  double cycle_rows = 3.0;
};

/// A number for every statistic of one cell.
struct CellValues {
  std::array<double, n_cell_statistics> values{};
  [[nodiscard]] double& operator[](CellStatistic s) noexcept { return values[static_cast<std::size_t>(s)]; }
  [[nodiscard]] double operator[](CellStatistic s) const noexcept { return values[static_cast<std::size_t>(s)]; }
};

/// Those of the main part; the others stay as they are.
void add_main_statistics(const BitSeries& series, double window_s, CellValues& values);

// How closely two numbers go together. Private to reconcile.

/// Pearson's coefficient of pairs that come one by one.
class Correlation {
 public:
  void add(double a, double b) noexcept {
    n_ += 1.0;
    a_ += a;
    b_ += b;
    aa_ += a * a;
    bb_ += b * b;
    ab_ += a * b;
  }
  /// 0 if one of the two doesn't vary.
  [[nodiscard]] double value() const {
    const double variance = (n_ * aa_ - a_ * a_) * (n_ * bb_ - b_ * b_);
    return variance > 1e-9 ? (n_ * ab_ - a_ * b_) / std::sqrt(variance) : 0.0;
  }

 private:
  double n_ = 0.0, a_ = 0.0, b_ = 0.0, aa_ = 0.0, bb_ = 0.0, ab_ = 0.0;
};

}  // namespace pirsim::reconcile
