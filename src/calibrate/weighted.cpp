#include "calibrate/weighted.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace pirsim::calibrate {
namespace {

std::vector<std::size_t> order_of(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
  return order;
}

/// The least value that so much of the weight doesn't exceed.
double weighted_quantile(std::span<const double> values, std::span<const double> weights, double probability) {
  const double wanted = probability * std::accumulate(weights.begin(), weights.end(), 0.0);
  double reached = 0.0, last = 0.0;
  for (const std::size_t i : order_of(values)) {
    if (!(weights[i] > 0.0)) continue;
    last = values[i];
    reached += weights[i];
    if (reached >= wanted) break;
  }
  return last;
}

std::vector<double> ranks(std::span<const double> values) {
  const std::vector<std::size_t> order = order_of(values);
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    i = end;
  }
  return ranks;
}

}  // namespace

double weighted_mean(std::span<const double> values, std::span<const double> weights) {
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0) /
         std::accumulate(weights.begin(), weights.end(), 0.0);
}

double weighted_sd(std::span<const double> values, std::span<const double> weights) {
  const double mean = weighted_mean(values, weights);
  std::vector<double> squares;
  for (const double value : values) squares.push_back((value - mean) * (value - mean));
  return std::sqrt(weighted_mean(squares, weights));
}

Interval weighted_interval(std::span<const double> values, std::span<const double> weights) {
  constexpr double tail = 0.05;
  return {weighted_quantile(values, weights, tail), weighted_quantile(values, weights, 1.0 - tail)};
}

double rank_correlation(std::span<const double> x, std::span<const double> y) {
  constexpr std::size_t fewest = 3;
  if (x.size() < fewest) return 0.0;
  const std::vector<double> a = ranks(x), b = ranks(y), one(x.size(), 1.0);
  const double spread = weighted_sd(a, one) * weighted_sd(b, one);
  if (!(spread > 0.0)) return 0.0;
  const double product = std::inner_product(a.begin(), a.end(), b.begin(), 0.0) / static_cast<double>(x.size());
  return (product - weighted_mean(a, one) * weighted_mean(b, one)) / spread;
}

}  // namespace pirsim::calibrate
