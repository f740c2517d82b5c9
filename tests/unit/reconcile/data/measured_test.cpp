#include "reconcile/data/measured.hpp"

#include <sstream>

#include "pirsim/csv.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

StudyFrame two_by_two() { return {{"S1", "S2"}, {"PIR1", "PIR2"}, {"working"}, 1.0}; }

/// Rows of one run: `n` working rows between one row of walking on each side.
std::string rows(const std::string& trial, int n, const std::string& bits = "0,1") {
  std::string text;
  for (int i = 1; i <= n + 2; ++i) {
    const bool working = i > 1 && i < n + 2;
    text += "1," + trial + "," + std::to_string(i) + (working ? ",working,1," : ",walking,1,") + bits + "\n";
  }
  return text;
}
const std::string header = "replicate,trial,time_s,phase,people,PIR1,PIR2\n";

std::string refusal(const std::string& text) {
  try {
    static_cast<void>(parse_measured(text, "m.csv", two_by_two()));
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::input);
    return error.what();
  }
  return "nothing";
}

}  // namespace

TEST_CASE("measured rows in pirsim's own format keep their bits and their main part", "[measured]") {
  const Measured measured = parse_measured(header + rows("S2", 40) + rows("S1", 40, "1,0"), "m.csv", two_by_two());
  REQUIRE(measured.runs.size() == 2);
  CHECK(measured.kind == Measured::Kind::series);
  CHECK(measured.runs[0].trial == 0);
  CHECK(measured.runs[0].main_begin == 1);
  CHECK(measured.runs[0].main_end == 41);
  CHECK(measured.runs[0].n_rows(2) == 42);
  CHECK(measured.runs[0].bits[0] == 1);
  CHECK(measured.runs[1].bits[0] == 0);
  REQUIRE(measured.notes.size() == 1);
  CHECK_THAT(measured.notes[0], contains("column 'people' is left out"));
  CHECK(measured.n_replicates() == 1);
}

TEST_CASE("every table of rows that pirsim writes is read, a dataset's days as runs", "[measured]") {
  const StudyFrame frame{{"S1"}, {"PIR1", "PIR2"}, {}, 1.0};
  const ColumnOwners owners{.sensors = frame.sensors, .areas = {"hall", "elsewhere"}};  // no sensors, though bits
  std::ostringstream study, dataset;
  io::CsvWriter rows(study, column_names<Sample>(owners));
  io::TableWriter<DayLine> days(dataset, column_names<DayLine>(owners));
  const std::vector<int> sensors{0, 1}, areas{0, 1};
  for (const int day : {4, 7}) {
    for (int i = 1; i <= 40; ++i) {
      const Sample row{day, "S1", double(i), "empty", 1, {1, 0}, "2026-03-02T07:00:00", {0, 1}};
      rows.write(row);
      days.write({1, day, row, 0, 0, sensors, areas});
    }
  }
  const Measured one = parse_measured(study.str(), "m.csv", frame),
                 other = parse_measured(dataset.str(), "m.csv", frame);
  for (const Measured* measured : {&one, &other}) {
    REQUIRE(measured->runs.size() == 2);
    CHECK(measured->runs[1].replicate == 2);
    CHECK(measured->runs[1].bits == one.runs[0].bits);
    CHECK(measured->runs[1].n_rows(2) == 40);
  }
}

TEST_CASE("gaps and empty readings become unknown and are told", "[measured]") {
  std::string text = header + rows("S1", 60);
  text.erase(text.find("1,S1,20,"), std::string("1,S1,20,working,1,0,1\n").size());
  text.replace(text.find("1,S1,30,working,1,0,1"), 21, "1,S1,30,working,1,,1");
  const Measured measured = parse_measured(text, "m.csv", two_by_two());
  REQUIRE(measured.runs.size() == 1);
  CHECK(measured.runs[0].n_rows(2) == 62);
  CHECK(measured.runs[0].bits[19 * 2] == unknown_bit);
  CHECK(measured.runs[0].bits[19 * 2 + 1] == unknown_bit);
  CHECK(measured.runs[0].bits[29 * 2] == unknown_bit);
  CHECK(measured.runs[0].bits[29 * 2 + 1] == 1);
  REQUIRE(measured.notes.size() == 4);
  CHECK_THAT(measured.notes[0], contains("column 'people' is left out"));
  CHECK_THAT(measured.notes[1], contains("1 row is missing"));
  CHECK_THAT(measured.notes[2], contains("1 reading is empty"));
  CHECK_THAT(measured.notes[3], contains("nothing of S2"));
}

TEST_CASE("rows without phases are taken for the counted phases", "[measured]") {
  std::string text = "trial,time_s,PIR1,PIR2\n";
  for (int i = 1; i <= 50; ++i) text += "S1," + std::to_string(i) + ",1,0\n";
  const Measured measured = parse_measured(text, "m.csv", two_by_two());
  CHECK(measured.runs.at(0).main_begin == 0);
  CHECK(measured.runs.at(0).main_end == 50);
  CHECK_THAT(measured.notes.at(0), contains("no column 'phase'"));
}

