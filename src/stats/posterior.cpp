#include "stats/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "stats/kit.hpp"
#include "stats/linear_algebra.hpp"

namespace pirsim::stats {
namespace {

using detail::as_eigen;

double median(std::vector<double> values) { return stats::quantile(values, 0.5); }

/// Median absolute deviation of each column from its median; 1 where that is 0.
std::vector<double> column_scales(const Matrix<double>& rows) {
  std::vector<double> scales;
  for (std::size_t c = 0; c < rows.columns(); ++c) {
    std::vector<double> values;
    for (std::size_t r = 0; r < rows.rows(); ++r) values.push_back(rows(r, c));
    const double centre = median(values);
    for (double& value : values) value = std::abs(value - centre);
    const double scale = median(std::move(values));
    scales.push_back(scale > 0.0 ? scale : 1.0);
  }
  return scales;
}

/// log((x - low) / (high - x)); a value at the very border is moved off it by a billionth of the range.
double to_open(double value, const Interval& bounds) {
  const double share = std::clamp((value - bounds.low) / (bounds.high - bounds.low), 1e-9, 1.0 - 1e-9);
  return std::log(share / (1.0 - share));
}
double from_open(double value, const Interval& bounds) {
  return bounds.low + (bounds.high - bounds.low) / (1.0 + std::exp(-value));
}

struct Accepted {
  std::vector<std::size_t> rows;
  std::vector<double> weights;  ///< sum 1
};

Accepted accept_nearest(const Matrix<double>& statistics, std::span<const double> observed, double share) {
  const std::vector<double> scales = column_scales(statistics);
  std::vector<double> distances(statistics.rows(), 0.0);
  for (std::size_t r = 0; r < statistics.rows(); ++r) {
    for (std::size_t c = 0; c < observed.size(); ++c)
      distances[r] += std::pow((statistics(r, c) - observed[c]) / scales[c], 2);
    distances[r] = std::sqrt(distances[r]);
  }
  Accepted accepted;
  accepted.rows.resize(statistics.rows());
  std::iota(accepted.rows.begin(), accepted.rows.end(), std::size_t{0});
  std::stable_sort(accepted.rows.begin(), accepted.rows.end(),
                   [&](std::size_t a, std::size_t b) { return distances[a] < distances[b]; });
  const auto kept = static_cast<std::size_t>(std::ceil(share * static_cast<double>(statistics.rows())));
  accepted.rows.resize(std::min(kept, statistics.rows()));
  // The widest is just beyond the last row, so that every kept row has a weight.
  const double widest = distances[accepted.rows.back()] * (1.0 + 1e-6) + std::numeric_limits<double>::min();
  double sum = 0.0;
  for (const std::size_t row : accepted.rows) {
    accepted.weights.push_back(1.0 - std::pow(distances[row] / widest, 2));
    sum += accepted.weights.back();
  }
  for (double& weight : accepted.weights) weight /= sum;
  return accepted;
}

/// Each parameter's regression on the statistics, taken at the observed ones, plus the rows' residuals.
Eigen::MatrixXd adjust(const Eigen::MatrixXd& parameters, const Eigen::MatrixXd& off, const Eigen::VectorXd& weights) {
  Eigen::MatrixXd design(off.rows(), off.cols() + 1);
  design << Eigen::VectorXd::Ones(off.rows()), off;
  const Eigen::VectorXd root = weights.cwiseSqrt();
  const Eigen::MatrixXd coefficients =
      detail::least_squares(root.asDiagonal() * design, root.asDiagonal() * parameters);
  return parameters - off * coefficients.bottomRows(off.cols());
}

}  // namespace

ParameterEstimator ParameterEstimator::fit(const Matrix<double>& statistics, const Matrix<double>& parameters) {
  require(statistics.rows() == parameters.rows() && statistics.rows() > 1,
          "estimate: rows differ in number or are too few");
  require_finite(statistics.values(), "estimate: a statistic is not finite");
  require_finite(parameters.values(), "estimate: a parameter is not finite");
  const Eigen::RowVectorXd mean = as_eigen(statistics).colwise().mean();
  Eigen::MatrixXd centred = as_eigen(statistics).rowwise() - mean;
  const Eigen::RowVectorXd sd = (centred.colwise().squaredNorm() / static_cast<double>(statistics.rows())).cwiseSqrt();
  const Eigen::RowVectorXd inverse = sd.unaryExpr([](double x) { return x > 1e-12 ? 1.0 / x : 0.0; });
  centred.array().rowwise() *= inverse.array();
  const Eigen::RowVectorXd parameter_mean = as_eigen(parameters).colwise().mean();
  const Eigen::MatrixXd targets = as_eigen(parameters).rowwise() - parameter_mean;

  const auto [u, s, v] = detail::singular_values(centred, detail::Sides::both);
  const Eigen::ArrayXd squares = s.array().square();
  const Eigen::MatrixXd rotated = u.transpose() * targets;
  const auto n = static_cast<double>(statistics.rows());

  ParameterEstimator estimate;
  estimate.slopes_ = Matrix<double>(parameters.columns(), statistics.columns());
  for (Eigen::Index p = 0; p < targets.cols(); ++p) {
    double best_score = std::numeric_limits<double>::infinity();
    Eigen::ArrayXd best_shrink = Eigen::ArrayXd::Zero(squares.size());
    for (double exponent = -6.0; exponent <= 3.0; exponent += 0.5) {
      const Eigen::ArrayXd shrink = squares / (squares + n * std::pow(10.0, exponent));
      const double fitted = (rotated.col(p).array().square() * shrink * (2.0 - shrink)).sum();
      const double left = 1.0 - (1.0 + shrink.sum()) / n;  // share of the degrees of freedom; one is the mean's
      if (left <= 0.0) continue;
      const double score = std::max(0.0, targets.col(p).squaredNorm() - fitted) / (left * left);
      if (score < best_score) {
        best_score = score;
        best_shrink = shrink;
      }
    }
    const Eigen::ArrayXd safe = (squares > 1e-12 * squares(0)).select(s.array(), 1.0);
    const Eigen::VectorXd slopes =
        v * ((squares > 1e-12 * squares(0)).select(best_shrink / safe, 0.0) * rotated.col(p).array()).matrix();
    const Eigen::VectorXd scaled = slopes.cwiseProduct(inverse.transpose());
    std::copy(scaled.begin(), scaled.end(), estimate.slopes_.row(static_cast<std::size_t>(p)).begin());
    estimate.intercept_.push_back(parameter_mean(p) - mean.dot(scaled));
  }
  return estimate;
}

std::vector<double> ParameterEstimator::estimate(std::span<const double> statistics) const {
  require(statistics.size() == slopes_.columns(), "estimate: another number of statistics than was fitted");
  std::vector<double> values = intercept_;
  for (std::size_t p = 0; p < values.size(); ++p)
    values[p] += std::inner_product(statistics.begin(), statistics.end(), slopes_.row(p).begin(), 0.0);
  return values;
}

Matrix<double> ParameterEstimator::estimate(const Matrix<double>& statistics) const {
  Matrix<double> estimates(statistics.rows(), intercept_.size());
  for (std::size_t r = 0; r < statistics.rows(); ++r) {
    const std::vector<double> values = estimate(statistics.row(r));
    std::copy(values.begin(), values.end(), estimates.row(r).begin());
  }
  return estimates;
}

double AbcPosterior::mean(std::size_t parameter) const {
  double sum = 0.0;
  for (std::size_t r = 0; r < values.rows(); ++r) sum += weights[r] * values(r, parameter);
  return sum;
}

double AbcPosterior::quantile(std::size_t parameter, double probability) const {
  std::vector<std::size_t> order(values.rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values(a, parameter) < values(b, parameter); });
  // Each value stands in the middle of its weight; between two of them the quantile is linear.
  double below = 0.0, last_place = 0.0, last_value = values(order[0], parameter);
  for (const std::size_t row : order) {
    const double place = below + 0.5 * weights[row], value = values(row, parameter);
    if (place >= probability)
      return place > last_place ? last_value + (value - last_value) * (probability - last_place) / (place - last_place)
                                : value;
    below += weights[row];
    last_place = place;
    last_value = value;
  }
  return last_value;
}

