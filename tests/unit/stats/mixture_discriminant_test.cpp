#include "stats/classes.hpp"

#include <algorithm>
#include <array>
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

constexpr std::size_t n_rows = 8000;
constexpr std::array<double, 3> places{0.0, 2.0, -1.5};  ///< of the subclasses along column 0
constexpr std::array<double, 3> shares{1.0, 0.7, 0.3};   ///< of their class: the first is a class of its own

struct Data : Labelled {
  std::vector<int> subclasses;
};

Data rows(std::uint32_t study) {
  Stream stream({43, study, 0, Purpose::test});
  Data data{{Matrix<float>(n_rows, 4), {}}, {}};
  for (std::size_t r = 0; r < n_rows; ++r) {
    const int label = static_cast<int>(r % 2);
    const std::size_t part = label == 0 ? 0 : stream.uniform() < shares[1] ? 1 : 2;
    for (float& value : data.features.row(r)) value = static_cast<float>(stream.normal());
    data.features(r, 0) += static_cast<float>(places[part]);
    data.labels.push_back(label);
    data.subclasses.push_back(static_cast<int>(part));
  }
  return data;
}

/// Of the best rule that knows the densities, by adding up the lesser one.
double least_error() {
  double error = 0.0;
  constexpr double step = 1e-3;
  for (double x = -10.0; x < 10.0; x += step) {
    std::array<double, 3> density{};
    for (std::size_t k = 0; k < 3; ++k)
      density[k] = shares[k] * std::exp(-0.5 * (x - places[k]) * (x - places[k])) / std::sqrt(2.0 * M_PI);
    error += 0.5 * std::min(density[0], density[1] + density[2]) * step;
  }
  return error;
}

double error_of(const MixtureDiscriminant& fitted, const Data& test) {
  double wrong = 0.0;
  for (std::size_t r = 0; r < n_rows; ++r)
    wrong += (fitted.probabilities_at(fitted.discriminant().project(test.features.row(r)))[1] > 0.5 ? 1 : 0) ==
                     test.labels[r]
                 ? 0.0
                 : 1.0;
  return wrong / n_rows;
}

}  // namespace

TEST_CASE("a class of two parts is told from one between them as well as the densities allow", "[stats]") {
  const Data train = rows(0), test = rows(1);
  const double expected = least_error();
  const double standard_error = std::sqrt(expected * (1.0 - expected) / n_rows);
  const auto by_parts = MixtureDiscriminant::fit(train.features, train.labels, 2, train.subclasses);
  CHECK(std::abs(error_of(by_parts, test) - expected) < 4 * standard_error);
  // The twin: one mean a class is another rule, and a worse one.
  const auto by_classes = MixtureDiscriminant::fit(train.features, train.labels, 2, train.labels);
  CHECK(error_of(by_classes, test) > expected + 8 * standard_error);
}

TEST_CASE("without parts a mixture discriminant is a discriminant", "[stats]") {
  const Data train = rows(2);
  const auto mixture = MixtureDiscriminant::fit(train.features, train.labels, 2, train.labels);
  const auto plain = Discriminant::fit(train.features, train.labels, 2);
  for (std::size_t r = 0; r < 20; ++r) {
    const std::vector<double> place = mixture.discriminant().project(train.features.row(r));
    CHECK(place == plain.project(train.features.row(r)));
    CHECK(mixture.probabilities_at(place) == stats::detail::softmax(plain.log_densities(train.features.row(r))));
  }
}

TEST_CASE("a subclass of two classes is refused", "[stats]") {
  Data train = rows(4);
  train.subclasses[0] = 1;  // row 0 is of class 0
  CHECK_THROWS_AS(MixtureDiscriminant::fit(train.features, train.labels, 2, train.subclasses), Error);
}
