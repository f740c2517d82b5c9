// Logs in the form of CASAS' homes, against lines written by hand.
#include "files/write/casas_writer.hpp"

#include <sstream>

#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::io;

namespace {

/// A run of one row a minute from midnight on: of two sensors, and of what ann does (empty: away).
struct Day {
  std::vector<Sample> rows;
  std::vector<OccupantRow> occupants;

  Day(const std::string& date, const std::vector<std::array<std::uint8_t, 2>>& bits,
      const std::vector<std::string>& activities) {
    for (std::size_t i = 0; i < bits.size(); ++i) {
      Sample& row = rows.emplace_back();
      row.time_s = 60.0 * static_cast<double>(i + 1);
      row.clock = date + "T00:0" + std::to_string(i + 1) + ":00";
      row.bits = {bits[i][0], bits[i][1]};
      row.doors = {0};
      if (!activities[i].empty()) occupants.push_back({row.time_s, row.clock, "ann", activities[i], ""});
    }
  }
};

std::string log_of(const std::vector<Day>& days) {
  std::ostringstream text;
  CasasWriter log(text, {"M1", "M2"}, {"D1"});
  for (const Day& day : days) log.add(day.rows, day.occupants);
  log.finish();
  return text.str();
}

}  // namespace

TEST_CASE("a log of CASAS has a line a change, and no sensor stays on at its end") {
  const Day day("2026-03-02", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {"", "", "", ""});
  CHECK(log_of({day}) ==
        "2026-03-02 00:02:00 M1 ON\n"
        "2026-03-02 00:03:00 M2 ON\n"
        "2026-03-02 00:04:00 M1 OFF\n"
        "2026-03-02 00:04:00 M2 OFF\n");
  CHECK(log_of({}).empty());
}

TEST_CASE("a log of CASAS has contacts of doors, which are shut at its end") {
  Day day("2026-03-02", {{0, 0}, {1, 0}, {0, 0}}, {"", "", ""});
  day.rows[1].doors = day.rows[2].doors = {1};
  CHECK(log_of({day}) ==
        "2026-03-02 00:02:00 M1 ON\n"
        "2026-03-02 00:02:00 door_D1 OPEN\n"
        "2026-03-02 00:03:00 M1 OFF\n"
        "2026-03-02 00:03:00 door_D1 CLOSE\n");
}

TEST_CASE("activities begin and end at the lines within them, a line with two labels stands twice, moves are none") {
  const Day day("2026-03-02", {{0, 0}, {1, 0}, {0, 0}, {0, 1}, {0, 0}, {1, 0}},
                {"eating", "eating", "eating", "reading", "walking", "toilet"});
  CHECK(log_of({day}) ==
        "2026-03-02 00:02:00 M1 ON ann_eating begin\n"
        "2026-03-02 00:03:00 M1 OFF ann_eating end\n"
        "2026-03-02 00:04:00 M2 ON ann_reading begin\n"
        "2026-03-02 00:04:00 M2 ON ann_reading end\n"
        "2026-03-02 00:05:00 M2 OFF\n"
        "2026-03-02 00:06:00 M1 ON ann_toilet begin\n"
        "2026-03-02 00:06:00 M1 OFF ann_toilet end\n");
}

TEST_CASE("what goes on at midnight is one activity, and what no sensor noticed is none") {
  const Day first("2026-03-02", {{0, 0}, {1, 0}, {0, 0}}, {"sleeping", "sleeping", "sleeping"});
  const Day noticed("2026-03-03", {{0, 1}, {0, 0}}, {"sleeping", ""});
  const Day unnoticed("2026-03-03", {{0, 0}, {0, 1}}, {"sleeping", ""});
  const std::string evening =
      "2026-03-02 00:02:00 M1 ON ann_sleeping begin\n"
      "2026-03-02 00:03:00 M1 OFF";
  CHECK(log_of({first, noticed}) == evening +
                                        "\n2026-03-03 00:01:00 M2 ON ann_sleeping end\n"
                                        "2026-03-03 00:02:00 M2 OFF\n");
  CHECK(log_of({first, unnoticed}) == evening +
                                          " ann_sleeping end\n"
                                          "2026-03-03 00:02:00 M2 ON\n"
                                          "2026-03-03 00:02:00 M2 OFF\n");
}
