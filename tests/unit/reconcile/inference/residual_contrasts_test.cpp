// Contrasts of a session made by hand: binomial gaps, of which a share changes.
#include "reconcile/inference/residuals.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

const StudyFrame frame{{"1", "2", "3", "4", "5", "6", "7", "8", "9", "10"}, {"A", "B"}, {}, 1.0};
constexpr std::size_t n_sensors = 2;

DataShape shape_with(int n_replicates) {
  DataShape shape;
  shape.n_replicates = n_replicates;
  for (std::size_t trial = 0; trial < frame.trials.size(); ++trial) {
    for (int replicate = 1; replicate <= n_replicates; ++replicate)
      shape.runs.push_back({trial, replicate, 100, {}, {}, {}});
  }
  return shape;
}

/// Chance that an awaited row is silent, by the run's place in the session and the sensor.
using Chance = std::function<double(std::size_t place, std::size_t sensor)>;
double usual(std::size_t, std::size_t) { return 0.3; }

ContrastData drawn(const DataShape& shape, std::uint32_t number, const Chance& chance) {
  Stream stream({1, number, 0, Purpose::test});
  ContrastData data;
  for (const DataShape::Run& run : shape.runs) {
    const std::size_t place = static_cast<std::size_t>(run.replicate - 1) * frame.trials.size() + run.trial;
    std::vector<Gaps>& gaps = data.gaps.emplace_back(1 + n_sensors);
    for (std::size_t s = 0; s < n_sensors; ++s) {
      Gaps& own = gaps[1 + s];
      own.awaited = 60.0;
      for (int row = 0; row < 60; ++row) own.silent += stream.uniform() < chance(place, s) ? 1.0 : 0.0;
      gaps[0].awaited += own.awaited;
      gaps[0].silent += own.silent;
    }
  }
  for (std::size_t run = 0; run < shape.runs.size(); ++run) data.shortest.push_back(1.0 + stream.index(3));
  return data;
}

std::vector<ResidualDriver> told(const DataShape& shape, const ContrastData& measured) {
  std::vector<ContrastData> simulated;
  for (std::uint32_t i = 0; i < 180; ++i) simulated.push_back(drawn(shape, 100 + i, usual));
  return telling_contrasts(frame, shape, measured, simulated, 0.05);
}

bool begins_at_any(const ResidualDriver& driver, const std::vector<std::string>& trials) {
  return std::ranges::any_of(
      trials, [&](const std::string& trial) { return driver.when == "from about trial " + trial + " on"; });
}

}  // namespace

TEST_CASE("a step of the session is told with its trial and its side", "[reconcile]") {
  const DataShape shape = shape_with(1);
  for (const double later : {0.5, 0.12}) {
    CAPTURE(later);
    const auto found = told(shape, drawn(shape, 1, [&](std::size_t place, auto) { return place < 6 ? 0.3 : later; }));
    REQUIRE_FALSE(found.empty());
    CHECK(found.front().who == "all sensors");
    CHECK(begins_at_any(found.front(), {"6", "7", "8"}));  // the true one or a neighbour
    CHECK_THAT(found.front().what, contains(later > 0.3 ? "more gaps" : "fewer gaps"));
  }
}

TEST_CASE("a step of one sensor is its own, and a trend is told", "[reconcile]") {
  const DataShape shape = shape_with(1);
  const auto of_one =
      told(shape, drawn(shape, 2, [](std::size_t place, std::size_t s) { return s == 1 && place >= 4 ? 0.6 : 0.3; }));
  const auto own = std::ranges::find(of_one, "B", &ResidualDriver::who);
  REQUIRE(own != of_one.end());
  CHECK(begins_at_any(*own, {"4", "5", "6"}));
  const auto trend =
      told(shape, drawn(shape, 3, [](std::size_t place, auto) { return 0.1 + 0.06 * static_cast<double>(place); }));
  REQUIRE_FALSE(trend.empty());
  CHECK_FALSE(trend.front().when.empty());
  CHECK_THAT(trend.front().what, contains("more"));
}

TEST_CASE("one repetition follows the other, and of three runs no session is told", "[reconcile]") {
  const DataShape shape = shape_with(2);
  const auto found = told(shape, drawn(shape, 4, [](std::size_t place, auto) { return place < 12 ? 0.3 : 0.5; }));
  REQUIRE_FALSE(found.empty());
  CHECK(begins_at_any(found.front(), {"2 of run 2", "3 of run 2", "4 of run 2"}));
  DataShape three = shape_with(1);
  three.runs.resize(3);
  CHECK(told(three, drawn(three, 5, [](std::size_t place, auto) { return place < 1 ? 0.1 : 0.9; })).empty());
}

TEST_CASE("a hold that grows from trial to trial is told, and holds in any order are not", "[reconcile]") {
  const DataShape shape = shape_with(1);
  ContrastData held = drawn(shape, 7, usual);
  held.shortest = {1, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  const auto found = told(shape, held);
  REQUIRE(found.size() == 1);
  CHECK(found.front().when == "from trial to trial");
  CHECK(found.front().what == "motion, once begun, lasts longer and longer");
  held.shortest = {3, 1, 4, 1, 2, 4, 1, 3, 4, 2};
  CHECK(told(shape, held).empty());
}

TEST_CASE("the shortest stretch is of those that no end of the main part cuts off", "[reconcile]") {
  DataShape shape = shape_with(1);
  shape.runs.resize(1);
  const auto shortest = [&](const std::vector<std::uint8_t>& of_a) {
    Series run{0, 1, 0, of_a.size(), {}};
    for (const std::uint8_t bit : of_a) run.bits.insert(run.bits.end(), {bit, 0});
    return contrast_data(frame, shape, std::span(&run, 1)).shortest.front();
  };
  CHECK(shortest({1, 0, 1, 1, 1, 0, 1, 1, 0, 0, 1}) == 2.0);
  CHECK(shortest({1, 0, 1, 1, unknown_bit, 0, 0, 1}) == 0.0);
}

TEST_CASE("contrasts are told of one session in twenty in which nothing changes", "[reconcile]") {
  const DataShape shape = shape_with(1);
  std::vector<ContrastData> simulated;
  for (std::uint32_t i = 0; i < 720; ++i) simulated.push_back(drawn(shape, 10000 + i, usual));
  int with_any = 0;
  constexpr int n =
      200;  // standard error of the share 0.0154, of what 720 datasets let pass 0.0082; both kinds may be told
  for (std::uint32_t i = 0; i < n; ++i)
    with_any += telling_contrasts(frame, shape, drawn(shape, 1000 + i, usual), simulated, 0.05).empty() ? 0 : 1;
  CHECK(with_any <= 0.05 * n + 3 * std::hypot(0.0154, 0.0082) * n);
  CHECK(with_any > 0);
}
