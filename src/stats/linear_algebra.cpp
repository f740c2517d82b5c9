#include "stats/linear_algebra.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cstdint>
#include <vector>

namespace pirsim::stats::detail {

Cholesky::Cholesky(const Eigen::MatrixXd& matrix) : factor_(matrix.llt().matrixLLT()) {}

Eigen::MatrixXd Cholesky::solve_lower(const Eigen::MatrixXd& right) const {
  return factor_.triangularView<Eigen::Lower>().solve(right);
}

Eigen::MatrixXd Cholesky::solve_upper(const Eigen::MatrixXd& right) const {
  return factor_.adjoint().triangularView<Eigen::Upper>().solve(right);
}

Eigen::MatrixXd Cholesky::solve(const Eigen::MatrixXd& right) const { return solve_upper(solve_lower(right)); }

SingularValues singular_values(const Eigen::MatrixXd& matrix, Sides sides) {
  const unsigned v = sides == Sides::both ? Eigen::ComputeThinV : 0;
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU | v);
  return {svd.matrixU(), svd.singularValues(), sides == Sides::both ? svd.matrixV() : Eigen::MatrixXd()};
}

Eigen::MatrixXd right_singular_vectors(const Eigen::MatrixXd& matrix) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV).matrixV();
}

Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd& matrix) {
  return matrix.ldlt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.ldlt().solve(right);
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::MatrixXd shortest_least_squares(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.completeOrthogonalDecomposition().solve(right);
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& matrix) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(matrix).householderQ() *
         Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
}

void check_labelled(const Matrix<float>& features, std::span<const int> labels, int n_classes, int fewest) {
  require(features.rows() > 0 && features.columns() > 0, "classes: no rows or no columns");
  require(labels.size() == features.rows(), "classes: rows and labels differ in number");
  require(n_classes > 0 && n_classes <= 65535, "classes: their number must lie between 1 and 65,535");
  require_finite(features.values(), "classes: a feature is not finite");
  std::vector<int> counts(static_cast<std::size_t>(n_classes), 0);
  for (const int label : labels) {
    require(label >= 0 && label < n_classes, "classes: a label is outside [0, n_classes)");
    ++counts[static_cast<std::size_t>(label)];
  }
  require(*std::min_element(counts.begin(), counts.end()) >= fewest, "classes: one has too few rows");
}

Groups group(const Matrix<float>& features, std::span<const int> labels, int n_classes) {
  Groups groups{Eigen::MatrixXd::Zero(n_classes, static_cast<Eigen::Index>(features.columns())),
                as_eigen(features).cast<double>()};
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(n_classes);
  for (std::size_t row = 0; row < labels.size(); ++row) {
    groups.means.row(labels[row]) += groups.residuals.row(static_cast<Eigen::Index>(row));
    counts(labels[row]) += 1.0;
  }
  groups.means.array().colwise() /= counts.array();
  for (std::size_t row = 0; row < labels.size(); ++row)
    groups.residuals.row(static_cast<Eigen::Index>(row)) -= groups.means.row(labels[row]);
  return groups;
}

Eigen::RowVectorXd scale_columns(Eigen::MatrixXd& residuals) {
  const Eigen::RowVectorXd spread =
      (residuals.colwise().squaredNorm() / static_cast<double>(residuals.rows())).cwiseSqrt();
  const double smallest = 1e-9 * std::max(1e-30, spread.maxCoeff());
  const Eigen::RowVectorXd inverse = spread.unaryExpr([&](double sd) { return sd > smallest ? 1.0 / sd : 0.0; });
  residuals.array().rowwise() *= inverse.array();
  return inverse;
}

}  // namespace pirsim::stats::detail
