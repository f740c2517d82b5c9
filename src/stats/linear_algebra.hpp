#pragma once

// Our matrices seen as Eigen's, and its decompositions. These take Eigen half a minute each to compile: they are
// compiled once, in linear_algebra.cpp.

// The same sums on every processor: products are cut into blocks for fixed sizes of caches instead of those of the
// machine, and roots don't begin with an estimate that differs from one maker to the next.
#define EIGEN_NO_CPUID
#define EIGEN_FAST_MATH 0
#include <Eigen/Core>

#include <span>

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

/// Lower triangle of a positive definite matrix A = L L'.
class Cholesky {
 public:
  explicit Cholesky(const Eigen::MatrixXd& matrix);
  [[nodiscard]] Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& right) const;  ///< X of L X = right
  [[nodiscard]] Eigen::MatrixXd solve_upper(const Eigen::MatrixXd& right) const;  ///< X of L' X = right
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;        ///< X of A X = right

 private:
  Eigen::MatrixXd factor_;  ///< L; what is above its diagonal has no meaning
};

/// Thin: A = U diag(s) V', s descending; U and V have as many columns as s has values.
struct SingularValues {
  Eigen::MatrixXd u;
  Eigen::VectorXd s;
  Eigen::MatrixXd v;  ///< empty if not asked for
};
enum class Sides { left, both };
[[nodiscard]] SingularValues singular_values(const Eigen::MatrixXd& matrix, Sides sides);
/// V alone, more exactly, of a matrix with few columns.
[[nodiscard]] Eigen::MatrixXd right_singular_vectors(const Eigen::MatrixXd& matrix);

[[nodiscard]] Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd& matrix);
/// x of A x = right, A symmetric.
[[nodiscard]] Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// X that brings A X nearest to right; without any doubt about it, or the shortest of several.
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
[[nodiscard]] Eigen::MatrixXd shortest_least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
/// As many orthonormal columns as the matrix has, which span the same.
[[nodiscard]] Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& matrix);

// Rows by their class: what discriminants and class shapes begin with.

/// Throws Error(usage) unless there are rows and columns, as many labels as rows, all in [0, n_classes), each class at
/// least `fewest` times, and all features finite.
void check_labelled(const Matrix<float>& features, std::span<const int> labels, int n_classes, int fewest);

struct Groups {
  Eigen::MatrixXd means;      ///< (n_classes x n_columns)
  Eigen::MatrixXd residuals;  ///< (n_rows x n_columns) rows less the mean of their class
};
[[nodiscard]] Groups group(const Matrix<float>& features, std::span<const int> labels, int n_classes);

/// Divides each column by its root mean square; one that is all but 0 becomes 0. Returns what was multiplied with.
Eigen::RowVectorXd scale_columns(Eigen::MatrixXd& residuals);

}  // namespace pirsim::stats::detail
