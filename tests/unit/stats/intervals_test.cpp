#include "pirsim/stats/intervals.hpp"

#include <cmath>
#include <vector>

#include "pirsim/core/error.hpp"
#include "pirsim/core/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::stats;

namespace {

/// P(from <= k <= n) by the recursion of the binomial coefficients.
double binomial_tail(std::size_t from, std::size_t n, double p) {
  double sum = 0.0;
  double term = std::pow(1.0 - p, static_cast<double>(n));
  for (std::size_t k = 0; k <= n; ++k) {
    if (k >= from) sum += term;
    term *= static_cast<double>(n - k) / static_cast<double>(k + 1) * p / (1.0 - p);
  }
  return sum;
}

/// How often the interval of the mean of `n` exponential draws holds the true mean, of `studies`.
double coverage(BootstrapKind kind, std::size_t n, int studies) {
  int held = 0;
  for (int study = 0; study < studies; ++study) {
    Stream stream({11, static_cast<std::uint32_t>(study), 0, Purpose::test});
    std::vector<double> values(n);
    for (double& value : values) value = -std::log(1.0 - stream.uniform());
    const auto mean = [&](std::span<const std::size_t> blocks) {
      double sum = 0.0;
      for (const std::size_t block : blocks) sum += values[block];
      return sum / static_cast<double>(blocks.size());
    };
    const BootstrapSettings settings{0.9, 400, kind, static_cast<std::uint64_t>(study), 1};
    held += block_bootstrap(n, mean, settings).contains(1.0) ? 1 : 0;
  }
  return static_cast<double>(held) / studies;
}

}  // namespace

TEST_CASE("Clopper-Pearson bounds are where the binomial tails equal half of what is left", "[stats]") {
  for (const std::size_t hits : {1U, 5U, 19U}) {
    const Interval interval = clopper_pearson(hits, 20, 0.95);
    CHECK(binomial_tail(hits, 20, interval.low) == Approx(0.025).epsilon(1e-6));
    CHECK(1.0 - binomial_tail(hits + 1, 20, interval.high) == Approx(0.025).epsilon(1e-6));
  }
  CHECK(clopper_pearson(0, 30).low == 0.0);
  CHECK(clopper_pearson(0, 30).high == Approx(1.0 - std::pow(0.025, 1.0 / 30.0)));
  CHECK(clopper_pearson(30, 30).high == 1.0);
  CHECK_THROWS_AS(clopper_pearson(3, 2), Error);
}

TEST_CASE("the sign test counts coins", "[stats]") {
  CHECK(sign_test_greater(9, 1) == Approx(11.0 / 1024.0));
  CHECK(sign_test_two_sided(1, 9) == Approx(22.0 / 1024.0));
  CHECK(sign_test_greater(0, 4) == 1.0);
  CHECK(sign_test_greater(0, 0) == 1.0);
  CHECK(sign_test_two_sided(3, 3) == 1.0);
}

TEST_CASE("quantiles lie on the line between order statistics", "[stats]") {
  const std::vector<double> sample{4, 1, 3, 2};
  CHECK(quantile(sample, 0.0) == 1.0);
  CHECK(quantile(sample, 1.0) == 4.0);
  CHECK(quantile(sample, 0.5) == 2.5);
  CHECK(quantile(sample, 0.25) == Approx(1.75));
  CHECK_THROWS_AS(quantile(std::vector<double>{}, 0.5), Error);
}

TEST_CASE("bootstrap intervals of a skewed mean cover it nearly as often as they say", "[stats]") {
  // 600 studies: standard error sqrt(.9 x .1 / 600) = 0.012. For 30 exponential draws the literature's coverage of a
  // nominal 90 % BCa interval is about .87 to .89.
  const double standard_error = std::sqrt(0.9 * 0.1 / 600);
  CHECK(coverage(BootstrapKind::bca, 30, 600) > 0.88 - 3 * standard_error);
  CHECK(coverage(BootstrapKind::bca, 30, 600) < 0.90 + 3 * standard_error);
  CHECK(coverage(BootstrapKind::percentile, 30, 600) > 0.86 - 3 * standard_error);
  // The twin: five draws are too few for any bootstrap, and the test sees it.
  CHECK(coverage(BootstrapKind::percentile, 5, 600) < 0.88 - 3 * standard_error);
}

TEST_CASE("a BCa interval of a symmetric sample is the percentile interval moved by nothing", "[stats]") {
  // Acceleration 0 by symmetry; bias 0 up to the bootstrap's own error.
  std::vector<double> values;
  for (int i = -20; i <= 20; ++i) values.push_back(i);
  const auto mean = [&](std::span<const std::size_t> blocks) {
    double sum = 0.0;
    for (const std::size_t block : blocks) sum += values[block];
    return sum / static_cast<double>(blocks.size());
  };
  BootstrapSettings settings{0.9, 4000, BootstrapKind::percentile, 3, 0};
  const Interval percentile = block_bootstrap(values.size(), mean, settings);
  settings.kind = BootstrapKind::bca;
  const Interval bca = block_bootstrap(values.size(), mean, settings);
  const double sd = std::sqrt(140.0 / 41.0);  // of the mean: variance of -20..20 is 140
  CHECK(percentile.low == Approx(-1.645 * sd).epsilon(0.06));
  CHECK(percentile.high == Approx(1.645 * sd).epsilon(0.06));
  CHECK(bca.low == Approx(percentile.low).margin(0.08 * sd));
  CHECK(bca.high == Approx(percentile.high).margin(0.08 * sd));
}

TEST_CASE("a bootstrap interval is the same for any number of threads", "[stats]") {
  const auto statistic = [](std::span<const std::size_t> blocks) {
    double sum = 0.0;
    for (const std::size_t block : blocks) sum += std::sqrt(static_cast<double>(block));
    return sum;
  };
  CHECK(block_bootstrap(12, statistic, {.seed = 5, .threads = 1}) ==
        block_bootstrap(12, statistic, {.seed = 5, .threads = 3}));
  CHECK_FALSE(block_bootstrap(12, statistic, {.seed = 5}) == block_bootstrap(12, statistic, {.seed = 6}));
}
