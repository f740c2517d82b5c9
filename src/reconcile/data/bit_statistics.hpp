// Statistics of one sensor's bits in one run. Private to reconcile.
#pragma once

#include <array>
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

}  // namespace pirsim::reconcile
