#include "pirsim/csv.hpp"

#include <sstream>

#include "files/read/csv_reader.hpp"
#include "support/catch.hpp"

using namespace pirsim;

TEST_CASE("numbers are written in the shortest form that reads back") {
  CHECK(io::csv_number(1.0) == "1");
  CHECK(io::csv_number(0.1) == "0.1");
  CHECK(io::csv_number(1.0 / 3.0) == "0.3333333333333333");
}

TEST_CASE("names with commas, quotes and line breaks come back from the reader as they were") {
  std::ostringstream out;
  io::CsvWriter csv(out, {"trial", "time_s", "trial, one", "a \"b\""});
  csv.write({1, "S1,\n\"x\"", 0.5, "working", 2, {1, 0}});
  const io::CsvTable table = io::CsvTable::parse(out.str(), "x");
  CHECK(table.text(0, *table.column("trial")) == "S1,\n\"x\"");
  CHECK(table.text(0, *table.column("time_s")) == "0.5");
  CHECK(table.text(0, *table.column("a \"b\"")) == "0");
  CHECK(out.str().starts_with("trial,time_s,\"trial, one\",\"a \"\"b\"\"\"\n"));
}

TEST_CASE("a table has the columns that it was asked for, sensors in their order") {
  std::ostringstream out, measured;
  const Sample row{2, "S,1", 0.5, "at, work", 3, {1, 0}};
  io::CsvWriter(out, column_names<Sample>({.sensors = {"A,1", "B"}})).write(row);
  io::CsvWriter(measured, {"B", "phase", "A,1"}).write(row);
  CHECK(out.str() == "replicate,trial,time_s,time,phase,people,\"A,1\",B\n2,\"S,1\",0.5,,\"at, work\",3,1,0\n");
  CHECK(measured.str() == "B,phase,\"A,1\"\n1,\"at, work\",0\n");
  CHECK_THROWS_WITH(io::TableWriter<ZoneLine>(out, {"tick", "x"}), contains("no column 'x'"));
}

TEST_CASE("people of areas stand before the sensors, by whatever names these have") {
  Sample row{2, "S1", 0.5, "working", 3, {1, 0}};
  row.people_of_areas = {1, 2};
  const std::vector<std::string> names = column_names<Sample>({.sensors = {"A", "B"}, .areas = {"hall", "elsewhere"}},
                                                              [](When when) { return when != When::with_clock; });
  std::ostringstream out, some;
  io::CsvWriter(out, names).write(row);
  CHECK(out.str() ==
        "replicate,trial,time_s,phase,people,people_hall,people_elsewhere,A,B\n2,S1,0.5,working,3,1,2,1,0\n");
  io::CsvWriter(some, {"B", "people_hall", "A"}).write(row);  // the first of each kind to the first of the row's
  CHECK(some.str() == "B,people_hall,A\n1,1,0\n");
  CHECK(column_names<OccupantLine>({.areas = {"hall"}}).size() == column_names<OccupantLine>().size() + 1);
}

TEST_CASE("a row has as many fields as its header, whether it knows the time of day or not") {
  std::ostringstream out;
  const Sample timed{1, "S1", 0.5, "working", 2, {1}, "2026-03-02T07:00:00"}, untimed{1, "S1", 0.5, "working", 2, {1}};
  io::CsvWriter csv(out, {"replicate", "trial", "time_s", "time", "phase", "people", "A"});
  csv.write(timed);
  csv.write(untimed);
  CHECK(out.str() ==
        "replicate,trial,time_s,time,phase,people,A\n"
        "1,S1,0.5,2026-03-02T07:00:00,working,2,1\n1,S1,0.5,,working,2,1\n");
}

TEST_CASE("zone activity is a string of bits, and what is rounded has no more decimals than it needs") {
  std::ostringstream out;
  io::TableWriter<ZoneLine> zones(out);
  const std::vector<std::uint8_t> activity{0, 1, 1};
  zones.write({3, "S1", 42, "B", activity});
  CHECK(out.str() == "replicate,trial,tick,sensor,zones\n3,S1,42,B,011\n");
  std::string line;
  io::add_csv(line, 1.23456, 3);
  io::add_csv(line, std::string_view(" "), -1);
  io::add_csv(line, 0.1 + 0.2, 3);
  CHECK(line == "1.235 0.3");
}
