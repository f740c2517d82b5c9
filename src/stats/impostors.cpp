#include "stats/impostors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/parallel.hpp"
#include "stats/conformal.hpp"
#include "stats/intervals.hpp"
#include "stats/kit.hpp"
#include "stats/logistic.hpp"

namespace pirsim::stats {
namespace {

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
    columns.append_row(std::span<const double>(clipped(log_densities.row(row), test.centre)));
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
