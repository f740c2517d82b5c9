// What a log's columns mean, as YAML.
#include <algorithm>
#include <sstream>
#include <utility>

#include "core/text.hpp"
#include "io/log/log_words.hpp"
#include "io/read/reader_parts.hpp"
#include "io/read/yaml_map.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/log.hpp"
#include "schema/columns.hpp"

namespace pirsim::io {
namespace {

template <typename Value>
using Names = std::vector<std::pair<std::string, Value>>;

const Names<LogMap::Form>& forms() {
  static const Names<LogMap::Form> names{
      {"wide", LogMap::Form::wide}, {"events", LogMap::Form::events}, {"intervals", LogMap::Form::intervals}};
  return names;
}
const Names<LogMap::Rows>& kinds_of_rows() {
  static const Names<LogMap::Rows> names{{"readings", LogMap::Rows::readings}, {"changes", LogMap::Rows::changes}};
  return names;
}
const Names<LogMap::Dates>& orders() {
  static const Names<LogMap::Dates> names{{"month_first", LogMap::Dates::month_first},
                                          {"day_first", LogMap::Dates::day_first},
                                          {"year_first", LogMap::Dates::year_first}};
  return names;
}
const Names<LogMap::Stamps>& stamps() {
  static const Names<LogMap::Stamps> names{{"end", LogMap::Stamps::end}, {"begin", LogMap::Stamps::begin}};
  return names;
}
const Names<LogMap::People>& meanings() {
  static const Names<LogMap::People> names{{"count", LogMap::People::count}, {"presence", LogMap::People::presence}};
  return names;
}
const Names<LogMap::Empty>& meanings_of_empty() {
  static const Names<LogMap::Empty> names{{"unknown", LogMap::Empty::unknown}, {"unchanged", LogMap::Empty::unchanged}};
  return names;
}

template <typename Value>
const std::string& word(const Names<Value>& names, Value value) {
  for (const auto& [name, known] : names) {
    if (known == value) return name;
  }
  static const std::string none;
  return none;
}

/// `time: stamp`, `time: [Date, Time]`, or `time: [Date, Time, AmPm]`.
std::vector<std::string> read_time(YamlMap& map, const std::string& key) {
  const auto node = map.child(key);
  if (!node) return {};
  std::vector<std::string> columns;
  if (node->is_list()) {
    for (const YamlNode& item : read_list(*node, map.faults(), key)) columns.push_back(item.text(map.faults(), key));
  } else {
    columns.push_back(node->text(map.faults(), key));
  }
  if (columns.empty() || columns.size() > 3) {
    map.faults().error(node->where(), key + ": expected a column, or those of date, time, and AM or PM or an offset");
  }
  return columns;
}

/// `hold_s: 30`, or of some sensors `hold_s: {hall: 30}`.
LogMap::Seconds read_seconds(YamlMap& map, const std::string& key, NumberRange range) {
  LogMap::Seconds seconds;
  const auto node = map.child(key);
  if (!node) return seconds;
  if (!node->is_map()) {
    seconds.all = node->number(map.faults(), key, range);
    return seconds;
  }
  const std::vector<YamlKey> keys = node->keys();
  const std::vector<YamlNode> values = node->items();
  for (std::size_t i = 0; i < keys.size(); ++i)
    seconds.each.emplace_back(keys[i].name, values[i].number(map.faults(), key + ": " + keys[i].name, range));
  return seconds;
}

/// `sensors: {PIR1: S6_PIR}`, or `sensors: [S6_PIR, S7_PIR]` under their own names.
std::vector<LogMap::Sensor> read_sensors(YamlMap& map) {
  const auto node = map.child("sensors");
  if (!node || node->is_null()) return {};
  std::vector<LogMap::Sensor> sensors;
  if (node->n_items() > limits::sensors) {
    map.faults().error(node->where(), too_many(limits::sensors, "sensors"));
    return {};
  }
  if (!node->is_map()) {
    for (const YamlNode& item : read_list(*node, map.faults(), "sensors", limits::sensors)) {
      const std::string name = item.text(map.faults(), "sensors");
      sensors.push_back({name, name});
    }
    return sensors;
  }
  const std::vector<YamlKey> keys = node->keys();
  const std::vector<YamlNode> values = node->items();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (const std::string fault = line_fault(keys[i].name); !fault.empty())
      map.faults().error(keys[i].where, "sensors: '" + keys[i].name + "': " + fault);
    sensors.push_back({keys[i].name, values[i].text(map.faults(), "sensors: " + keys[i].name)});
  }
  return sensors;
}

/// Each column is one sensor's.
void check_sensors(YamlMap& map, const std::vector<LogMap::Sensor>& sensors) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const auto before = sensors.begin() + static_cast<std::ptrdiff_t>(i);
    const bool is_first = std::find_if(sensors.begin(), before,
                                       [&](const auto& other) { return other.in_log == sensors[i].in_log; }) == before;
    if (is_first && !is_column_name(sensors[i].name)) continue;
    const Where where = map.child("sensors")->items()[i].where();
    if (!is_first) map.faults().error(where, "sensors: '" + sensors[i].in_log + "' is named twice");
    if (is_column_name(sensors[i].name))
      map.faults().error(where, "sensors: '" + sensors[i].name +
                                    "' is the name of a column of rows: give the sensor another one, as {PIR1: " +
                                    quoted_yaml(sensors[i].in_log) + "}");
  }
}

