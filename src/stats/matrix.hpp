// A rectangle of numbers, row after row. The layer's own, so that no linear-algebra library shows in a header.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "model/core/parallel.hpp"
#include "pirsim/error.hpp"

namespace pirsim::stats {

/// (rows x columns), row-major: a row is one dataset, a column one feature.
template <typename T>
class Matrix {
 public:
  Matrix() = default;
  Matrix(std::size_t rows, std::size_t columns, T value = T{})
      : rows_(rows), columns_(columns), values_(rows * columns, value) {}

  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::size_t columns() const noexcept { return columns_; }
  [[nodiscard]] T& operator()(std::size_t row, std::size_t column) { return values_[row * columns_ + column]; }
  [[nodiscard]] const T& operator()(std::size_t row, std::size_t column) const {
    return values_[row * columns_ + column];
  }
  [[nodiscard]] std::span<T> row(std::size_t index) { return std::span(values_).subspan(index * columns_, columns_); }
  [[nodiscard]] std::span<const T> row(std::size_t index) const {
    return std::span(values_).subspan(index * columns_, columns_);
  }
  [[nodiscard]] std::span<T> values() noexcept { return values_; }
  [[nodiscard]] std::span<const T> values() const noexcept { return values_; }

  /// An empty matrix takes the first row's length as its number of columns; later rows must have as many.
  void append_row(std::span<const T> row) {
    if (rows_ == 0) columns_ = row.size();
    values_.insert(values_.end(), row.begin(), row.begin() + static_cast<std::ptrdiff_t>(columns_));
    ++rows_;
  }
  [[nodiscard]] std::vector<T> column(std::size_t index) const {
    std::vector<T> values;
    for (std::size_t r = 0; r < rows_; ++r) values.push_back((*this)(r, index));
    return values;
  }
  /// The rows of the given indices, in their order.
  [[nodiscard]] Matrix select_rows(std::span<const std::size_t> indices) const {
    Matrix selected(indices.size(), columns_);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const auto from = row(indices[i]);
      std::copy(from.begin(), from.end(), selected.row(i).begin());
    }
    return selected;
  }
  /// The columns of the given indices, in their order.
  [[nodiscard]] Matrix select_columns(std::span<const std::size_t> indices) const {
    Matrix selected(rows_, indices.size());
    for (std::size_t r = 0; r < rows_; ++r)
      for (std::size_t i = 0; i < indices.size(); ++i) selected(r, i) = (*this)(r, indices[i]);
    return selected;
  }
  bool operator==(const Matrix&) const = default;

 private:
  std::size_t rows_ = 0, columns_ = 0;
  std::vector<T> values_;
};

// What several methods share.

/// (n) 0 to n - 1.
[[nodiscard]] inline std::vector<std::size_t> numbers_to(std::size_t n) {
  std::vector<std::size_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

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
