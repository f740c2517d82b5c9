// A rectangle of numbers, row after row. The layer's own, so that no linear-algebra library shows in a header.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

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

}  // namespace pirsim::stats
