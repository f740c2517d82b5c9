#include "stats/conformal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "model/core/parallel.hpp"
#include "stats/intervals.hpp"
#include "stats/matrix.hpp"
#include "stats/trees.hpp"

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

std::vector<std::vector<std::size_t>> checked_blocks(std::vector<std::vector<std::size_t>> blocks,
                                                     std::size_t columns) {
  if (blocks.empty()) blocks.push_back(numbers_to(columns));
  for (const auto& block : blocks) {
    require(!block.empty(), "classes: a block without columns");
    for (const std::size_t column : block)
      require(column < columns, "classes: a block names a column that isn't there");
  }
  return blocks;
}

constexpr std::size_t fewest_impostors = 10;  ///< and twice as many own rows (assumed)
/// Log densities further than this from what is usual in the class tell no more; 20, 40, 80, 150 and 300 were tried.
constexpr double farthest = 80.0;
constexpr double ridge = 1.0;  ///< of standardised columns; 0.1, 1 and 10 were tried: no difference

/// Which class the row is taken for if `unknown` is none of them.
std::size_t likeliest_without(std::span<const double> log_densities, std::size_t unknown) {
  std::size_t best = unknown == 0 ? 1 : 0;
  for (std::size_t k = 0; k < log_densities.size(); ++k) {
    if (k != unknown && log_densities[k] > log_densities[best]) best = k;
  }
  return best;
}

std::vector<double> clipped(std::span<const double> log_densities, double centre) {
  std::vector<double> values;
  for (const double value : log_densities) values.push_back(std::clamp(value - centre, -farthest, farthest));
  return values;
}

}  // namespace

ConformalClassifier ConformalClassifier::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                             const Split& split, const ConformalSettings& settings,
                                             std::span<const int> subclasses) {
  ConformalClassifier fitted;
  fitted.pooled_ = PooledClassifier::fit(features, labels, n_classes, split, settings.pooled, subclasses);
  fitted.blocks_ = checked_blocks(settings.blocks, features.columns());
  {
    const Matrix<float> fitting = features.select_rows(split.fitting);
    const std::vector<int> fitting_labels = detail::select(labels, split.fitting);
    for (const auto& block : fitted.blocks_)
      fitted.shapes_.push_back(
          ClassShapes::fit(fitting.select_columns(block), fitting_labels, n_classes, settings.shapes));
  }
  fitted.calibrate(features.select_rows(split.calibration), detail::select(labels, split.calibration),
                   settings.pooled.threads);
  return fitted;
}

std::vector<double> ConformalClassifier::measures(std::span<const float> features,
                                                  std::span<const double> log_densities, std::size_t k) const {
  std::vector<double> measures;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    measures.push_back(std::cbrt(shapes_[b].strangeness(detail::select(features, blocks_[b]), k)));
  measures.push_back(-log_densities[k]);
  return measures;
}

void ConformalClassifier::calibrate(const Matrix<float>& features, std::span<const int> labels, unsigned threads) {
  const auto classes = static_cast<std::size_t>(n_classes());
  margins_.assign(classes, {});
  std::vector<Matrix<double>> measures_of(classes);  // per class (its calibration rows x measures)
  std::size_t next = 0;
  ordered_parallel<std::vector<double>>(
      features.rows(), threads,
      [&](std::size_t i) {
        const std::span<const float> row = features.row(i);
        return measures(row, pooled_.log_densities(row), static_cast<std::size_t>(labels[i]));
      },
      [&](std::vector<double>& row) {
        const auto own = static_cast<std::size_t>(labels[next]);
        margins_[own].push_back(margin(calibration_probabilities().row(next), own));
        measures_of[own].append_row(row);
        ++next;
      });
  for (const Matrix<double>& own : measures_of) strangest_.emplace_back(own);
}

Classification ConformalClassifier::classify(std::span<const float> features) const {
  Classification result;
  result.probabilities = pooled_.probabilities(features);
  const std::vector<double> log_densities = pooled_.log_densities(features);
  for (std::size_t k = 0; k < result.probabilities.size(); ++k) {
    result.p_relative.push_back(conformal_p(margins_[k], margin(result.probabilities, k)));
    result.p_absolute.push_back(strangest_[k].p(measures(features, log_densities, k)));
    result.p.push_back(std::min(1.0, 2.0 * std::min(result.p_relative[k], result.p_absolute[k])));
  }
  return result;
}

double conformal_p(std::span<const double> calibration, double score) {
  const auto as_strange = std::count_if(calibration.begin(), calibration.end(), [&](double c) { return c >= score; });
  return static_cast<double>(as_strange + 1) / static_cast<double>(calibration.size() + 1);
}