/// `people: Room_Occupancy_Count`, with what it means, or `people: none`.
void read_people(YamlMap& map, LogMap& log) {
  const auto node = map.child("people");
  if (!node) return;
  if (!node->is_map()) {
    log.people = node->is_null() ? "" : node->text(map.faults(), "people");
    if (log.people.empty())
      map.faults().error(node->where(), "people: expected a column, or `none` for a log without a count");
    if (log.people != "none") return;
    log.people.clear();
    log.people_mean = LogMap::People::none;
    return;
  }
  YamlMap people(*node, map.faults(), "people");
  log.people = people.required_text("column");
  log.people_mean = people.choice("means", log.people_mean, meanings());
  people.finish();
}

LogMap map_from(const YamlNode& root) {
  Diagnostics faults;
  YamlMap map(root, faults, "map of a log");
  check_version(map, "pirsim_log");
  LogMap log;
  log.form = map.choice("form", log.form, forms());
  log.rows = map.choice("rows", log.rows, kinds_of_rows());
  log.empty = map.choice("empty", log.empty, meanings_of_empty());
  log.time = read_time(map, "time");
  log.end = read_time(map, "end");
  log.sensor_column = map.text("sensor");
  log.state_column = map.text("state");
  log.time_zone = map.text("time_zone");
  log.dates = map.choice("dates", log.dates, orders());
  log.stamps = map.choice("stamps", log.stamps, stamps());
  log.sensors = read_sensors(map);
  check_sensors(map, log.sensors);
  read_people(map, log);
  constexpr NumberRange length{.min = 1e-3, .max = 4e5};
  log.interval_s = map.optional_number("interval_s", length);
  log.longest_gap_s = map.optional_number("longest_gap_s", {.min = 1e-3, .max = 1e8});
  log.hold_s = read_seconds(map, "hold_s", length);
  log.longest_motion_s = read_seconds(map, "longest_motion_s", length);
  log.shift_s = map.number("shift_s", log.shift_s, {.min = -1e6, .max = 1e6});
  log.from = map.text("from");
  log.to = map.text("to");
  map.finish();
  faults.throw_if_errors();
  return log;
}

}  // namespace

LogMap read_log_map(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return map_from(YamlNode::load(read_input(file), overrides));
}
LogMap parse_log_map(std::string_view text, const std::string& name) { return map_from(YamlNode::parse(text, name)); }

std::string to_yaml(const LogMap& map) {
  std::ostringstream out;
  const auto line = [&](const char* key, const std::string& value) {
    if (!value.empty()) out << key << ": " << value << '\n';
  };
  const auto text = [&](const char* key, const std::string& value) {
    if (!value.empty()) line(key, quoted_yaml(value));
  };
  const auto number = [&](const char* key, const std::optional<double>& value) {
    if (value) line(key, csv_number(*value));
  };
  const auto time = [&](const char* key, const std::vector<std::string>& columns) {
    if (columns.size() == 1) text(key, columns.front());
    std::vector<std::string> quoted;
    std::ranges::transform(columns, std::back_inserter(quoted), quoted_yaml);
    if (columns.size() > 1) line(key, "[" + joined(quoted, ", ") + "]");
  };
  const auto seconds = [&](const char* key, const LogMap::Seconds& value) {
    if (value.each.empty()) return number(key, value.all);
    out << key << ":\n";
    for (const auto& [sensor, s] : value.each) out << "  " << quoted_yaml(sensor) << ": " << csv_number(s) << '\n';
  };
  line("pirsim_log", "1");
  line("form", word(forms(), map.form));
  line("rows", word(kinds_of_rows(), map.rows));
  line("empty", word(meanings_of_empty(), map.empty));
  time("time", map.time);
  time("end", map.end);
  text("sensor", map.sensor_column);
  text("state", map.state_column);
  text("time_zone", map.time_zone);
  line("dates", word(orders(), map.dates));
  if (map.stamps != LogMap::Stamps::end) line("stamps", word(stamps(), map.stamps));
  if (!map.sensors.empty()) out << "sensors:\n";
  for (const LogMap::Sensor& sensor : map.sensors)
    out << "  " << quoted_yaml(sensor.name) << ": " << quoted_yaml(sensor.in_log) << '\n';
  if (!map.people.empty())
    out << "people: {column: " << quoted_yaml(map.people) << ", means: " << word(meanings(), map.people_mean) << "}\n";
  if (map.people_mean == LogMap::People::none) line("people", "none");
  number("interval_s", map.interval_s);
  number("longest_gap_s", map.longest_gap_s);
  seconds("hold_s", map.hold_s);
  seconds("longest_motion_s", map.longest_motion_s);
  if (map.shift_s != 0.0) number("shift_s", map.shift_s);
  text("from", map.from);
  text("to", map.to);
  return out.str();
}

}  // namespace pirsim::io
