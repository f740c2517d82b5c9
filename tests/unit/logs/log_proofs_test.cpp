// How a log's form is proven, or refused with the maps that settle it.
#include <algorithm>

#include "pirsim/log.hpp"
#include "support/catch.hpp"
#include "support/log_files.hpp"

using namespace pirsim;
using Texts = std::vector<std::string>;

namespace {

/// The maps that a refusal names.
Texts maps_in(const std::string& message) {
  Texts maps;
  for (std::size_t at = 0; (at = message.find("{pirsim_log: 1, ", at)) != std::string::npos; ++at) {
    std::size_t end = at, depth = 0;
    do {
      depth += message[end] == '{' ? 1 : 0;
      depth -= message[end] == '}' ? 1 : 0;
    } while (depth > 0 && ++end < message.size());
    maps.push_back(message.substr(at, end + 1 - at));
  }
  return maps;
}
std::string refusal_of_log(const std::string& text) {
  try {
    (void)read_log_text(text);
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::input);
    return error.what();
  }
  FAIL("it was read:\n" << text.substr(0, 400));
  return {};
}
/// Refused, and read by each of the maps that the refusal names.
std::vector<Log> settled(const std::string& text) {
  const std::string message = refusal_of_log(text);
  CAPTURE(message);
  std::vector<Log> logs;
  for (const std::string& map : maps_in(message)) {
    CAPTURE(map);
    logs.push_back(read_log_text(text, io::parse_log_map(map, "map")));
  }
  REQUIRE(logs.size() >= 2);
  return logs;
}

/// A row a change of one sensor whose hold makes half of all steps equal.
std::string held(const std::string& header) {
  std::string text = header;
  int at = 0;
  for (int i = 0; i < 40; ++i) {
    text += std::to_string(at) + (i % 2 == 0 ? ",on\n" : ",off\n");
    at += i % 2 == 0 ? 90 : 60 + 37 * (i % 11);
  }
  return text;
}

}  // namespace

TEST_CASE("rows that alternate at any step are changes, also where a hold makes half of the steps equal") {
  const Log log = read_log_text(held("last_changed,state\n"));
  CHECK_FALSE(log.has_readings());
  CHECK(log.map.people_mean == LogMap::People::none);
  // On for the first 90 s of each pulse: the truth since it was made.
  CHECK(windows_of(log, 30.0).front().starts_with("1110"));
  // The same steps, in which mostly nothing changes, are no changes, and no readings.
  std::string quiet = "time,A\n";
  for (int i = 0, at = 0; i < 40; at += i % 2 == 0 ? 90 : 60 + 37 * (i % 11), ++i)
    quiet += std::to_string(at) + (i == 20 ? ",1\n" : ",0\n");
  const std::vector<Log> logs = settled(quiet);
  CHECK(logs[0].has_readings());
  CHECK_FALSE(logs[1].has_readings());
}

TEST_CASE("a cadence makes readings, also with lost rows, gaps and seconds that are rounded") {
  for (const int lost : {0, 5}) {
    std::string text = "time,A,B\n";
    for (int i = 1; i < 200; ++i) {
      if (lost > 0 && i % lost == 3) continue;
      text += std::to_string(30 * i + (i % 3 == 0 ? 1 : 0) + (i > 100 ? 3600 : 0)) + ',' + std::to_string(i / 4 % 2) +
              ',' + std::to_string(i / 7 % 2) + '\n';
    }
    const Log log = read_log_text(text);
    CHECK(log.interval_us / 1'000'000 == 30);
  }
}

TEST_CASE("rows that change one sensor each at equal steps may be both") {
  std::string text = "time,A\n";
  for (int i = 0; i < 20; ++i) text += std::to_string(30 * i) + (i % 2 == 0 ? ",0\n" : ",1\n");
  const std::vector<Log> logs = settled(text);
  CHECK(windows_of(logs[0], 30.0).front().starts_with("0101"));
  CHECK_FALSE(logs[1].has_readings());
}

TEST_CASE("few rows at any step aren't readings") {
  const std::vector<Log> logs = settled(
      "time,hall_motion\n2025-03-05 00:00:00,0\n2025-03-05 10:00:00,1\n2025-03-05 10:30:00,0\n2025-03-05 "
      "23:59:00,0\n");
  CHECK(windows_of(logs[1], 1800.0).front() == std::string(20, '0') + "1" + std::string(26, '0') + ".");
  CHECK_FALSE(read_log_text("time,A\n0,0\n100,1\n130,0\n400,1\n433,0\n").has_readings());
}

