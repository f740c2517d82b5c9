// Logs that programs write for people, and rows that tell a begin and an end: the same motion, told in other words.
#include "pirsim/error.hpp"
#include "pirsim/log.hpp"
#include "support/catch.hpp"
#include "support/log_files.hpp"

using namespace pirsim;
using Texts = std::vector<std::string>;

namespace {

std::string fault_of(const std::string& text, const LogMap& map = {}) {
  try {
    static_cast<void>(read_log_text(text, map));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// Two sensors over nine seconds, and what the last moment tells.
const Texts motion{"001110010.", ".001110..."};

}  // namespace

TEST_CASE("openHAB's log: items that change, of any version, among lines of other things") {
  const std::string text =
      "2024-01-31 18:00:00.000 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Hall_Motion' changed from NULL "
      "to OFF\n"
      "2024-01-31 18:00:01.000 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Desk_Motion' changed from ON "
      "to "
      "OFF (source: org.openhab.core)\n"
      "2024-01-31 18:00:01.500 [INFO ] [openhab.event.ItemCommandEvent        ] - Item 'Lamp' received command ON\n"
      "2024-01-31 18:00:02.000 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Hall_Motion' changed from OFF "
      "to "
      "ON\n"
      "2024-01-31 18:00:02.100 [INFO ] [enhab.event.GroupItemStateChangedEvent] - Item 'gMotion' changed from OFF to "
      "ON "
      "through Hall_Motion\n"
      "2024-01-31 18:00:02.200 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Temp' changed from 20.1 to "
      "20.2\n"
      "2024-01-31 18:00:03.000 [INFO ] [vent.ItemStateChangedEvent] - Desk_Motion changed from OFF to ON\n"
      "2024-01-31 18:00:05.000 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Hall_Motion' changed from ON "
      "to "
      "OFF\n"
      "2024-01-31 18:00:06.000 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Desk_Motion' changed from ON "
      "to "
      "OFF\n"
      "2024-01-31 18:00:07.000 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Hall_Motion' changed from OFF "
      "to "
      "ON\n"
      "2024-01-31 18:00:07.000 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Desk_Motion' changed from OFF "
      "to "
      "UNDEF\n"
      "2024-01-31 18:00:08.000 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Hall_Motion' changed from ON "
      "to "
      "OFF\n"
      "2024-01-31 18:00:09.000 [INFO ] [openhab.event.ThingStatusInfoEvent    ] - Thing changed from ONLINE to "
      "OFFLINE\n"
      "2024-01-31 18:00:09.000 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Temp' changed from 20.2 to "
      "20.1\n";
  LogMap map;
  map.sensors = {{"hall", "Hall_Motion"}, {"desk", "Desk_Motion"}};
  const Log log = read_log_text(text, map);
  CHECK(windows_of(log, 1.0) == motion);
  CHECK(log.source == "openHAB's log");
  CHECK(log.n_other_lines == 2);
  CHECK(log.others == Texts{"gMotion", "Temp"});
  CHECK(log.remarks.empty());
  CHECK(sensors_of(read_log_text(text)) == Texts{"Desk_Motion", "Hall_Motion"});
}

TEST_CASE("Zigbee2MQTT's log: properties that tell motion, and a device that is offline") {
  const auto line = [](const std::string& time, const std::string& topic, const std::string& payload) {
    return "[2026-01-25 10:00:" + time + "] info: \tz2m:mqtt: MQTT publish: topic 'zigbee2mqtt/" + topic +
           "', payload '" + payload + "'\n";
  };
  const std::string text =
      "[2026-01-25 10:00:00] info: \tz2m: Started frontend on port 8080\n" +
      line("00", "hall", R"({"battery":100,"occupancy":false})") +
      line("00", "hall", R"({"battery":99,"occupancy":false})") +
      line("01", "room/desk PIR", R"({"occupancy":false})") + line("02", "hall", R"({"occupancy":true})") +
      line("02", "lamp", R"({"state":"ON"})") + line("03", "room/desk PIR", R"({"occupancy":true})") +
      "Zigbee2MQTT:info  2026-01-25 10:00:05: MQTT publish: topic 'zigbee2mqtt/hall', payload "
      "'{\"occupancy\":false}'\n" +
      line("06", "room/desk PIR/occupancy", "false") +
      line("07", "room/desk PIR/availability", R"({"state":"offline"})") + line("07", "hall", R"({"occupancy":true})") +
      line("08", "hall", R"({"occupancy":false})") + line("09", "hall", R"({"occupancy":false,"temperature":20.5})");
  const Log log = read_log_text(text);
  CHECK(sensors_of(log) == Texts{"hall_occupancy", "room/desk PIR_occupancy"});
  CHECK(windows_of(log, 1.0) == motion);
  CHECK(log.n_other_lines == 3);  // of the repeated message nothing is new
  CHECK(log.remarks.empty());
  CHECK(io::parse_log_map(io::to_yaml(log.map), "map") == log.map);
  CHECK(windows_of(read_log_text(text, log.map), 1.0) == motion);
  CHECK_THAT(fault_of(line("00", "lamp", R"({"state":"ON"})")),
             contains("none of the lines of Zigbee2MQTT's log tells that a sensor changed"));
  const auto at_eight = [](const std::string& offset) {
    std::string text;
    for (const std::string state : {"false", "true"})
      text += "[2026-05-14T20:00:0" + std::to_string(state == "true") + offset +
              "] info: z2m:mqtt: MQTT publish: topic 'zigbee2mqtt/hall', payload '{\"occupancy\":" + state + "}'\n";
    return read_log_text(text).begin_us;
  };
  CHECK(at_eight("Z") - at_eight("+02:00") == 7'200'000'000);
}

TEST_CASE("ESPHome's log: old and new words, colours, and days that pass without motion") {
  const std::string text =
      "INFO ESPHome 2025.11.0\n"
      "[23:59:50][D][binary_sensor:036]: 'Bob's PIR': Sending initial state OFF\n"
      "\x1B[0;36m[23:59:55][D][binary_sensor:036]: 'Bob's PIR': Sending state ON\x1B[0m\n"
      "[00:00:05.500][D][binary_sensor:044]: 'Bob's PIR' >> OFF\n"
      "[00:00:06][D][sensor:093]: 'Distance': Sending state 1.0 m with 1 decimals of accuracy\n"
      "[12:00:00][D][sensor:093]: 'Distance': Sending state 1.2 m with 1 decimals of accuracy\n"
      "[00:00:04][D][sensor:093]: 'Distance': Sending state 1.3 m with 1 decimals of accuracy\n"
      "[00:00:10][D][binary_sensor:036]: 'Bob's PIR': New state is ON\n"
      "[00:00:20][D][binary_sensor:036]: 'Bob's PIR': New state is OFF\n";
  const Log log = read_log_text(text);
  CHECK(sensors_of(log) == Texts{"Bob's PIR"});
  CHECK(log.clock == LogClock::elapsed);
  constexpr std::int64_t s = 1'000'000, day = 86'400 * s;
  const std::vector<LogChange> expected{{day - 10 * s, 0, 0},
                                        {day - 5 * s, 0, 1},
                                        {day + 5 * s + s / 2, 0, 0},
                                        {2 * day + 10 * s, 0, 1},
                                        {2 * day + 20 * s, 0, 0}};
  CHECK(log.sensors.front().changes == expected);
  CHECK(log.n_other_lines == 4);
  CHECK(log.remarks.empty());
  CHECK_THAT(fault_of("[08:00:00][\n[08:00:00]\x1B[\n"), contains("expected a table, got lines of a text"));
  const Log odd = read_log_text(text +
                                "[23:00:00][D][binary_sensor:036]: 'Bob's PIR': New state is ON\n"
                                "[22:30:00][D][binary_sensor:036]: 'Bob's PIR': New state is OFF\n");
  REQUIRE(odd.remarks.size() == 1);
  CHECK(odd.remarks.front().where.line == 11);
  CHECK_THAT(odd.remarks.front().message, contains("step back by 30 min"));
}

TEST_CASE("a console's lines of which the newest is the first are refused, since each would begin a day") {
  std::string newest_last, newest_first;
  for (int i = 0; i < 40; ++i) {
    const std::string line = "[08:" + std::to_string(10 + i) + ":00][D][binary_sensor:036]: 'PIR': New state is " +
                             (i % 2 == 0 ? "ON\n" : "OFF\n");
    newest_last += line;
    newest_first = line + newest_first;
  }
  CHECK(read_log_text(newest_last).end_us / 1'000'000 == (8 * 60 + 49) * 60);
  CHECK_THAT(fault_of(newest_first), contains("turn the lines round"));
}

TEST_CASE("intervals: on from begin to end, off at all other times, overlapping ones united") {
  const Texts expected{"1110000111", "000111000."};
  for (const char* text :
       {"start,end,sensor\n2026-03-02 07:00:00,2026-03-02 07:00:03,hall\n2026-03-02 07:00:03,2026-03-02 "
        "07:00:05.5,kitchen\n2026-03-02 07:00:07,2026-03-02 07:00:09.5,hall\n",
        "Location;Stop time;Start time;value\nhall;02.03.2026 07:00:03;02.03.2026 07:00:00;1\nhall;02.03.2026 "
        "07:00:06;02.03.2026 07:00:05;0\nkitchen;02.03.2026 07:00:05.5;02.03.2026 07:00:03;1\nhall;02.03.2026 "
        "07:00:09.5;02.03.2026 07:00:07;1\n",
        "Start time          End time            Place\n---------           --------            -----\n"
        "2026-03-02 07:00:00\t\t2026-03-02 07:00:03\t\thall\t\n2026-03-02 07:00:03  2026-03-02 07:00:05.5\tkitchen\n"
        "2026-03-02 07:00:07  2026-03-02 07:00:09.5  hall\n",
        "sensor_id,begin_ts,end_ts\nhall,1772434807,1772434809.5\nhall,1772434800,1772434803\nkitchen,1772434803,"
        "1772434805.5\n"}) {
    CAPTURE(text);
    const Log log = read_log_text(text);
    CHECK(sensors_of(log) == Texts{"hall", "kitchen"});
    CHECK(log.map.form == LogMap::Form::intervals);
    CHECK(windows_of(log, 1.0) == expected);
    CHECK(windows_of(read_log_text(text, io::parse_log_map(io::to_yaml(log.map), "map")), 1.0) == expected);
    CHECK(log.remarks.empty());
  }
  const Log of_motion = read_log_text("start,end,sensor,motion\n0,3,A,1\n3,6,A,0\n6,8,A,1\n8,10,B,0\n");
  CHECK(windows_of(of_motion, 1.0).front() == "1110001100.");
  const std::string active = "start,end,sensor,active\n0,3,A,yes\n3,6,A,no\n6,8,A,yes\n";
  CHECK_THAT(fault_of(active), contains("'active' may be their state, or a sensor") && contains("state: \"active\""));
  CHECK(windows_of(read_log_text(active, io::parse_log_map("{pirsim_log: 1, form: intervals, state: active}", "map")),
                   1.0)
            .front() == "11100011.");
  CHECK_THAT(fault_of("start,end,room,PIR1,PIR2\n0,30,kitchen,0,1\n30,60,kitchen,1,0\n60,90,kitchen,0,0\n"),
             contains("'PIR1' may be their state, or a sensor"));
  const Log of_a_query = read_log_text(
      "_start,_stop,_time,_value,entity_id\n0,99,1,1,hall_motion\n0,99,4,0,hall_motion\n"
      "0,99,6,1,hall_motion\n0,99,9,0,hall_motion\n");
  CHECK(of_a_query.map.form == LogMap::Form::events);
  const Log overlapping = read_log_text("start,end,sensor\n0,9,A\n2,4,A\n6,12,A\n12,13,A\n15,15,A\n20,21,A\n");
  CHECK(windows_of(overlapping, 1.0) == Texts{"111111111111100100001."});
  REQUIRE(overlapping.remarks.size() == 1);
  CHECK_THAT(overlapping.remarks.front().message, contains("; 1 more like this"));
}

TEST_CASE("intervals whose begin and end are told in German") {
  for (const char* header : {"Beginn;Ende;Melder", "Start;Ende;Melder", "von;bis;Melder"}) {
    const Log log = read_log_text(std::string(header) +
                                  "\n02.03.2026 07:00:00;02.03.2026 07:01:00;Flur\n02.03.2026 07:05:00;02.03.2026 "
                                  "07:06:30;Flur\n02.03.2026 07:20:00;02.03.2026 07:30:00;Flur\n");
    CHECK(log.map.form == LogMap::Form::intervals);
    CHECK(facts_of(log).sensors.front().motion_s == Approx(750.0));
  }
}

TEST_CASE("intervals that can't be: faults name their line, and a map says what isn't known") {
  CHECK_THAT(fault_of("start,end,sensor\n2026-03-02 07:00:05,2026-03-02 07:00:40,A\n2026-03-02 07:01:00,2026-03-02 "
                      "07:00:59,A\n"),
             contains(":3:21: error: it ends at '2026-03-02 07:00:59', before it begins at '2026-03-02 07:01:00'"));
  const std::string nameless = "7,1000,1500\n8,1400,1600\n7,2000,2100\n";
  LogMap map;
  map.form = LogMap::Form::intervals;
  map.time = {"column 2"};
  CHECK_THAT(fault_of(nameless, map), contains("name them in a map: time and end"));
  map.end = {"column 3"};
  map.sensor_column = {"column 1"};
  const Log log = read_log_text(nameless, map);
  CHECK(sensors_of(log) == Texts{"7", "8"});
  CHECK(windows_of(log, 100.0) == Texts{"11111000001.", "00001100000."});
  map.hold_s.all = 10.0;
  CHECK_THAT(fault_of(nameless, map), contains("intervals tell when motion ends"));
  CHECK_THAT(fault_of("start,end,room,type\n1,2,hall,PIR\n3,4,hall,door\n"), contains("say which in a map: sensor"));
}

TEST_CASE("times of JavaScript in quotes, columns of time stamps called _ts, and a logger's title") {
  const Log javascript = read_log_text(
      "time,sensor,state\n\"5/24/2019, 7:50:03 PM\",hall_motion,true\n\"5/24/2019, 7:50:05\xE2\x80\xAFPM\",hall_motion,"
      "false\n");
  CHECK(windows_of(javascript, 1.0) == Texts{"11."});
  CHECK(to_text(LogWindows(javascript, 1.0).begin(0), javascript.clock) == "2019-05-24T19:50:03");
  const Log stamps = read_log_text(
      "state,last_updated_ts,entity_id\non,1674875524.947023,binary_sensor.hall_motion\noff,1674875525.4,binary_sensor."
      "hall_motion\n");
  CHECK(stamps.sensors.front().changes.front().us == 1674875524947023);
  const Log logger = read_log_text(
      "\"Plot Title: Room 12\"\n\"No\",\"Date Time, GMT-05:00\",\"Occupied (SEN S/N: 1)\"\n1,\"02/13/26 08:00:00 "
      "AM\",0\n"
      "2,\"02/13/26 08:12:31 AM\",1\n3,\"02/13/26 08:14:01 AM\",0\n");
  CHECK(sensors_of(logger) == Texts{"Occupied (SEN S/N: 1)"});
  const Log numbered = read_log_text(
      "Plot Title: Room 12\n\"#\",\"Date Time, GMT-05:00\",\"Occupied (SEN S/N: 1)\",End\n1,02/13/26 08:00:00 AM,0,\n"
      "2,02/13/26 08:12:31 AM,1,\n3,02/13/26 08:14:01 AM,0,\n4,02/13/26 09:21:32 AM,,Logged\n");
  CHECK(sensors_of(numbered) == Texts{"Occupied (SEN S/N: 1)"});
}

TEST_CASE("the end of motion: told, by a hold, or lost") {
  const std::string text =
      "time,sensor,state\n0,A,off\n0,B,off\n1,A,on\n6,A,off\n8,B,on\n10,B,on\n16,A,on\n17,A,on\n30,A,off\n31,A,on\n";
  LogMap map;
  CHECK(windows_of(read_log_text(text, map), 1.0) ==
        Texts{"01111100000000001111111111111101", "00000000111111111111111111111111"});
  map.hold_s.all = 3.0;  // of A's ends one isn't told: 16 to 17 goes on
  CHECK(windows_of(read_log_text(text, map), 1.0) ==
        Texts{"01111100000000001111111111111101", "0000000011111000000000000000000."});
  map.hold_s = {{}, {{"B", 4.0}}};
  CHECK(windows_of(read_log_text(text, map), 1.0) ==
        Texts{"01111100000000001111111111111101", "0000000011111100000000000000000."});
  map.hold_s = {};
  map.longest_motion_s.each = {{"A", 7.0}, {"B", 1.0}};
  const Log limited = read_log_text(text, map);
  CHECK(windows_of(limited, 1.0) == Texts{"011111000000000011111111......01", "000000001.1....................."});
  CHECK(limited.remarks.size() == 2);
  CHECK(io::parse_log_map(io::to_yaml(map), "map") == map);
  map.hold_s.each = {{"C", 1.0}};
  CHECK_THAT(fault_of(text, map), contains("no sensor of the log is called 'C'"));
}
