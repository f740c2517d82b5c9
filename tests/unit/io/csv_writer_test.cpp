#include "pirsim/csv.hpp"

#include <sstream>

#include "io/csv_reader.hpp"
#include "support/catch.hpp"

using namespace pirsim;

TEST_CASE("numbers are written in the shortest form that reads back") {
  CHECK(io::csv_number(1.0) == "1");
  CHECK(io::csv_number(0.1) == "0.1");
  CHECK(io::csv_number(1.0 / 3.0) == "0.3333333333333333");
}

TEST_CASE("names with commas, quotes and line breaks come back from the reader as they were") {
  std::ostringstream out;
  io::CsvWriter csv(out, {"trial, one", "a \"b\""});
  csv.write({1, "S1,\n\"x\"", 0.5, "working", 2, {1, 0}});
  const io::CsvTable table =
      io::CsvTable::parse("replicate,trial,time_s,phase,people,A,B" + out.str().substr(out.str().find('\n')), "x");
  CHECK(table.text(0, 1) == "S1,\n\"x\"");
  CHECK(table.text(0, 2) == "0.5");
  CHECK(table.text(0, 6) == "0");
  CHECK(out.str().starts_with("\"trial, one\",\"a \"\"b\"\"\"\n"));
}

TEST_CASE("measured rows are the others without the number of people") {
  std::ostringstream out, measured;
  io::CsvWriter(out, {"replicate", "trial", "time_s", "phase", "people", "A,1", "B"})
      .write({2, "S,1", 0.5, "at, work", 3, {1, 0}});
  io::MeasuredCsvWriter(measured, {"A,1", "B"}).write({2, "S,1", 0.5, "at, work", 3, {1, 0}});
  CHECK(measured.str() == "replicate,trial,time_s,phase,\"A,1\",B\n2,\"S,1\",0.5,\"at, work\",1,0\n");
  CHECK(out.str() == "replicate,trial,time_s,phase,people,\"A,1\",B\n2,\"S,1\",0.5,\"at, work\",3,1,0\n");
}

TEST_CASE("a row has as many fields as its header, whether it knows the time of day or not") {
  std::ostringstream out, measured;
  const Sample timed{1, "S1", 0.5, "working", 2, {1}, "2026-03-02T07:00:00"}, untimed{1, "S1", 0.5, "working", 2, {1}};
  io::CsvWriter csv(out, {"replicate", "trial", "time_s", "time", "phase", "people", "A"});
  csv.write(timed);
  csv.write(untimed);
  CHECK(out.str() ==
        "replicate,trial,time_s,time,phase,people,A\n"
        "1,S1,0.5,2026-03-02T07:00:00,working,2,1\n1,S1,0.5,,working,2,1\n");
  io::MeasuredCsvWriter(measured, {"A"}).write(timed);
  CHECK(measured.str() == "replicate,trial,time_s,phase,A\n1,S1,0.5,working,1\n");
}

TEST_CASE("zone activity is one line a sensor, zones split at the sensors' borders") {
  std::ostringstream out;
  io::ZoneCsvWriter zones(out, {"A", "B"}, {0, 2, 5});
  const std::vector<std::uint8_t> activity{1, 0, 0, 1, 1};
  zones.write(3, "S1", 42, activity);
  CHECK(out.str() == "replicate,trial,tick,sensor,zones\n3,S1,42,A,10\n3,S1,42,B,011\n");
}
