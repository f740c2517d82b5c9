// One log of two sensors in every way in which programs write it: read by itself, or with the map that its refusal
// offers.
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>

#include "pirsim/log.hpp"
#include "support/catch.hpp"
#include "support/log_files.hpp"

using namespace pirsim;
using Texts = std::vector<std::string>;

namespace {

struct Event {
  int s;  ///< since 2026-03-02 07:00
  std::string sensor;
  bool is_on;
};
/// Hall and desk, each off from the begin, and the end.
std::vector<Event> made_events() {
  std::vector<Event> events{{0, "hall", false}, {0, "desk", false}};
  for (int i = 0, s = 13; i < 40; ++i, s += 17 + 29 * i % 41) {
    const bool is_desk = i / 2 % 3 == 1;
    events.push_back({s, is_desk ? "desk" : "hall", i % 2 == 0});
  }
  return events;
}
std::string formatted(const char* format, int s) {  // with hours, minutes and seconds
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), format, 7 + s / 3600, s / 60 % 60, s % 60);
  return text.data();
}
std::string iso(int s) { return formatted("2026-03-02 %02d:%02d:%02d", s); }

/// The truth in windows of ten seconds: desk, hall.
Texts truth(const std::vector<Event>& events = made_events()) {
  Texts windows(2, std::string(static_cast<std::size_t>(events.back().s / 10 + 1), '0'));
  std::array<int, 2> on{-1, -1};
  for (const Event& event : events) {
    const std::size_t sensor = event.sensor == "hall" ? 1 : 0;
    if (event.is_on) on[sensor] = event.s;
    for (int w = on[sensor] / 10; !event.is_on && on[sensor] >= 0 && w * 10 < event.s; ++w)
      windows[sensor][static_cast<std::size_t>(w)] = '1';
    if (!event.is_on) on[sensor] = -1;
  }
  for (std::string& sensor : windows) sensor.pop_back();  // the last window isn't over
  return windows;
}
Texts windows_so_far(const Log& log) {
  Texts windows = windows_of(log, 10.0);
  for (std::string& sensor : windows) sensor.pop_back();
  return windows;
}

using Line = std::function<std::string(const Event&)>;
std::string lines_of(const std::string& header, const Line& line) {
  std::string text = header;
  for (const Event& event : made_events()) text += line(event) + '\n';
  return text;
}
std::string state_of(const Event& event) { return event.is_on ? "on" : "off"; }
std::string plain() {
  return lines_of("time,sensor,state\n", [](const Event& e) { return iso(e.s) + ',' + e.sensor + ',' + state_of(e); });
}
LogMap map_of(const std::string& keys) { return io::parse_log_map("{pirsim_log: 1, " + keys + "}", "map"); }

void check_truth(const std::string& text, const std::string& keys = {}) {
  CAPTURE(text.substr(0, 300), keys);
  const Log log = read_log_text(text, keys.empty() ? LogMap{} : map_of(keys));
  REQUIRE(log.sensors.size() == 2);
  CHECK(windows_so_far(log) == truth());
}

}  // namespace

TEST_CASE("times as programs write them") {
  check_truth(plain());
  for (const char* way :
       {"2026-03-02_%02d:%02d:%02d", "02-Mar-2026 %02d:%02d:%02d", "02-Mar-26 %d:%02d:%02d AM",
        "02 Mar 2026 %02d:%02d:%02d", "\"March 02, 2026 at %02d:%02d:%02d AM\"", "20260302T%02d%02d%02dZ",
        "20260302T%02d%02d%02d", "20260302%02d%02d%02d", "2026-03-02 %02d:%02d:%02d.000000 +0000 UTC",
        "Mon Mar  2 %02d:%02d:%02d 2026", "Mon Mar  2 %02d:%02d:%02d UTC 2026",
        "\"Mon, 02 Mar 2026 %02d:%02d:%02d +0000\"", "02/Mar/2026:%02d:%02d:%02d +0000"}) {
    const auto line = [&](const Event& e) { return formatted(way, e.s) + ',' + e.sensor + ',' + state_of(e); };
    check_truth(lines_of("time,sensor,state\n", line));
    check_truth(lines_of("", line));
    const std::string text = way;
    const bool is_utc =
        text.ends_with('Z') || text.find("UTC") != std::string::npos || text.find("+0000") < text.size();
    CHECK(read_log_text(lines_of("", line)).clock == (is_utc ? LogClock::zoned : LogClock::local));
  }
  for (const auto& [way, format] : {std::pair{"02.03.26 %02d.%02d.%02d", "%d.%m.%y %H.%M.%S"},
                                    {"2026/061 %02d:%02d:%02d", "%Y/%j %H:%M:%S"},
                                    {"%02dh%02dm%02ds on 2/3/2026", "%Hh%Mm%Ss on %d/%m/%Y"}}) {
    const auto line = [&](const Event& e) { return formatted(way, e.s) + ',' + e.sensor + ',' + state_of(e); };
    check_truth(lines_of("time,sensor,state\n", line), "time_format: \"" + std::string(format) + '"');
    check_truth(lines_of("", line), "time_format: \"" + std::string(format) + '"');
    CHECK_THROWS_WITH(read_log_text(lines_of("time,sensor,state\n", line)),
                      contains("may be a time, but none that can be read") && contains("time_format"));
    CHECK_THROWS_WITH(read_log_text(plain(), map_of("time_format: \"" + std::string(format) + '"')),
                      contains("none that can be read by time_format"));
  }
}

