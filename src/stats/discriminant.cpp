#include "stats/discriminant.hpp"

#include <algorithm>
#include <cmath>

#include "stats/eigen.hpp"
#include "stats/groups.hpp"
#include "stats/require.hpp"
#include "stats/row_blocks.hpp"
#include "stats/softmax.hpp"

namespace pirsim::stats {
namespace {

using detail::as_eigen;

/// rows must have mean 0.
ShrunkCovariance shrink(const Eigen::MatrixXd& rows) {
  const auto n = static_cast<double>(rows.rows()), p = static_cast<double>(rows.cols());
  Eigen::MatrixXd sample = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
  sample.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose(), 1.0 / n);
  sample.triangularView<Eigen::StrictlyUpper>() = sample.transpose();
  const double mean_variance = sample.trace() / p;
  const double sample_norm = sample.squaredNorm();
  const double distance = sample_norm - p * mean_variance * mean_variance;  // squared, of the sample from the target
  const double error = (rows.rowwise().squaredNorm().array().square().sum() / n - sample_norm) / n;
  ShrunkCovariance shrunk;
  shrunk.shrinkage = distance > 0.0 ? std::clamp(error / distance, 0.0, 1.0) : 1.0;
  sample *= 1.0 - shrunk.shrinkage;
  sample.diagonal().array() += shrunk.shrinkage * mean_variance;
  shrunk.covariance = detail::to_matrix(sample);
  return shrunk;
}

Eigen::VectorXd off_centre(std::span<const float> features, std::span<const double> centre) {
  require(features.size() == centre.size(), "discriminant: another number of features than was fitted");
  return as_eigen(features).cast<double>() - as_eigen(centre);
}

}  // namespace

ShrunkCovariance ledoit_wolf(const Matrix<double>& rows) {
  require(rows.rows() > 1 && rows.columns() > 0, "covariance: too few rows or no columns");
  require_finite(rows.values(), "covariance: a number is not finite");
  const Eigen::RowVectorXd mean = as_eigen(rows).colwise().mean();
  ShrunkCovariance shrunk = shrink(as_eigen(rows).rowwise() - mean);
  shrunk.mean.assign(mean.begin(), mean.end());
  return shrunk;
}

Discriminant Discriminant::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes) {
  require(n_classes > 1, "discriminant: fewer than two classes");
  detail::check_labelled(features, labels, n_classes, 1);
  detail::Groups groups = detail::group(features, labels, n_classes);
  const Eigen::RowVectorXd inverse = detail::scale_columns(groups.residuals);
  const Eigen::RowVectorXd centre = groups.means.colwise().mean();
  const Eigen::MatrixXd means = ((groups.means.rowwise() - centre).array().rowwise() * inverse.array()).transpose();
  const ShrunkCovariance within = shrink(groups.residuals);
  const Eigen::LLT<Eigen::MatrixXd> factor(as_eigen(within.covariance));
  const Eigen::MatrixXd whitened = factor.matrixL().solve(means);  // (n_columns x n_classes)
  const Eigen::BDCSVD<Eigen::MatrixXd> parting(whitened, Eigen::ComputeThinU);
  const auto& strength = parting.singularValues();
  const Eigen::Index kept = (strength.array() > 1e-9 * strength(0)).count();
  const Eigen::MatrixXd basis = parting.matrixU().leftCols(kept);
  const Eigen::MatrixXd unwhitened = factor.matrixU().solve(basis);

  Discriminant fitted;
  fitted.centre_.assign(centre.begin(), centre.end());
  fitted.directions_ = detail::to_matrix(unwhitened.transpose() * inverse.asDiagonal());
  fitted.class_means_ = detail::to_matrix(whitened.transpose() * basis);
  fitted.shrinkage_ = within.shrinkage;
  return fitted;
}

std::vector<double> Discriminant::project(std::span<const float> features) const {
  const Eigen::VectorXd place = as_eigen(directions_) * off_centre(features, centre_);
  return {place.begin(), place.end()};
}

Matrix<double> Discriminant::project(const Matrix<float>& features, std::size_t n_coordinates, unsigned threads) const {
  require(n_coordinates <= n_directions(), "discriminant: more coordinates than directions");
  const auto n = static_cast<Eigen::Index>(n_coordinates);
  return detail::map_rows(features.rows(), n_coordinates, threads, [&](std::size_t row) {
    const Eigen::VectorXd place = as_eigen(directions_).topRows(n) * off_centre(features.row(row), centre_);
    return std::vector<double>(place.begin(), place.end());
  });
}

std::vector<double> Discriminant::log_densities(std::span<const float> features) const {
  return log_densities_at(project(features));
}

std::vector<double> Discriminant::log_densities_at(std::span<const double> place) const {
  require(place.size() == n_directions(), "discriminant: another number of coordinates than was fitted");
  std::vector<double> logs;
  for (std::size_t k = 0; k < class_means_.rows(); ++k) {
    double squares = 0.0;
    for (std::size_t i = 0; i < place.size(); ++i) {
      const double off = place[i] - class_means_(k, i);
      squares += off * off;
    }
    logs.push_back(-0.5 * squares);
  }
  return logs;
}

std::vector<double> Discriminant::probabilities(std::span<const float> features) const {
  return detail::softmax(log_densities(features));
}

}  // namespace pirsim::stats
