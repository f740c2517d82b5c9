#include "calibrate/room_check.hpp"

#include <algorithm>
#include <cmath>

#include "stats/intervals.hpp"
#include "stats/linear_algebra.hpp"

namespace pirsim::calibrate {
namespace {

/// Of row i from the mean of the others, by their covariance.
double distance_from_others(const Eigen::MatrixXd& rows, Eigen::Index i) {
  constexpr double ridge = 0.05;  // of each variance: statistics that nearly follow from others; assumed, 0.02-0.2
  constexpr double least = 1e-9;  // of a statistic that is the same in all rooms
  const auto n = static_cast<double>(rows.rows() - 1);
  const Eigen::RowVectorXd mean = (rows.colwise().sum() - rows.row(i)) / n;
  Eigen::MatrixXd centred = rows.rowwise() - mean;
  centred.row(i).setZero();
  Eigen::MatrixXd covariance = centred.transpose() * centred / (n - 1.0);
  const Eigen::VectorXd variances = covariance.diagonal();
  covariance.diagonal() += ridge * variances + Eigen::VectorXd::Constant(variances.size(), least);
  const Eigen::VectorXd away = (rows.row(i) - mean).transpose();
  return away.dot(stats::detail::solve_symmetric(covariance, away));
}

}  // namespace

double unlike_share(const stats::Matrix<double>& rows, std::span<const double> vector) {
  Eigen::MatrixXd all(static_cast<Eigen::Index>(rows.rows() + 1), static_cast<Eigen::Index>(rows.columns()));
  all.topRows(all.rows() - 1) = stats::detail::as_eigen(rows);
  all.bottomRows(1) = stats::detail::as_eigen(vector).transpose();
  const double own = distance_from_others(all, all.rows() - 1);
  int as_far = 1;
  for (Eigen::Index i = 0; i + 1 < all.rows(); ++i) as_far += distance_from_others(all, i) >= own ? 1 : 0;
  return static_cast<double>(as_far) / static_cast<double>(all.rows());
}

double unlike_share(std::span<const double> values, double value) {
  std::vector<double> all(values.begin(), values.end());
  all.push_back(value);
  const double middle = stats::quantile(all, 0.5), own = std::abs(value - middle);
  const auto as_far = std::ranges::count_if(all, [&](double other) { return std::abs(other - middle) >= own; });
  return static_cast<double>(as_far) / static_cast<double>(all.size());
}

}  // namespace pirsim::calibrate
