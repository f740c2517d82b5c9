#include "stats/intervals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::stats;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Rows of `columns` dependent numbers: normal, or (coarse) small whole numbers that are equal more often than not.
Matrix<double> draw_rows(std::size_t rows, std::size_t columns, std::uint32_t study, double coarse) {
  Stream stream({21, study, 0, Purpose::test});
  Matrix<double> drawn(rows, columns);
  for (std::size_t r = 0; r < rows; ++r) {
    const double common = stream.normal();
    for (std::size_t c = 0; c < columns; ++c) {
      const double value = 0.6 * common + 0.8 * stream.normal();
      drawn(r, c) = coarse > 0.0 ? std::floor(value / coarse) : value;
    }
  }
  return drawn;
}

Matrix<double> without_first(const Matrix<double>& rows) {
  std::vector<std::size_t> rest;
  for (std::size_t r = 1; r < rows.rows(); ++r) rest.push_back(r);
  return rows.select_rows(rest);
}

/// Share of studies whose true model is refused at 5 %, with 39 simulated rows: 2 of the 40 places.
double refusals(double coarse, int studies) {
  int refused = 0;
  for (int study = 0; study < studies; ++study) {
    const Matrix<double> rows = draw_rows(40, 6, static_cast<std::uint32_t>(study), coarse);
    refused += global_envelope_test(rows.row(0), without_first(rows), {.threads = 1}).p <= 0.05 + 1e-12 ? 1 : 0;
  }
  return static_cast<double>(refused) / studies;
}

/// The twin that must fail: every entry tested alone at 5 %.
double refusals_of_any_entry(int studies) {
  int refused = 0;
  for (int study = 0; study < studies; ++study) {
    const Matrix<double> rows = draw_rows(40, 6, static_cast<std::uint32_t>(study), 0.0);
    bool any = false;
    for (std::size_t c = 0; c < 6; ++c) {
      int below = 0;
      for (std::size_t r = 0; r < 40; ++r) below += rows(r, c) <= rows(0, c) ? 1 : 0;
      any = any || below == 1 || below == 40;
    }
    refused += any ? 1 : 0;
  }
  return static_cast<double>(refused) / studies;
}

/// From below, how far up a value is among the others of its entry, which differ: their number below it, and which
/// share of the way between its neighbours it lies. At an end the other end stands for the neighbour that it lacks.
double continuous_rank(const std::vector<double>& others, double value) {
  double before = -infinity, after = infinity, least = infinity, greatest = -infinity, n_below = 0.0;
  for (const double other : others) {
    n_below += other < value ? 1.0 : 0.0;
    if (other < value) before = std::max(before, other);
    if (other > value) after = std::min(after, other);
    least = std::min(least, other);
    greatest = std::max(greatest, other);
  }
  if (before == -infinity) return std::exp(-(after - value) / (greatest - after));
  if (after == infinity) return n_below + 1.0 - std::exp(-(value - before) / (before - least));
  return n_below + (value - before) / (after - before);
}

/// Extreme rank length by its definition, row by row, for values without ties.
double p_by_definition(const Matrix<double>& rows) {
  const std::size_t n = rows.rows();
  std::vector<std::vector<double>> words(n);
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = 0; c < rows.columns(); ++c) {
      std::vector<double> others = rows.column(c);
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(r));
      const double rank = continuous_rank(others, rows(r, c));
      words[r].push_back(std::min(rank, static_cast<double>(n) - rank));
    }
    std::sort(words[r].begin(), words[r].end());
  }
  const auto as_extreme = std::count_if(words.begin(), words.end(), [&](const auto& w) { return w <= words[0]; });
  return static_cast<double>(as_extreme) / static_cast<double>(n);
}

}  // namespace

TEST_CASE("the envelope test's p is that of the definition of extreme rank length", "[stats]") {
  for (std::uint32_t study = 0; study < 20; ++study) {
    const Matrix<double> rows = draw_rows(60, 9, study, 0.0);
    const GlobalEnvelope envelope = global_envelope_test(rows.row(0), without_first(rows));
    CHECK(envelope.p == Approx(p_by_definition(rows)));
  }
}

TEST_CASE("the envelope test refuses a true model in 5 of 100 studies - with ties too", "[stats]") {
  constexpr int studies = 1500;
  const double standard_error = std::sqrt(0.05 * 0.95 / studies);
  CHECK(std::abs(refusals(0.0, studies) - 0.05) < 3 * standard_error);
  CHECK(refusals(1.5, studies) < 0.05 + 3 * standard_error);
  CHECK(refusals_of_any_entry(studies) > 0.05 + 10 * standard_error);
}

