#include "stats/pooled_classifier.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "stats/kit.hpp"

namespace pirsim::stats {
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
