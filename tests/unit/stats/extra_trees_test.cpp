#include "stats/trees.hpp"

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

/// Two classes that only the sign of x0 x1 tells apart (no single column, no linear rule does), two columns of noise.
Labelled checkerboard(std::size_t rows, std::uint32_t study) {
  Stream stream({31, study, 0, Purpose::test});
  Labelled data{Matrix<float>(rows, 4), {}};
  for (std::size_t r = 0; r < rows; ++r) {
    for (float& value : data.features.row(r)) value = static_cast<float>(stream.normal());
    data.labels.push_back(data.features(r, 0) * data.features(r, 1) > 0.0F ? 1 : 0);
  }
  return data;
}

double accuracy(const ExtraTrees& forest, const Labelled& data) {
  int right = 0;
  for (std::size_t r = 0; r < data.labels.size(); ++r)
    right += (forest.probabilities(data.features.row(r))[1] > 0.5 ? 1 : 0) == data.labels[r] ? 1 : 0;
  return right / static_cast<double>(data.labels.size());
}

}  // namespace

TEST_CASE("randomised trees learn what no linear rule can and shuffled labels teach them nothing", "[stats]") {
  Labelled train = checkerboard(2000, 0);
  const Labelled test = checkerboard(2000, 1);
  const ExtraTreesSettings settings{.trees = 60, .threads = 1};
  const ExtraTrees forest = ExtraTrees::fit(train.features, train.labels, 2, settings);
  CHECK(accuracy(forest, test) > 0.93);
  CHECK(forest.importance()[0] + forest.importance()[1] > 0.7);
  CHECK(std::accumulate(forest.importance().begin(), forest.importance().end(), 0.0) == Approx(1.0));

  Stream stream({32, 0, 0, Purpose::test});
  for (int& label : train.labels) label = static_cast<int>(stream.index(2));
  const ExtraTrees fooled = ExtraTrees::fit(train.features, train.labels, 2, settings);
  CHECK(std::abs(accuracy(fooled, test) - 0.5) < 5 * std::sqrt(0.25 / 2000));  // five standard errors of a coin
}

TEST_CASE("leaf shares of one whole tree are the class shares whatever the class sizes", "[stats]") {
  // One constant column: no split is possible, every row has the shares of the root, each class weighing the same.
  Matrix<float> features(30, 1, 2.0F);
  std::vector<int> labels(30, 0);
  labels[3] = labels[4] = 1;
  labels[7] = 2;
  const ExtraTrees forest = ExtraTrees::fit(features, labels, 3, {.trees = 4});
  for (const double share : forest.probabilities(features.row(0))) CHECK(share == Approx(1.0 / 3));
  CHECK(forest.importance()[0] == 0.0);
}

TEST_CASE("with leaves of one row the forest reproduces its training rows", "[stats]") {
  const Labelled data = checkerboard(300, 2);
  CHECK(accuracy(ExtraTrees::fit(data.features, data.labels, 2, {.trees = 20, .min_leaf = 1}), data) == 1.0);
}

TEST_CASE("a forest is the same for any number of threads and another for another seed", "[stats]") {
  const Labelled data = checkerboard(400, 3);
  const auto fit = [&](std::uint64_t seed, unsigned threads) {
    return ExtraTrees::fit(data.features, data.labels, 2, {.trees = 20, .seed = seed, .threads = threads});
  };
  const ExtraTrees forest = fit(1, 1);
  CHECK(forest == fit(1, 3));
  CHECK_FALSE(forest == fit(2, 1));
}

TEST_CASE("randomised trees refuse data that they can't be grown from", "[stats]") {
  Labelled data = checkerboard(10, 4);
  CHECK_THROWS_AS(ExtraTrees::fit(data.features, std::vector<int>(9, 0), 2), Error);
  CHECK_THROWS_AS(ExtraTrees::fit(data.features, std::vector<int>(10, 0), 2), Error);
  CHECK_THROWS_AS(ExtraTrees::fit(data.features, std::vector<int>(10, 5), 2), Error);
  data.features(3, 3) = std::nanf("");
  CHECK_THROWS_AS(ExtraTrees::fit(data.features, data.labels, 2), Error);
}
