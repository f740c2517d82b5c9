#include "pirsim/stats/conformal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pirsim/core/parallel.hpp"
#include "pirsim/core/random.hpp"
#include "pirsim/stats/intervals.hpp"
#include "stats/require.hpp"
#include "stats/softmax.hpp"

namespace pirsim::stats {
namespace {

/// How much likelier the best other class is than class k, in log odds.
double margin(std::span<const double> probabilities, std::size_t k) {
  constexpr double floor = 1e-300;
  double best_other = floor;
  for (std::size_t other = 0; other < probabilities.size(); ++other)
    if (other != k) best_other = std::max(best_other, probabilities[other]);
  return std::log(best_other) - std::log(std::max(probabilities[k], floor));
}

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

std::vector<int> select(std::span<const int> labels, std::span<const std::size_t> rows) {
  std::vector<int> selected;
  for (const std::size_t row : rows) selected.push_back(labels[row]);
  return selected;
}

std::vector<float> pick(std::span<const float> features, std::span<const std::size_t> columns) {
  std::vector<float> picked;
  for (const std::size_t column : columns) picked.push_back(features[column]);
  return picked;
}

Matrix<float> pick(const Matrix<float>& features, std::span<const std::size_t> columns) {
  Matrix<float> picked(features.rows(), columns.size());
  for (std::size_t row = 0; row < features.rows(); ++row)
    for (std::size_t i = 0; i < columns.size(); ++i) picked(row, i) = features(row, columns[i]);
  return picked;
}

std::vector<std::vector<std::size_t>> checked_blocks(std::vector<std::vector<std::size_t>> blocks,
                                                     std::size_t columns) {
  if (blocks.empty()) {
    blocks.emplace_back(columns);
    std::iota(blocks[0].begin(), blocks[0].end(), std::size_t{0});
  }
  for (const auto& block : blocks) {
    require(!block.empty(), "classes: a block without columns");
    for (const std::size_t column : block)
      require(column < columns, "classes: a block names a column that isn't there");
  }
  return blocks;
}

}  // namespace

double conformal_p(std::span<const double> calibration, double score) {
  const auto as_strange = std::count_if(calibration.begin(), calibration.end(), [&](double c) { return c >= score; });
  return static_cast<double>(as_strange + 1) / static_cast<double>(calibration.size() + 1);
}

std::vector<std::size_t> prediction_set(std::span<const double> p, double alpha) {
  std::vector<std::size_t> members;
  for (std::size_t k = 0; k < p.size(); ++k)
    if (p[k] > alpha) members.push_back(k);
  return members;
}

Split split_by_class(std::span<const int> labels, double calibration_share, std::uint64_t seed) {
  require(calibration_share > 0.0 && calibration_share < 1.0, "split: calibration share outside (0, 1)");
  require(!labels.empty(), "split: no row");
  const int n_classes = *std::max_element(labels.begin(), labels.end()) + 1;
  Split split;
  for (int k = 0; k < n_classes; ++k) {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < labels.size(); ++row)
      if (labels[row] == k) rows.push_back(row);
    if (rows.empty()) continue;
    require(rows.size() > 1, "split: a class with a single row");
    Stream stream({seed, static_cast<std::uint32_t>(k), 0, Purpose::calibration_split});
    for (std::size_t i = rows.size() - 1; i > 0; --i)
      std::swap(rows[i], rows[stream.index(static_cast<std::uint32_t>(i + 1))]);
    const auto wanted = static_cast<std::size_t>(std::lround(calibration_share * static_cast<double>(rows.size())));
    const auto kept = static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(wanted, 1, rows.size() - 1));
    split.calibration.insert(split.calibration.end(), rows.begin(), rows.begin() + kept);
    split.fitting.insert(split.fitting.end(), rows.begin() + kept, rows.end());
  }
  std::sort(split.calibration.begin(), split.calibration.end());
  std::sort(split.fitting.begin(), split.fitting.end());
  return split;
}

ConformalClassifier ConformalClassifier::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                             const Split& split, const ConformalSettings& settings) {
  require(labels.size() == features.rows(), "classes: rows and labels differ in number");
  const std::vector<int> fitting_labels = select(labels, split.fitting);
  ConformalClassifier fitted;
  {
    const Matrix<float> fitting = features.select_rows(split.fitting);
    fitted.discriminant_ = Discriminant::fit(fitting, fitting_labels, n_classes);
    fitted.blocks_ = checked_blocks(settings.blocks, features.columns());
    for (const auto& block : fitted.blocks_)
      fitted.shapes_.push_back(ClassShapes::fit(pick(fitting, block), fitting_labels, n_classes, settings.shapes));
    const Matrix<double> places = fitted.discriminant_.project(fitting, settings.threads);
    fitted.layers_ = NormalLayers::fit(places, fitting_labels, n_classes, settings.layers);
    fitted.trees_ = ExtraTrees::fit(with_coordinates(fitting, places), fitting_labels, n_classes, settings.trees);
  }
  fitted.calibrate(features.select_rows(split.calibration), select(labels, split.calibration), settings.threads);
  return fitted;
}

