#include "stats/normal_layers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stats/discriminant.hpp"
#include "stats/eigen.hpp"
#include "stats/require.hpp"

namespace pirsim::stats {
namespace {

using detail::as_eigen;

NormalLayers::Layer fit_layer(const Matrix<double>& rows) {
  const ShrunkCovariance shrunk = ledoit_wolf(rows);
  Eigen::MatrixXd covariance = as_eigen(shrunk.covariance);
  // Coordinates have variance 1 within classes; a layer that doesn't vary at all along one still has a width.
  covariance.diagonal().array() += 1e-6;
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::MatrixXd whitening =
      factor.matrixL().solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
  return {shrunk.mean, detail::to_matrix(whitening), whitening.diagonal().array().log().sum()};
}

double squared_distance(const NormalLayers::Layer& layer, std::span<const double> place) {
  const Eigen::VectorXd off = as_eigen(place) - as_eigen(std::span<const double>(layer.mean));
  return (as_eigen(layer.whitening).triangularView<Eigen::Lower>() * off).squaredNorm();
}

double log_density(const NormalLayers::Layer& layer, std::span<const double> place) {
  return layer.log_determinant - 0.5 * squared_distance(layer, place);
}

}  // namespace

NormalLayers NormalLayers::fit(const Matrix<double>& places, std::span<const int> labels, int n_classes,
                               const NormalLayersSettings& settings) {
  require(settings.layers > 0 && settings.fewest_rows > 1, "layers: none, or too few rows in one");
  require(n_classes > 0 && labels.size() == places.rows(), "layers: rows and labels differ in number");
  std::vector<std::vector<std::size_t>> rows_of(static_cast<std::size_t>(n_classes));
  for (std::size_t row = 0; row < labels.size(); ++row) {
    require(labels[row] >= 0 && labels[row] < n_classes, "layers: a label is outside [0, n_classes)");
    rows_of[static_cast<std::size_t>(labels[row])].push_back(row);
  }
  NormalLayers fitted;
  Layer first;
  for (std::vector<std::size_t>& rows : rows_of) {
    require(rows.size() >= 10, "layers: a class has too few rows");
    std::size_t n_layers = 1;
    if (fitted.classes_.empty()) {
      first = fit_layer(places.select_rows(rows));
    } else {
      n_layers = std::clamp<std::size_t>(rows.size() / settings.fewest_rows, 1, settings.layers);
      std::vector<std::pair<double, std::size_t>> by_distance;
      for (const std::size_t row : rows) by_distance.emplace_back(squared_distance(first, places.row(row)), row);
      std::ranges::sort(by_distance);
      std::ranges::transform(by_distance, rows.begin(), [](const auto& entry) { return entry.second; });
    }
    std::vector<Layer>& layers = fitted.classes_.emplace_back();
    for (std::size_t l = 0; l < n_layers; ++l) {
      const std::size_t begin = l * rows.size() / n_layers, end = (l + 1) * rows.size() / n_layers;
      layers.push_back(fit_layer(places.select_rows(std::span(rows).subspan(begin, end - begin))));
    }
  }
  return fitted;
}

std::vector<double> NormalLayers::log_densities(std::span<const double> place) const {
  std::vector<double> densities;
  for (const std::vector<Layer>& layers : classes_) {
    require(place.size() == layers.front().mean.size(), "layers: another number of coordinates than was fitted");
    std::vector<double> logs;
    for (const Layer& layer : layers) logs.push_back(log_density(layer, place));
    const double largest = std::ranges::max(logs);
    double sum = 0.0;
    for (const double log : logs) sum += std::exp(log - largest);
    densities.push_back(largest + std::log(sum / static_cast<double>(logs.size())));
  }
  return densities;
}

}  // namespace pirsim::stats
