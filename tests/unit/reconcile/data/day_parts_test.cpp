// DayParts of days against counts that were looked up reading by reading.
#include "reconcile/data/measured.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;
using namespace pirsim::test;

namespace {

constexpr double window_s = 30.0;

/// Readings every minute, from eight o'clock on each day, with these people at each.
ScriptSpec script_with(const std::vector<std::vector<int>>& days) {
  ScriptSpec script = script_of({});
  script.sensing.tick_rate_hz = 10;
  script.sensing.ticks_per_window = 300;
  OccupancySpec& occupancy = script.trials.front().occupancy.emplace();
  CountsSpec& counts = occupancy.counts.emplace();
  counts.begin = "2026-03-02T00:00:00";
  for (std::size_t day = 0; day < days.size(); ++day) {
    for (std::size_t i = 0; i < days[day].size(); ++i) {
      counts.times_s.push_back(86400.0 * static_cast<double>(day) + 8 * 3600.0 + 60.0 * static_cast<double>(i));
      counts.people.push_back(days[day][i]);
    }
  }
  occupancy.from_h = 8.0;
  occupancy.to_h = 8.0 + static_cast<double>(days.front().size() - 1) / 60.0;
  return script;
}

std::vector<int> stretches(std::initializer_list<std::pair<int, int>> of) {
  std::vector<int> people;
  for (const auto& [n, minutes] : of) people.insert(people.end(), static_cast<std::size_t>(minutes), n);
  return people;
}

const std::vector<std::vector<int>> two_days{stretches({{0, 60}, {1, 90}, {3, 60}, {1, 31}}),
                                             stretches({{2, 120}, {0, 121}})};

}  // namespace

TEST_CASE("A part has one number of people, and no row within a minute of a change", "[day_parts]") {
  const DayParts parts = day_parts_of(script_with(two_days));
  REQUIRE(parts.n_days == 2);
  REQUIRE(parts.n_rows == 480);
  const CountsSpec given = *script_with(two_days).trials.front().occupancy->counts;
  const std::array<double, 2> begins_s{8 * 3600.0, 86400.0 + 8 * 3600.0};
  std::map<std::uint16_t, std::set<int>> people_of;
  std::size_t sure = 0;
  for (std::size_t day = 0; day < 2; ++day) {
    for (std::size_t row = 0; row < parts.n_rows; ++row) {
      // Looked up: what two readings say that follow each other holds from a minute before the first to a minute after
      // the second.
      const double from_s = begins_s[day] + window_s * static_cast<double>(row), to_s = from_s + window_s;
      std::set<int> said;
      for (std::size_t k = 1; k < given.people.size(); ++k) {
        if (given.times_s[k - 1] - 60.0 >= to_s || given.times_s[k] + 60.0 <= from_s) continue;
        said.insert({given.people[k - 1], given.people[k]});
      }
      const std::int32_t people = parts.people[day * parts.n_rows + row];
      if (people == DayParts::not_sure) {
        CHECK(said.size() > 1);
        continue;
      }
      ++sure;
      CHECK(said.contains(people));
      CHECK(said.size() == 1);
      people_of[parts.of_row[day * parts.n_rows + row]].insert(people);
    }
  }
  CHECK(sure > 900);
  for (const auto& [part, people] : people_of) {
    if (part != DayParts::none) CHECK(people.size() == 1);
  }
  CHECK(std::ranges::count(parts.of_row, DayParts::none) < 40);
  CHECK(
      std::ranges::any_of(parts.names, [](const std::string& name) { return name.starts_with("comings and goings"); }));
  CHECK(parts.names.front() == "nobody from 03-02 08:00 to 03-03 10:31");
}

TEST_CASE("Few people are told apart by their number, many by twice as many each time", "[day_parts]") {
  const auto names = [](int most) {
    const DayParts parts = day_parts_of(script_with({stretches({{most, 60}, {most - 1, 61}})}));
    std::set<std::string> people;
    for (const std::string& name : parts.names) people.insert(name.substr(0, name.find(" from")));
    return people;
  };
  CHECK(names(4) == std::set<std::string>{"3 people", "4 people"});
  CHECK(names(9) == std::set<std::string>{"8 to 15 people"});
}

