#include "files/read/csv_reader.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "support/catch.hpp"
#include "support/paths.hpp"

using namespace pirsim;
using namespace pirsim::io;

namespace {

std::string lines_of(const std::vector<Issue>& issues) {
  std::string text;
  for (Issue issue : issues) {
    issue.where.file = "f";
    text += (text.empty() ? "" : "\n") + to_string(issue);
  }
  return text;
}
std::string refusal_of_table(const std::string& text) {
  try {
    (void)CsvTable::parse(text, "f");
  } catch (const Error& error) {
    return lines_of(error.issues());
  }
  return "accepted";
}
std::string refusal_of_cells(const std::string& text) {
  const std::string name = "pirsim_csv_" + std::to_string(getpid()) + ".csv";
  const std::filesystem::path path = std::filesystem::temp_directory_path() / name;
  std::ofstream(path, std::ios::binary) << text;
  const std::shared_ptr<void> cleanup(nullptr, [&](void*) { std::filesystem::remove(path); });
  try {
    (void)read_measured_cells(path);
  } catch (const Error& error) {
    return lines_of(error.issues());
  }
  return "accepted";
}

}  // namespace

TEST_CASE("CSV with quotes, CRLF, a byte order mark and comments is read", "[csv]") {
  const CsvTable table = CsvTable::parse(
      "\xEF\xBB\xBF# a comment\r\na,\"b \"\"x\"\"\",c\r\n1,\"two, and\nmore\",3\r\n\r\n-4,,\"\"\r\n+5,x,2.5", "f");
  CHECK(table.names() == std::vector<std::string>{"a", "b \"x\"", "c"});
  REQUIRE(table.n_rows() == 3);
  CHECK(table.text(0, 1) == "two, and\nmore");
  CHECK(table.where(0, 2) == Where{"f", 4, 7});
  CHECK(table.where(1, 0) == Where{"f", 6, 1});
  Diagnostics faults;
  CHECK(table.integer(1, 0, faults) == -4);
  CHECK_FALSE(table.integer(1, 1, faults));
  CHECK_FALSE(table.number(1, 2, faults));
  CHECK(table.integer(2, 0, faults) == 5);
  CHECK(table.number(2, 2, faults) == 2.5);
  CHECK(faults.issues().empty());
  CHECK_FALSE(table.integer(2, 2, faults));
  CHECK_FALSE(table.number(2, 1, faults));
  CHECK(lines_of(faults.issues()) ==
        "f:7:6: error: c: expected a whole number, got '2.5'\nf:7:4: error: b \"x\": expected a number, got 'x'");
}

TEST_CASE("a line that begins with a number sign is a comment before the header alone", "[csv]") {
  const CsvTable table = CsvTable::parse("# one\n\n#two\nid,x\n#1,2\n", "f");
  REQUIRE(table.n_rows() == 1);
  CHECK(table.text(0, 0) == "#1");
  CHECK(table.where(0, 1) == Where{"f", 5, 4});
  CHECK(refusal_of_table("id,x\n# a comment\n1,2\n") == "f:2:1: error: expected 2 fields, got 1");
}

TEST_CASE("CSV that breaks the rules is refused with line and column", "[csv]") {
  CHECK(refusal_of_table("") == "f:1:1: error: expected a line with column names");
  CHECK(refusal_of_table("a,b\n1\n1,2,3\n") == "f:2:1: error: expected 2 fields, got 1; 1 more like this");
  CHECK(refusal_of_table("a,a\n1,2\n") == "f:1:3: error: column 'a' appears twice");
  CHECK(refusal_of_table("a,b\n1,\"2\n3,4\n") == "f:2:3: error: this quote is never closed");
  CHECK(refusal_of_table("a,b\n1,\"2\"x\n") == "f:2:6: error: expected ',' after the closing quote");
  CHECK(refusal_of_table("a,b\n1,2\"\n") == "f:2:4: error: a quote inside a field that doesn't begin with one");
  CHECK(refusal_of_table("a,b\n1,2,\n") == "f:2:1: error: expected 2 fields, got 3");
}

TEST_CASE("the paper's Table 1 is read whole", "[csv]") {
  const std::vector<MeasuredCell> cells =
      read_measured_cells(pirsim::test::data_dir() / "measured/stefansson2021_table1.csv");
  REQUIRE(cells.size() == 50);
  const MeasuredCell& cell = cells[33];  // the paper's largest difference
  CHECK(cell.trial == "S7");
  CHECK(cell.sensor == "PIR4");
  CHECK(cell.real == 128);
  CHECK(cell.min_sim == 6);
  CHECK(cell.max_sim == 76);
  CHECK(cell.mean_sim == 11.0);
}

TEST_CASE("faults of a table of measured counts are all told", "[csv]") {
  const std::string missing = refusal_of_cells("seat,sensr,value\nS1,A,3\n");
  CHECK(missing.find("f:1:1: error: column 'sensor' is missing (did you mean 'sensr'?)\n") == 0);
  CHECK(missing.find("f:1:1: error: column 'real' is missing") != std::string::npos);
  CHECK(refusal_of_cells("trial,sensor,real,min_sim,max_sim\nS1,A,x,1,2\nS1,A,3,5,4\nS2,A,-1,,\nS3,A,,1,\n") ==
        "f:2:6: error: real: expected a whole number, got 'x'\n"
        "f:3:8: error: min_sim is greater than max_sim\n"
        "f:3:1: error: trial 'S1' and sensor 'A' appear twice\n"
        "f:4:6: error: real: a count can't be negative\n"
        "f:5:6: error: real: expected a number\n"
        "f:5:1: error: expected both or neither of min_sim and max_sim");
  CHECK(refusal_of_cells("trial,sensor,real\r\nS1,A,3\r\n") == "accepted");
}

TEST_CASE("fields may be separated by semicolons or tabs, and have decimal commas then", "[csv]") {
  for (const char* text : {"trial,s\nS1,1.5\n", "trial;s\nS1;1,5\n", "trial;s\n\"S1\";1.5\n", "trial\ts\nS1\t1,5\n"}) {
    CAPTURE(text);
    const CsvTable table = CsvTable::parse(text, "f");
    Diagnostics faults;
    CHECK(table.text(0, 0) == "S1");
    CHECK(table.number(0, 1, faults) == 1.5);
    CHECK(table.where(0, 1).column == (text[8] == '"' ? 6 : 4));
  }
  CHECK(CsvTable::parse("trial\nS1\n", "f").names() == std::vector<std::string>{"trial"});
  CHECK(CsvTable::parse("trial,a;b\nS1,1\n", "f").names() == std::vector<std::string>{"trial", "a;b"});
  Diagnostics faults;
  CHECK_FALSE(CsvTable::parse("trial,s\nS1,\"1,234\"\n", "f").number(0, 1, faults));  // a thousand, or 1.234
}
