// The last gate: what isn't plausible is refused whatever form or map it was read by, and the maps that the refusal
// names give the right values.
#include <cmath>
#include <random>

#include "pirsim/log.hpp"
#include "support/catch.hpp"
#include "support/log_files.hpp"

using namespace pirsim;
using Texts = std::vector<std::string>;

namespace {

/// The first map that a refusal names, or nothing.
std::string map_in(const std::string& message) {
  const std::size_t begin = message.find("{pirsim_log: 1, ");
  std::size_t end = begin, depth = 0;
  if (begin == std::string::npos) return {};
  do {
    depth += message[end] == '{' ? 1 : 0;
    depth -= message[end] == '}' ? 1 : 0;
  } while (++end < message.size() && depth > 0);
  return message.substr(begin, end - begin);
}

std::string refusal(const std::string& text, const LogMap& map = {}) {
  try {
    (void)read_log_text(text, map);
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::input);
    return error.what();
  }
  FAIL("it was read:\n" << text.substr(0, 400));
  return {};
}
/// Refused with this message, and read by the first map that it names.
Log settled_by_map(const std::string& text, const std::string& message) {
  const std::string told = refusal(text);
  CHECK_THAT(told, contains(message));
  return read_log_text(text, io::parse_log_map(map_in(told), "map"));
}

std::string remarks_of(const Log& log) {
  std::string all;
  for (const Issue& remark : log.remarks) all += remark.message + '\n';
  return all;
}

