// Our matrices seen as Eigen's.
#pragma once

// The same sums on every processor: products are cut into blocks for fixed sizes of caches instead of those of the
// machine, and roots don't begin with an estimate that differs from one maker to the next.
#define EIGEN_NO_CPUID
#define EIGEN_FAST_MATH 0
#include <Eigen/Dense>

#include "stats/matrix.hpp"

namespace pirsim::stats::detail {

template <typename T>
using RowMajor = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <typename T>
Eigen::Map<const RowMajor<T>> as_eigen(const Matrix<T>& matrix) {
  return {matrix.values().data(), static_cast<Eigen::Index>(matrix.rows()),
          static_cast<Eigen::Index>(matrix.columns())};
}

template <typename T>
Eigen::Map<RowMajor<T>> as_eigen(Matrix<T>& matrix) {
  return {matrix.values().data(), static_cast<Eigen::Index>(matrix.rows()),
          static_cast<Eigen::Index>(matrix.columns())};
}

template <typename T>
Eigen::Map<const Eigen::VectorX<T>> as_eigen(std::span<const T> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

template <typename T = double, typename Derived>
Matrix<T> to_matrix(const Eigen::MatrixBase<Derived>& from) {
  Matrix<T> to(static_cast<std::size_t>(from.rows()), static_cast<std::size_t>(from.cols()));
  as_eigen(to) = from.template cast<T>();
  return to;
}

}  // namespace pirsim::stats::detail
