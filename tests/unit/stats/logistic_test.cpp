#include "stats/trees.hpp"

#include <cmath>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::stats;

namespace {

struct Draws {
  Matrix<double> columns;
  std::vector<std::uint8_t> outcomes;
  std::vector<int> trial;
};

double share(double odds) { return 1.0 / (1.0 + std::exp(-odds)); }

/// Log-odds -0.5 + 1.0 x0 + 0 x1 + a normal effect of the trial (20 rows each, which also share x1).
Draws draw_trials(std::size_t trials, double trial_sd, std::uint32_t study) {
  Stream stream({61, study, 0, Purpose::test});
  Draws drawn{Matrix<double>(trials * 20, 2), {}, {}};
  for (std::size_t trial = 0; trial < trials; ++trial) {
    const double effect = trial_sd * stream.normal(), shared = stream.normal();
    for (std::size_t i = 0; i < 20; ++i) {
      const std::size_t row = trial * 20 + i;
      drawn.columns(row, 0) = stream.normal();
      drawn.columns(row, 1) = shared;
      drawn.outcomes.push_back(stream.uniform() < share(-0.5 + drawn.columns(row, 0) + effect) ? 1 : 0);
      drawn.trial.push_back(static_cast<int>(trial));
    }
  }
  return drawn;
}

}  // namespace

TEST_CASE("one binary column's logistic fit is the table's log odds ratio and its standard error", "[stats]") {
  // Counts (no, yes): column 0: 30, 10; column 1: 12, 28.
  Matrix<double> column(80, 1);
  std::vector<std::uint8_t> outcomes(80, 0);
  for (std::size_t i = 0; i < 80; ++i) column(i, 0) = i < 40 ? 0.0 : 1.0;
  for (std::size_t i = 0; i < 10; ++i) outcomes[i] = 1;
  for (std::size_t i = 40; i < 68; ++i) outcomes[i] = 1;
  const LogisticFit fit = fit_logistic(column, outcomes);
  CHECK(fit.coefficients[0] == Approx(std::log(10.0 / 30.0)));
  CHECK(fit.coefficients[1] == Approx(std::log((28.0 / 12.0) / (10.0 / 30.0))));
  CHECK(fit.standard_errors[0] == Approx(std::sqrt(1.0 / 10 + 1.0 / 30)));
  CHECK(fit.standard_errors[1] == Approx(std::sqrt(1.0 / 10 + 1.0 / 30 + 1.0 / 28 + 1.0 / 12)));
  CHECK(fit.log_likelihood ==
        Approx(10 * std::log(0.25) + 30 * std::log(0.75) + 28 * std::log(0.7) + 12 * std::log(0.3)));
}

TEST_CASE("a known offset is taken off and a ridge draws slopes to zero", "[stats]") {
  const Draws drawn = draw_trials(100, 0.0, 0);
  std::vector<double> offset;
  for (std::size_t r = 0; r < drawn.columns.rows(); ++r) offset.push_back(-0.5 + drawn.columns(r, 0));
  const LogisticFit rest = fit_logistic(drawn.columns, drawn.outcomes, {.offset = offset});
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(rest.coefficients[k]) < 4 * rest.standard_errors[k]);
  const LogisticFit free = fit_logistic(drawn.columns, drawn.outcomes);
  CHECK(std::abs(free.coefficients[1] - 1.0) < 4 * free.standard_errors[1]);
  CHECK(free.coefficients[1] > 10 * free.standard_errors[1]);
  const LogisticFit held = fit_logistic(drawn.columns, drawn.outcomes, {.ridge = 1e5});
  CHECK(std::abs(held.coefficients[1]) < 0.01);
  CHECK(held.coefficients[0] < -0.2);  // the intercept isn't held
}

TEST_CASE("standard errors by trial hold where rows of a trial depend on each other and plain ones do not", "[stats]") {
  constexpr int studies = 300;
  int plain = 0, by_trial = 0;
  for (int study = 0; study < studies; ++study) {
    const Draws drawn = draw_trials(60, 1.0, static_cast<std::uint32_t>(study + 1));
    const LogisticFit independent = fit_logistic(drawn.columns, drawn.outcomes);
    const LogisticFit clustered = fit_logistic(drawn.columns, drawn.outcomes, {.cluster = drawn.trial});
    plain += std::abs(independent.coefficients[2]) > 1.96 * independent.standard_errors[2] ? 1 : 0;
    by_trial += std::abs(clustered.coefficients[2]) > 1.96 * clustered.standard_errors[2] ? 1 : 0;
  }
  // Level 5 %, standard error 1.3 %; with 60 clusters the sandwich is known to give a little more than 5 %.
  CHECK(by_trial / 300.0 < 0.07 + 3 * 0.013);
  CHECK(plain / 300.0 > 0.15);
}

TEST_CASE("logistic regression says when there is no maximum", "[stats]") {
  Matrix<double> column(6, 1);
  const std::vector<std::uint8_t> outcomes{0, 0, 0, 1, 1, 1};
  for (std::size_t i = 0; i < 6; ++i) column(i, 0) = static_cast<double>(i);
  CHECK_THROWS_WITH(fit_logistic(column, outcomes), contains("separable"));
  CHECK(fit_logistic(column, outcomes, {.ridge = 0.1}).coefficients[1] > 0.0);
  CHECK_THROWS_AS(fit_logistic(column, std::vector<std::uint8_t>{0, 1, 2, 0, 0, 0}), Error);
  CHECK_THROWS_AS(fit_logistic(column, std::vector<std::uint8_t>{0, 1}), Error);
}

TEST_CASE("with outcomes that are all equal a ridge on the intercept keeps the fit finite", "[stats]") {
  // One parameter: penalised maximum where n (outcome - share(b)) = ridge b.
  for (const std::uint8_t outcome : {std::uint8_t{0}, std::uint8_t{1}}) {
    const Matrix<double> nothing(500, 1, 0.0);
    const std::vector<std::uint8_t> outcomes(500, outcome);
    const LogisticFit fit = fit_logistic(nothing, outcomes, {.ridge = 1.0, .intercept_ridge = 0.1});
    CHECK(500.0 * (outcome - share(fit.coefficients[0])) == Approx(0.1 * fit.coefficients[0]).margin(1e-6));
    CHECK((outcome == 1) == (fit.coefficients[0] > 0.0));
    CHECK(fit.standard_errors[0] > 0.0);
  }
}
