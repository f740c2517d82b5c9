// A look at the file before any statistics: what is told of rows that sensors can't have said, and what isn't told of
// rows that are merely strange. The rows are made here, by no simulation.
#include "reconcile/data/data_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

constexpr std::size_t n_sensors = 3, n_trials = 4, n_rows = 120;
using What = DataFinding::What;
/// Bit of a row and sensor, from what the sensor said before and a uniform number.
using Bit = std::function<std::uint8_t(std::size_t row, std::size_t sensor, std::uint8_t before, double uniform)>;

StudyFrame frame_of_four() { return {{"A", "B", "C", "D"}, {"left", "middle", "right"}, {}, 1.0}; }

/// On and off for some seconds each.
std::uint8_t at_work(std::size_t, std::size_t, std::uint8_t before, double uniform) {
  return before == 1 ? (uniform < 0.6 ? 1 : 0) : (uniform < 0.3 ? 1 : 0);
}

std::vector<Series> dataset(std::uint32_t number, const Bit& bit = at_work, int n_replicates = 1) {
  std::vector<Series> runs;
  for (std::uint32_t trial = 0; trial < n_trials; ++trial) {
    for (int replicate = 1; replicate <= n_replicates; ++replicate) {
      Stream stream({5, number, trial * 100 + static_cast<std::uint32_t>(replicate), Purpose::false_trigger});
      Series run{trial, replicate, 0, n_rows, {}};
      for (std::size_t i = 0; i < n_rows * n_sensors; ++i)
        run.bits.push_back(bit(i / n_sensors, i % n_sensors, i < n_sensors ? std::uint8_t{0} : run.bits[i - n_sensors],
                               stream.uniform()));
      runs.push_back(std::move(run));
    }
  }
  return runs;
}

using Change = std::function<void(std::vector<Series>&)>;
void none(std::vector<Series>&) {}

std::vector<Series> pilot(const Bit& bit = at_work, const Change& change = none) {
  std::vector<Series> all;
  for (std::uint32_t number = 1000; number < 1040; ++number) {
    std::vector<Series> runs = dataset(number, bit);
    change(runs);
    std::ranges::move(runs, std::back_inserter(all));
  }
  return all;
}

std::vector<DataFinding> check(std::vector<Series> runs, std::span<const Series> simulated,
                               const WholeDatasets& periodic = {}) {
  Measured measured;
  measured.runs = std::move(runs);
  return check_data(frame_of_four(), measured, simulated, periodic);
}
std::vector<DataFinding> check(const Change& change, const Change& in_model = none) {
  std::vector<Series> runs = dataset(1);
  change(runs);
  return check(std::move(runs), pilot(at_work, in_model));
}

std::uint8_t& bit(Series& run, std::size_t row, std::size_t sensor) { return run.bits[row * n_sensors + sensor]; }

Change each_row(const std::function<void(Series&, std::size_t row)>& change) {
  return [change](std::vector<Series>& runs) {
    for (Series& run : runs) {
      for (std::size_t row = 0; row < n_rows; ++row) change(run, row);
    }
  };
}

void check_one(const std::vector<DataFinding>& findings, What what, const std::vector<std::string>& sensors) {
  REQUIRE(findings.size() == 1);
  CHECK(findings.front().what == what);
  CHECK(findings.front().sensors == sensors);
  CHECK(any_impossible(findings));
  CHECK(findings.front().chance < 1e-9);
}

}  // namespace

TEST_CASE("rows in which nothing is wrong have no finding", "[data_check]") {
  const std::vector<Series> simulated = pilot();
  for (std::uint32_t number = 0; number < 50; ++number) CHECK(check(dataset(number), simulated).empty());
  CHECK(check(dataset(1), {}).empty());  // without a model, only what chance can't do
  CHECK(check(dataset(1, at_work, 3), simulated).empty());
}

