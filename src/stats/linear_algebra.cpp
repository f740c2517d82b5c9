#include "stats/linear_algebra.hpp"

#include <Eigen/Dense>

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

}  // namespace pirsim::stats::detail
