// Windows: a twin that follows the definition, hours of summer time, and what is unknown.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "pirsim/log.hpp"
#include "support/catch.hpp"
#include "support/log_files.hpp"

using namespace pirsim;
using Texts = std::vector<std::string>;

namespace {

/// Greatest first: motion, then unknown.
char worse(char a, char b) {
  const std::string order = "0.1";
  return order.find(a) > order.find(b) ? a : b;
}

struct OneReading {
  int s;
  char state;
};

/// By the definition: the readings whose stamps are in the window (begin, end], or the next one if none is; a lost
/// reading is one that tells nothing.
std::string twin_of_readings(std::vector<OneReading> readings, int interval_s, int window_s) {
  std::vector<OneReading> all;
  all.push_back({readings.front().s - interval_s, '.'});
  for (const OneReading& reading : readings) {
    for (int s = all.back().s + interval_s; all.size() > 1 && s < reading.s; s += interval_s) all.push_back({s, '.'});
    all.push_back(reading);
  }
  all.push_back({all.back().s + interval_s, '.'});
  const auto window_of = [&](int s) { return (s + window_s - 1) / window_s - 1; };
  std::string windows;
  for (int window = window_of(readings.front().s); window <= window_of(readings.back().s); ++window) {
    const int begin = window * window_s, end = begin + window_s;
    char state = '0';
    for (std::size_t i = 1; i < all.size(); ++i) {
      const bool is_in = all[i].s > begin && all[i].s <= end;
      const bool spans = all[i - 1].s <= begin && all[i].s >= end;
      if (is_in || spans) state = worse(state, all[i].state);
    }
    if (all.front().s > begin) state = worse(state, '.');
    windows += state;
  }
  return windows;
}

struct Event {
  double s;
  char state;
};

/// By the definition: looked at in steps of a hundredth of a second.
std::string twin_of_events(const std::vector<Event>& events, double end_s, double window_s) {
  std::string windows;
  const auto n = static_cast<int>(std::floor(end_s / window_s + 1e-9)) + 1;
  for (int window = static_cast<int>(std::floor(events.front().s / window_s + 1e-9)); window < n; ++window) {
    char state = '0';
    for (int step = 0; step < std::lround(window_s * 100); ++step) {
      const double s = window * window_s + 0.01 * step + 1e-6;
      char now = '.';
      for (const Event& event : events) {
        if (event.s <= s && s <= end_s + 2e-6) now = event.state;
      }
      state = worse(state, now);
    }
    windows += state;
  }
  return windows;
}

}  // namespace

TEST_CASE("windows of readings are what their definition says") {
  std::mt19937 random(7);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const int interval = 1 + static_cast<int>(random() % 12);
    std::vector<OneReading> readings;
    std::string text = "time_s,A\n";
    const int first = static_cast<int>(random() % 40) + interval;
    for (int i = 0; i < 60; ++i) {
      if (i > 5 && i < 55 && random() % 6 == 0) continue;  // lost
      const char state = "001.0"[random() % 5];
      readings.push_back({first + i * interval, state});
      text += std::to_string(readings.back().s) + ',' + (state == '.' ? "" : std::string(1, state)) + '\n';
    }
    LogMap map;
    map.interval_s = interval;
    map.empty = LogMap::Empty::unknown;
    map.sensors = {{"A", "A"}};
    const Log log = read_log_text(text, map);
    for (const int window : {1, 2, 5, 30, 7}) {
      CAPTURE(text, interval, window);
      REQUIRE(windows_of(log, window) == Texts{twin_of_readings(readings, interval, window)});
    }
  }
}

TEST_CASE("windows of events are what their definition says, in whatever order the events come") {
  std::mt19937 random(8);
  for (int repeat = 0; repeat < 100; ++repeat) {
    std::vector<Event> events{{0.0, '0'}};
    for (int i = 0; i < 20; ++i)
      events.push_back({events.back().s + 0.05 * (1 + static_cast<double>(random() % 60)), "011."[random() % 4]});
    std::vector<Event> shuffled = events;
    std::shuffle(shuffled.begin() + 1, shuffled.end(), random);
    std::string text = "time,sensor,state\n";
    for (const Event& event : shuffled)
      text +=
          std::to_string(event.s) + ",A," + (event.state == '.' ? "unavailable" : std::string(1, event.state)) + '\n';
    const Log log = read_log_text(text);
    for (const double window : {0.1, 0.5, 2.0, 10.0}) {
      CAPTURE(text, window);
      REQUIRE(windows_of(log, window) == Texts{twin_of_events(events, events.back().s, window)});
    }
  }
}

