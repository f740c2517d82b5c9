#include "stats/scores.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/kit.hpp"

namespace pirsim::stats {
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