TEST_CASE("a beat, and rows between its beats that change something, are changes") {
  std::string text = "time,A\n";
  for (int i = 0; i < 60; ++i) {
    text += std::to_string(60 * i) + "," + (i % 10 == 5 ? "1" : "0") + "\n";
    if (i % 10 == 4) text += std::to_string(60 * i + 17) + ",1\n";
    if (i % 10 == 5) text += std::to_string(60 * i + 23) + ",0\n";
  }
  const Log log = read_log_text(text);
  CHECK_FALSE(log.has_readings());
  CHECK(windows_of(log, 1.0).front().substr(250, 100) ==
        std::string(7, '0') + std::string(66, '1') + std::string(27, '0'));
}

TEST_CASE("a table of devices and states with further columns tells events of devices") {
  const auto rows = [](const std::string& header, const std::string& more) {
    std::string text = header + '\n';
    for (int i = 0; i < 24; ++i)
      text += std::to_string(1772438400 + 41 * i + i % 5) + (i / 2 % 2 == 0 ? ",hall" : ",desk") +
              (i % 2 == 0 ? ",true" : ",false") + more + '\n';
    return text;
  };
  const Texts expected = windows_of(read_log_text(rows("time,device,state", "")), 10.0);
  for (const auto& [header, more] : {std::pair{"timestamp,room,motion,light", ",0"},
                                     {"time,device,occupancy,battery_low,tamper", ",false,false"},
                                     {"ts,id,val,ack,q", ",true,0"},
                                     {"when,who,what,note", ",x"}}) {
    const Log log = read_log_text(rows(header, more));
    CAPTURE(header);
    CHECK(log.map.form == LogMap::Form::events);
    CHECK(sensors_of(log) == Texts{"desk", "hall"});
    CHECK(windows_of(log, 10.0) == expected);
  }
  // Two columns of states, or two of names, that say different things.
  std::string states = "time,device,motion,occupancy\n", names = "time,device,sensor,state\n";
  for (int i = 0; i < 24; ++i) {
    const std::string at = std::to_string(1772438400 + 41 * i), bit = std::to_string(i / 2 % 2);
    states += at + (i % 2 == 0 ? ",hall," : ",desk,") + bit + ',' + std::to_string(i / 5 % 2) + '\n';
    names += at + (i % 2 == 0 ? ",hall," : ",desk,") + (i / 3 % 2 == 0 ? "a," : "b,") + bit + '\n';
  }
  CHECK(settled(states).front().map.state_column == "motion");
  CHECK(settled(names).front().map.sensor_column == Texts{"device"});
}

TEST_CASE("sensors that are numbers are no times, and no states") {
  std::string ids = "", wide = "time,3,7\n", named = "id,time,state\n";
  for (int i = 0; i < 24; ++i) {
    const std::string at = std::to_string(1772438400 + 41 * i + i % 7), bit = std::to_string(i / 2 % 2);
    ids += (i % 2 == 0 ? "3," : "7,") + at + ',' + bit + '\n';
    named += (i % 2 == 0 ? "0," : "1,") + at + ',' + bit + '\n';
    wide += std::to_string(30 * i + 30) + ',' + bit + ",0\n";
  }
  CHECK(sensors_of(read_log_text(ids)) == Texts{"3", "7"});
  CHECK(sensors_of(read_log_text(named)) == Texts{"0", "1"});
  CHECK(sensors_of(read_log_text(wide)) == Texts{"3", "7"});
  CHECK(read_log_text(ids).clock == LogClock::zoned);
  // Seconds of the log's own beside another column that grows.
  std::string rows;
  for (int i = 0; i < 20; ++i)
    rows += std::to_string(i) + ',' + std::to_string(30 * i) + ',' + std::to_string(i / 3 % 2) + '\n';
  CHECK(settled(rows)[1].interval_us == 30'000'000);
}

TEST_CASE("columns beside the names of sensors: days of the week aren't devices") {
  std::string text = "time,weekday,motion\n";
  for (int i = 0; i < 400; ++i)
    text += std::to_string(1772438400 + 3600 * i) + (i / 24 % 2 == 0 ? ",Monday," : ",Tuesday,") +
            std::to_string(i / 5 % 2) + '\n';
  const Log log = read_log_text(text);
  CHECK(log.has_readings());
  CHECK(log.others == Texts{"weekday"});
}

