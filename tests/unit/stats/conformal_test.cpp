#include "stats/conformal.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"
#include "support/labelled.hpp"

using namespace pirsim;
using namespace pirsim::stats;
using pirsim::test::Labelled;

namespace {

/// 30 columns. Class k in {0, 1, 2} moves columns 2 k and 2 k + 1 by a random strength from 0 to 4, so that weak ones
/// look alike; class 3 is in no catalogue: it moves columns 20 to 22 by 4.
Labelled draw(std::size_t rows_per_class, std::initializer_list<int> classes, std::uint32_t study) {
  Stream stream({81, study, 0, Purpose::test});
  Labelled drawn{Matrix<float>(rows_per_class * classes.size(), 30), {}};
  std::size_t row = 0;
  for (const int label : classes) {
    for (std::size_t i = 0; i < rows_per_class; ++i, ++row) {
      const double strength = 4.0 * stream.uniform();
      for (float& value : drawn.features.row(row)) value = static_cast<float>(stream.normal());
      for (std::size_t c = 0; c < 3; ++c) {
        if (label == 3) drawn.features(row, 20 + c) += 4.0F;
        if (label < 3 && c < 2)
          drawn.features(row, static_cast<std::size_t>(2 * label) + c) += static_cast<float>(strength);
      }
      drawn.labels.push_back(label);
    }
  }
  return drawn;
}

ConformalClassifier fit(std::uint32_t study, unsigned threads = 0) {
  const Labelled table = draw(400, {0, 1, 2}, study);
  return ConformalClassifier::fit(table.features, table.labels, 3, test::split_by_class(table.labels),
                                  {.pooled = {.trees = {.trees = 60, .threads = threads}, .threads = threads},
                                   .shapes = {.subspace = 4, .threads = threads}});
}

bool all_refused(const std::vector<double>& p, double alpha) {
  return std::all_of(p.begin(), p.end(), [&](double one) { return one <= alpha; });
}

}  // namespace

TEST_CASE(
    "the true class is refused as rarely as its p says and another kind "
    "of row is refused by all",
    "[stats]") {
  // Given one calibration set of 160 rows a class the level itself varies by sqrt(.1 x .9 / 160) = 0.024, and the share
  // of 900 rows by 0.010; three tables average: 0.014 + 0.006.
  double wrongly = 0.0, relative_only = 0.0, unknown_refused = 0.0, unknown_refused_by_margin = 0.0, least = 1.0;
  for (std::uint32_t study = 0; study < 3; ++study) {
    const ConformalClassifier classifier = fit(10 * study);
    const Labelled known = draw(300, {0, 1, 2}, 10 * study + 1), unknown = draw(300, {3}, 10 * study + 2);
    for (std::size_t r = 0; r < known.features.rows(); ++r) {
      const Classification of_known = classifier.classify(known.features.row(r));
      const auto own = static_cast<std::size_t>(known.labels[r]);
      wrongly += of_known.p[own] <= 0.1 ? 1.0 / 2700 : 0.0;
      relative_only += of_known.p_relative[own] <= 0.1 ? 1.0 / 2700 : 0.0;
    }
    for (std::size_t r = 0; r < unknown.features.rows(); ++r) {
      const Classification one = classifier.classify(unknown.features.row(r));
      for (std::size_t k = 0; k < one.p.size(); ++k) least = std::min(least, one.p[k] - classifier.least_p(k));
      unknown_refused += all_refused(one.p, 0.1) ? 1.0 / 900 : 0.0;
      unknown_refused_by_margin += all_refused(one.p_relative, 0.1) ? 1.0 / 900 : 0.0;
    }
  }
  CHECK(wrongly < 0.1 + 3 * 0.015);
  CHECK(wrongly > 0.02);
  CHECK(std::abs(relative_only - 0.1) < 3 * 0.015);
  // Columns 20 to 22 are 3 sd off: chi-squared of 27 over 30, four-sigma with 3 columns known.
  CHECK(unknown_refused > 0.8);
  CHECK(unknown_refused_by_margin < 0.3);
  CHECK(least == 0.0);  // what is stranger than all known rows has the least p there is, and no row a smaller one
}

TEST_CASE(
    "calibrated probabilities of rows never seen are right as often as "
    "they say",
    "[stats]") {
  const ConformalClassifier classifier = fit(5);
  const Labelled fresh = draw(1000, {0, 1, 2}, 6);
  Matrix<double> probabilities(fresh.features.rows(), 3);
  for (std::size_t r = 0; r < fresh.features.rows(); ++r)
    std::ranges::copy(classifier.classify(fresh.features.row(r)).probabilities, probabilities.row(r).begin());
  CHECK(reliability(probabilities, fresh.labels).expected_calibration_error < 0.05);
}

TEST_CASE("a conformal classifier is the same for any number of threads", "[stats]") {
  const ConformalClassifier one = fit(7, 1), three = fit(7, 3);
  CHECK(one.calibration_probabilities() == three.calibration_probabilities());
  for (std::size_t r = 0; r < 5; ++r) {
    const Labelled row = draw(1, {static_cast<int>(r % 4)}, 8);
    const Classification a = one.classify(row.features.row(0)), b = three.classify(row.features.row(0));
    CHECK(a.probabilities == b.probabilities);
    CHECK(a.p == b.p);
  }
}

TEST_CASE("a small change of every column is strange where a block holds their sum", "[stats]") {
  // 40 columns of unit noise and their sum; the out-of-catalogue fault moves each by half a standard deviation, the sum
  // by 3.2 of them.
  Stream stream({82, 0, 0, Purpose::test});
  const auto draw_rows = [&](std::size_t rows, float change) {
    Matrix<float> drawn(rows, 41);
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < 40; ++c) {
        drawn(r, c) = static_cast<float>(stream.normal()) + change;
        drawn(r, 40) += drawn(r, c);
      }
    }
    return drawn;
  };
  Matrix<float> table = draw_rows(600, 0.0F);
  std::vector<int> labels;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    labels.push_back(r % 2 == 0 ? 0 : 1);
    table(r, 0) += 4.0F * static_cast<float>(labels.back());
  }
  std::vector<std::size_t> cells(40);
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  const auto refused = [&](std::vector<std::vector<std::size_t>> blocks) {
    const auto classifier = ConformalClassifier::fit(table, labels, 2, test::split_by_class(labels),
                                                     {.pooled = {.trees = {.trees = 20}}, .blocks = blocks});
    const Matrix<float> changed = draw_rows(200, 0.5F);
    double share = 0.0;
    for (std::size_t r = 0; r < 200; ++r)
      share += classifier.classify(changed.row(r)).p_absolute[0] <= 0.05 ? 1.0 / 200 : 0.0;
    return share;
  };
  CHECK(refused({cells, {40}}) > 0.6);
  CHECK(refused({cells}) < 0.4);
  CHECK_THROWS_AS(refused({{41}}), Error);
}