TEST_CASE("a part of the windows is that part of all, also where several changes come at its very begin") {
  std::string text = "time,sensor,state\n";
  std::mt19937 random(9);
  for (int i = 0; i < 400; ++i)
    text += std::to_string(i / 3 * 4) + ",S" + std::to_string(random() % 3) + (random() % 2 == 0 ? ",on\n" : ",off\n");
  LogMap map;
  map.form = LogMap::Form::events;
  map.sensor_column = {"sensor"};
  map.state_column = "state";
  const Log log = read_log_text(text, map);
  const LogWindows windows(log, 4.0);
  const LogRows all = windows.rows();
  for (std::size_t first = 0; first < windows.size(); first += 5) {
    const LogRows part = windows.rows(first, 5);
    for (std::size_t i = 0; i < part.n_windows(); ++i) {
      CHECK(part.begin[i] == all.begin[first + i]);
      for (std::size_t sensor = 0; sensor < 3; ++sensor) REQUIRE(part.at(i, sensor) == all.at(first + i, sensor));
    }
  }
}

// Europe/Berlin: clocks went from 02:00 to 03:00 on 2025-03-30, and from 03:00 to 02:00 on 2025-10-26, at 01:00 UTC.

namespace {

std::map<std::string, int> windows_by_day(const Log& log, double window_s) {
  std::map<std::string, int> days;
  for (const LogMoment& begin : LogWindows(log, window_s).rows().begin) ++days[to_text(begin, log.clock).substr(0, 10)];
  return days;
}

}  // namespace

TEST_CASE("days of 23 and 25 hours, from events in UTC") {
  LogMap map;
  map.time_zone = "Europe/Berlin";
  const Log spring = read_log_text(
      "entity_id,state,last_changed\na,off,2025-03-28T23:00:00Z\na,on,2025-03-30T00:59:00Z\na,off,2025-03-30T01:01:"
      "00Z\na,off,2025-03-31T22:00:00Z\n",
      map);
  CHECK(windows_by_day(spring, 3600.0) ==
        std::map<std::string, int>{{"2025-03-29", 24}, {"2025-03-30", 23}, {"2025-03-31", 24}, {"2025-04-01", 1}});
  const LogRows rows = LogWindows(spring, 60.0).rows();
  const auto at = static_cast<std::size_t>((24 + 2) * 60 - 1);  // the minute before the clocks are put forward
  CHECK(to_text(rows.begin[at], rows.clock) == "2025-03-30T01:59:00");
  CHECK(to_text(rows.begin[at + 1], rows.clock) == "2025-03-30T03:00:00");
  CHECK(rows.motion[at - 1] == 0);
  CHECK(rows.motion[at] == 1);
  CHECK(rows.motion[at + 1] == 1);
  CHECK(rows.motion[at + 2] == 0);
  const Log autumn =
      read_log_text("entity_id,state,last_changed\na,off,2025-10-24T22:00:00Z\na,on,2025-10-27T23:00:00Z\n", map);
  CHECK(windows_by_day(autumn, 1800.0) ==
        std::map<std::string, int>{{"2025-10-25", 48}, {"2025-10-26", 50}, {"2025-10-27", 48}, {"2025-10-28", 1}});
}

TEST_CASE("local times of a zone: an hour that there is twice, and one that there isn't") {
  LogMap map;
  map.time_zone = "Europe/Berlin";
  std::string text = "time,A\n";
  for (const char* time : {"01:30", "02:00", "02:30", "02:00", "02:30", "03:00"})
    text += std::string("2025-10-26 ") + time + ",0\n";
  const Log log = read_log_text(text, map);
  CHECK(log.interval_us == 1800LL * 1'000'000);
  CHECK(windows_of(log, 1800.0) == Texts{"000000"});
  REQUIRE(log.remarks.size() == 2);  // and that the sensor is never on
  CHECK(log.remarks[0].message.find("twice") != std::string::npos);
  CHECK(log.remarks[0].message.find("; 3 more like this") != std::string::npos);
  // Events of two sensors, between which the clock is put back by ten minutes that can be seen.
  std::string events = "time,sensor,state\n";
  for (const char* row :
       {"01:50:00,a,off", "01:50:00,b,off", "02:00:10,a,on", "02:00:30,a,off", "02:20:00,b,on", "02:20:30,b,off",
        "02:10:00,b,on", "02:10:30,b,off", "02:11:00,a,on", "02:11:30,a,off", "03:30:00,a,on", "03:30:20,a,off"})
    events += std::string("2025-10-26 ") + row + '\n';
  const std::vector<LogChange>& of_b = read_log_text(events, map).sensors[1].changes;
  REQUIRE(of_b.size() == 5);
  CHECK(of_b[3].us - of_b[1].us == (3600LL - 600) * 1'000'000);
  // The same as they are, without a zone: the second pass is out of order.
  CHECK_THROWS_WITH(read_log_text(text), contains("log.csv:5:1: error: the times step back here") &&
                                             contains("{pirsim_log: 1, time_zone: Europe/Berlin}"));

  LogMap told = map;
  told.rows = LogMap::Rows::readings;
  const Log gap = read_log_text(
      "time,A\n2025-03-30 01:30,0\n2025-03-30 02:30,1\n2025-03-30 03:30,0\n2025-03-30 04:00,0\n2025-03-30 04:30,0\n",
      told);
  REQUIRE(gap.remarks.size() >= 1);
  CHECK(gap.remarks[0].message.find("left out") != std::string::npos);
  LogMap wrong = map;
  wrong.time_zone = "Europe/Berlim";
  CHECK_THROWS_WITH(read_log_text(text, wrong),
                    contains("'Europe/Berlim' is not a time zone") && contains("did you mean 'Europe/Berlin'?"));
}