ConformalClassifier::Evidence ConformalClassifier::evidence(std::span<const float> features) const {
  const std::vector<double> place = discriminant_.project(features);
  std::vector<double> log_densities = layers_.log_densities(place);
  return {{trees_.probabilities(with_coordinates(features, place)), discriminant_.probabilities(features),
           detail::softmax(log_densities)},
          log_densities};
}

std::vector<double> ConformalClassifier::measures(std::span<const float> features, const Evidence& evidence,
                                                  std::size_t k) const {
  std::vector<double> measures;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    measures.push_back(std::cbrt(shapes_[b].strangeness(pick(features, blocks_[b]), k)));
  measures.push_back(-evidence.log_densities[k]);
  return measures;
}

ConformalClassifier::StrangestMeasure::StrangestMeasure(const Matrix<double>& rows) {
  for (std::size_t m = 0; m < rows.columns(); ++m) {
    std::vector<double> values;
    for (std::size_t row = 0; row < rows.rows(); ++row) values.push_back(rows(row, m));
    const double median = quantile(values, 0.5);
    scales_.push_back({median, std::max(quantile(values, 0.95) - median, 1e-9)});
  }
  for (std::size_t row = 0; row < rows.rows(); ++row) known_.push_back(of(rows.row(row)));
}

double ConformalClassifier::StrangestMeasure::of(std::span<const double> measures) const {
  double strangest = -std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < measures.size(); ++m)
    strangest = std::max(strangest, (measures[m] - scales_[m].median) / scales_[m].reach);
  return strangest;
}

void ConformalClassifier::calibrate(const Matrix<float>& features, std::span<const int> labels, unsigned threads) {
  const auto classes = static_cast<std::size_t>(n_classes());
  struct Row {
    Evidence evidence;
    std::vector<double> measures;  ///< for its own class
  };
  std::vector<Row> rows;
  ordered_parallel<Row>(
      features.rows(), threads,
      [&](std::size_t i) {
        Row row{evidence(features.row(i)), {}};
        row.measures = measures(features.row(i), row.evidence, static_cast<std::size_t>(labels[i]));
        return row;
      },
      [&](Row& row) { rows.push_back(std::move(row)); });

  std::array<Matrix<double>, n_sources> tables;
  for (const Row& row : rows)
    for (std::size_t s = 0; s < n_sources; ++s) tables[s].append_row(std::span<const double>(row.evidence.sources[s]));
  pool_ = LogPool::fit(tables, labels);

  margins_.assign(classes, {});
  probabilities_ = {};
  std::vector<Matrix<double>> measures_of(classes);  // per class (its calibration rows x measures)
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto own = static_cast<std::size_t>(labels[i]);
    const std::vector<double> pooled = pool_.combine(rows[i].evidence.sources);
    probabilities_.append_row(std::span<const double>(pooled));
    margins_[own].push_back(margin(pooled, own));
    measures_of[own].append_row(std::span<const double>(rows[i].measures));
  }
  for (const Matrix<double>& own : measures_of) strangest_.emplace_back(own);
}

std::vector<double> ConformalClassifier::probabilities(std::span<const float> features) const {
  return pool_.combine(evidence(features).sources);
}

Classification ConformalClassifier::classify(std::span<const float> features) const {
  const Evidence found = evidence(features);
  Classification result;
  result.probabilities = pool_.combine(found.sources);
  for (std::size_t k = 0; k < result.probabilities.size(); ++k) {
    result.p_relative.push_back(conformal_p(margins_[k], margin(result.probabilities, k)));
    result.p_absolute.push_back(strangest_[k].p(measures(features, found, k)));
    result.p.push_back(std::min(1.0, 2.0 * std::min(result.p_relative[k], result.p_absolute[k])));
  }
  return result;
}

std::vector<Classification> ConformalClassifier::classify(const Matrix<float>& features, unsigned threads) const {
  std::vector<Classification> all;
  ordered_parallel<Classification>(
      features.rows(), threads, [&](std::size_t row) { return classify(features.row(row)); },
      [&](Classification& one) { all.push_back(std::move(one)); });
  return all;
}

}  // namespace pirsim::stats
