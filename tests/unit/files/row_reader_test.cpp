#include "files/read/row_reader.hpp"

#include <algorithm>

#include "pirsim/sample.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::io;

namespace {

std::vector<Sample> all_of(const std::string& text) {
  RowReader reader(text, "f");
  std::vector<Sample> rows;
  Sample row;
  while (reader.next_of_all(row)) rows.push_back(row);
  return rows;
}
std::string refusal_of_rows(const std::string& text) {
  try {
    all_of(text);
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::input);
    return error.what();
  }
  return "accepted";
}

const std::string wide_header = "replicate,trial,time_s,people,people_hall,door_front,A,B\n";

}  // namespace

TEST_CASE("rows are read by the names of their columns, and an empty field is unknown", "[rows]") {
  const std::vector<Sample> rows = all_of(
      "# a comment\nB,time_s,people,trial,replicate,people_hall,door_front,A,time\n"
      "1,1,2,x,3,1,0,0,2026-03-01T23:59:58\n"
      ",2,,x,3,,,1.0,2026-03-01 23:59:59.5\n"
      "\n0.0,3,1.0,\"x\",3,0,1,1,2026-03-01T24:00\n"
      "1,1,0,#y,4,0,1,1,2026-03-02T08:00\n");
  REQUIRE(rows.size() == 4);
  CHECK(rows[0] == Sample{3, "x", 1.0, {}, 2, {1, 0}, "2026-03-01T23:59:58", {1}, {0}});
  CHECK(rows[1] ==
        Sample{
            3, "x", 2.0, {}, unknown_people, {unknown_bit, 1}, "2026-03-01T23:59:59", {unknown_people}, {unknown_bit}});
  CHECK(rows[2] == Sample{3, "x", 3.0, {}, 1, {0, 1}, "2026-03-02T00:00:00", {0}, {1}});
  CHECK(rows[3].trial == "#y");
  CHECK(rows[3].clock == "2026-03-02T08:00:00");
}

TEST_CASE("what pirsim log writes are rows of one run", "[rows]") {
  const std::vector<Sample> rows =
      all_of("time_s,time,people,A\n30,2026-03-02T08:00:30,,1\n60,2026-03-02T08:01:00,0,\n");
  REQUIRE(rows.size() == 2);
  CHECK(rows[1] == Sample{1, "", 60.0, {}, 0, {unknown_bit}, "2026-03-02T08:01:00"});
  CHECK(rows[0].people == unknown_people);
}

