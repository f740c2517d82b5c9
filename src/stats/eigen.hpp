// Our matrices seen as Eigen's.
#pragma once

#include <Eigen/Dense>

#include "pirsim/stats/matrix.hpp"

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
