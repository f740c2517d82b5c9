#include "stats/intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <vector>

#include "stats/kit.hpp"

namespace pirsim::stats {
namespace {

using boost::math::binomial_distribution;

}  // namespace

double quantile(std::span<const double> sample, double probability) {
  std::vector<double> sorted(sample.begin(), sample.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted_quantile(sorted, probability);
}

double sorted_quantile(std::span<const double> sample, double probability) {
  require(!sample.empty(), "quantile: empty sample");
  require(probability >= 0.0 && probability <= 1.0, "quantile: probability outside [0, 1]");
  const double place = probability * static_cast<double>(sample.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sample.size() - 1);
  return sample[below] + (place - static_cast<double>(below)) * (sample[above] - sample[below]);
}

Interval clopper_pearson(std::size_t hits, std::size_t trials, double confidence) {
  require(trials > 0 && hits <= trials, "clopper_pearson: hits must lie between 0 and a positive number of trials");
  require(confidence > 0.0 && confidence < 1.0, "clopper_pearson: confidence must lie between 0 and 1");
  const double tail = 0.5 * (1.0 - confidence);
  const auto n = static_cast<double>(trials), k = static_cast<double>(hits);
  return {hits == 0 ? 0.0 : binomial_distribution<>::find_lower_bound_on_p(n, k, tail),
          hits == trials ? 1.0 : binomial_distribution<>::find_upper_bound_on_p(n, k, tail)};
}

double sign_test_greater(std::size_t positive, std::size_t negative) {
  if (positive == 0) return 1.0;
  const binomial_distribution<> signs(static_cast<double>(positive + negative), 0.5);
  return boost::math::cdf(boost::math::complement(signs, static_cast<double>(positive) - 1.0));
}

Interval mean_interval(std::span<const double> values, double confidence) {
  require(values.size() > 1, "mean_interval: fewer than two values");
  require(confidence > 0.0 && confidence < 1.0, "mean_interval: confidence must lie between 0 and 1");
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const boost::math::students_t_distribution<> student(n - 1.0);
  const double reach = boost::math::quantile(boost::math::complement(student, 0.5 * (1.0 - confidence))) *
                       std::sqrt(squares / (n - 1.0) / n);
  return {mean - reach, mean + reach};
}

namespace {

std::vector<double> sorted(std::span<const double> values) {
  std::vector<double> copy(values.begin(), values.end());
  std::sort(copy.begin(), copy.end());
  return copy;
}

double distance(std::span<const double> a, std::span<const double> b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squares);
}

}  // namespace

double crps(std::span<const double> ensemble, double observed) {
  require(!ensemble.empty(), "crps: no member");
  const std::vector<double> x = sorted(ensemble);
  const auto n = static_cast<double>(x.size());
  double error = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    error += std::abs(x[i] - observed);
    pairs += x[i] * (2.0 * static_cast<double>(i) + 1.0 - n);  // sum over i < j of x_j - x_i
  }
  return error / n - pairs / (n * n);
}

double energy_score(const Matrix<double>& ensemble, std::span<const double> observed) {
  require(ensemble.rows() > 0, "energy_score: no member");
  require(ensemble.columns() == observed.size(), "energy_score: members and observation differ in length");
  const auto n = static_cast<double>(ensemble.rows());
  double error = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i < ensemble.rows(); ++i) {
    error += distance(ensemble.row(i), observed);
    for (std::size_t j = 0; j < i; ++j) pairs += distance(ensemble.row(i), ensemble.row(j));
  }
  return error / n - pairs / (n * n);
}

double area_between(std::span<const double> a, std::span<const double> b) {
  require(!a.empty() && !b.empty(), "area_between: empty sample");
  const std::vector<double> x = sorted(a), y = sorted(b);
  double area = 0.0, at = std::min(x.front(), y.front());
  for (std::size_t i = 0, j = 0; i < x.size() || j < y.size();) {
    const double next = j == y.size() || (i < x.size() && x[i] <= y[j]) ? x[i] : y[j];
    const double height =
        static_cast<double>(i) / static_cast<double>(x.size()) - static_cast<double>(j) / static_cast<double>(y.size());
    area += std::abs(height) * (next - at);
    at = next;
    while (i < x.size() && x[i] == next) ++i;
    while (j < y.size() && y[j] == next) ++j;
  }
  return area;
}

}  // namespace pirsim::stats
