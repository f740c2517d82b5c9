#include "reconcile/inference/feature_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

TEST_CASE("features are finite and keep their places where some simulated datasets lack a trial", "[reconcile]") {
  const StudyFrame frame{{"S1", "S2"}, {"A", "B"}, {"standing"}, 1.0};
  stats::Matrix<float> plain(20, n_statistics(frame));
  Stream stream({2, 0, 0, Purpose::test});
  for (std::size_t row = 0; row < plain.rows(); ++row) {
    for (float& value : plain.row(row)) value = static_cast<float>(stream.uniform());
  }
  const FeatureMap all(frame, std::vector<CellKnowledge>(frame.n_cells()), plain, {0, 1});
  const auto lose_second_trial = [&](std::size_t row) {  // nobody stood in it
    std::ranges::fill(Statistics(frame, plain.row(row)).cells(1), std::nanf(""));
  };
  for (const std::size_t row : {0, 7, 8}) lose_second_trial(row);
  const FeatureMap some(frame, std::vector<CellKnowledge>(frame.n_cells()), plain, {0, 1});
  CHECK(some.names() == all.names());
  for (std::size_t row = 0; row < plain.rows(); ++row) {
    CAPTURE(row);
    CHECK(std::ranges::all_of(some.features(plain.row(row)), [](float value) { return std::isfinite(value); }));
  }
}