TEST_CASE("numbers of time in the unit that their column's name tells, or that is asked for") {
  const auto rows = [](const std::string& name, double step) {
    std::string text = name + ",hall_motion,desk_motion\n";
    for (int i = 1; i <= 60; ++i)
      text += std::to_string(step * i) + (i % 7 < 3 ? ",1" : ",0") + (i % 5 < 2 ? ",1\n" : ",0\n");
    return text;
  };
  for (const auto& [name, step] : std::vector<std::pair<std::string, double>>{{"hours", 0.01},
                                                                              {"Time (h)", 0.01},
                                                                              {"time_min", 0.6},
                                                                              {"Time (min)", 0.6},
                                                                              {"time [min]", 0.6},
                                                                              {"minutes since start", 0.6},
                                                                              {"Time (ms)", 36'000},
                                                                              {"time_ms", 36'000},
                                                                              {"millis", 36'000},
                                                                              {"micros", 36e6},
                                                                              {"day", 0.01 / 24},
                                                                              {"seconds of day", 36},
                                                                              {"time", 36}}) {
    CAPTURE(name);
    LogMap map;
    map.time = {name};
    map.time_format = name == "day" ? "days" : "";
    CHECK(static_cast<double>(read_log_text(rows(name, step), map).interval_us) == Approx(36e6).epsilon(0.01));
  }
  CHECK_THROWS_WITH(read_log_text(rows("time", 1000)), contains("'time' counts whole thousands") &&
                                                           contains("{pirsim_log: 1, time_format: milliseconds}"));
  LogMap map;
  map.time_format = "milliseconds";
  CHECK(read_log_text(rows("time", 1000), map).interval_us == 1'000'000);
  map.time_format = "seconds";
  CHECK(read_log_text(rows("time", 1000), map).interval_us == 1'000'000'000);
  CHECK(read_log_text(rows("time_s", 1000)).interval_us == 1'000'000'000);
}

TEST_CASE("the name of a zone is one with a map's time_zone alone") {
  const auto rows = [](const std::string& zone) {
    return lines_of("time,sensor,state\n",
                    [&](const Event& e) { return iso(e.s) + ' ' + zone + ',' + e.sensor + ',' + state_of(e); });
  };
  check_truth(rows("CET"), "time_zone: Europe/Berlin");
  CHECK_THROWS_WITH(read_log_text(rows("EST")), contains("{pirsim_log: 1, time_zone: America/New_York}"));
  CHECK_THROWS_AS(read_log_text(rows("on")), Error);
}

TEST_CASE("days as spreadsheets and MATLAB count them") {
  for (const auto& [zero, decimals] : {std::pair{46083, 6}, {740043, 6}}) {
    const auto line = [&](const Event& e) {
      std::array<char, 40> text{};
      std::snprintf(text.data(), text.size(), "%.*f", decimals, zero + (25'200.0 + e.s) / 86'400.0);
      return text.data() + (',' + e.sensor) + ',' + state_of(e);
    };
    const Log log = read_log_text(lines_of("time,sensor,state\n", line));
    CHECK(windows_so_far(log) == truth());
    CHECK(to_text(log.moment(log.begin_us), log.clock) == "2026-03-02T07:00:00");
  }
  // A row a day and a half apart: days, or half seconds.
  std::string rare = "time,A\n";
  for (int i = 0; i < 40; ++i)
    rare += std::to_string(46083 + i / 2) + (i % 2 == 0 ? ".5," : ".7,") + std::to_string(i % 2) + '\n';
  CHECK_THROWS_WITH(read_log_text(rare), contains("time_format: excel_days") && contains("time_format: seconds"));
  CHECK(read_log_text(rare, map_of("time_format: excel_days, rows: changes")).clock == LogClock::local);
  CHECK(read_log_text(rare, map_of("time_format: seconds, rows: changes")).clock == LogClock::elapsed);
}

TEST_CASE("states in other words") {
  const auto rows = [](const std::string& on, const std::string& off) {
    return lines_of("time,sensor,state\n",
                    [&](const Event& e) { return iso(e.s) + ',' + e.sensor + ',' + (e.is_on ? on : off); });
  };
  for (const auto& [on, off] : {std::pair{"t", "f"},
                                {"Y", "N"},
                                {"Ein", "Aus"},
                                {"Ja", "Nein"},
                                {"Oui", "Non"},
                                {"Motion detector", "No one"},
                                {"detected motion", "cleared (no motion detected)"},
                                {"motion active", "motion inactive"},
                                {"present", "absent"}})
    check_truth(rows(on, off));
  for (const auto& [on, off] :
       {std::pair{"pir", "none"}, {"open", "closed"}, {"HIGH", "LOW"}, {"triggered", "ready"}}) {
    check_truth(rows(on, off), "states: {on: [" + std::string(on) + "], off: [" + off + "]}");
    CHECK_THROWS_WITH(read_log_text(rows(on, off)), contains("states: {on: [\"" + std::string(on) + "\"], off:"));
  }
  const std::string unknown_words = lines_of("Zeit;Melder;Zustand\n", [](const Event& e) {
    return iso(e.s) + ';' + e.sensor + ';' + (e.is_on ? "rege" : "starr");
  });
  CHECK_THROWS_WITH(read_log_text(unknown_words), contains("'rege' and 'starr' in 'Zustand' may be states"));
  check_truth(unknown_words, "form: events, sensor: Melder, state: Zustand, states: {on: [rege], off: [starr]}");
  check_truth(rows("off", "on"), "states: {on: [off], off: [on]}");  // inverted
  check_truth(rows("255", "0"), "states: {on: 255, off: 0}");
  check_truth(rows("255.0", "0"), "above: 0");
  check_truth(rows("30", "2"), "above: 2");
  CHECK_THROWS_WITH(map_of("states: {on: [a], off: [a]}"), contains("'a' is on and off"));
  CHECK_THROWS_WITH(map_of("states: {an: [a]}"), contains("an"));
}

TEST_CASE("JSON is a table: lines of objects, arrays, Home Assistant's history") {
  const auto entity = [](const Event& e) { return "\"binary_sensor." + e.sensor + "_motion\""; };
  const auto stamp = [](const Event& e) { return formatted("\"2026-03-02T%02d:%02d:%02dZ\"", e.s); };
  const auto object = [&](const Event& e) {
    return "{\"entity_id\": " + entity(e) + ", \"state\": \"" + state_of(e) +
           "\", \"attributes\": {\"class\": \"motion\"}, " + "\"last_changed\": " + stamp(e) + "}";
  };
  check_truth(lines_of("", object));
  check_truth("[" + lines_of("", [&](const Event& e) { return object(e) + ","; }) + object(made_events().back()) + "]");
  check_truth(lines_of("", [&](const Event& e) {
    return R"({"payload": {"occupancy": )" + std::string(e.is_on ? "true" : "false") + R"(}, "topic": ")" + e.sensor +
           "\", \"time\": " + stamp(e) + "}";
  }));
  std::array<std::string, 2> minimal{}, websocket{};
  for (const Event& e : made_events()) {
    const std::size_t sensor = e.sensor == "hall" ? 1 : 0;
    std::string& one = minimal[sensor];
    one += one.empty() ? object(e) : ", {\"state\": \"" + state_of(e) + "\", \"last_changed\": " + stamp(e) + "}";
    websocket[sensor] += (websocket[sensor].empty() ? "" : ", ") + std::string("{\"s\": \"") + state_of(e) +
                         "\", \"a\": {}, \"lu\": " + std::to_string(1772434800 + e.s) + ".5}";
  }
  check_truth("[[" + minimal[0] + "],\n[" + minimal[1] + "]]");
  const Log log =
      read_log_text("{\"binary_sensor.desk\": [" + websocket[0] + "], \"binary_sensor.hall\": [" + websocket[1] + "]}");
  CHECK(sensors_of(log) == Texts{"binary_sensor.desk", "binary_sensor.hall"});
  CHECK(log.clock == LogClock::zoned);
}

TEST_CASE("JSON that is no table is refused, however deep, long or cut off") {
  CHECK_THROWS_WITH(read_log_text(std::string(100'000, '[')), contains("JSON of more than 64 levels is no table"));
  CHECK_THROWS_WITH(read_log_text(std::string(100'000, '{')), contains("expected a table, or JSON"));
  CHECK_THROWS_WITH(read_log_text("[{\"time\": 1, \"A\": 0},\n"), contains("JSON that ends within a value"));
  std::string lines;
  for (int i = 0; i < 30; ++i)
    lines += "{\"time\": " + std::to_string(30 * i) + ", \"A\": " + std::to_string(i / 2 % 2) + "}\n";
  for (const std::size_t cut : {3U, 5U, 9U, 14U}) {
    const Log log = read_log_text(lines.substr(0, lines.size() - cut));
    CHECK(log.n_rows == 29);
    REQUIRE(log.remarks.size() == 1);
    CHECK_THAT(log.remarks.front().message, contains("the last line ends within a value: it is left out"));
  }
  CHECK_THROWS_WITH(read_log_text("[[1, 2], [3]]\n"), contains("JSON without a list of objects"));
  CHECK_THROWS_WITH(read_log_text(R"({"status": "success", "data": {"resultType": "matrix", "result": []}})"),
                    contains("Prometheus' answer"));
  std::string columns;
  for (int i = 0; i < 600; ++i)
    columns += (i == 0 ? "\"" : ", \"") + std::to_string(i) + "\": " + std::to_string(i % 2);
  CHECK_THROWS_WITH(read_log_text("{\"time\": {" + columns + "}, \"hall\": {" + columns + "}}"),
                    contains("orient='records'"));
}

TEST_CASE("texts that consoles and databases write") {
  check_truth(lines_of("", [](const Event& e) {
    return formatted("2026-03-02T%02d:%02d:%02d+0000 zigbee2mqtt/", e.s) + e.sensor +
           R"( {"battery":100,"occupancy":)" + (e.is_on ? "true" : "false") + "}";
  }));
  check_truth(lines_of("00:00:04 APP: Boot\n", [](const Event& e) {
    const std::string state = e.is_on ? "ON" : "OFF";
    return formatted("%02d:%02d:%02d MQT: stat/", e.s) + e.sensor + "/SWITCH1 = " + state +
           formatted("\n%02d:%02d:%02d RSL: tele/", e.s) + e.sensor + R"(/SENSOR = {"Switch1":")" + state + "\"}";
  }));
  check_truth(lines_of("", [](const Event& e) {
    return formatted("2026-03-02_%02d:%02d:%02d ", e.s) + e.sensor + "_Flur motion: " + state_of(e) +
           formatted("\n2026-03-02_%02d:%02d:%02d ", e.s) + e.sensor + "_Flur brightness: 40";
  }));
  const auto bars = [](const std::string& bar) {
    return [bar](const Event& e) { return ' ' + iso(e.s) + bar + e.sensor + "_motion" + bar + state_of(e); };
  };
  check_truth(lines_of("time|sensor|state\n", bars("|")));
  check_truth(lines_of("        time         |  sensor     | state \n---------------------+-------------+-------\n",
                       bars(" | ")) +
              "(42 rows)\n");
  check_truth(
      lines_of("+------+--------+-------+\n| time | sensor | state |\n+------+--------+-------+\n",
               [](const Event& e) { return "| " + iso(e.s) + " | " + e.sensor + "_motion | " + state_of(e) + " |"; }) +
      "+------+--------+-------+\n");
  check_truth("history:/Station/Office\n" + plain());
  check_truth(lines_of("", [](const Event& e) {
    return iso(e.s) + (e.sensor == "hall" ? "\tM001" : "\tM000") + "\thall\tHall\t" + (e.is_on ? "ON" : "OFF") +
           "\tMotion";
  }));
  CHECK_THROWS_WITH(read_log_text("b,entity_id=hall state=\"on\",value=1 1772434844185564000\n"),
                    contains("InfluxDB's line protocol"));
  std::string numbered = "\"time\",\"hall_pir\"\n";  // R's write.table
  for (int i = 1; i < 40; ++i)
    numbered += '"' + std::to_string(i) + "\",\"" + iso(30 * i) + "\"," + std::to_string(i / 3 % 2) + '\n';
  CHECK(sensors_of(read_log_text(numbered)) == Texts{"hall_pir"});
}

TEST_CASE("lines that are no rows are left out, and reported") {
  const auto warned = [](const std::string& text, const std::string& remark, const std::string& keys = {}) {
    check_truth(text, keys);
    const Log log = read_log_text(text, keys.empty() ? LogMap{} : map_of(keys));
    CHECK(std::ranges::any_of(log.remarks,
                              [&](const Issue& issue) { return issue.message.find(remark) != std::string::npos; }));
  };
  const std::string log = plain();
  warned(log + "2026-03-02 15:0", "the last line has too few fields");
  CHECK_THROWS_WITH(read_log_text(log + "2026-03-02 15:0\n2026-03-02 15:00:00,hall,off\n"),
                    contains("expected 3 fields, got 1"));
  const std::size_t middle = log.find('\n', log.size() / 2) + 1;
  const auto with = [&](const std::string& lines) { return std::string(log).insert(middle, lines); };
  warned(with("time,sensor,state\n"), "names of the columns stand here again");
  const std::string unset = with("1970-01-01 00:00:03,lamp,off\n1970-01-01 00:00:05,lamp,on\n");
  CHECK_THROWS_WITH(read_log_text(unset), contains("{pirsim_log: 1, from: 2026-03-02T07:00:00}"));
  warned(unset, "the clock wasn't set", "from: 2026-03-02T07:00:00");
  // The sensor of such a row isn't known until it tells something again.
  const Log lost = read_log_text(with("1970-01-01 00:00:03,hall,off\n"), map_of("from: 2026-03-02T07:00:00"));
  CHECK(windows_so_far(lost)[1].find('.') != std::string::npos);
}

TEST_CASE("an interval without an end goes on, but one before another of its sensor isn't known") {
  const Log log = read_log_text(
      "start,end,sensor\n2026-03-02 07:00:00,2026-03-02 07:00:20,A\n2026-03-02 07:00:40,,A\n2026-03-02 "
      "07:01:00,2026-03-02 "
      "07:01:20,A\n2026-03-02 07:01:40,,A\n2026-03-02 07:00:00,2026-03-02 07:02:00,B\n");
  CHECK(windows_so_far(log)[0] == "1100..110011");
}

TEST_CASE("a name in several columns, and a sensor of several names") {
  const auto rows = [](const std::string& header, const Line& name) {
    return lines_of(header, [&](const Event& e) { return iso(e.s) + ',' + name(e) + ',' + (e.is_on ? "1" : "0"); });
  };
  const std::string nodes =
      rows("time,node,child,value\n", [](const Event& e) { return e.sensor == "hall" ? "7,2" : "7,1"; });
  check_truth(nodes, "sensor: [node, child]");
  CHECK(sensors_of(read_log_text(nodes, map_of("sensor: [node, child]"))) == Texts{"7_1", "7_2"});
  const std::string renamed = rows(
      "time,sensor,state\n", [](const Event& e) { return e.sensor == "hall" && e.s > 300 ? "corridor" : e.sensor; });
  check_truth(renamed, "sensors: {DESK: desk, HALL: [hall, corridor]}");
  const Log log = read_log_text(renamed, map_of("sensors: {DESK: desk, HALL: [hall, corridor]}"));
  CHECK(sensors_of(log) == Texts{"DESK", "HALL"});
  CHECK(io::parse_log_map(io::to_yaml(log.map), "map") == log.map);
  CHECK_THROWS_WITH(read_log_text(plain(), map_of("sensors: {BOTH: [desk, hall]}")), contains("tell in turns"));
}

TEST_CASE("triggers without a state last for hold_s") {
  std::string triggers = "time,sensor\n", alone;
  for (const int s : {100, 103, 200, 320}) triggers += iso(s) + ",hall\n", alone += iso(s) + '\n';
  for (const auto& [text, keys] :
       {std::pair{triggers, "form: events, sensor: sensor, hold_s: 5"}, {alone, "form: events, hold_s: 5"}}) {
    const Log log = read_log_text(text, map_of(keys));
    REQUIRE(log.sensors.size() == 1);
    CHECK(sensors_of(log).front() == (text == alone ? "log" : "hall"));
    CHECK(windows_of(log, 1.0).front().substr(0, 12) == "111111110000");
  }
}

TEST_CASE("rows newest first are turned round") {
  std::string rows, turned;
  for (int i = 1; i <= 60; ++i) {
    const std::string row = iso(30 * i) + ',' + std::to_string(i / 7 % 2) + ',' + std::to_string(i / 5 % 2) + '\n';
    rows += row;
    turned = row + turned;
  }
  const Log forward = read_log_text("time,A,B\n" + rows), back = read_log_text("time,A,B\n" + turned);
  CHECK(back.interval_us == 30'000'000);
  CHECK(windows_of(back, 30.0) == windows_of(forward, 30.0));
  CHECK(windows_of(read_log_text(turned, map_of("order: newest_first")), 30.0) == windows_of(forward, 30.0));
  const std::vector<Event> events = made_events();
  std::string newest = "time,sensor,state\n";
  for (auto e = events.rbegin(); e != events.rend(); ++e)
    newest += iso(e->s) + ',' + e->sensor + ',' + state_of(*e) + '\n';
  check_truth(newest);
}

TEST_CASE("files that overlap: the same rows, or a file a sensor") {
  const TemporaryFolder folder;
  const auto file = [&](const std::string& name, const std::function<bool(const Event&)>& has, bool is_named) {
    std::string text = is_named ? "time,sensor,state\n" : "time,state\n";
    for (const Event& e : made_events())
      if (has(e)) text += iso(e.s) + (is_named ? ',' + e.sensor : "") + ',' + state_of(e) + '\n';
    return folder.write(name, text);
  };
  const auto read = [](std::vector<std::filesystem::path> files, const std::string& keys = {}) {
    return io::read_log(files, keys.empty() ? LogMap{} : map_of(keys));
  };
  const auto first = file(
                 "w1.csv", [](const Event&e) { return e.s < 800; }, true),
             second = file(
                 "w2.csv", [](const Event&e) { return e.s > 500; }, true);
  CHECK(windows_so_far(read({first, second})) == truth());
  CHECK(windows_so_far(read({second, first})) == truth());
  const auto hall = file(
                 "hall.csv", [](const Event&e) { return e.sensor == "hall"; }, false),
             desk = file(
                 "desk.csv", [](const Event&e) { return e.sensor == "desk"; }, false);
  for (const char* keys : {"", "files: sensors"}) {
    const Log log = read({hall, desk}, keys);
    CHECK(sensors_of(log) == Texts{"hall", "desk"});
    const Texts windows = windows_so_far(log);
    CHECK(windows[1].substr(0, 100) == truth()[0].substr(0, 100));
    CHECK(windows[0].substr(0, 100) == truth()[1].substr(0, 100));
  }
  CHECK_THROWS_WITH(read({hall, desk}, "files: parts"), contains("says something else of 'state'"));
  CHECK(sensors_of(read({hall, desk}, "files: sensors, sensors: {H: hall, D: desk}")) == Texts{"H", "D"});
  const auto other = folder.write("w3.csv", "time,sensor,state\n" + iso(500) + ",hall,on\n" + iso(900) + ",hall,off\n");
  CHECK_THROWS_WITH(read({first, other}), contains("says something else of 'hall'"));
  // Readings, too.
  const auto readings = [&](const std::string& name, int from, int to, int turn) {
    std::string text = "time,A,B\n";
    for (int i = from; i < to; ++i)
      text += iso(30 * i) + ',' + std::to_string(i / 7 % 2) + ',' + std::to_string((i + turn) / 5 % 2) + '\n';
    return folder.write(name, text);
  };
  CHECK(windows_of(read({readings("r1.csv", 1, 60, 0), readings("r2.csv", 40, 100, 0)}), 30.0) ==
        windows_of(read({readings("r3.csv", 1, 100, 0)}), 30.0));
  CHECK_THROWS_WITH(read({readings("r1.csv", 1, 60, 0), readings("r4.csv", 40, 100, 1)}),
                    contains("says something else of column 'B'"));
}
