#include "stats/conformal.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "stats/intervals.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::stats;

namespace {

constexpr std::size_t n_known = 39, n_measures = 6;

Matrix<double> draw_measures(Stream& stream, std::size_t n_rows) {
  Matrix<double> rows(n_rows, n_measures);
  for (double& value : rows.values()) value = stream.normal();
  return rows;
}

/// With scales from the known rows alone.
double naive_p(const Matrix<double>& known, std::span<const double> row) {
  std::vector<double> strangest(known.rows() + 1, -1e300);
  for (std::size_t m = 0; m < n_measures; ++m) {
    std::vector<double> values;
    for (std::size_t i = 0; i < known.rows(); ++i) values.push_back(known(i, m));
    const double median = quantile(values, 0.5), reach = quantile(values, 0.95) - median;
    values.push_back(row[m]);
    for (std::size_t i = 0; i < values.size(); ++i) strangest[i] = std::max(strangest[i], (values[i] - median) / reach);
  }
  const double own = strangest.back();
  strangest.pop_back();
  return conformal_p(strangest, own);
}

}  // namespace

TEST_CASE("a conformal p counts the scores that are as strange", "[stats]") {
  const std::vector<double> calibration{1, 2, 3, 3};
  CHECK(conformal_p(calibration, 3.0) == Approx(3.0 / 5));
  CHECK(conformal_p(calibration, 9.0) == Approx(1.0 / 5));
  CHECK(conformal_p(calibration, 0.0) == 1.0);
}

TEST_CASE("one more row of the same kind is refused exactly as often as the level says", "[stats]") {
  // Ranks of 40 exchangeable rows without ties are uniform: p <= 0.05 has the probability 2 / 40.
  constexpr int n_studies = 6000;
  const double standard_error = std::sqrt(0.05 * 0.95 / n_studies);
  Stream stream({91, 0, 0, Purpose::test});
  double refused = 0.0, refused_naively = 0.0;
  for (int i = 0; i < n_studies; ++i) {
    const Matrix<double> known = draw_measures(stream, n_known), more = draw_measures(stream, 1);
    refused += StrangestMeasure(known).p(more.row(0)) <= 0.05 ? 1.0 / n_studies : 0.0;
    refused_naively += naive_p(known, more.row(0)) <= 0.05 ? 1.0 / n_studies : 0.0;
  }
  CHECK(std::abs(refused - 0.05) < 4 * standard_error);
  // The twin: known rows stretch their own scales.
  CHECK(refused_naively > 0.05 + 4 * standard_error);
}

TEST_CASE("what is strange by one measure is strange, whatever the others and their units", "[stats]") {
  Stream stream({92, 0, 0, Purpose::test});
  Matrix<double> known = draw_measures(stream, 200);
  std::vector<double> row(n_measures, 0.0);
  CHECK(StrangestMeasure(known).p(row) > 0.5);
  row[4] = 6.0;
  CHECK(StrangestMeasure(known).p(row) == Approx(1.0 / 201));
  for (std::size_t i = 0; i < 200; ++i) known(i, 4) = 1e6 + 1e3 * known(i, 4);
  row[4] = 1e6 + 6e3;
  CHECK(StrangestMeasure(known).p(row) == Approx(1.0 / 201));
  row.pop_back();
  CHECK_THROWS_AS(StrangestMeasure(known).p(row), Error);
}