TEST_CASE("Where areas are counted, who is where tells rows apart", "[day_parts]") {
  const auto names = [](const std::vector<int>& kitchen, const std::vector<int>& bath) {
    AreaCountsSpec in_kitchen{"kitchen", "", {}}, in_bath{"bath", "", {}};
    std::vector<int> all;
    for (std::size_t i = 0; i < 20 * kitchen.size(); ++i) {  // twenty minutes each
      in_kitchen.people.push_back(kitchen[i / 20]);
      in_bath.people.push_back(bath[i / 20]);
      all.push_back(kitchen[i / 20] + bath[i / 20]);
    }
    ScriptSpec script = script_with({all});
    script.trials.front().occupancy->counts->areas = {in_kitchen, in_bath};
    std::set<std::string> found;
    for (const std::string& name : day_parts_of(script).names) found.insert(name.substr(0, name.find(" from")));
    found.erase("comings and goings");
    return found;
  };
  // The same number of people all the time.
  CHECK(names({1, 0, 1}, {0, 1, 0}) == std::set<std::string>{"1 in kitchen", "1 in bath"});
  // More than eight numbers: in which of them anybody is.
  CHECK(names({9, 8, 7, 6, 5, 4, 3, 2, 1, 0}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}) ==
        std::set<std::string>{"people in kitchen", "people in kitchen, people in bath", "people in bath"});
}

TEST_CASE("Runs in parts keep every row once, apart where they don't follow each other", "[day_parts]") {
  SceneSpec scene;
  scene.sensors.resize(2);
  const StudyFrame frame = frame_of(scene, script_with(two_days));
  REQUIRE(frame.trials == frame.day_parts.names);
  std::vector<Series> days;
  for (int day = 1; day <= 2; ++day) {
    Series run{0, day, 0, 480, std::vector<std::uint8_t>(960)};
    for (std::size_t i = 0; i < run.bits.size(); ++i) run.bits[i] = (i * 7 + static_cast<std::size_t>(day)) % 3 == 0;
    days.push_back(run);
  }
  const std::vector<Series> parts = in_day_parts(frame, days);
  REQUIRE(parts.size() == frame.trials.size());
  std::size_t kept = 0, ones = 0, wanted = 0;
  for (const Series& part : parts) {
    CHECK(part.replicate == 1);
    CHECK(part.main_end == part.n_rows(2));
    CHECK(part.bits.front() != unknown_bit);
    CHECK(part.bits.back() != unknown_bit);
    kept += static_cast<std::size_t>(std::ranges::count_if(part.bits, [](auto bit) { return bit != unknown_bit; }));
    ones += static_cast<std::size_t>(std::ranges::count(part.bits, 1));
  }
  for (std::size_t i = 0; i < frame.day_parts.of_row.size(); ++i) {
    if (frame.day_parts.of_row[i] == DayParts::none) continue;
    for (std::size_t sensor = 0; sensor < 2; ++sensor) wanted += days[i / 480].bits[i % 480 * 2 + sensor];
  }
  const auto none = static_cast<std::size_t>(std::ranges::count(frame.day_parts.of_row, DayParts::none));
  CHECK(kept == 2 * (960 - none));
  CHECK(ones == wanted);
  // "1 person" of the morning and of the end of the first day: one unknown row lies between.
  const auto one = std::ranges::find_if(
      parts, [&](const Series& part) { return frame.trials[part.trial].starts_with("comings and goings"); });
  REQUIRE(one != parts.end());
  CHECK(std::ranges::count(one->bits, unknown_bit) > 0);
  days.pop_back();  // a second day that wasn't recorded
  for (const Series& part : in_day_parts(frame, days)) CHECK_FALSE(frame.trials[part.trial].starts_with("2 people"));
}

TEST_CASE("A script that draws who is there is refused, with what to write instead", "[day_parts]") {
  ScriptSpec script = script_of({});
  script.trials.front().schedule.emplace();
  CHECK_THROWS_WITH(require_known_presence(script), contains("occupancy: {counts: FILE}"));
  CHECK_THROWS_WITH(parse_measured("time_s,PIR1\n1,0\n", "m.csv", SceneSpec{}, script), contains("schedule"));
  CHECK_NOTHROW(require_known_presence(script_with(two_days)));
}
