#include "files/write/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "files/read/csv_reader.hpp"
#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

std::vector<MeasuredCell> paper() {
  return io::read_measured_cells(pirsim::test::data_dir() / "measured/stefansson2021_table1.csv");
}

}  // namespace

TEST_CASE("the shuffled count inside agrees with all permutations", "[summary]") {
  const std::vector<RangedValue> cells{{3, 0, 5}, {9, 2, 9}, {4, 4, 4}, {0, 1, 3}, {7, 6, 20}, {2, 0, 1}};
  std::array<std::size_t, 6> deal{0, 1, 2, 3, 4, 5};
  double sum = 0.0;
  double squares = 0.0;
  double ways = 0.0;
  do {
    int inside = 0;
    for (std::size_t i = 0; i < deal.size(); ++i) {
      inside += cells[i].min <= cells[deal[i]].value && cells[deal[i]].value <= cells[i].max ? 1 : 0;
    }
    sum += inside;
    squares += inside * inside;
    ways += 1.0;
  } while (std::next_permutation(deal.begin(), deal.end()));
  const InsideCount count = count_inside(cells);
  CHECK(ways == 720.0);
  CHECK(count.inside == 4);
  CHECK(count.shuffled_mean == Approx(sum / ways));
  CHECK(count.shuffled_sd == Approx(std::sqrt(squares / ways - sum * sum / ways / ways)));
}

TEST_CASE("the paper's own ranges hold 34 of its real values, and 24.7 of them shuffled", "[summary]") {
  std::vector<std::string> seats;
  for (int i = 1; i <= 10; ++i) seats.push_back("S" + std::to_string(i));
  const Summary summary(seats, {"PIR1", "PIR2", "PIR3", "PIR4", "PIR5"}, paper());
  CHECK(summary.overall().cells == 0);  // nothing simulated yet
  const std::optional<OverallSummary> published = summary.published();
  REQUIRE(published);
  CHECK(published->cells == 50);
  CHECK(published->inside == 34);
  CHECK(published->shuffled_inside == Approx(24.7).margin(0.05));
  CHECK(published->real_total == 1554.0);
  CHECK(published->simulated_total == 981.0);
  CHECK(published->bias == Approx((981.0 - 1554.0) / 50.0));
  CHECK_FALSE(published->mean_crps);
}

TEST_CASE("runs add up per trial and sensor", "[summary]") {
  Summary summary({"S1", "S2"}, {"A", "B"},
                  {{"S1", "B", 4, 1, 9, 3.5}, {"S2", "A", 8, {}, {}, {}}, {"S9", "A", 1, {}, {}, {}}});
  summary.add_run("S1", std::array{1, 2});
  summary.add_run("S1", std::array{3, 6});
  summary.add_run("S2", std::array{5, 0});
  summary.add_run("S2", std::array{5, 0});
  const std::vector<CellSummary> cells = summary.cells();
  REQUIRE(cells.size() == 4);
  CHECK(cells[0].counts == Tally{{1, 1}, {3, 1}});
  CHECK((cells[0].runs == 2 && cells[0].min == 1 && cells[0].max == 3 && cells[0].mean == 2.0));
  CHECK_FALSE(cells[0].inside);
  CHECK(cells[1].inside == true);
  CHECK(cells[1].crps == Approx(1.0));  // mean |2-4|,|6-4| = 2, half the mean spread = 1
  CHECK((cells[2].runs == 2 && cells[2].counts == Tally{{5, 2}} && cells[2].mean == 5.0));
  CHECK(cells[2].inside == false);
  const OverallSummary overall = summary.overall();
  CHECK(overall.cells == 2);
  CHECK(overall.inside == 1);
  CHECK(overall.bias == Approx(((4.0 - 4.0) + (5.0 - 8.0)) / 2.0));
  CHECK(overall.mean_absolute_error == Approx(1.5));
  CHECK(*overall.mean_crps == Approx((1.0 + 3.0) / 2.0));
  CHECK(overall.shuffled_inside == Approx((1.0 + 0.0 + 0.0 + 0.0) / 2.0));
  CHECK_THROWS_AS(summary.add_run("S3", std::array{1, 2}), Error);
  CHECK_THROWS_AS(summary.add_run("S1", std::array{1}), Error);
}

TEST_CASE("a run's counts take the rows of the named phases", "[summary]") {
  RunCounts counts(2, {{"work"}, "", {}});
  const auto row = [](const char* phase, std::uint8_t a, std::uint8_t b) {
    return Sample{1, "S1", 1.0, phase, 1, {a, b}};
  };
  counts.add(row("enter", 1, 1));
  counts.add(row("work", 1, 0));
  counts.add(row("work", 1, 1));
  CHECK(std::vector<int>(counts.counts().begin(), counts.counts().end()) == std::vector<int>{2, 1});
  counts.reset();
  CHECK(std::vector<int>(counts.counts().begin(), counts.counts().end()) == std::vector<int>{0, 0});
  RunCounts all(2, {});
  all.add(row("enter", 1, 1));
  CHECK(all.counts()[0] == 1);
}

TEST_CASE("a summary reads the same as CSV, text and Markdown", "[summary]") {
  Summary summary({"S1", "S,2"}, {"A", "B"}, {{"S1", "B", 4, 1, 9, 3.5}});
  summary.add_run("S1", std::array{1, 2});
  summary.add_run("S1", std::array{3, 6});
  CHECK(to_csv(summary) ==
        "trial,sensor,runs,min,max,mean,real,inside,crps,published_min,published_max,published_mean\n"
        "S1,A,2,1,3,2.000,,,,,,\n"
        "S1,B,2,2,6,4.000,4,1,1.000,1,9,3.500\n"
        "\"S,2\",A,0,,,,,,,,,\n"
        "\"S,2\",B,0,,,,,,,,,\n");
  const std::string text = to_text(summary);
  CHECK('\n' + text == R"(
trial                      A    B
S1     real                     4
       min                 1    2
       max                 3    6
       mean              2.0  4.0
       real in min..max        in
       CRPS                   1.0
       published min            1
       published max            9
       published mean         3.5
S,2    real
       min
       max
       mean
       real in min..max
       CRPS
       published min
       published max
       published mean

over all cells            this study   published
cells compared                     1           1
real in min..max                   1           1
the same, cells shuffled  1.0 +- 0.0  1.0 +- 0.0
total real                         4           4
total simulated mean               4           4
bias (simulated - real)          0.0        -0.5
mean absolute error              0.0         0.5
mean CRPS                        1.0           -
)");
  const std::string markdown = to_markdown(summary);
  CHECK(markdown.find("| trial |  | A | B |\n|---|---|---:|---:|\n| S1 | real |  | 4 |\n") == 0);
  const Summary bare({"S1"}, {"A"});
  CHECK(to_text(bare) == "trial        A\nS1     min\n       max\n       mean\n");
}