StrangestMeasure::StrangestMeasure(const Matrix<double>& known) : known_(known.columns(), known.rows()) {
  require(known.rows() > 0, "strangeness: no known row");
  for (std::size_t m = 0; m < known.columns(); ++m) {
    for (std::size_t row = 0; row < known.rows(); ++row) known_(m, row) = known(row, m);
    std::vector<double>& sorted = sorted_.emplace_back(known_.row(m).begin(), known_.row(m).end());
    std::ranges::sort(sorted);
  }
}

double StrangestMeasure::p(std::span<const double> row) const {
  require(row.size() == sorted_.size(), "strangeness: another number of measures than of the known rows");
  constexpr double lowest = -std::numeric_limits<double>::infinity();
  std::vector<double> strangest(known_.columns(), lowest);
  double own = lowest;
  for (std::size_t m = 0; m < row.size(); ++m) {
    std::vector<double> all = sorted_[m];
    all.insert(std::ranges::upper_bound(all, row[m]), row[m]);
    const double median = sorted_quantile(all, 0.5);
    const double reach = std::max(sorted_quantile(all, 0.95) - median, 1e-9);
    own = std::max(own, (row[m] - median) / reach);
    for (std::size_t i = 0; i < strangest.size(); ++i)
      strangest[i] = std::max(strangest[i], (known_(m, i) - median) / reach);
  }
  return conformal_p(strangest, own);
}

ImpostorTests::Test ImpostorTests::learn(std::size_t k, const Matrix<double>& log_densities,
                                         std::span<const int> labels, const Split& split) {
  Test test;
  std::vector<double> own_densities;
  for (const std::size_t row : split.fitting) {
    if (static_cast<std::size_t>(labels[row]) == k) own_densities.push_back(log_densities(row, k));
  }
  test.centre = quantile(own_densities, 0.5);
  Matrix<double> columns;
  std::vector<std::uint8_t> is_impostor;
  std::size_t n_impostors = 0;
  constexpr std::size_t none = ~std::size_t{0};
  for (const std::size_t row : split.fitting) {
    const auto label = static_cast<std::size_t>(labels[row]);
    if (label == 0 || likeliest_without(log_densities.row(row), label == k ? none : label) != k) continue;
    columns.append_row(clipped(log_densities.row(row), test.centre));
    is_impostor.push_back(label == k ? 0 : 1);
    n_impostors += is_impostor.back();
  }
  if (n_impostors < fewest_impostors || is_impostor.size() - n_impostors < 2 * fewest_impostors) return test;

  std::vector<double> scale(columns.columns(), 0.0);
  for (std::size_t c = 0; c < columns.columns(); ++c) {
    double mean = 0.0, square = 0.0;
    for (std::size_t r = 0; r < columns.rows(); ++r) mean += columns(r, c) / static_cast<double>(columns.rows());
    for (std::size_t r = 0; r < columns.rows(); ++r) square += (columns(r, c) - mean) * (columns(r, c) - mean);
    scale[c] = std::sqrt(square / static_cast<double>(columns.rows())) + 1e-9;
    for (std::size_t r = 0; r < columns.rows(); ++r) columns(r, c) = (columns(r, c) - mean) / scale[c];
  }
  const LogisticFit fit = fit_logistic(columns, is_impostor, {.ridge = ridge, .intercept_ridge = 1e-6});
  for (std::size_t c = 0; c < scale.size(); ++c) test.slopes.push_back(fit.coefficients[1 + c] / scale[c]);
  return test;
}

ImpostorTests ImpostorTests::fit(const Matrix<double>& log_densities, std::span<const int> labels, const Split& split,
                                 unsigned threads) {
  require(log_densities.columns() >= 2, "impostors: fewer than two classes");
  require(labels.size() == log_densities.rows(), "impostors: rows and labels differ in number");
  ImpostorTests fitted;
  fitted.tests_.emplace_back();
  ordered_parallel<Test>(
      log_densities.columns() - 1, threads, [&](std::size_t i) { return learn(i + 1, log_densities, labels, split); },
      [&](Test& test) { fitted.tests_.push_back(std::move(test)); });
  for (const std::size_t row : split.calibration) {
    Test& test = fitted.tests_[static_cast<std::size_t>(labels[row])];
    if (!test.slopes.empty()) test.calibration.push_back(test.score(log_densities.row(row)));
  }
  return fitted;
}

double ImpostorTests::Test::score(std::span<const double> log_densities) const {
  const std::vector<double> values = clipped(log_densities, centre);
  double sum = 0.0;
  for (std::size_t c = 0; c < values.size(); ++c) sum += slopes[c] * values[c];
  return sum;
}

double ImpostorTests::p(std::size_t k, std::span<const double> log_densities) const {
  const Test& test = tests_.at(k);
  return test.slopes.empty() ? 1.0 : conformal_p(test.calibration, test.score(log_densities));
}

}  // namespace pirsim::stats