TEST_CASE("an entry is outside the drawn envelope just when its adjusted p says so and the test then refuses",
          "[stats]") {
  int outside_somewhere = 0;
  for (std::uint32_t study = 0; study < 60; ++study) {
    Matrix<double> rows = draw_rows(80, 7, study, 0.0);
    if (study % 2 == 0) rows(0, study % 7) += 2.5;
    for (const double alpha : {0.05, 0.25}) {
      const GlobalEnvelope envelope = global_envelope_test(rows.row(0), without_first(rows), {.alpha = alpha});
      CHECK(*std::min_element(envelope.adjusted_p.begin(), envelope.adjusted_p.end()) == envelope.p);
      for (std::size_t c = 0; c < 7; ++c) {
        const bool outside = rows(0, c) < envelope.lower[c] || rows(0, c) > envelope.upper[c];
        CHECK(outside == (envelope.adjusted_p[c] <= alpha));
        outside_somewhere += outside ? 1 : 0;
      }
    }
  }
  CHECK(outside_somewhere > 20);
}

TEST_CASE("one entry's envelope test is the Monte Carlo test of that number", "[stats]") {
  Matrix<double> simulated(19, 1);
  for (std::size_t r = 0; r < 19; ++r) simulated(r, 0) = static_cast<double>(r);
  const GlobalEnvelope high = global_envelope_test(std::vector<double>{16.5}, simulated);
  CHECK(high.p == Approx(6.0 / 20));  // itself, 17 and 18, and as many from below
  CHECK(high.median[0] == 9.0);
  // Itself alone: 0 is first from below, but nearer to the others.
  CHECK(global_envelope_test(std::vector<double>{30.0}, simulated).p == Approx(1.0 / 20));
}

TEST_CASE("one entry far outside among many is seen by continuous ranks", "[stats]") {
  // With 400 independent entries most rows of 200 are first or last somewhere, so the first rank alone says little.
  Stream stream({5, 0, 0, Purpose::test});
  Matrix<double> simulated(199, 400);
  for (double& value : simulated.values()) value = stream.normal();
  std::vector<double> observed(400);
  for (double& value : observed) value = stream.normal();
  observed[123] = 12.0;
  const GlobalEnvelope envelope = global_envelope_test(observed, simulated);
  CHECK(envelope.p == Approx(1.0 / 200));
  CHECK(envelope.adjusted_p[123] == Approx(1.0 / 200));
}

TEST_CASE("entries that are the same in all rows change nothing in the envelope test", "[stats]") {
  const Matrix<double> rows = draw_rows(60, 5, 3, 0.0);
  Matrix<double> wide(60, 8, 4.0);
  for (std::size_t r = 0; r < 60; ++r) std::copy(rows.row(r).begin(), rows.row(r).end(), wide.row(r).begin());
  CHECK(global_envelope_test(wide.row(0), without_first(wide)).p ==
        global_envelope_test(rows.row(0), without_first(rows)).p);
}

TEST_CASE("the envelope test gives the same for any number of threads and refuses what it can't use", "[stats]") {
  const Matrix<double> rows = draw_rows(50, 6, 1, 1.5);
  const auto test = [&](unsigned threads) {
    return global_envelope_test(rows.row(0), without_first(rows), {.threads = threads}).adjusted_p;
  };
  CHECK(test(1) == test(4));
  CHECK_THROWS_AS(global_envelope_test(std::vector<double>{1.0}, rows), Error);
  CHECK_THROWS_AS(global_envelope_test(std::vector<double>(6, std::nan("")), rows), Error);
  CHECK_THROWS_AS(global_envelope_test(rows.row(0), Matrix<double>(0, 6)), Error);
}

TEST_CASE("a reference for many observed rows gives the p of the whole envelope test", "[stats]") {
  for (const double coarse : {0.0, 0.4, 1.5}) {
    for (std::uint32_t study = 0; study < 60; ++study) {
      const Matrix<double> rows = draw_rows(30 + study, 7, study, coarse);
      const Matrix<double> simulated = without_first(rows);
      std::vector<double> observed(rows.row(0).begin(), rows.row(0).end());
      if (study % 3 == 1) observed[study % 7] += 5.0;                        // outside all
      if (study % 3 == 2) observed[study % 7] = simulated(2, study % 7);     // tied with one
      if (study % 5 == 4) std::fill(observed.begin(), observed.end(), 0.1);  // in the middle of all
      CAPTURE(coarse, study);
      CHECK(EnvelopeReference(simulated).p(observed) == global_envelope_test(observed, simulated).p);
    }
  }
  const EnvelopeReference reference(draw_rows(20, 3, 1, 0.0));
  CHECK_THROWS_AS(reference.p(std::vector<double>{1.0}), Error);
}