TEST_CASE("windows begin at the local midnight, also where zones are half an hour apart") {
  LogMap map;
  map.time_zone = "Asia/Kolkata";
  const Log log =
      read_log_text("entity_id,state,last_changed\na,off,2025-04-06T17:59:00Z\na,on,2025-04-06T19:10:00Z\n", map);
  CHECK(to_text(LogWindows(log, 3600.0).begin(0), log.clock) == "2025-04-06T23:00:00");
  CHECK(windows_by_day(log, 3600.0) == std::map<std::string, int>{{"2025-04-06", 1}, {"2025-04-07", 1}});
}

TEST_CASE("offsets of the stamps alone tell local time") {
  LogMap map;
  map.rows = LogMap::Rows::readings;
  const Log log = read_log_text(
      "time,A\n2025-10-26T02:30:00+02:00,0\n2025-10-26T02:00:00+01:00,1\n2025-10-26T02:30:00+01:00,0\n", map);
  CHECK(log.clock == LogClock::zoned);
  const LogRows rows = LogWindows(log, 1800.0).rows();
  CHECK(windows_of(log, 1800.0) == Texts{"010"});
  CHECK(to_text(rows.begin[0], rows.clock) == "2025-10-26T02:00:00");
  CHECK(to_text(rows.begin[2], rows.clock) == "2025-10-26T02:00:00");
}

TEST_CASE("from, to, a clock that is late, and stamps that tell where readings begin") {
  const std::string text =
      "time,A\n2025-04-06T18:00:10,0\n2025-04-06T18:00:20,1\n2025-04-06T18:00:30,0\n2025-04-06T18:00:40,1\n";
  LogMap map;
  map.from = "2025-04-06T18:00:10";
  map.to = "2025-04-06T18:00:30";
  CHECK(windows_of(read_log_text(text, map), 10.0) == Texts{"10"});
  map.to = "2025-04-06T17:00";
  CHECK_THROWS_AS(read_log_text(text, map), Error);
  LogMap late;
  late.shift_s = 10.0;
  CHECK(to_text(LogWindows(read_log_text(text, late), 10.0).begin(0), LogClock::local) == "2025-04-06T18:00:10");
  LogMap begins;
  begins.stamps = LogMap::Stamps::begin;
  CHECK(to_text(LogWindows(read_log_text(text, begins), 10.0).begin(0), LogClock::local) == "2025-04-06T18:00:10");
  LogMap events;
  events.from = "2025-04-06T18:00:02";
  events.to = "2025-04-06T18:00:05";
  const std::string told =
      "time,sensor,state\n2025-04-06T18:00:00,A,off\n2025-04-06T18:00:01,A,on\n2025-04-06T18:00:04,A,off\n2025-04-"
      "06T18:00:09,A,on\n";
  CHECK(windows_of(read_log_text(told, events), 1.0) == Texts{"110"});
  events.from = "2025-04-06T18:00:04";
  CHECK(windows_of(read_log_text(told, events), 1.0) == Texts{"0"});
  const std::string at_once = "2025-04-06T18:00:04,A,on\n2025-04-06T18:00:04,A,off\n2025-04-06T18:00:09,A,on\n";
  CHECK(windows_of(read_log_text(told.substr(0, told.find("2025-04-06T18:00:04")) + at_once, events), 1.0) ==
        Texts{"0"});
  CHECK(windows_of(read_log_text("time,sensor,state\n2025-04-06T18:00:01,A,off\n" + at_once, events), 1.0) ==
        Texts{"1"});
}

TEST_CASE("silence beyond a stated length, and motion whose end isn't told") {
  const std::string text = "time,sensor,state\n0,A,off\n2,A,on\n3,A,off\n20,B,on\n21,B,off\n";
  LogMap map;
  map.longest_gap_s = 10.0;
  CHECK(windows_of(read_log_text(text, map), 1.0) == Texts{"001.................0.", "....................1."});
  const std::string pulses = "time,sensor,state\n0,A,on\n2,A,on\n10,A,on\n12,A,off\n";
  LogMap hold;
  hold.hold_s.all = 3.0;
  CHECK(windows_of(read_log_text(pulses, hold), 1.0) == Texts{"111110000011."});
}
