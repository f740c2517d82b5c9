#include "stats/classes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"
#include "support/labelled.hpp"

using namespace pirsim;
using namespace pirsim::stats;
using pirsim::test::Labelled;

namespace {

/// Two classes in 12 columns of unit noise; class 0 varies by sd 5 along (1, 1, 0, ...), class 1 not at all.
Labelled draw_shapes(std::size_t rows, std::uint32_t study) {
  Stream stream({91, study, 0, Purpose::test});
  Labelled drawn{Matrix<float>(rows, 12), {}};
  for (std::size_t r = 0; r < rows; ++r) {
    const int label = static_cast<int>(r % 2);
    const double along = label == 0 ? 5.0 * stream.normal() : 0.0;
    for (float& value : drawn.features.row(r)) value = static_cast<float>(stream.normal());
    for (const std::size_t c : {0U, 1U}) drawn.features(r, c) += static_cast<float>(along);
    drawn.labels.push_back(label);
  }
  return drawn;
}

}  // namespace

TEST_CASE("what a class varies by is not strange for it and what it does not vary by is", "[stats]") {
  const Labelled table = draw_shapes(4000, 0);
  const ClassShapes shapes = ClassShapes::fit(table.features, table.labels, 2, {.subspace = 1});
  std::vector<float> along(12, 0.0F), across(12, 0.0F);
  along[0] = along[1] = 6.0F;
  across[0] = 6.0F;
  across[1] = -6.0F;
  // Along: 6 sqrt(2) of sd sqrt(51): among the class's rows, and nothing left over.
  CHECK(shapes.strangeness(along, 0) < 1.5);
  // Across: 6 sqrt(2) where the class has unit noise, squared 72; shrinking takes that noise for somewhat greater.
  CHECK(shapes.strangeness(across, 0) > 30.0);
  CHECK(shapes.strangeness(across, 0) < 72.0 * 1.1);
}

TEST_CASE("strangeness of a class's own fresh rows has the mean that normal theory gives", "[stats]") {
  const Labelled table = draw_shapes(4000, 1), fresh = draw_shapes(2000, 2);
  const ClassShapes shapes = ClassShapes::fit(table.features, table.labels, 2, {.subspace = 3});
  double mahalanobis = 0.0;
  for (std::size_t r = 0; r < 2000; r += 2) mahalanobis += shapes.strangeness(fresh.features.row(r), 0) / 1000;
  // Nine directions are left; the shrunk covariance isn't singular in the three that were taken out.
  CHECK(mahalanobis == Approx(9.0).epsilon(0.06));
}

TEST_CASE("a pair of common values is strange where one predicts the other otherwise", "[stats]") {
  // Column 1 follows column 0 closely in class 0: (1.5, -1.5) times their sd is a rare pair of common values.
  const Labelled table = draw_shapes(4000, 4);
  const ClassShapes shapes = ClassShapes::fit(table.features, table.labels, 2, {.subspace = 1, .curved = 0});
  std::vector<float> pair(12, 0.0F);
  pair[0] = 7.5F;
  pair[1] = -7.5F;
  CHECK(shapes.strangeness(pair, 0) > 40.0);
  pair[1] = 7.5F;
  CHECK(shapes.strangeness(pair, 0) < 1.5);
}

TEST_CASE("a class that bends is followed along its bend", "[stats]") {
  // Columns 0, 2 and 3 are the same number, column 1 its square, all with a little noise; class 1 only fills the table.
  Stream stream({92, 0, 0, Purpose::test});
  Matrix<float> features(2000, 4);
  std::vector<int> labels;
  for (std::size_t r = 0; r < 2000; ++r) {
    const double at = 2.0 * stream.normal();
    for (float& value : features.row(r)) value = static_cast<float>(at + 0.05 * stream.normal());
    features(r, 1) = static_cast<float>(0.2 * at * at + 0.05 * stream.normal());
    labels.push_back(r % 4 == 0 ? 1 : 0);
  }
  const std::vector<float> on{3.0F, 1.8F, 3.0F, 3.0F}, off{3.0F, 0.6F, 3.0F, 3.0F};
  const auto distance = [&](std::size_t curved, const std::vector<float>& row) {
    return ClassShapes::fit(features, labels, 2, {.subspace = 1, .curved = curved}).strangeness(row, 0);
  };
  CHECK(distance(1, on) < 10.0);
  CHECK(distance(1, off) > 100.0);
  CHECK(distance(0, off) < 10.0);  // the twin: without the bend the row off the curve isn't strange
}

TEST_CASE("class shapes refuse too few rows and rows of another length", "[stats]") {
  const Labelled table = draw_shapes(40, 3);
  std::vector<int> labels = table.labels;
  labels[0] = 2;
  CHECK_THROWS_AS(ClassShapes::fit(table.features, labels, 3), Error);
  const ClassShapes shapes = ClassShapes::fit(table.features, table.labels, 2);
  CHECK_THROWS_AS(shapes.strangeness(std::vector<float>(3, 0.0F), 0), Error);
}

TEST_CASE("a class whose rows are all the same is strange to any other row", "[stats]") {
  Matrix<float> rows(60, 12);
  std::vector<int> labels(60, 0);
  Stream stream({8, 0, 0, Purpose::test});
  for (std::size_t r = 30; r < 60; ++r) {
    labels[r] = 1;
    for (float& value : rows.row(r)) value = static_cast<float>(stream.normal());
  }
  const ClassShapes shapes = ClassShapes::fit(rows, labels, 2, {.subspace = 3});
  CHECK(std::isfinite(shapes.strangeness(std::as_const(rows).row(0), 0)));
  CHECK(shapes.strangeness(std::as_const(rows).row(40), 0) > shapes.strangeness(std::as_const(rows).row(0), 0) + 1.0);
}