TEST_CASE("missing rows are unknown, and runs stay runs", "[rows]") {
  const std::string text = wide_header +
                           "1,a,30,1,1,0,1,0\n1,a,60,1,1,0,1,0\n1,a,150,1,1,0,1,0\n1,a,180,1,1,0,1,0\n"
                           "2,a,300,1,1,0,1,0\n2,a,330,1,1,0,1,0\n2,b,30,1,1,0,1,0\n";
  const std::vector<Sample> rows = all_of(text);
  std::vector<double> times;
  for (const Sample& row : rows) times.push_back(row.time_s);
  CHECK(times == std::vector<double>{30, 60, 90, 120, 150, 180, 300, 330, 30});
  for (const std::size_t missing : {2U, 3U}) {
    CHECK(rows[missing].bits == std::vector<std::uint8_t>{unknown_bit, unknown_bit});
    CHECK(rows[missing].doors == std::vector<std::uint8_t>{unknown_bit});
    CHECK(rows[missing].people == unknown_people);
    CHECK(rows[missing].people_of_areas == std::vector<int>{unknown_people});
  }
  RowReader reader(text, "f");
  CHECK(reader.step_s() == 30.0);
  std::int64_t n_missing = 0;
  for (Sample row; reader.next(row);) n_missing += reader.n_missing();
  CHECK(n_missing == 2);
  // The clock goes on, over midnight too.
  const auto clocks =
      all_of("time_s,time,A\n1,2026-03-02T23:59:58,1\n2,2026-03-02T23:59:59,1\n5,2026-03-03T00:00:02,1\n");
  REQUIRE(clocks.size() == 5);
  CHECK(clocks[2].clock == "2026-03-03T00:00:00");
  CHECK(clocks[3].clock == "2026-03-03T00:00:01");
  const auto days =
      all_of("time_s,time,A\n1,2026-03-02T23:00:01,1\n2,2026-03-02T23:00:02,1\n108003,2026-03-04T05:00:03,1\n");
  REQUIRE(days.size() == 108'003);
  CHECK(days[2].clock == "2026-03-02T23:00:03");
  CHECK(days[90'000].clock == "2026-03-04T00:00:01");
}

TEST_CASE("two rows tell how long they are by the first one's end, too", "[rows]") {
  CHECK(all_of("time_s,A\n1,1\n1800,1\n").size() == 1800);
  CHECK(all_of("time_s,A\n30,1\n60,1\n").size() == 2);
  CHECK(all_of("time_s,A\n3600,1\n3630,1\n").size() == 2);
}

TEST_CASE("a row's clock goes on as its seconds do, but for summer time", "[rows]") {
  const auto of = [](const std::string& third) {
    return "time_s,time,A\n1800,2026-03-29T01:30:00,1\n3600,2026-03-29T02:00:00,1\n5400," + third + ",1\n";
  };
  CHECK(all_of(of("2026-03-29T02:30:00")).size() == 3);
  CHECK(all_of(of("2026-03-29T03:30:00")).size() == 3);
  CHECK(all_of(of("2026-03-29T01:30:00")).size() == 3);
  for (const std::string moment : {"2026-03-30T02:30:00", "2026-03-29T02:31:00", "2026-03-28T02:30:00"})
    CHECK_THAT(refusal_of_rows(of(moment)), contains("f:4:6: error: time is"));
  CHECK_THAT(refusal_of_rows("time_s,time,A\n1,2026-02-30T08:00:01,1\n"), contains("f:2:3: error: time: expected"));
}

TEST_CASE("a sensor that a room of a dataset hasn't got isn't one without motion", "[rows]") {
  const std::vector<Sample> rows = all_of(
      "room,day,time_s,time,people,people_hall,A,B\n"
      "1,1,30,2026-03-02T08:00:30,1,,1,\n1,1,60,2026-03-02T08:01:00,1,,,\n1,1,120,2026-03-02T08:02:00,1,,1,\n"
      "2,1,30,2026-03-02T08:00:30,1,1,0,1\n");
  REQUIRE(rows.size() == 5);
  CHECK(rows[0].replicate == 1);
  CHECK(rows[0].trial == "1");
  CHECK(rows[0].bits == std::vector<std::uint8_t>{1, absent_bit});
  CHECK(rows[1].bits == std::vector<std::uint8_t>{unknown_bit, absent_bit});
  CHECK(rows[2].bits == std::vector<std::uint8_t>{unknown_bit, absent_bit});  // missing
  for (const std::size_t i : {0U, 1U, 2U, 3U}) CHECK(rows[i].people_of_areas == std::vector<int>{absent_people});
  CHECK(rows[4].bits == std::vector<std::uint8_t>{0, 1});
  CHECK_THAT(refusal_of_rows("room,day,time_s,people,A,B\n1,1,1,0,0,\n1,1,2,0,0,1\n"),
             contains("f:3:11: error: B: its field"));
}

TEST_CASE("what is no row is refused with line and column, each kind once", "[rows]") {
  const auto with = [](const std::string& line) {
    return refusal_of_rows(wide_header + "1,a,1,0,0,0,0,0\n1,a,2,0,0,0,0,0\n" + line);
  };
  for (const std::string bit : {"2", "-1", "0.5", "x", "1 ", "true", "nan"})
    CHECK(with("1,a,3,0,0,0,0," + bit + "\n") == "f:4:15: error: B: expected 0 or 1, got '" + bit + "'");
  CHECK(with("1,a,3,0,0,3,0,0\n") == "f:4:11: error: door_front: expected 0 or 1, got '3'");
  for (const std::string people : {"-1", "1.5", "two", "1e3"})
    CHECK(with("1,a,3," + people + ",0,0,0,0\n") ==
          "f:4:7: error: people: expected a number of people, got '" + people + "'");
  CHECK(with("1,a,,0,0,0,0,0\n") == "f:4:5: error: time_s: expected a number");
  CHECK(with("1,a,inf,0,0,0,0,0\n") == "f:4:5: error: time_s: expected a number, got 'inf'");
  CHECK(with("one,a,3,0,0,0,0,0\n") == "f:4:1: error: replicate: expected a whole number, got 'one'");
  CHECK(with("1,a,3,0\n") == "f:4:1: error: expected 8 fields, got 4");
  CHECK(with("1,\"a,b\",3,0,0,0,0,x\n") == "f:4:19: error: B: expected 0 or 1, got 'x'");
  CHECK_THAT(with("1,\"a,3,0,0,0,0,0\n"), contains("f:4:1: error: a quote isn't closed"));
  CHECK(with("1,a,3,0,0,0,2,0\n1,a,4,0,0,0,0,3\n1,a,5,-1,0,0,0,0\n") ==
        "f:4:13: error: A: expected 0 or 1, got '2'; 1 more like this\n"
        "f:6:7: error: people: expected a number of people, got '-1'");
  CHECK_THAT(refusal_of_rows("time_s,time,A\n1,10:00,0\n"), contains("f:2:3: error: time: expected a local time"));
  CHECK_THAT(refusal_of_rows("time_s,time,A\n1,2026-03-02T08:00:01,0\n2,,0\n"),
             contains("f:3:3: error: time: expected"));
}

TEST_CASE("rows that don't ascend by one step are refused", "[rows]") {
  const std::string begin = "replicate,trial,time_s,A\n1,a,10,0\n1,a,20,0\n1,a,30,0\n";
  CHECK(refusal_of_rows(begin + "1,a,30,0\n") == "f:5:5: error: time_s doesn't grow: 30 after 30");
  CHECK(refusal_of_rows(begin + "1,a,20,0\n") == "f:5:5: error: time_s doesn't grow: 20 after 30");
  CHECK_THAT(refusal_of_rows(begin + "1,a,45,0\n"),
             contains("f:5:5: error: rows are 10 s apart, and this one comes 15 s after"));
  CHECK_THAT(refusal_of_rows(begin + "1,a,31,0\n"),
             contains("f:5:5: error: rows are 10 s apart, and this one comes 1 s after"));
  CHECK_THAT(refusal_of_rows(begin + "2,a,10,0\n1,a,40,0\n"),
             contains("f:6:1: error: this row is of a run whose rows have ended"));
  CHECK_THAT(refusal_of_rows(begin + "1,a,1e12,0\n"), contains("too long a gap"));
  std::string longer = begin;
  for (int i = 1; i <= 4; ++i) longer += "1,b," + std::to_string(10 * i) + ",0\n";
  for (int i = 1; i <= 4; ++i) longer += "1,b," + std::to_string(40 + 60 * i) + ",0\n";
  CHECK_THAT(refusal_of_rows(longer), contains("f:11:5: error: rows are 10 s apart at first and 60 s here"));
  CHECK(refusal_of_rows(begin + "1,a,90,0\n1,a,100,0\n1,a,160,0\n1,a,170,0\n1,a,230,0\n") == "accepted");
}

TEST_CASE("columns of rows are checked once", "[rows]") {
  CHECK(refusal_of_rows("") == "f:1:1: error: expected a line with column names");
  CHECK_THAT(refusal_of_rows("time,A\n"), contains("f:1:1: error: these aren't rows of a run or a dataset"));
  CHECK(refusal_of_rows("time_s,A,A\n") == "f:1:10: error: column 'A' appears twice");
  CHECK(refusal_of_rows("time_s,people\n1,0\n") == "f:1:1: error: none of the columns is a sensor's");
  CHECK(refusal_of_rows("time_s,peple,A\n1,0,0\n") == "f:1:8: error: unknown column 'peple' (did you mean 'people'?)");
  CHECK(refusal_of_rows("Time_s,A\n1,0\n") == "f:1:1: error: unknown column 'Time_s' (did you mean 'time_s'?)");
  CHECK(refusal_of_rows("time_s,seat,trial,A\n1,a,a,0\n") ==
        "f:1:8: error: columns 'trial' and 'seat' mean the same: give one of them");
  CHECK_THAT(refusal_of_rows(",time_s,A\n0,1,0\n"), contains("f:1:1: error: a column without a name"));
  CHECK_THAT(refusal_of_rows("time_s;A\n1;0\n"), contains("separated by commas"));
  for (const std::string sensor : {"seat1", "room_2", "days", "time2", "trials_3"})
    CHECK(refusal_of_rows("time_s," + sensor + "\n1,0\n") == "accepted");
}