TEST_CASE("a column that repeats another is told, and one that says its opposite", "[data_check]") {
  const Change equal = each_row([](Series& run, std::size_t row) { bit(run, row, 2) = bit(run, row, 0); });
  check_one(check(equal), What::equal_columns, {"left", "right"});
  CHECK(check(equal).front().n_rows == n_trials * n_rows);
  check_one(check(each_row([](Series& run, std::size_t row) { bit(run, row, 1) = bit(run, row, 0) == 0 ? 1 : 0; })),
            What::opposite_columns, {"left", "middle"});
  SECTION("but for few changes") {
    const auto findings = check([&](std::vector<Series>& runs) {
      equal(runs);
      bit(runs[1], 60, 2) ^= 1;
    });
    check_one(findings, What::equal_columns, {"left", "right"});
    CHECK(findings.front().n_exceptions > 0);
  }
  SECTION("not if they are as equal in the model") { CHECK(check(equal, equal).empty()); }
  SECTION("not of columns that say nothing, or whose rows are hardly known") {
    const auto silent = check(each_row([](Series& run, std::size_t row) { bit(run, row, 0) = bit(run, row, 2) = 0; }));
    CHECK(std::ranges::all_of(silent, [](const auto& f) { return f.what == What::silent_column; }));
    CHECK(check(each_row([&](Series& run, std::size_t row) {
            bit(run, row, 2) = row % 40 == 0 ? bit(run, row, 0) : unknown_bit;
          })).empty());
  }
}

TEST_CASE("a sensor that says 1 on a grid is told with its period", "[data_check]") {
  const Change beats = each_row([](Series& run, std::size_t row) {
    if ((row + 3 * run.trial) % 5 == 0) bit(run, row, 1) = 1;
  });
  const auto findings = check(beats);
  check_one(findings, What::beats, {"middle"});
  CHECK(findings.front().every_s == 5.0);
  CHECK(check(beats, beats).empty());  // somebody works by the metronome
}

TEST_CASE("a column of ones is told unless the model begins so", "[data_check]") {
  const Change ones = each_row([](Series& run, std::size_t row) { bit(run, row, 1) = 1; });
  // Of four runs it might be chance: the first rows are motion in three of ten.
  CHECK(std::ranges::none_of(check(ones), [](const auto& f) { return f.what == What::beats; }));
  std::vector<Series> many = dataset(1, at_work, 10);
  ones(many);
  const Change begins_silent = each_row([](Series& run, std::size_t row) {
    if (row == 0) bit(run, row, 1) = 0;
  });
  check_one(check(many, pilot(at_work, begins_silent)), What::constant_column, {"middle"});
  CHECK(check(many, pilot(at_work, ones)).empty());
}

TEST_CASE("a logger that asks only now and then is told with how often", "[data_check]") {
  const auto findings = check([](std::vector<Series>& runs) {
    for (Series& run : runs) {
      for (std::size_t i = 0; i < run.bits.size(); ++i)
        run.bits[i] = run.bits[i / n_sensors / 4 * 4 * n_sensors + i % n_sensors];
    }
  });
  REQUIRE_FALSE(findings.empty());
  const auto polled = std::ranges::find(findings, What::polled, &DataFinding::what);
  REQUIRE(polled != findings.end());
  CHECK(polled->every_s == 4.0);
}

TEST_CASE("a logger that asks every 2.3 s is told, and sensors that hold for three are not", "[data_check]") {
  std::vector<Series> asked = dataset(1), held = dataset(1);
  for (Series& run : asked) {
    const std::vector<std::uint8_t> now = run.bits;
    for (std::size_t row = 0; row < n_rows; ++row) {
      const auto poll = static_cast<std::size_t>(std::ceil(2.3 * std::floor(static_cast<double>(row) / 2.3)));
      for (std::size_t s = 0; s < n_sensors; ++s) bit(run, row, s) = now[poll * n_sensors + s];
    }
  }
  for (Series& run : held) {
    for (std::size_t s = 0; s < n_sensors; ++s) {
      for (std::size_t row = 1, since = 3; row < n_rows; ++row) {
        if (++since < 3) bit(run, row, s) = bit(run, row - 1, s);
        if (bit(run, row, s) != bit(run, row - 1, s)) since = 0;
      }
    }
  }
  const auto told = [](const std::vector<DataFinding>& findings) {
    const auto polled = std::ranges::find(findings, What::polled, &DataFinding::what);
    return polled == findings.end() ? 0.0 : polled->every_s;
  };
  CHECK(told(check(std::move(asked), pilot())) == Approx(2.3).margin(0.02));
  CHECK(told(check(std::move(held), pilot())) == 0.0);
}

