// Features of statistics, and which cells differ by themselves.
#include "reconcile/inference/locate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pirsim/random.hpp"
#include "reconcile/inference/feature_map.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

TEST_CASE("a cell is framed in which the data move and no simulated dataset does", "[reconcile]") {
  // One trial; a sensor that never moves in 1,499 datasets beside 40 that move by chance.
  constexpr std::size_t n_busy = 40;
  StudyFrame frame{{"A"}, {"silent"}, {}, 1.0};
  for (std::size_t i = 0; i < n_busy; ++i) frame.sensors.push_back("busy " + std::to_string(i));
  Stream stream({1, 0, 0, Purpose::analysis});
  const auto drawn = [&](float of_silent) {
    std::vector<float> row(n_statistics(frame), 0.0F);
    const Statistics out(frame, std::span<float>(row));
    out.cell(0, 0, CellStatistic::seconds) = of_silent;
    for (std::size_t i = 1; i <= n_busy; ++i)
      out.cell(0, i, CellStatistic::seconds) = static_cast<float>(20.0 + 5.0 * stream.uniform());
    return row;
  };
  stats::Matrix<float> plain;
  for (int i = 0; i < 1499; ++i) plain.append_row(std::span<const float>(drawn(0.0F)));
  const FeatureMap map(frame, std::vector<CellKnowledge>(frame.n_cells()), plain, {0});
  const auto p_of_silent = [&](float seconds) {
    return locate(frame, map, plain, drawn(seconds), 0.05, {}).cells.front().adjusted_p;
  };
  for (const float seconds : {1.0F, 3.0F, 30.0F}) CHECK(p_of_silent(seconds) <= 1.0 / 1500.0);
  CHECK(p_of_silent(0.0F) > 0.05);
}

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
