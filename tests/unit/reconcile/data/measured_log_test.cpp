// Logs as measured data, against windows that were filled by hand.
#include "reconcile/data/measured.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "support/catch.hpp"
#include "support/log_files.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;
using namespace pirsim::test;

namespace {

SceneSpec two_sensors() {
  SceneSpec scene;
  for (const char* name : {"PIR1", "PIR2"}) scene.sensors.emplace_back().id = name;
  return scene;
}

/// Two people all the time, from eight o'clock on.
ScriptSpec hour(double window_s, int people = 2) {
  ScriptSpec script = script_of({});
  script.sensing.tick_rate_hz = 10;
  script.sensing.ticks_per_window = static_cast<int>(10 * window_s);
  CountsSpec& counts = script.trials.front().occupancy.emplace().counts.emplace();
  counts.begin = "2026-03-02T08:00:00";
  counts.times_s = {0.0, 1800.0, 3600.0};
  counts.people = {people, people, people};
  return script;
}

std::string clock(int second) {
  std::ostringstream text;
  text << "2026-03-02T0" << 8 + second / 3600 << ':' << (second / 600) % 6 << (second / 60) % 10 << ':'
       << (second / 10) % 6 << second % 10;
  return text.str();
}

/// Bits of all parts, a part after the other, without what separates them.
std::vector<std::uint8_t> bits_of(const Measured& measured, std::size_t sensor) {
  std::vector<std::uint8_t> bits;
  for (const Series& run : measured.runs) {
    for (std::size_t i = sensor; i < run.bits.size(); i += 2) {
      if (run.bits[i] != unknown_bit) bits.push_back(run.bits[i]);
    }
  }
  return bits;
}

/// The note with these words in it; empty if there is none.
std::string note(const Measured& measured, const std::string& words) {
  for (const std::string& one : measured.notes) {
    if (one.find(words) != std::string::npos) return one;
  }
  return {};
}

}  // namespace

TEST_CASE("Readings of a wide log stand where the script's windows are", "[measured]") {
  std::string text = "time,PIR1,PIR2,people\n";
  std::vector<std::uint8_t> wanted;
  for (int i = 1; i <= 120; ++i) {
    const int bit = i % 5 == 0 ? 1 : 0;
    text += clock(30 * i) + "," + std::to_string(bit) + ",0," + std::to_string(i <= 20 ? 1 : 2) + "\n";
    wanted.push_back(static_cast<std::uint8_t>(bit));
  }
  const Measured measured = measured_of(read_log_text(text), two_sensors(), hour(30.0));
  CHECK(bits_of(measured, 0) == wanted);
  CHECK(std::ranges::count(bits_of(measured, 1), 1) == 0);
  CHECK_THAT(note(measured, "The data count other people"),
             contains("in 20 of 120 windows, first 1 instead of 2 at 2026-03-02T08:00:00."));
  CHECK_FALSE(note(measured, "Read as a log of 120 lines").empty());
}

TEST_CASE("Events fill the windows that they touch, and pulses tell a hold", "[measured]") {
  std::ostringstream text;
  text << "entity_id,state,last_changed\nbinary_sensor.a_motion,off," << clock(0) << "\nbinary_sensor.b_motion,off,"
       << clock(0) << "\n";
  std::vector<std::uint8_t> wanted(120, 0);
  for (int i = 0; i < 40; ++i) {
    const int begin = 90 * i + 7 * (i % 4), end = begin + 12 + (i % 7 == 0 ? 30 : 0);
    text << "binary_sensor.a_motion,on," << clock(begin) << "\nbinary_sensor.a_motion,off," << clock(end) << "\n";
    for (int second = begin; second < end; ++second) wanted[static_cast<std::size_t>(second / 30)] = 1;
  }
  text << "binary_sensor.b_motion,on," << clock(3595) << "\nbinary_sensor.b_motion,off," << clock(3600) << "\n";
  LogMap map;
  map.sensors = {{"PIR1", "binary_sensor.a_motion"}, {"PIR2", "binary_sensor.b_motion"}};
  const SceneSpec scene = two_sensors();
  const Measured measured = measured_of(read_log_text(text.str(), map), scene, hour(30.0));
  CHECK(bits_of(measured, 0) == wanted);
  REQUIRE(measured.holds_s.size() == 2);
  CHECK(measured.holds_s[0] == 12.0);
  CHECK(measured.holds_s[1] == 0.0);  // one pulse is too few
  const ScriptSpec held = with_holds(scene, hour(30.0), measured);
  REQUIRE(held.effects.size() == 1);
  CHECK(held.effects[0].name == "pulse_stretching");
  CHECK(held.effects[0].parameters.at("hold_s") == 12.0);
  CHECK(held.effects[0].choices.at("sensor") == "PIR1");
  CHECK(with_holds(scene, held, measured).effects.size() == 1);
}

