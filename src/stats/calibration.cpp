#include "stats/calibration.hpp"

#include <algorithm>
#include <cmath>

#include "stats/kit.hpp"
#include "stats/linear_algebra.hpp"

namespace pirsim::stats {
namespace {

/// A forest gives 0 to classes that no leaf holds; what is less likely than this is taken for as likely.
constexpr double smallest_probability = 1e-4;  // assumed; 1e-3 and 1e-6 tried

double log_of(double probability) { return std::log(std::max(probability, smallest_probability)); }

Eigen::VectorXd softmax(const Eigen::VectorXd& logs) {
  const Eigen::VectorXd shares = (logs.array() - logs.maxCoeff()).exp();
  return shares / shares.sum();
}

/// Loss, gradient and Hessian of the mean log loss in the weights.
struct LossTerms {
  double loss = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

LossTerms loss_of(std::span<const Matrix<double>> sources, std::span<const int> labels,
                  const Eigen::VectorXd& weights) {
  const Eigen::Index n_sources = weights.size();
  LossTerms terms{0.0, Eigen::VectorXd::Zero(n_sources), Eigen::MatrixXd::Zero(n_sources, n_sources)};
  Eigen::MatrixXd logs(static_cast<Eigen::Index>(sources[0].columns()), n_sources);
  for (std::size_t row = 0; row < labels.size(); ++row) {
    for (Eigen::Index s = 0; s < n_sources; ++s)
      for (Eigen::Index k = 0; k < logs.rows(); ++k)
        logs(k, s) = log_of(sources[static_cast<std::size_t>(s)](row, static_cast<std::size_t>(k)));
    const Eigen::VectorXd shares = softmax(logs * weights);
    const Eigen::VectorXd mean = logs.transpose() * shares;
    terms.loss -= std::log(std::max(shares(labels[row]), 1e-300));
    terms.gradient += mean - logs.row(labels[row]).transpose();
    terms.hessian += logs.transpose() * shares.asDiagonal() * logs - mean * mean.transpose();
  }
  const double n = static_cast<double>(labels.size());
  return {terms.loss / n, terms.gradient / n, terms.hessian / n};
}

}  // namespace

LogPool LogPool::fit(std::span<const Matrix<double>> sources, std::span<const int> labels) {
  require(!sources.empty() && !labels.empty(), "pool: no source or no row");
  for (const Matrix<double>& source : sources)
    require(source.rows() == labels.size() && source.columns() == sources[0].columns(), "pool: sizes differ");
  const auto n_sources = static_cast<Eigen::Index>(sources.size());
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(n_sources, 1.0 / static_cast<double>(n_sources));
  LossTerms terms = loss_of(sources, labels, weights);
  for (int iteration = 0; iteration < 50; ++iteration) {
    terms.hessian.diagonal().array() += 1e-9;
    Eigen::VectorXd step = detail::solve_symmetric(terms.hessian, terms.gradient);
    LossTerms next = loss_of(sources, labels, weights - step);
    for (int halving = 0; next.loss > terms.loss && halving < 30; ++halving) {
      step *= 0.5;
      next = loss_of(sources, labels, weights - step);
    }
    if (!(next.loss < terms.loss)) break;
    weights -= step;
    terms = next;
    if (step.norm() < 1e-8) break;
  }
  return LogPool({weights.begin(), weights.end()});
}

std::vector<double> LogPool::combine(std::span<const std::vector<double>> sources) const {
  require(sources.size() == weights_.size() && !sources.empty(), "pool: another number of sources than was fitted");
  Eigen::VectorXd logs = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(sources[0].size()));
  for (std::size_t s = 0; s < sources.size(); ++s)
    for (std::size_t k = 0; k < sources[s].size(); ++k)
      logs(static_cast<Eigen::Index>(k)) += weights_[s] * log_of(sources[s][k]);
  const Eigen::VectorXd shares = softmax(logs);
  return {shares.begin(), shares.end()};
}

Reliability reliability(const Matrix<double>& probabilities, std::span<const int> labels, std::size_t n_bins) {
  require(probabilities.rows() == labels.size() && !labels.empty(), "reliability: rows and labels differ in number");
  require(n_bins > 0, "reliability: no bin");
  Reliability result{std::vector<ReliabilityBin>(n_bins), 0.0};
  for (std::size_t row = 0; row < labels.size(); ++row) {
    const auto shares = probabilities.row(row);
    const auto likeliest = std::max_element(shares.begin(), shares.end());
    const auto place = static_cast<std::size_t>(std::clamp(*likeliest, 0.0, 1.0) * static_cast<double>(n_bins));
    ReliabilityBin& bin = result.bins[std::min(place, n_bins - 1)];
    ++bin.rows;
    bin.mean_probability += *likeliest;
    bin.share_right += likeliest - shares.begin() == labels[row] ? 1.0 : 0.0;
  }
  for (ReliabilityBin& bin : result.bins) {
    result.expected_calibration_error +=
        std::abs(bin.mean_probability - bin.share_right) / static_cast<double>(labels.size());
    if (bin.rows == 0) continue;
    bin.mean_probability /= static_cast<double>(bin.rows);
    bin.share_right /= static_cast<double>(bin.rows);
  }
  return result;
}

}  // namespace pirsim::stats