/// "2026-03-02T07:00:00" and so many seconds.
std::string at(std::int64_t s) { return to_text({(1'772'434'800 + s) * 1'000'000, 0}, LogClock::local); }

std::string stepped(int n, int step_s, const std::function<std::string(int)>& cells, const std::string& header) {
  std::string text = header + '\n';
  for (int i = 1; i <= n; ++i) text += at(i * step_s) + ',' + cells(i) + '\n';
  return text;
}

double share(const Log& log, std::size_t sensor) { return facts_of(log).sensors[sensor].motion_share().value_or(-1.0); }

}  // namespace

TEST_CASE("gate: one row in a hundred may be left out, with a map too") {
  const auto rows = [](int n_double) {
    std::string text = "time,A\n";
    for (int i = 1; i <= 300; ++i) {
      text += std::to_string(30 * i) + (i % 3 == 0 ? ",1\n" : ",0\n");
      if (i <= n_double) text += std::to_string(30 * i) + ",1\n";
    }
    return text;
  };
  LogMap map;
  map.rows = LogMap::Rows::readings;
  map.interval_s = 30.0;
  CHECK(windows_of(read_log_text(rows(2), map), 30.0).front().starts_with("001001"));
  CHECK_THAT(refusal(rows(4), map), contains("log.csv:3:1: error: 4 of 304 rows would be left out"));
  map.rows = LogMap::Rows::changes;
  map.interval_s.reset();
  std::string back = "time,A\n";
  for (int i = 1; i <= 100; ++i)
    back += std::to_string(i % 20 == 0 ? 10 * i - 300 : 10 * i) + (i % 2 == 0 ? ",1\n" : ",0\n");
  CHECK_THAT(refusal(back, map), contains("5 of 100 rows would be left out; of this one the times step back here"));
}

TEST_CASE("gate: states that are numbers are a count, not unknown") {
  for (const bool is_wide : {true, false}) {
    std::string text = is_wide ? "time,motion\n" : "time,sensor,state\n";
    for (int i = 1; i <= 200; ++i) {
      const int triggers = i % 5 < 3 ? 0 : (i % 5 == 3 ? 1 : i);
      text += at(300 * i + (is_wide ? 0 : 97 * i % 200)) + (is_wide ? "," : ",PIR,") + std::to_string(triggers) + '\n';
    }
    const Log log = settled_by_map(
        text, "'4' is no state of '" + std::string(is_wide ? "motion" : "PIR") + "', as are 40 of its 200 rows");
    CHECK(log.map.states.above == 0.0);
    CHECK(share(log, 0) == Approx(0.4).margin(0.02));
  }
  // A map that names the columns doesn't make unknown what isn't.
  LogMap map;
  map.sensors = {{"PIR", "x"}};
  CHECK_THAT(refusal(stepped(
                         200, 30, [](int i) { return std::to_string(i % 4); }, "time,x"),
                     map),
             contains("'2' is no state"));
}

TEST_CASE("gate: what is known to be unknown is no fault, however long it lasts") {
  const auto outage = [](int i) {
    return std::string(i <= 20 ? "1," : i < 200 ? "unavailable," : ",") + (i / 4 % 2 == 0 ? "0" : "1");
  };
  const Log log = read_log_text(stepped(400, 30, outage, "time,hall_motion,desk_motion"));
  CHECK(facts_of(log).sensors[0].known_s == Approx(600.0));
  CHECK(read_log_text("time,sensor,state\n0,PIR1,on\n60,PIR1,jammed\n600,PIR1,off\n1200,PIR1,on\n").remarks.size() ==
        1);
}

TEST_CASE("gate: times are from 1990 to tomorrow, unless a map names a limit beyond them") {
  const auto rows = [](const std::string& odd, std::int64_t odd_at) {
    std::string text = "time,A\n";
    for (int i = 1; i <= 40; ++i) text += (i == odd_at ? odd : at(30 * i)) + (i / 3 % 2 == 0 ? ",0\n" : ",1\n");
    return text;
  };
  settled_by_map(rows("2094-01-01T00:00:10", 40), "log.csv:41:1: error: its time is 2094-01-01, later than tomorrow");
  // The clock is the reader's: these rows are from a day after the day after.
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("log.csv", rows("", 0));
  const auto read_on = [&](std::int64_t s, const LogMap& map = {}) {
    io::LogObserver observer;
    observer.now_us = (1'772'434'800 + s) * 1'000'000;
    return io::read_log({&file, 1}, map, observer);
  };
  CHECK(read_on(1200 - 86'400).n_rows == 40);
  CHECK_THROWS_WITH(read_on(1199 - 86'400),
                    contains("later than tomorrow") && contains("{pirsim_log: 1, to: 2026-03-03}"));
  LogMap map;
  map.to = "2026-03-03";
  CHECK(read_on(0 - 3 * 86'400, map).n_rows == 40);
  // Simulated days may be tomorrow's.
  const auto own = [](int i) { return std::to_string(30 * i) + ",1," + (i / 4 % 2 == 0 ? "0" : "1"); };
  const std::filesystem::path ours = folder.write("rows.csv", stepped(40, 30, own, "time,time_s,people,A"));
  io::LogObserver long_ago;
  long_ago.now_us = 1'000'000'000'000'000;
  CHECK(io::read_log({&ours, 1}, {}, long_ago).n_rows == 40);
}

TEST_CASE("gate: a week of silence before anything moves isn't known, a later one is said") {
  const auto log_of = [](std::int64_t first_s, std::int64_t later_s) {
    std::string text = "time,sensor,state\n" + at(-first_s) + ",A,off\n" + at(-first_s) + ",B,off\n";
    for (int i = 0; i < 40; ++i)
      text += at((i > 20 ? later_s : 0) + 100 * i) + (i / 2 % 2 == 0 ? ",A," : ",B,") + (i % 2 == 0 ? "on\n" : "off\n");
    return read_log_text(text);
  };
  const std::int64_t day_s = 86'400;
  const Log begun = log_of(58 * day_s, 0);
  CHECK(facts_of(begun).sensors[0].known_s == Approx(3900.0).margin(1.0));
  CHECK(to_text(begun.moment(begun.begin_us), begun.clock) == at(0));
  CHECK_THAT(remarks_of(begun), contains("before anything moves: the log begins behind it"));
  CHECK(log_of(6 * day_s, 0).remarks.empty());
  const Log silent = log_of(0, 8 * day_s);
  CHECK_THAT(remarks_of(silent),
             contains("nothing is written from 2026-03-02 to 2026-03-10") && contains("longest_gap_s: 86400"));
  CHECK(facts_of(silent).sensors[0].known_s == Approx(static_cast<double>(8 * day_s + 3900)).margin(1.0));
}

TEST_CASE("gate: an hour that stands twice needs a zone, of readings and of events") {
  std::mt19937 random(5);
  std::string readings = "time,hall_motion\n", events = "time,sensor,state\n";
  const std::int64_t midnight = 1'761'436'800 - 1'772'434'800;  // 2025-10-26T00:00
  std::vector<int> bits;
  for (int minute = 1; minute <= 360; ++minute) {  // clocks in Berlin are put back at 03:00
    const std::string time = at(midnight + 60 * (minute >= 180 ? minute - 60 : minute));
    bits.push_back(random() % 3 == 0 ? 1 : 0);
    readings += time + ',' + std::to_string(bits.back()) + '\n';
    if (minute == 1 || bits[bits.size() - 2] != bits.back())
      events += time + ",hall_motion," + std::to_string(bits.back()) + '\n';
  }
  const Log from_readings = settled_by_map(readings, "stand in it a second time: clocks were put back"),
            from_events = settled_by_map(events, "stand in it a second time: clocks were put back");
  std::string truth;
  for (const int bit : bits) truth += bit == 0 ? '0' : '1';
  CHECK(windows_of(from_readings, 60.0).front() == truth);
  CHECK(windows_of(from_events, 60.0).front().substr(0, 358) == truth.substr(0, 358));
  // One row that comes late, and two files in any order, are no clock's.
  std::string late = "time,sensor,state\n";
  for (int i = 0; i < 60; ++i) late += at(i == 30 ? 100 * i - 850 : 100 * i) + (i % 2 == 0 ? ",A,on\n" : ",A,off\n");
  CHECK_THAT(remarks_of(read_log_text(late)), contains("its events are put in order"));
  const TemporaryFolder folder;
  const auto part = [&](const char* name, int from_s) {
    std::string text = "time,sensor,state\n";
    for (int i = 0; i < 12; ++i) text += at(from_s + 100 * i) + (i % 2 == 0 ? ",A,on\n" : ",A,off\n");
    return folder.write(name, text);
  };
  const std::vector<std::filesystem::path> files{part("b.csv", 1200), part("a.csv", 0)};
  CHECK(io::read_log(files).remarks.empty());
}

TEST_CASE("gate: a column that never repeats names no sensor") {
  std::string intervals = "id,start,end,room\n", events = "time,id,room,state\n";
  double hall_s = 0.0;
  for (int i = 0; i < 40; ++i) {
    const bool is_hall = i % 3 == 0;
    const int length = 10 + 7 * i % 40;
    hall_s += is_hall ? length : 0;
    intervals +=
        std::to_string(900 + i) + ',' + at(100 * i) + ',' + at(100 * i + length) + (is_hall ? ",hall\n" : ",desk\n");
  }
  const Log log = settled_by_map(intervals, "'id' is another one in each row, so that it names no sensor");
  REQUIRE(sensors_of(log) == Texts{"desk", "hall"});
  CHECK(facts_of(log).sensors[1].motion_s == Approx(hall_s));
  LogMap map;
  map.sensor_column = {"id"};
  CHECK_THAT(refusal(intervals, map), contains("it names no sensor"));
  intervals += intervals.substr(intervals.rfind('\n', intervals.size() - 2) + 1);  // the last row once more
  CHECK_THAT(refusal(intervals, map), contains("'id' is another one in nearly each row"));
}

TEST_CASE("gate: a further column that tells two sensors apart belongs to the name") {
  const unsigned longest_s = GENERATE(200U, 30U);  // of motion: two sensors overlap often, or one time in ten
  std::mt19937 random(7);
  std::vector<std::tuple<int, int, int, int>> events;  // second, node, child, state
  std::array<double, 3> motion_s{};
  for (int sensor = 0; sensor < 3; ++sensor) {
    for (int s = 0; s < 20'000;) {
      const int on = s + 20 + static_cast<int>(random() % 300);
      const int off = on + 20 + static_cast<int>(random() % longest_s);
      events.emplace_back(on, sensor / 2, sensor == 1 ? 1 : 0, 1);
      events.emplace_back(off, sensor / 2, sensor == 1 ? 1 : 0, 0);
      motion_s[static_cast<std::size_t>(sensor)] += off - on;
      s = off;
    }
  }
  std::ranges::sort(events);
  std::string one = "time,node,child,value\n", tagged = "name,tags,time,value\n", beat = "time,entity_id,state,note\n";
  for (const auto& [s, node, child, state] : events) {
    if (node == 0) one += at(s) + ",7," + std::to_string(child) + ',' + std::to_string(state) + '\n';
    if (node == 0)
      tagged += std::string("state,") + (child == 0 ? "id=a," : "id=b,") + at(s) + ',' + std::to_string(state) + '\n';
    if (node == 1)
      beat +=
          at(s) + ",PIR,1," + (s % 2 == 0 ? "x" : "y") + '\n' + at(s + 1) + ",PIR," + std::to_string(state) + ",x\n";
  }
  const Log children = settled_by_map(one, "names a sensor that goes on while it is on"),
            tags = settled_by_map(tagged, "and 'tags' tells two apart");
  for (const Log* log : {&children, &tags}) {
    REQUIRE(log->sensors.size() == 2);
    CHECK(facts_of(*log).sensors[0].pulses.n > 40);
    CHECK(share(*log, 0) == Approx(motion_s[0] / 20'000).margin(0.02));
    CHECK(share(*log, 1) == Approx(motion_s[1] / 20'000).margin(0.02));
  }
  CHECK(read_log_text(beat).sensors.size() == 1);  // an `on` that is said again tells no two
}

TEST_CASE("gate: a sensor that is on most of the time, or when all others are off, is asked about") {
  const auto told = [](const std::function<std::string(int)>& cells) {
    return remarks_of(read_log_text(stepped(1000, 30, cells, "time,hall_motion,desk_motion,wc_motion")));
  };
  const auto bit = [](bool is_on) { return std::string(is_on ? "1" : "0"); };
  // At work from reading 300 to 700: a busy office moves for six tenths of it.
  const auto busy = [&](int i, int of_ten) { return i > 300 && i <= 700 && i * 7 % 10 < of_ten; };
  CHECK(told([&](int i) { return bit(busy(i, 6)) + ',' + bit(busy(i, 3)) + ',' + bit(busy(i + 3, 2)); }).empty());
  CHECK_THAT(told([&](int i) { return bit(!busy(i, 3)) + ',' + bit(busy(i, 4)) + ',' + bit(busy(i + 3, 2)); }),
             contains("'hall_motion' is on for 88 % of the time: does its 0 tell motion?"));
  const auto at_night = [&](int i) { return i > 400; };
  CHECK_THAT(told([&](int i) {
               return bit(at_night(i) || i % 4 == 0) + ',' + bit(i <= 400 && i % 2 == 0) + ',' +
                      bit(i <= 400 && i % 3 != 0);
             }),
             contains("of the time in which all others are off: does its 0 tell motion?"));
}

TEST_CASE("gate: a sensor that falls silent when another one begins may have been renamed") {
  const auto log_of = [](int last) {
    std::string text = "entity_id,state,last_changed\nbinary_sensor.desk_motion,off," + at(0) +
                       "\nbinary_sensor.hall_motion,off," + at(0) + '\n';
    for (int i = 1; i < 120; ++i) {
      const std::string state = i % 2 == 1 ? ",on," : ",off,";
      text += std::string(i <= last ? "binary_sensor.hall_motion" : "binary_sensor.corridor_motion") + state +
              at(100 * i) + '\n';
      text += "binary_sensor.desk_motion" + state + at(100 * i + 40) + '\n';
    }
    return remarks_of(read_log_text(text));
  };
  CHECK_THAT(
      log_of(40),
      contains("'binary_sensor.hall_motion' says nothing for the last 2.2 h, which counts as still") &&
          contains(
              R"(sensors: {"binary_sensor.hall_motion": ["binary_sensor.hall_motion", "binary_sensor.corridor_motion"]})"));
  CHECK(log_of(100).empty());  // half an hour of silence is no long one
  CHECK(log_of(120).empty());
}

TEST_CASE("gate: a count that falls below 0 is a count, and what is called so and isn't one is named") {
  const auto counts = [](const std::function<std::string(int)>& count) {
    return read_log_text(stepped(
        300, 30, [&](int i) { return std::string(i % 7 < 2 ? "1," : "0,") + count(i); },
        "time,hall_motion,people_count"));
  };
  const Log log = counts([](int i) { return std::to_string(i == 150 ? -1 : i / 60); });
  REQUIRE(log.people);
  CHECK(LogWindows(log, 30.0).rows().n_counted() == 299);
  CHECK_THAT(remarks_of(log), contains("'-1' is no number of people of 'people_count': it counts as unknown"));
  const Log odd = counts([](int i) { return std::to_string(0.5 * i); });
  CHECK_FALSE(odd.people);
  CHECK_THAT(remarks_of(odd),
             contains("column 'people_count' isn't read: '0.500000' and more are no numbers of people"));
  // Counts of another entity than the sensors', with a map.
  std::string text = "time,entity,state\n";
  for (int i = 1; i <= 100; ++i)
    text += at(60 * i) + ",X," + std::to_string(i % 4 - 1) + '\n' + at(60 * i + 7) + ",dev0," + std::to_string(i % 2) +
            '\n';
  LogMap map;
  map.people = "X";
  CHECK_THAT(refusal(text, map), contains("'-1' is no number of people of 'X', as are 25 of its 100 rows"));
}

TEST_CASE("gate: what is called motion and can't be read is named, and nothing else takes its place") {
  const auto rows = [](const std::string& header, const std::string& cell) {
    return stepped(
        100, 30, [&](int i) { return cell + (i / 5 % 2 == 0 ? ",0" : ",1"); }, header);
  };
  const Log heated =
      settled_by_map(rows("time,room_motion,heating", "ready"),
                     "'room_motion' is called a motion sensor, and none of its cells tells whether it is on");
  CHECK(sensors_of(heated) == Texts{"heating"});
  CHECK_THAT(remarks_of(read_log_text(rows("time,room_motion,hall_motion", "ready"))),
             contains("'room_motion' is called a motion sensor"));
}

namespace {

/// Of two sensors that begin at 0, another one every 100 s: a line for each change.
std::string changes(const std::string& header, const std::function<std::string(const std::string&, bool)>& line,
                    const std::function<std::string(int)>& time = at) {
  std::string text = header.empty() ? std::string() : header + '\n';
  for (int i = 0; i < 80; ++i) {
    const bool is_on = i / 2 % 2 == 1;
    text += line(time(100 * i + (is_on ? 30 : 0)), is_on);
    text.replace(text.rfind('@'), 1, i % 2 == 0 ? "hall" : "desk");
    text += '\n';
  }
  return text;
}
/// Both are on from 230 to 400 s, and so on.
bool is_right(const Log& log) {
  return log.sensors.size() == 2 && std::abs(share(log, 0) - 0.42) < 0.02 && std::abs(share(log, 1) - 0.43) < 0.02;
}

}  // namespace

TEST_CASE("gate: of an old and a new state in each row the new one is read, or asked for") {
  const auto word = [](bool is_on) { return std::string(is_on ? "on" : "off"); };
  for (const char* header : {"time,sensor,from,to", "time,sensor,old,new", "time,sensor,previous,current",
                             "time,sensor,before,after", "time,sensor,from_state,to_state", "time,sensor,alt,neu"}) {
    CAPTURE(header);
    CHECK(is_right(read_log_text(
        changes(header, [&](const std::string& time, bool on) { return time + ",@," + word(!on) + ',' + word(on); }))));
  }
  CHECK(is_right(read_log_text(changes("time,sensor,state,old", [&](const std::string& time, bool on) {
    return time + ",@," + word(on) + ',' + word(!on);
  }))));
  const std::string sentences = changes(
      "", [&](const std::string& time, bool on) { return time + " @ changed from " + word(!on) + " to " + word(on); });
  CHECK_THAT(refusal(sentences),
             contains("each row") && contains(R"(state: "column 5")") && contains(R"(state: "column 7")"));
  CHECK(is_right(read_log_text(
      sentences, io::parse_log_map(R"({pirsim_log: 1, form: events, sensor: "column 2", state: "column 7"})", "map"))));
  // Without names: a state that is told again tells which is the old one.
  std::string beat;
  std::array<bool, 2> last{};
  for (int i = 0; i < 120; ++i) {
    const auto sensor = static_cast<std::size_t>(i % 2);
    const bool is_on = i / 6 % 2 == 1;
    beat += at(7 * i * i) + (sensor == 0 ? ",hall," : ",desk,") + word(last[sensor]) + ',' + word(is_on) + '\n';
    last[sensor] = is_on;
  }
  const Log log = read_log_text(beat);
  REQUIRE(log.sensors.size() == 2);
  CHECK(log.sensors[0].changes.back().us - log.begin_us == 92'575'000'000);  // of row 115, not of 117
}

TEST_CASE("gate: a column that tells motion from other things belongs to the name") {
  std::mt19937 random(5);
  std::string rows = "time,device,type,state\n", kinds = "time,device,class,state\n",
              words = "time,device,text,state\n";
  for (int i = 0; i < 200; ++i) {
    const std::string bit = std::to_string(i / 2 % 2), name = i % 2 == 0 ? ",hall," : ",desk,";
    rows += at(100 * i) + name + "motion," + bit + '\n';
    if (i % 3 == 0) rows += at(100 * i + 20) + name + "light," + std::to_string(random() % 2) + '\n';
    kinds += at(100 * i) + (i % 2 == 0 ? ",N1,motion," : ",N2,contact,") + bit + '\n';
    words += at(100 * i) + name + (i / 2 % 2 == 0 ? "quiet," : "motion,") + bit + '\n';
  }
  const Log log = settled_by_map(rows, "'type' tells motion from other things, and isn't read");
  CHECK(sensors_of(log) == Texts{"desk_motion", "hall_motion"});
  CHECK(share(log, 0) == Approx(0.5).margin(0.02));
  CHECK(sensors_of(settled_by_map(kinds, "'class' tells motion from other things")) == Texts{"N1_motion"});
  CHECK(sensors_of(read_log_text(words)) == Texts{"desk", "hall"});  // the text says the state again
}

TEST_CASE("gate: of a home's entities binary sensors are sensors, but not those that tell of the sensor itself") {
  std::string text = "entity_id,state,last_changed\n";
  for (int i = 0; i < 60; ++i) {
    for (const char* entity :
         {"binary_sensor.hall_motion", "light.motion_night_light", "automation.motion_lights", "input_boolean.motion",
          "binary_sensor.hall_motion_tamper", "binary_sensor.hall_motion_low_battery", "binary_sensor.motion_led",
          "binary_sensor.hall_motion_connectivity", "binary_sensor.hall_occupancy_problem", "sensor.desk_motion"})
      text += std::string(entity) + (i % 2 == 0 ? ",off," : ",on,") + at(100 * i) + '\n';
  }
  const Log log = read_log_text(text);
  CHECK(sensors_of(log) == Texts{"binary_sensor.hall_motion", "sensor.desk_motion"});
  CHECK(log.remarks.empty());
}

TEST_CASE("gate: what is called vacant, or idle, is turned round by a map alone") {
  for (const char* name : {"hall_vacant", "no_motion_hall", "hall unoccupied", "frei Flur", "idle", "HallClear"}) {
    for (const bool is_word : {false, true}) {
      const auto cells = [&](int i) {
        return std::string(i % 4 == 0 ? (is_word ? "false" : "0") : (is_word ? "true" : "1"));
      };
      const std::string rows = stepped(200, 30, cells, std::string("time,") + name);
      CHECK(share(settled_by_map(rows, "the contrary of motion"), 0) == Approx(0.25));
      LogMap as_it_is;
      as_it_is.states = {{"1", "true"}, {"0", "false"}, {}};
      CHECK(share(read_log_text(rows, as_it_is), 0) == Approx(0.75));
    }
  }
  const auto both = [](int i) { return std::string(i % 4 == 0 ? "0,1" : i % 4 == 1 ? "0,0" : "1,0"); };
  CHECK(sensors_of(settled_by_map(stepped(200, 30, both, "time,desk_vacant,hall"), "'desk_vacant'")) == Texts{"hall"});
  CHECK(is_right(settled_by_map(
      changes("time,room,vacant", [](const std::string& time, bool on) { return time + ",@," + (on ? "no" : "yes"); }),
      "the contrary of motion")));
}

TEST_CASE("gate: a state that isn't a device's, and seconds since motion, are no motion") {
  const std::string online = changes("time,device,status,motion", [](const std::string& time, bool on) {
    return time + ",@," + (time.ends_with("00") ? "online" : "offline") + (on ? ",1" : ",0");
  });
  CHECK(is_right(read_log_text(online)));
  const auto since = [](int i) { return std::to_string(i % 9); };
  CHECK_THAT(refusal(stepped(200, 60, since, "time,minutes_since_motion")),
             contains("no column is a motion sensor's") && !contains("above"));
}