TEST_CASE("Logs that can't be compared are refused, with what to do", "[measured]") {
  const auto refusal = [](const std::string& header, double every_s, const ScriptSpec& script) -> std::string {
    std::string text = header + "\n";
    for (int i = 1; i <= 40; ++i) text += clock(static_cast<int>(every_s) * i) + ",1,0\n";
    try {
      static_cast<void>(measured_of(read_log_text(text), two_sensors(), script));
    } catch (const Error& error) {
      CHECK(error.code() == ErrorCode::input);
      return error.what();
    }
    return "nothing";
  };
  CHECK(refusal("time,PIR1,PIR2", 30, hour(30.0)) == "nothing");
  CHECK_THAT(refusal("time,left,right", 30, hour(30.0)), contains("--map"));
  CHECK_THAT(refusal("time,PIR1,PIR2", 30, hour(1.0)), contains("window_s: 30"));
  ScriptSpec without_clock = hour(30.0);
  without_clock.trials.front().occupancy->counts->begin.clear();
  CHECK_THAT(refusal("time,PIR1,PIR2", 30, without_clock), contains("begin: 2026-03-02T08:00:00"));
  ScriptSpec later = hour(30.0);
  later.trials.front().occupancy->counts->begin = "2026-03-05T08:00:00";
  CHECK_THAT(refusal("time,PIR1,PIR2", 30, later), contains("nothing of the log"));
}

TEST_CASE("Rows with a local time belong to the day that it is", "[measured]") {
  ScriptSpec script = hour(30.0);
  OccupancySpec& occupancy = *script.trials.front().occupancy;
  occupancy.counts->begin = "2026-03-02T00:00:00";
  occupancy.counts->times_s = {8 * 3600.0, 9 * 3600.0, 86400 + 8 * 3600.0, 86400 + 9 * 3600.0};
  occupancy.counts->people = {1, 1, 2, 2};
  occupancy.from_h = 8.0;
  occupancy.to_h = 9.0;
  std::string text = "replicate,time_s,time,people,PIR1,PIR2\n";
  for (int i = 1; i <= 120; ++i) {
    std::string time = clock(30 * i);
    time[9] = '3';  // the second day alone, called the first run
    text += "1," + std::to_string(30 * i) + "," + time + ",2,1,0\n";
  }
  const SceneSpec scene = two_sensors();
  const Measured measured = parse_measured(text, "m.csv", scene, script);
  const StudyFrame frame = frame_of(scene, script);
  for (const Series& run : measured.runs) CHECK(frame.trials[run.trial].starts_with("2 people"));
  CHECK(bits_of(measured, 0).size() == 118);  // but for the first minute, in which the second person may come
  CHECK(note(measured, "The data count other people").empty());
  CHECK_FALSE(note(measured, "The file has nothing of").empty());
  // Without times, runs are days in order.
  std::string third = "replicate,time_s,PIR1,PIR2\n";
  for (int i = 1; i <= 120; ++i) third += "3," + std::to_string(30 * i) + ",1,0\n";
  CHECK_THROWS_WITH(parse_measured(third, "m.csv", scene, script), contains("has 2 days"));
}

TEST_CASE("A log is known by its first line", "[measured]") {
  const TemporaryFolder folder;
  const auto looks_like_log = [&](const std::string& text) { return is_log(folder.write("file.csv", text)); };
  CHECK(looks_like_log("Date,Time,S6_PIR\n"));
  CHECK(looks_like_log("entity_id,state,last_changed\n"));
  CHECK(looks_like_log("2026-03-02 08:00:00 M001 ON\n"));
  CHECK(looks_like_log("start,end,sensor\n"));
  CHECK(looks_like_log("[08:37:08][D][binary_sensor:036]: 'PIR': Sending state ON\n"));
  CHECK(looks_like_log("\"Plot Title: Room 12\"\n"));
  CHECK(looks_like_log(std::string("SQLite format 3") + '\0'));
  CHECK_FALSE(looks_like_log("replicate,trial,time_s,time,PIR1\n"));
  CHECK_FALSE(looks_like_log("trial,sensor,seconds\n"));
  CHECK_FALSE(looks_like_log("trial,tim_s,PIR1\n"));
  CHECK_FALSE(looks_like_log(""));
}