TEST_CASE("rows that stand twice are told with both places", "[data_check]") {
  const Change pasted = [](std::vector<Series>& runs) {
    for (std::size_t row = 0; row < 50; ++row) {
      for (std::size_t s = 0; s < n_sensors; ++s) bit(runs[2], 60 + row, s) = bit(runs[0], 20 + row, s);
    }
  };
  const auto findings = check(pasted);
  check_one(findings, What::repeated_rows, {});
  const auto& places = findings.front().places;
  REQUIRE(places.size() == 2);
  CHECK((places[0].trial == "A" && places[1].trial == "C"));
  // Neighbours may be alike by chance.
  CHECK((places[0].from_row <= 21 && places[0].from_row > 15 && places[0].to_row >= 70 && places[0].to_row < 76));
  CHECK(places[1].from_row - places[0].from_row == 40);
  CHECK(check(pasted, pasted).empty());
  // A periodic cause repeats them too.
  std::vector<Series> measured = dataset(1), fan = dataset(2);
  pasted(measured);
  const auto told_beside = [&](const std::vector<Series>& periodic) {
    return !check(measured, pilot(), [&] { return std::vector<std::vector<Series>>{periodic}; }).empty();
  };
  CHECK(told_beside(fan));
  pasted(fan);
  CHECK_FALSE(told_beside(fan));
}

TEST_CASE("work by the metronome and runs that are repeated repeat rows, and nothing is told", "[data_check]") {
  const Bit by_metronome = [](std::size_t row, std::size_t sensor, std::uint8_t, double uniform) {
    const bool begun = row > 6 + sensor || uniform < 0.5;
    return static_cast<std::uint8_t>(begun && (row / 3 + sensor) % 3 == 0 ? 1 : 0);
  };
  // The model's people have another beat.
  const auto told = check(dataset(1, by_metronome, 3), pilot());
  CHECK(std::ranges::none_of(told, [](const auto& f) { return f.what == What::repeated_rows; }));
  std::vector<Series> runs = dataset(1);
  const std::vector<Series> again = dataset(1);
  for (Series run : again) {
    run.replicate = 2;
    runs.push_back(std::move(run));
  }
  std::ranges::stable_sort(runs, {}, &Series::trial);
  // Nor if one begins a minute later.
  for (std::size_t i = 1; i < runs.size(); i += 2)
    std::rotate(runs[i].bits.begin(), runs[i].bits.begin() + 60 * n_sensors, runs[i].bits.end());
  CHECK(check(std::move(runs), pilot()).empty());
}

TEST_CASE("a minute without any motion among dense motion is told with its place", "[data_check]") {
  const Change gap = [](std::vector<Series>& runs) {
    for (std::size_t row = 30; row < 85; ++row) std::ranges::fill_n(&bit(runs[1], row, 0), n_sensors, std::uint8_t{0});
  };
  const auto findings = check(gap);
  check_one(findings, What::all_silent, {});
  const DataFinding::Rows& place = findings.front().places.front();
  CHECK((place.trial == "B" && place.from_row <= 31 && place.from_row > 25 && place.to_row >= 85));
  CHECK(check(gap, gap).empty());
}

TEST_CASE("a dead sensor is odd, but sensors do that", "[data_check]") {
  const Change dead = each_row([](Series& run, std::size_t row) { bit(run, row, 1) = 0; });
  const auto findings = check(dead);
  REQUIRE(findings.size() == 1);
  CHECK(findings.front().what == What::silent_column);
  CHECK_FALSE(any_impossible(findings));
  CHECK(check(dead, dead).empty());
}

TEST_CASE("sums have no rows to look at", "[data_check]") {
  Measured measured;
  measured.kind = Measured::Kind::sums;
  measured.sums = {{0, 0, 1, 3.0}, {1, 0, 1, 3.0}};
  CHECK(check_data(frame_of_four(), measured, pilot()).empty());
}
