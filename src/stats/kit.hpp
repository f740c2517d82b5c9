// What several methods share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "pirsim/error.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {

// One way to refuse an argument.

/// Throws Error(usage) unless the condition holds.
inline void require(bool condition, const char* message) {
  if (!condition) throw Error(ErrorCode::usage, message);
}

template <typename Range>
void require_finite(const Range& values, const char* message) {
  for (const auto value : values) require(std::isfinite(value), message);
}

}  // namespace pirsim::stats

namespace pirsim::stats::detail {

// Some of a list.

/// The values at the given places, in their order.
template <typename T>
[[nodiscard]] std::vector<T> select(std::span<const T> values, std::span<const std::size_t> places) {
  std::vector<T> selected;
  selected.reserve(places.size());
  for (const std::size_t place : places) selected.push_back(values[place]);
  return selected;
}

// Logs of odds as probabilities.

/// Sums to 1; logs: at least one, up to a number that all share.
inline std::vector<double> softmax(std::vector<double> logs) {
  const double largest = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (double& log : logs) sum += log = std::exp(log - largest);
  for (double& log : logs) log /= sum;
  return logs;
}

// One result row per data row, computed in parallel.

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
