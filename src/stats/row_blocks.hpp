// One result row per data row, computed in parallel.
#pragma once

#include <algorithm>
#include <vector>

#include "core/parallel.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats::detail {

/// (n_rows x n_columns): row i is compute(i), a std::vector<double> of n_columns. Blocks of rows go to the threads.
template <typename Compute>
Matrix<double> map_rows(std::size_t n_rows, std::size_t n_columns, unsigned threads, const Compute& compute) {
  constexpr std::size_t block = 64;
  Matrix<double> result(n_rows, n_columns);
  std::size_t next = 0;
  ordered_parallel<std::vector<std::vector<double>>>((n_rows + block - 1) / block, threads,
                                                     [&](std::size_t i) {
                                                       std::vector<std::vector<double>> rows;
                                                       for (std::size_t row = i * block;
                                                            row < std::min(n_rows, (i + 1) * block); ++row)
                                                         rows.push_back(compute(row));
                                                       return rows;
                                                     },
                                                     [&](std::vector<std::vector<double>>& rows) {
                                                       for (const std::vector<double>& row : rows)
                                                         std::copy(row.begin(), row.end(), result.row(next++).begin());
                                                     });
  return result;
}

}  // namespace pirsim::stats::detail
