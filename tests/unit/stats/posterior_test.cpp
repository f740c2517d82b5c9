#include "stats/intervals.hpp"

#include <cmath>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::stats;

namespace {

/// theta ~ N(0, 1); two statistics, theta + noise of sd 0.5 and 2 theta + noise of sd 3.
struct Conjugate {
  Matrix<double> parameters, statistics;
};

Conjugate simulate(std::size_t rows, std::uint32_t study) {
  Stream stream({51, study, 0, Purpose::test});
  Conjugate drawn{Matrix<double>(rows, 1), Matrix<double>(rows, 2)};
  for (std::size_t r = 0; r < rows; ++r) {
    const double theta = stream.normal();
    drawn.parameters(r, 0) = theta;
    drawn.statistics(r, 0) = theta + 0.5 * stream.normal();
    drawn.statistics(r, 1) = 2.0 * theta + 3.0 * stream.normal();
  }
  return drawn;
}

constexpr double precision = 1.0 + 1.0 / 0.25 + 4.0 / 9.0;
double exact_mean(double first, double second) { return (first / 0.25 + 2.0 * second / 9.0) / precision; }

/// Share of 90 % intervals that hold the truth, for parameters drawn from the prior.
double posterior_coverage(double widening, int studies) {
  const Conjugate table = simulate(1000, 0);
  const Conjugate truths = simulate(static_cast<std::size_t>(studies), 1);
  int held = 0;
  for (std::size_t study = 0; study < truths.parameters.rows(); ++study) {
    const AbcPosterior posterior = abc_posterior(table.parameters, table.statistics, truths.statistics.row(study));
    held += posterior.interval(0, 0.9, widening).contains(truths.parameters(study, 0)) ? 1 : 0;
  }
  return static_cast<double>(held) / studies;
}

}  // namespace

TEST_CASE("the adjusted posterior is the conjugate one", "[stats]") {
  const Conjugate table = simulate(20000, 2);
  for (const double first : {-1.0, 0.3, 1.4}) {
    const std::vector<double> observed{first, 1.0};
    const AbcPosterior posterior = abc_posterior(table.parameters, table.statistics, observed, {.accepted = 0.1});
    const double sd = 1.0 / std::sqrt(precision);
    // 2,000 accepted rows of unequal weight: about 1,500 worth of them; four standard errors.
    double mean = 0.0;
    for (std::size_t r = 0; r < posterior.values.rows(); ++r) mean += posterior.weights[r] * posterior.values(r, 0);
    CHECK(mean == Approx(exact_mean(first, 1.0)).margin(4 * sd / std::sqrt(1500.0)));
    CHECK(posterior.quantile(0, 0.5) == Approx(exact_mean(first, 1.0)).margin(4 * 1.25 * sd / std::sqrt(1500.0)));
    const Interval interval = posterior.interval(0, 0.9);
    CHECK(interval.high - interval.low == Approx(2 * 1.645 * sd).epsilon(0.08));
    const Interval wide = posterior.interval(0, 0.9, 2.0);
    CHECK(wide.high - wide.low == Approx(2.0 * (interval.high - interval.low)));
  }
}

TEST_CASE("ninety per cent posterior intervals hold the truth nine times in ten and narrowed ones do not", "[stats]") {
  constexpr int studies = 600;
  const double standard_error = std::sqrt(0.9 * 0.1 / studies);
  CHECK(std::abs(posterior_coverage(1.0, studies) - 0.9) < 3 * standard_error);
  CHECK(posterior_coverage(0.7, studies) < 0.9 - 4 * standard_error);
}

TEST_CASE("the posterior of a bounded parameter stays in its bounds", "[stats]") {
  Stream stream({52, 0, 0, Purpose::test});
  Matrix<double> parameters(1000, 1), statistics(1000, 1);
  for (std::size_t r = 0; r < 1000; ++r) {
    parameters(r, 0) = 0.2 + 0.6 * stream.uniform();
    statistics(r, 0) = parameters(r, 0) + 0.1 * stream.normal();
  }
  const AbcPosterior posterior =
      abc_posterior(parameters, statistics, std::vector<double>{0.95}, {.accepted = 0.2, .bounds = {{0.2, 0.8}}});
  for (const double value : posterior.values.values()) CHECK((value >= 0.2 && value <= 0.8));
  CHECK(posterior.quantile(0, 0.5) > 0.7);
  CHECK_THROWS_AS(abc_posterior(parameters, statistics, std::vector<double>{0.5}, {.accepted = 0.002}), Error);
}

TEST_CASE("estimated parameters from many statistics are near the best estimate there is", "[stats]") {
  // 200 statistics: theta plus noise of sd 4 each and 100 of noise alone; the best estimate has variance 1 / (1 + 100 /
  // 16).
  Stream stream({53, 0, 0, Purpose::test});
  const auto draw = [&](std::size_t rows) {
    Conjugate drawn{Matrix<double>(rows, 1), Matrix<double>(rows, 200)};
    for (std::size_t r = 0; r < rows; ++r) {
      drawn.parameters(r, 0) = stream.normal();
      for (std::size_t c = 0; c < 200; ++c)
        drawn.statistics(r, c) = (c < 100 ? drawn.parameters(r, 0) : 0.0) + 4.0 * stream.normal();
    }
    return drawn;
  };
  const Conjugate train = draw(1000), test = draw(1000);
  const ParameterEstimator fitted = ParameterEstimator::fit(train.statistics, train.parameters);
  double squares = 0.0;
  for (std::size_t r = 0; r < 1000; ++r)
    squares += std::pow(fitted.estimate(test.statistics.row(r))[0] - test.parameters(r, 0), 2) / 1000;
  const double best = 1.0 / (1.0 + 100.0 / 16.0);
  CHECK(squares > best * 0.8);
  CHECK(squares < best * 1.45);  // 200 slopes from 1,000 rows cost about a fifth each way
  CHECK(squares < 0.25);         // guessing the mean would give 1
}
