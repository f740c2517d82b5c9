#include "stats/intervals.hpp"

#include <cmath>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
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

/// How often Student's interval of the mean of `n` normal draws holds the true mean, of `studies`.
double coverage(std::size_t n, int studies) {
  int held = 0;
  for (int study = 0; study < studies; ++study) {
    Stream stream({11, static_cast<std::uint32_t>(study), 0, Purpose::test});
    std::vector<double> values(n);
    for (double& value : values) value = 1.0 + stream.normal();
    held += mean_interval(values).contains(1.0) ? 1 : 0;
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
  CHECK(sign_test_greater(0, 4) == 1.0);
  CHECK(sign_test_greater(0, 0) == 1.0);
}

TEST_CASE("quantiles lie on the line between order statistics", "[stats]") {
  const std::vector<double> sample{4, 1, 3, 2};
  CHECK(quantile(sample, 0.0) == 1.0);
  CHECK(quantile(sample, 1.0) == 4.0);
  CHECK(quantile(sample, 0.5) == 2.5);
  CHECK(quantile(sample, 0.25) == Approx(1.75));
  CHECK_THROWS_AS(quantile(std::vector<double>{}, 0.5), Error);
}

TEST_CASE("intervals of a mean hold it as often as they say, of few values too", "[stats]") {
  const double standard_error = std::sqrt(0.95 * 0.05 / 4000);
  for (const std::size_t n : {2U, 5U, 10U}) {
    INFO(n);
    CHECK(coverage(n, 4000) == Approx(0.95).margin(3.5 * standard_error));
  }
  // two values, one degree of freedom: tan(0.475 pi) half-distances to either side of the middle
  const double reach = std::tan(0.475 * std::acos(-1.0));
  CHECK(mean_interval(std::vector<double>{1.0, 3.0}).low == Approx(2.0 - reach));
  CHECK(mean_interval(std::vector<double>{1.0, 3.0}).high == Approx(2.0 + reach));
  CHECK_THROWS_AS(mean_interval(std::vector<double>{1.0}), Error);
}