Interval AbcPosterior::interval(std::size_t parameter, double confidence, double widening) const {
  const double centre = quantile(parameter, 0.5), tail = 0.5 * (1.0 - confidence);
  return {centre + widening * (quantile(parameter, tail) - centre),
          centre + widening * (quantile(parameter, 1.0 - tail) - centre)};
}

AbcPosterior abc_posterior(const Matrix<double>& parameters, const Matrix<double>& statistics,
                           std::span<const double> observed, const AbcSettings& settings) {
  require(parameters.rows() == statistics.rows() && parameters.rows() > 0, "abc: rows differ in number");
  require(observed.size() == statistics.columns(), "abc: observed and simulated statistics differ in number");
  require(settings.bounds.empty() || settings.bounds.size() == parameters.columns(), "abc: bounds per parameter");
  require(settings.accepted > 0.0 && settings.accepted <= 1.0, "abc: accepted share outside (0, 1]");
  require_finite(statistics.values(), "abc: a statistic is not finite");
  require_finite(observed, "abc: a statistic is not finite");
  Accepted accepted = accept_nearest(statistics, observed, settings.accepted);
  require(accepted.rows.size() >= observed.size() + 2, "abc: too few accepted rows for this many statistics");

  const Matrix<double> kept_parameters = parameters.select_rows(accepted.rows);
  const Matrix<double> kept_statistics = statistics.select_rows(accepted.rows);
  Eigen::MatrixXd values = as_eigen(kept_parameters);
  for (std::size_t p = 0; p < settings.bounds.size(); ++p)
    for (double& value : values.col(static_cast<Eigen::Index>(p))) value = to_open(value, settings.bounds[p]);
  const Eigen::MatrixXd off = as_eigen(kept_statistics).rowwise() - as_eigen(observed).transpose();
  values = adjust(values, off, as_eigen(std::span<const double>(accepted.weights)));
  for (std::size_t p = 0; p < settings.bounds.size(); ++p)
    for (double& value : values.col(static_cast<Eigen::Index>(p))) value = from_open(value, settings.bounds[p]);
  return {detail::to_matrix(values), std::move(accepted.weights)};
}

}  // namespace pirsim::stats
