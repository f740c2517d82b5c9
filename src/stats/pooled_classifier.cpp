#include "stats/pooled_classifier.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
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

namespace {

std::vector<float> with_coordinates(std::span<const float> features, std::span<const double> place) {
  std::vector<float> wide(features.begin(), features.end());
  for (const double coordinate : place) wide.push_back(static_cast<float>(coordinate));
  return wide;
}

Matrix<float> with_coordinates(const Matrix<float>& features, const Matrix<double>& places) {
  Matrix<float> wide(features.rows(), features.columns() + places.columns());
  for (std::size_t row = 0; row < features.rows(); ++row) {
    const std::vector<float> values = with_coordinates(features.row(row), places.row(row));
    std::copy(values.begin(), values.end(), wide.row(row).begin());
  }
  return wide;
}

}  // namespace

PooledClassifier PooledClassifier::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                       const Split& split, const PooledClassifierSettings& settings,
                                       std::span<const int> subclasses) {
  require(labels.size() == features.rows(), "classes: rows and labels differ in number");
  const std::vector<int> fitting_labels = detail::select(labels, split.fitting);
  PooledClassifier fitted;
  {
    const Matrix<float> fitting = features.select_rows(split.fitting);
    const std::vector<int> parts = subclasses.empty() ? fitting_labels : detail::select(subclasses, split.fitting);
    fitted.mixture_ = MixtureDiscriminant::fit(fitting, fitting_labels, n_classes, parts);
    fitted.n_coordinates_ = std::min(settings.coordinates, fitted.mixture_.discriminant().n_directions());
    const Matrix<double> places =
        fitted.mixture_.discriminant().project(fitting, fitted.n_coordinates_, settings.threads);
    fitted.layers_ = NormalLayers::fit(places, fitting_labels, n_classes, settings.layers);
    fitted.trees_ = ExtraTrees::fit(with_coordinates(fitting, places), fitting_labels, n_classes, settings.trees);
  }
  std::vector<Matrix<double>> tables;  // per source (n_calibration_rows x n_classes)
  using Sources = std::vector<std::vector<double>>;
  ordered_parallel<Sources>(
      split.calibration.size(), settings.threads,
      [&](std::size_t i) { return fitted.sources(features.row(split.calibration[i])); },
      [&](Sources& row) {
        tables.resize(row.size());
        for (std::size_t s = 0; s < row.size(); ++s) tables[s].append_row(std::span<const double>(row[s]));
      });
  fitted.pool_ = LogPool::fit(tables, detail::select(labels, split.calibration));
  for (std::size_t i = 0; i < split.calibration.size(); ++i) {
    Sources row;
    for (const Matrix<double>& table : tables) row.emplace_back(table.row(i).begin(), table.row(i).end());
    fitted.probabilities_.append_row(std::span<const double>(fitted.pool_.combine(row)));
  }
  return fitted;
}

std::vector<std::vector<double>> PooledClassifier::sources(std::span<const float> features) const {
  const std::vector<double> whole = mixture_.discriminant().project(features);
  const auto place = std::span(whole).first(n_coordinates_);
  return {trees_.probabilities(with_coordinates(features, place)), mixture_.probabilities_at(whole),
          detail::softmax(layers_.log_densities(place))};
}

std::vector<double> PooledClassifier::probabilities(std::span<const float> features) const {
  return pool_.combine(sources(features));
}

std::vector<double> PooledClassifier::log_densities(std::span<const float> features) const {
  const std::vector<double> place = mixture_.discriminant().project(features);
  return layers_.log_densities(std::span(place).first(n_coordinates_));
}

Matrix<double> PooledClassifier::log_densities(const Matrix<float>& features, unsigned threads) const {
  Matrix<double> all;
  ordered_parallel<std::vector<double>>(
      features.rows(), threads, [&](std::size_t row) { return log_densities(features.row(row)); },
      [&](std::vector<double>& one) { all.append_row(std::span<const double>(one)); });
  return all;
}

}  // namespace pirsim::stats
