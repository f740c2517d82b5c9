// Features of statistics, and which cells differ by themselves.
#include "reconcile/inference/locate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/core/text.hpp"
#include "pirsim/random.hpp"
#include "reconcile/inference/feature_map.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

TEST_CASE("a cell in which no simulated dataset moves is beyond them by a second, and framed by more", "[reconcile]") {
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
  const auto silent = [&](float seconds) { return locate(frame, map, plain, drawn(seconds), 0.05, {}).cells.front(); };
  const LocatedCell hardly = silent(0.5F), much = silent(30.0F);
  for (const LocatedCell& cell : {hardly, much}) CHECK(cell.adjusted_p <= 1.0 / 1500.0);
  CHECK(silent(0.0F).adjusted_p > 0.05);
  CHECK(much.differs(0.05));
  CHECK_FALSE(hardly.differs(0.05));  // the others scatter by 1.4 s
}

TEST_CASE("the strongest deviation is told of the part of the trial and of those whose it is", "[reconcile]") {
  const StudyFrame frame{{"S1", "S2", "S3"}, {"A", "B", "C"}, {"working"}, 1.0};
  Stream stream({3, 0, 0, Purpose::test});
  const auto drawn = [&](std::size_t fewer_of, float lead_share) {
    std::vector<float> row(n_statistics(frame), 0.0F);
    const Statistics out(frame, std::span<float>(row));
    for (std::size_t t = 0; t < 3; ++t) {
      for (std::size_t s = 0; s < 3; ++s) {
        out.cell(t, s, CellStatistic::seconds) = static_cast<float>(20.0 + 5.0 * stream.uniform());
        out.cell(t, s, CellStatistic::lead_seconds) =
            static_cast<float>(10.0 + 2.0 * stream.uniform()) * (s == fewer_of || fewer_of == 3 ? lead_share : 1.0F);
      }
    }
    return row;
  };
  stats::Matrix<float> plain;
  for (int i = 0; i < 99; ++i) plain.append_row(std::span<const float>(drawn(3, 1.0F)));
  const FeatureMap map(frame, std::vector<CellKnowledge>(frame.n_cells()), plain, {0, 1, 2});
  const auto strongest = [&](std::size_t fewer_of, float lead_share) {
    return locate(frame, map, plain, drawn(fewer_of, lead_share), 0.05, {}).strongest;
  };
  const Deviation all = strongest(3, 0.2F), one = strongest(1, 0.2F);
  CHECK((all.who.empty() && all.part == Deviation::Part::before && all.scatters < -3.0));
  CHECK(all.measured_s < 0.3 * all.expected_s);
  CHECK((one.who == "B" && one.part == Deviation::Part::before));
  CHECK(std::abs(strongest(3, 1.0F).scatters) < 3.0);
}

TEST_CASE("a sensor of which one seat gains what another loses is told as a whole", "[reconcile]") {
  StudyFrame frame{{"S1", "S2", "S3", "S4", "S5", "S6", "S7", "S8"}, {"A", "B", "C"}, {}, 1.0};
  Stream stream({4, 0, 0, Purpose::test});
  const auto drawn = [&](double b_scatters) {
    std::vector<float> row(n_statistics(frame), 0.0F);
    const Statistics out(frame, std::span<float>(row));
    for (std::size_t t = 0; t < frame.trials.size(); ++t) {
      for (std::size_t s = 0; s < 3; ++s)
        out.cell(t, s, CellStatistic::seconds) =
            static_cast<float>(30.0 + 4.0 * stream.normal() * (s == 1 ? b_scatters : 1.0));
    }
    return row;
  };
  stats::Matrix<float> plain;
  for (int i = 0; i < 499; ++i) plain.append_row(std::span<const float>(drawn(1.0)));
  const FeatureMap map(frame, std::vector<CellKnowledge>(frame.n_cells()), plain, all_trials(frame));
  const auto told = [&](double b_scatters) {
    Outcome outcome;
    outcome.verdict = Verdict::none_in_catalogue;
    outcome.location = locate(frame, map, plain, drawn(b_scatters), 0.05, {});
    return joined(details(outcome), " ");
  };
  CHECK_THAT(told(3.5), contains("B differs as a whole") && !contains("A differs"));
  CHECK_THAT(told(1.0), !contains("as a whole"));
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