TEST_CASE("words of sentences are no table") {
  CHECK_THROWS_WITH(
      read_log_text("2026-03-02 08:00:00 motion detected in hall\n2026-03-02 08:01:00 no motion in hall\n"),
      contains("words, not a table: write a line a change"));
}

TEST_CASE("what is called occupancy or presence is a sensor, unless a map says that it is the truth") {
  const auto rows = [](const std::string& header) {
    const auto bit = [&](int i) {
      return std::string(header.ends_with("detected") ? (i % 2 == 0 ? "off" : "on") : (i % 2 == 0 ? "0" : "1"));
    };
    std::string text = header + '\n';
    for (int i = 1; i < 40; ++i)
      text +=
          (header.starts_with("A") ? "0," : "") + std::to_string(10 * i) + ',' + bit(i / 3) + ',' + bit(i / 5) + '\n';
    return text;
  };
  const Log two = read_log_text(rows("time,hall_occupancy,desk_occupancy"));
  CHECK(sensors_of(two) == Texts{"hall_occupancy", "desk_occupancy"});
  CHECK_FALSE(two.people);
  const std::vector<Log> logs = settled(rows("time,hall_motion,room_occupancy"));
  CHECK(sensors_of(logs[0]) == Texts{"hall_motion", "room_occupancy"});
  CHECK_FALSE(logs[0].people);
  CHECK(sensors_of(logs[1]) == Texts{"hall_motion"});
  CHECK(logs[1].map.people_mean == LogMap::People::presence);
  // A map's sensors are sensors, whatever they are called.
  LogMap map;
  map.sensors = {{"hall", "hall_occupancy"}};
  const Log mapped = read_log_text(rows("time,hall_occupancy,people"), map);
  CHECK(sensors_of(mapped) == Texts{"hall"});
  CHECK(mapped.people);
  CHECK(settled(rows("A,time,people,occupants")).size() == 3);
  CHECK(sensors_of(settled(rows("time,A,occupants_detected"))[0]) == Texts{"A", "occupants_detected"});
}

TEST_CASE("one column that is always the other's opposite is no second sensor") {
  std::string text = "time,moving,resting\n";
  for (int i = 1; i < 40; ++i) text += std::to_string(10 * i) + (i / 3 % 2 == 0 ? ",0,1\n" : ",1,0\n");
  CHECK(sensors_of(settled(text)[0]) == Texts{"moving"});
}

TEST_CASE("a column of states that no name calls motion, beside ones that are called so, is left out and told") {
  const auto rows = [](const std::string& header) {
    std::string text = header + '\n';
    for (int i = 1; i < 40; ++i)
      text += std::to_string(10 * i) + ',' + std::to_string(i / 3 % 2) + ',' + std::to_string(i / 7 % 2) + '\n';
    return text;
  };
  const Log log = read_log_text(rows("time,hall_motion,Anwesenheit"));
  CHECK(sensors_of(log) == Texts{"hall_motion"});
  REQUIRE(log.remarks.size() == 1);
  CHECK(log.remarks.front().message.starts_with("column 'Anwesenheit' holds states"));
  CHECK(sensors_of(read_log_text(rows("time,hall,Anwesenheit"))).size() == 2);
  CHECK(sensors_of(read_log_text(rows("time_s,hall_motion,desk"))).size() == 2);  // pirsim's own
  CHECK(read_log_text(rows("time,hallMotion,frontDoor")).remarks.empty());
  CHECK(read_log_text(rows("time,hallMotion,personCount")).people);
}

TEST_CASE("few changes between a beat's steps may be changes or readings") {
  std::string text = "time,A\n";
  for (int i = 0; i < 60; ++i) {
    text += std::to_string(60 * i) + (i >= 5 && i < 7 ? ",1\n" : ",0\n");
    if (i == 4 || i == 6) text += std::to_string(60 * i + 17) + (i == 4 ? ",1\n" : ",0\n");
  }
  CHECK(settled(text)[0].has_readings());
}