TEST_CASE("runs are numbered from 1 in every trial, whatever the file calls them", "[measured]") {
  std::string text = header;
  for (const auto& [trial, replicate] : {std::pair{"S1", 7}, {"S1", 3}, {"S2", 0}}) {
    std::string run = rows(trial, 40);
    for (std::size_t at = 0; at < run.size(); at = run.find('\n', at) + 1)
      run.replace(at, 1, std::to_string(replicate));
    text += run;
  }
  const Measured measured = parse_measured(text, "m.csv", two_by_two());
  REQUIRE(measured.runs.size() == 3);
  CHECK(measured.n_replicates() == 2);
  for (const auto& [i, trial, replicate] : {std::tuple{0U, 0U, 1}, {1U, 0U, 2}, {2U, 1U, 1}}) {
    CHECK(measured.runs[i].trial == trial);
    CHECK(measured.runs[i].replicate == replicate);
  }
}

TEST_CASE("a run that was recorded late keeps its place where no phase tells it", "[measured]") {
  const StudyFrame frame{{"S1"}, {"PIR1"}, {}, 1.0};
  std::string text = "time_s,PIR1\n";
  for (int i = 6; i <= 45; ++i) text += std::to_string(i) + ",1\n";
  const Measured late = parse_measured(text, "m.csv", frame);
  CHECK(late.runs.at(0).n_rows(1) == 45);
  CHECK(late.runs.at(0).bits[4] == unknown_bit);
  CHECK(late.runs.at(0).bits[5] == 1);
  CHECK_THAT(late.notes.at(0), contains("5 rows are missing"));
  const StudyFrame phased{{"S1"}, {"PIR1"}, {"working"}, 1.0};
  CHECK(parse_measured(text, "m.csv", phased).runs.at(0).n_rows(1) == 40);
  CHECK_THROWS_WITH(parse_measured("time_s,PIR1\n1700000000,1\n1700000001,1\n", "m.csv", frame),
                    contains("counts from the beginning of the trial"));
  CHECK_THROWS_WITH(parse_measured("time_s,PIR1\n-1e19,1\n", "m.csv", frame),
                    contains("m.csv:2:1: error: time_s counts from the beginning of the trial"));
}

TEST_CASE("bad measured rows are refused with a sentence and a place", "[measured]") {
  CHECK_THAT(refusal(header + rows("S1", 40) + rows("S11", 40)), contains("'S11' is not in the study (did you mean"));
  CHECK_THAT(refusal(header + rows("S1", 40, "0,2")), contains("m.csv:2:20: error: PIR2: expected 0 or 1, got '2'"));
  CHECK_THAT(refusal("replicate,trial,time_s,phase,people,PIR1,PRI2\n" + rows("S1", 40)),
             contains("unknown column 'PRI2' (did you mean"));
  CHECK_THAT(refusal("trial,time_s,A,B\nS1,1,0,0\n"), contains("is this the data of another scene?"));
  CHECK_THAT(refusal(header + rows("S1", 5)), contains("too little data: 5 rows"));
  std::string slow = "trial,time_s,PIR1,PIR2\n";
  for (int i = 1; i <= 50; ++i) slow += "S1," + std::to_string(2 * i) + ",1,0\n";
  CHECK_THAT(refusal(slow), contains("rows are 2 s apart, the script's window is 1 s"));
  CHECK_THAT(refusal(header + rows("S1", 40) + rows("S1", 40)), contains("time_s doesn't grow: 1 after 42"));
  CHECK_THAT(refusal("trial,time_s,PIR1,PIR2\nS1,1,0,0\nS1,2,0,0\nS1,1e9,0,0\n"), contains("too long a gap"));
  CHECK_THAT(refusal("time_s,PIR1,PIR2\n1,0,0\n"), contains("column 'trial' is missing"));
}

TEST_CASE("sums are read with seats as trials and empty ones are left out", "[measured]") {
  const StudyFrame frame{{"S1", "S2", "S3"}, {"PIR1", "PIR2"}, {}, 1.0};
  const Measured measured = parse_measured(
      "seat,sensor,real,min_sim\nS1,PIR1,39,1\nS1,PIR2,24,2\nS2,PIR1,,2\nS2,PIR2,0,0\nS3,PIR1,5,0\nS3,PIR2,1.5,0\n",
      "m.csv", frame);
  CHECK(measured.kind == Measured::Kind::sums);
  REQUIRE(measured.sums.size() == 5);
  CHECK(measured.sums[0].seconds == 39.0);
  CHECK(measured.sums[4].seconds == 1.5);
  CHECK_THAT(measured.notes.at(0), contains("1 sum is empty"));
  CHECK_THROWS_WITH(parse_measured("trial,sensor,seconds\nS1,PIR1,3\nS1,PIR1,4\n", "m.csv", frame),
                    contains("appear twice"));
  CHECK_THROWS_WITH(parse_measured("trial,sensor,seconds\nS1,PIR1,-3\n", "m.csv", frame), contains("negative"));
  CHECK_THROWS_WITH(parse_measured("trial,sensor,seconds\nS1,PIR1,3\n", "m.csv", frame), contains("too little data"));
  CHECK_THROWS_WITH(parse_measured("trial,sensor,seconds\nS1,PIR4,3\n", "m.csv", frame), contains("did you mean"));
  CHECK_THROWS_WITH(parse_measured("trial,sensor,seconds,PIR9\nS1,PIR1,3,1\n", "m.csv", frame),
                    contains("m.csv:1:1: error: unknown column 'PIR9'"));
  CHECK_THROWS_WITH(parse_measured("trial,sensor,seconds,real\nS1,PIR1,5,50\n", "m.csv", frame),
                    contains("'seconds' and 'real' mean the same"));
  CHECK_THROWS_WITH(parse_measured("trial,seat,sensor,seconds\nS1,S2,PIR1,5\n", "m.csv", frame),
                    contains("'trial' and 'seat' mean the same"));
}
