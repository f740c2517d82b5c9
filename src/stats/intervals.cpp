#include "pirsim/stats/intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>

#include "pirsim/core/parallel.hpp"
#include "pirsim/core/random.hpp"
#include "stats/require.hpp"

namespace pirsim::stats {
namespace {

using boost::math::binomial_distribution;

/// Type 7 of a sorted sample.
std::vector<double> bootstrap_values(std::size_t n_blocks, const BlockStatistic& statistic,
                                     const BootstrapSettings& settings) {
  std::vector<double> values;
  values.reserve(settings.samples);
  const auto draw = [&](std::size_t sample) {
    Stream stream({settings.seed, static_cast<std::uint32_t>(sample), 0, Purpose::bootstrap});
    std::vector<std::size_t> blocks(n_blocks);
    for (auto& block : blocks) block = stream.index(static_cast<std::uint32_t>(n_blocks));
    return statistic(blocks);
  };
  ordered_parallel<double>(settings.samples, settings.threads, draw, [&](double& value) { values.push_back(value); });
  std::sort(values.begin(), values.end());
  return values;
}

/// A sixth of the skewness of the jackknife's influence values. Ref: [Efron1987] equation 6.6
double acceleration(std::size_t n_blocks, const BlockStatistic& statistic) {
  std::vector<double> left_out;
  for (std::size_t gone = 0; gone < n_blocks; ++gone) {
    std::vector<std::size_t> blocks;
    for (std::size_t i = 0; i < n_blocks; ++i)
      if (i != gone) blocks.push_back(i);
    left_out.push_back(statistic(blocks));
  }
  const double mean = std::accumulate(left_out.begin(), left_out.end(), 0.0) / static_cast<double>(n_blocks);
  double squares = 0.0, cubes = 0.0;
  for (const double value : left_out) {
    const double influence = mean - value;
    squares += influence * influence;
    cubes += influence * influence * influence;
  }
  return squares > 0.0 ? cubes / (6.0 * std::pow(squares, 1.5)) : 0.0;
}

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

double sign_test_two_sided(std::size_t positive, std::size_t negative) {
  return std::min(1.0, 2.0 * sign_test_greater(std::max(positive, negative), std::min(positive, negative)));
}

Interval block_bootstrap(std::size_t n_blocks, const BlockStatistic& statistic, const BootstrapSettings& settings) {
  require(n_blocks > 1, "block_bootstrap: fewer than two blocks");
  require(settings.samples > 1, "block_bootstrap: fewer than two samples");
  require(settings.confidence > 0.0 && settings.confidence < 1.0, "block_bootstrap: confidence outside (0, 1)");
  const std::vector<double> values = bootstrap_values(n_blocks, statistic, settings);
  const double tail = 0.5 * (1.0 - settings.confidence);
  if (settings.kind == BootstrapKind::percentile)
    return {sorted_quantile(values, tail), sorted_quantile(values, 1.0 - tail)};

  std::vector<std::size_t> all(n_blocks);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const double estimate = statistic(all);
  const auto [first, last] = std::equal_range(values.begin(), values.end(), estimate);
  const auto n = static_cast<double>(values.size());
  // Values equal to the estimate count half; kept off 0 and 1, where the normal quantile is infinite.
  const double below = 0.5 * static_cast<double>((first - values.begin()) + (last - values.begin())) / n;
  const boost::math::normal_distribution<> normal;
  const double bias = boost::math::quantile(normal, std::clamp(below, 0.5 / n, 1.0 - 0.5 / n));
  const double skew = acceleration(n_blocks, statistic);
  const auto corrected = [&](double probability) {
    const double z = bias + boost::math::quantile(normal, probability);
    return boost::math::cdf(normal, bias + z / (1.0 - skew * z));
  };
  return {sorted_quantile(values, corrected(tail)), sorted_quantile(values, corrected(1.0 - tail))};
}

}  // namespace pirsim::stats
