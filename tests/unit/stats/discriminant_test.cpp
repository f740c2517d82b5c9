#include "stats/classes.hpp"

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

/// Classes at -distance / 2 and +distance / 2 along column 0; column 1 repeats column 0's noise times `correlation`.
Labelled two_normals(std::size_t rows, std::size_t columns, double distance, double correlation, std::uint32_t study) {
  Stream stream({41, study, 0, Purpose::test});
  Labelled data{Matrix<float>(rows, columns), {}};
  for (std::size_t r = 0; r < rows; ++r) {
    const int label = static_cast<int>(r % 2);
    const double noise = stream.normal();
    for (float& value : data.features.row(r)) value = static_cast<float>(stream.normal());
    data.features(r, 0) = static_cast<float>(noise + distance * (label - 0.5));
    data.features(r, 1) =
        static_cast<float>(correlation * noise + std::sqrt(1.0 - correlation * correlation) * data.features(r, 1));
    data.labels.push_back(label);
  }
  return data;
}

int likelier(const Discriminant& fitted, std::span<const float> row) {
  const std::vector<double> logs = fitted.log_densities(row);
  return logs[1] > logs[0] ? 1 : 0;
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

}  // namespace

TEST_CASE("a discriminant is wrong as rarely as normal theory allows", "[stats]") {
  // Mahalanobis distance of the means, column 1 known to carry `correlation` of column 0's noise:
  // distance / sqrt(1 - correlation^2); error Phi(-half of it).
  constexpr double distance = 1.2, correlation = 0.8;
  const Labelled train = two_normals(8000, 6, distance, correlation, 0);
  const Labelled test = two_normals(8000, 6, distance, correlation, 1);
  const Discriminant fitted = Discriminant::fit(train.features, train.labels, 2);
  int wrong = 0;
  for (std::size_t r = 0; r < 8000; ++r) wrong += likelier(fitted, test.features.row(r)) == test.labels[r] ? 0 : 1;
  const double expected = normal_cdf(-0.5 * distance / std::sqrt(1.0 - correlation * correlation));
  const double standard_error = std::sqrt(expected * (1.0 - expected) / 8000);
  CHECK(std::abs(wrong / 8000.0 - expected) < 4 * standard_error);
  // The twin: without the second column the theory's error is another one.
  CHECK(std::abs(wrong / 8000.0 - normal_cdf(-0.5 * distance)) > 4 * standard_error);
}

TEST_CASE("projected rows have the within-class variance one and the means apart by Mahalanobis' distance", "[stats]") {
  const Labelled data = two_normals(4000, 3, 2.0, 0.0, 2);
  const Discriminant fitted = Discriminant::fit(data.features, data.labels, 2);
  REQUIRE(fitted.n_directions() == 1);
  const Matrix<double> places = fitted.project(data.features, 1, 1);
  double mean[2] = {0.0, 0.0}, square[2] = {0.0, 0.0};
  for (std::size_t r = 0; r < 4000; ++r) {
    mean[data.labels[r]] += places(r, 0) / 2000;
    square[data.labels[r]] += places(r, 0) * places(r, 0) / 2000;
  }
  CHECK(std::abs(mean[1] - mean[0]) == Approx(2.0).margin(4 * std::sqrt(2.0 / 2000)));
  for (const int k : {0, 1}) CHECK(square[k] - mean[k] * mean[k] == Approx(1.0).margin(4 * std::sqrt(2.0 / 2000)));
}

TEST_CASE("the first coordinates of rows are those of each row", "[stats]") {
  Labelled data = two_normals(600, 5, 2.0, 0.0, 4);
  for (std::size_t r = 0; r < 600; r += 3) {
    data.labels[r] = 2;
    data.features(r, 4) += 5.0F;
  }
  const Discriminant fitted = Discriminant::fit(data.features, data.labels, 3);
  REQUIRE(fitted.n_directions() == 2);
  for (const std::size_t n : {std::size_t{1}, std::size_t{2}}) {
    const Matrix<double> places = fitted.project(data.features, n, 2);
    REQUIRE(places.columns() == n);
    for (std::size_t r = 0; r < 600; ++r) {
      const std::vector<double> whole = fitted.project(data.features.row(r));
      for (std::size_t i = 0; i < n; ++i) CHECK(places(r, i) == Approx(whole[i]).margin(1e-9));
    }
  }
  CHECK_THROWS_AS(fitted.project(data.features, 3), Error);
}

TEST_CASE("Ledoit and Wolf shrink independent columns almost wholly and many dependent rows hardly", "[stats]") {
  Stream stream({42, 0, 0, Purpose::test});
  Matrix<double> independent(60, 40), dependent(4000, 3);
  for (double& value : independent.values()) value = 3.0 * stream.normal();
  for (std::size_t r = 0; r < 4000; ++r) {
    const double common = stream.normal();
    for (double& value : dependent.row(r)) value = 5.0 + common + 0.5 * stream.normal();
  }
  const ShrunkCovariance first = ledoit_wolf(independent), second = ledoit_wolf(dependent);
  CHECK(first.shrinkage > 0.9);
  CHECK(first.covariance(4, 4) == Approx(9.0).epsilon(0.2));
  CHECK(std::abs(first.covariance(4, 5)) < 0.5);
  CHECK(second.shrinkage < 0.01);
  CHECK(second.covariance(0, 1) == Approx(1.0).epsilon(0.1));
  CHECK(second.covariance(2, 2) == Approx(1.25).epsilon(0.1));
  CHECK(second.mean[1] == Approx(5.0).margin(0.1));
}

TEST_CASE("more columns than rows and columns without spread don't stop a discriminant", "[stats]") {
  Labelled data = two_normals(40, 60, 6.0, 0.0, 3);
  for (std::size_t r = 0; r < 40; ++r) data.features(r, 59) = 7.0F;
  const Discriminant fitted = Discriminant::fit(data.features, data.labels, 2);
  int right = 0;
  for (std::size_t r = 0; r < 40; ++r) right += likelier(fitted, data.features.row(r)) == data.labels[r] ? 1 : 0;
  CHECK(right == 40);
  CHECK_THROWS_AS(fitted.project(std::vector<float>(3, 0.0F)), Error);
  CHECK_THROWS_AS(Discriminant::fit(data.features, data.labels, 3), Error);
}