TEST_CASE("a table whose series were joined by time: an empty cell is no change") {
  std::string joined = "Time,hall,desk\n0,0,0\n", events = "time,sensor,state\n0,hall,0\n0,desk,0\n";
  for (int i = 1; i < 40; ++i) {
    const std::string at = std::to_string(45 * i + 11 * (i % 4)), bit = std::to_string((i + 1) / 2 % 2);
    joined += at + (i % 2 == 0 ? "," + bit + "," : ",," + bit) + '\n';
    events += at + (i % 2 == 0 ? ",hall," : ",desk,") + bit + '\n';
  }
  const Log log = read_log_text(joined);
  CHECK(log.map.empty == LogMap::Empty::unchanged);
  LogMap map;
  map.sensors = {{"hall", "hall"}, {"desk", "desk"}};
  CHECK(windows_of(log, 10.0) == windows_of(read_log_text(events, map), 10.0));
  // Cells that are empty now and then, and don't alternate, tell nothing of it.
  std::string holes = "time,A,B\n";
  for (int i = 1; i < 60; ++i)
    holes += std::to_string(30 * i) + (i % 2 == 0 ? "," : ",1") + (i % 7 == 0 ? ",1" : ",0") + '\n';
  const std::vector<Log> logs = settled(holes);
  CHECK(windows_of(logs[0], 30.0)[0].substr(0, 4) == "1111");
  CHECK(windows_of(logs[1], 30.0)[0].substr(0, 4) == "1.1.");
}

TEST_CASE("people of a map are an entity of the log, and no sensor") {
  const std::string text =
      "time,entity,state\n0,dev0,off\n1,X,1\n3,dev0,on\n4,dev1,on\n5,X,0\n9,dev1,off\n11,dev0,off\n12,X,1\n";
  LogMap map;
  map.people = "X";
  const Log log = read_log_text(text, map);
  CHECK(log.sensors.size() == 2);
  REQUIRE(log.people);
  map.people = "Y";
  CHECK_THROWS_WITH(read_log_text(text, map), contains("the log has no events of 'Y'"));
  map.people = "X";
  map.sensors = {{"A", "X"}};
  CHECK_THROWS_WITH(read_log_text(text, map), contains("'X' can't be a sensor and the people"));
  map.sensors.clear();
  map.form = LogMap::Form::events;
  map.sensor_column = {"entity"}, map.state_column = "state";
  CHECK_THROWS_WITH(read_log_text("time,entity,state\n0,X,2\n5,X,3\n", map), contains("no motion sensor is in it"));
}

TEST_CASE("events newest first are read from their end, also those of one second") {
  const std::string forward[] = {"0,A,off", "5,A,on",   "5,A,off", "9,A,on",
                                 "9,A,off", "20,B,off", "21,B,on", "30,B,off"};
  std::string oldest_first = "time,sensor,state\n", newest_first = oldest_first;
  for (const std::string& line : forward) oldest_first += line + "\n";
  for (auto line = std::rbegin(forward); line != std::rend(forward); ++line) newest_first += *line + "\n";
  CHECK(read_log_text(newest_first).sensors[0].changes == read_log_text(oldest_first).sensors[0].changes);
  CHECK(read_log_text(oldest_first).sensors[0].changes.back().value == log_state::off);
}

TEST_CASE("a sensor that is never available isn't another one's opposite") {
  std::string text = "time,hall_motion,desk_motion\n";
  for (int i = 1; i <= 40; ++i) text += std::to_string(30 * i) + (i / 3 % 2 == 0 ? ",0" : ",1") + ",unavailable\n";
  CHECK(read_log_text(text).sensors.size() == 2);
}

TEST_CASE("a table of many columns of states is read in time that grows with its cells") {
  std::string text = "time";
  for (int k = 0; k < 300; ++k) text += ",c" + std::to_string(k);
  for (int i = 0; i < 300; ++i) {
    text += "\n" + std::to_string(30 * i);
    for (int k = 0; k < 300; ++k) text += (i / (2 + k % 7)) % 2 == 0 ? ",0" : ",1";
  }
  CHECK(read_log_text(text + "\n").sensors.size() == 300);  // minutes, if each pair of columns is compared
}

TEST_CASE("times of day that run over midnight need a date") {
  const std::string evening =
      "time,sensor,state\n21:00:00,hall_motion,off\n22:00:00,hall_motion,on\n23:00:00,hall_motion,off\n";
  CHECK(read_log_text(evening).sensors.size() == 1);
  CHECK_THAT(refusal_of_log(evening + "01:00:00,hall_motion,on\n"), contains("step back over midnight"));
}

TEST_CASE("rows of changes that step back are left out, and told") {
  LogMap map;
  map.rows = LogMap::Rows::changes;
  const Log log = read_log_text("time,A,B\n0,0,0\n20,1,0\n10,1,1\n30,0,0\n", map);
  CHECK(windows_of(log, 10.0) == Texts{"001.", "000."});
  CHECK(log.remarks.front().message == "the times step back here: the row is left out");
}

TEST_CASE("a word that is no state ends what is known, from the first event on") {
  const Log log = read_log_text(
      "time,sensor,state\n0,PIR1,on\n60,PIR1,jammed\n600,PIR1,off\n1200,PIR1,on\n1800,PIR1,off\n1860,PIR1,on\n");
  CHECK(windows_of(log, 60.0).front() ==
        "1" + std::string(9, '.') + std::string(10, '0') + std::string(10, '1') + "01");
  REQUIRE(log.remarks.size() == 1);
  CHECK(log.remarks[0].message.find("'jammed' is no state") == 0);
  // Newest first, as histories are downloaded.
  const Log back = read_log_text("time,sensor,state\n40,A,lost\n30,A,on\n20,A,off\n10,A,on\n0,A,off\n");
  CHECK(windows_of(back, 10.0).front() == "0101.");
}

TEST_CASE("a line that begins with # is a comment above the table alone") {
  const Log log = read_log_text(
      "# a logger's title\n#group,false,true\nentity_id,state,last_changed\n#1_motion,on,2026-03-02T07:00:00\n"
      "b_motion,off,2026-03-02T07:00:00\n#1_motion,off,2026-03-02T07:01:00\nb_motion,on,2026-03-02T07:02:00\n");
  CHECK(sensors_of(log) == Texts{"#1_motion", "b_motion"});
  CHECK(sensors_of(read_log_text("#1,2026-03-02T07:00:00,on\nb,2026-03-02T07:01:00,on\n#1,2026-03-02T07:02:00,off\n"
                                 "b,2026-03-02T07:03:00,off\n")) == Texts{"#1", "b"});
}

TEST_CASE("no sensor is called as a column of rows") {
  for (const char* name : {"people", "time", "time_s", "trial", "people_hall", "presence"}) {
    const std::string map = std::string("pirsim_log: 1\nsensors: {") + name + ": PIR1, P2: PIR2}\n";
    CHECK_THROWS_WITH(io::parse_log_map(map, "map"), contains("map:2:") && contains("is the name of a column of rows"));
  }
  CHECK(sensors_of(read_log_text("time,sensor,state\n0,people,on\n5,people,off\n9,people,on\n",
                                 io::parse_log_map("{pirsim_log: 1, sensors: {PIR1: people}}", "map"))) ==
        Texts{"PIR1"});
  CHECK_THROWS_WITH(read_log_text("time,sensor,state\n0,people,on\n5,people,off\n9,people,on\n"),
                    contains(R"({pirsim_log: 1, sensors: {PIR1: "people"}})"));
}

TEST_CASE("a map can say that nobody counted") {
  const std::string text = "time_s,people,PIR1\n1,0,0\n2,0,1\n3,0,0\n";
  CHECK(read_log_text(text).people);
  const Log log = read_log_text(text, io::parse_log_map("{pirsim_log: 1, people: none}", "map"));
  CHECK_FALSE(log.people);
  CHECK(io::to_yaml(log.map).find("people: none\n") != std::string::npos);
  for (const char* people : {"", "null", "\"\"", "~"}) {
    CHECK_THROWS_WITH(io::parse_log_map(std::string("pirsim_log: 1\npeople: ") + people + "\n", "map"),
                      contains("expected a column, or `none` for a log without a count"));
  }
  CHECK_THROWS_AS(io::parse_log_map("{pirsim_log: 1, people: {}}", "map"), Error);
}

TEST_CASE("one time far from all others is told with its line") {
  const std::string text =
      "time,sensor,state\n2026-03-02T08:00:00,A,off\n2026-03-02T08:01:00,A,on\n2024-01-01T00:00:00,A,off\n"
      "2026-03-02T08:02:00,A,on\n";
  CHECK_THROWS_WITH(read_log_text(text), contains("log.csv:4:1: error: nothing is told from 2024-01-01 to 2026-03-02"));
  LogMap part;
  part.from = "2026-03-02";
  CHECK(read_log_text(text, part).n_rows == 4);
}
