#include "logs/log_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ranges>
#include <tuple>
#include <utility>

#include "logs/log_head.hpp"
#include "logs/log_proof.hpp"
#include "logs/times.hpp"
#include "model/core/text.hpp"
#include "model/schema/limits.hpp"

namespace pirsim::io {
namespace {

constexpr std::string_view publishes = "MQTT publish: topic '", with_payload = "', payload '";

/// What stands between two texts; none if one of them isn't there.
std::optional<std::string_view> between(std::string_view text, std::string_view begin, std::string_view end) {
  const std::size_t from = text.find(begin);
  if (from == std::string_view::npos) return std::nullopt;
  text.remove_prefix(from + begin.size());
  const std::size_t to = text.find(end);
  return to == std::string_view::npos ? std::nullopt : std::optional(text.substr(0, to));
}

/// Terminals' colours, "ESC[0;36m", left out.
std::string without_colours(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t at = std::min(text.find("\x1B["), text.size());
    plain += text.substr(0, at);
    text.remove_prefix(at);
    if (!text.empty()) text.remove_prefix(std::min(text.find('m'), text.size() - 1) + 1);
  }
  return plain;
}

/// The time of day of "[08:37:08.123][D][...".
std::optional<std::int64_t> esphome_time(std::string_view text) {
  const std::size_t end = text.find("][");
  if (!text.starts_with('[') || end == std::string_view::npos || text.find("][", end + 3) != end + 3)
    return std::nullopt;
  const auto stamp = parse_stamp(text.substr(1, end - 1), LogMap::Dates::found);
  return stamp && stamp->kind == Stamp::Kind::time_of_day ? std::optional(stamp->us) : std::nullopt;
}

std::optional<std::int64_t> console_time(std::string_view text) {
  const auto stamp = parse_stamp(text.substr(0, text.find(' ')), LogMap::Dates::found);
  return stamp && stamp->kind == Stamp::Kind::time_of_day ? std::optional(stamp->us) : std::nullopt;
}

/// Begins so: d is a digit, ? a T or a space.
bool matches(std::string_view text, std::string_view pattern) {
  const auto is_so = [](char c, char wanted) {
    return wanted == 'd' ? c >= '0' && c <= '9' : wanted == '?' ? c == 'T' || c == ' ' : c == wanted;
  };
  return std::ranges::equal(text.substr(0, pattern.size()), pattern, is_so);
}

/// The first two words, and all that follows.
std::array<std::string_view, 3> three_words(std::string_view text) {
  std::array<std::string_view, 3> words;
  for (std::string_view& word : words) {
    word = text.substr(0, &word == &words.back() ? text.size() : text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
  }
  return words;
}

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// "2026-01-25 10:20:47" out of what stands before a message, with its fraction and its offset if it has them.
std::string_view time_in(std::string_view text) {
  constexpr std::string_view pattern = "dddd-dd-dd?dd:dd:dd";
  for (std::size_t at = 0; at + pattern.size() <= text.size(); ++at) {
    if (!matches(text.substr(at), pattern)) continue;
    const std::string_view rest = text.substr(at + pattern.size());
    std::size_t more = std::min(rest.find_first_not_of(".0123456789Z"), rest.size());
    if (more < rest.size() && (rest[more] == '+' || rest[more] == '-'))
      more = std::min(rest.find_first_not_of("0123456789:", more + 1), rest.size());
    return text.substr(at, pattern.size() + more);
  }
  return text.substr(std::min(text.find_first_not_of(' '), text.size()));  // which the timer refuses by name
}

constexpr std::array<std::string_view, 3> properties{"occupancy", "presence", "motion"};

constexpr std::size_t head_lines = 2000, head_bytes = 1'000'000;
constexpr std::size_t longest_document = 64'000'000;  // assumed: Home Assistant's history of 100 sensors and a month
constexpr std::uint64_t most_faults = 1000;

bool has_no_data(std::string_view line) { return line.find_first_not_of(" \t;,") == std::string_view::npos; }

/// What stands above the table, as loggers and spreadsheets write it: lines that begin with #, but have no time in
/// them.
bool is_comment(std::string_view line) {
  if (!line.starts_with('#')) return false;
  constexpr std::string_view separators = ",;\t";
  while (!line.empty()) {
    const std::size_t end = std::min(line.find_first_of(separators), line.size());
    const auto stamp = parse_stamp(line.substr(0, end), LogMap::Dates::found);
    if (stamp && stamp->kind != Stamp::Kind::number) return false;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return true;
}

/// How many fields a line has; 0 for what is no line of fields.
std::size_t n_fields(const std::string& line, char separator) {
  std::vector<std::string_view> fields;
  std::vector<std::string> unquoted;
  return split_fields(line, separator, fields, unquoted) ? fields.size() : 0;
}

/// "binary_sensor,entity_id=hall state="on",value=1 1772434844185564000", of InfluxDB.
bool is_line_protocol(std::string_view line) {
  const std::size_t space = line.find(' '), last = line.rfind(' ');
  const auto stamp =
      last == std::string_view::npos ? std::nullopt : parse_stamp(line.substr(last), LogMap::Dates::found);
  return stamp && last > space && line.substr(space, last - space).find('=') != std::string_view::npos &&
         stamp->number > 1e17;
}

/// What a log isn't, and what to do; empty if it may be a table.
std::string_view what_is_no_table(std::string_view first) {
  if (first.starts_with('<')) return "XML or a page: save the log as CSV";
  if (is_line_protocol(first)) return "InfluxDB's line protocol: save a query's result as CSV";
  if (!first.starts_with('[')) return {};
  return "lines of a text: those of openHAB, Zigbee2MQTT, ESPHome, Tasmota and FHEM are read";
}
/// An array or an object, and no "[08:37:08][D]".
bool is_json(std::string_view first) {
  const std::size_t inner = first.find_first_not_of(" \t", 1);
  return first.starts_with('{') ||
         (first.starts_with('[') &&
          (inner == std::string_view::npos || std::string_view("{[\"]").find(first[inner]) != std::string_view::npos));
}

/// Dashes below the names of columns, or around them, as UCI 271 and psql have them.
bool is_ruler(std::string_view line) {
  return line.find("---") < 2 && line.find_first_not_of("-+| \t") == std::string_view::npos;
}

/// Columns that stand below each other, with a tab or two spaces between them, as fields with one tab.
std::string with_tabs(std::string_view line) {
  if (line.find('|') != std::string_view::npos) return std::string(line.substr(line.starts_with('|') ? 1 : 0));
  std::string result;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t end = std::min(line.find_first_not_of(" \t", at), line.size());
    const std::string_view gap = line.substr(at, end - at);
    if (!gap.empty() && !result.empty()) result += gap == " " ? ' ' : '\t';
    const std::size_t next = std::min(line.find_first_of(" \t", end), line.size());
    result += line.substr(end, next - end);
    at = next;
  }
  while (result.ends_with('\t')) result.pop_back();
  return result;
}

/// Without folders and endings: "hall" of "logs/hall.csv.gz".
std::string name_of_file(std::filesystem::path path) {
  path = path.filename();
  const std::filesystem::path packed = path.extension();
  if (packed == ".gz" || packed == ".zst") path = path.stem();
  return path.stem().string();
}

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

}  // namespace

std::optional<TextLines::Writer> TextLines::writer_of(std::span<const HeadLine> head) {
  for (const HeadLine& line : head) {
    if (has(line.text, publishes) || has(line.text, "\tz2m:") || has(line.text, "Zigbee2MQTT:"))
      return Writer::zigbee2mqtt;
    if (has(line.text, "] [openhab.") || has(line.text, "] [org.openhab.") || has(line.text, "StateChangedEvent"))
      return Writer::openhab;
    if (esphome_time(without_colours(line.text))) return Writer::esphome;
    if (console_time(line.text) && (has(line.text, " MQT: ") || has(line.text, " RSL: "))) return Writer::tasmota;
    if (matches(line.text, "dddd-dd-dd_dd:dd:dd ")) return Writer::fhem;
    const auto [time, topic, payload] = three_words(line.text);
    if (payload.starts_with('{') && has(topic, "/") && parse_stamp(time, LogMap::Dates::found))
      return Writer::mosquitto;
  }
  return std::nullopt;
}

std::string_view TextLines::name() const {
  constexpr std::array<std::string_view, 6> names{"openHAB's log",       "Zigbee2MQTT's log", "ESPHome's log",
                                                  "mosquitto_sub's log", "Tasmota's log",     "FHEM's log"};
  return names[static_cast<std::size_t>(writer_)];
}

void TextLines::read(const HeadLine& line, std::vector<HeadLine>& rows, LogRemarks& remarks) {
  const Changes changes = changes_in(without_colours(line.text), line.line, remarks);
  if (changes.empty()) ++n_other_;
  for (const Change& change : changes) {
    rows.push_back({change.time + '\t' + quoted_field(change.sensor) + '\t' + quoted_field(change.state), line.line});
  }
}

TextLines::Changes TextLines::changes_in(std::string_view text, int line, LogRemarks& remarks) {
  switch (writer_) {
    case Writer::openhab:
      return of_openhab(text);
    case Writer::zigbee2mqtt:
      return of_zigbee2mqtt(text);
    case Writer::mosquitto:
      return of_mosquitto(text);
    case Writer::tasmota:
      return of_tasmota(text, line, remarks);
    case Writer::fhem:
      return of_fhem(text);
    case Writer::esphome:
      break;
  }
  return of_esphome(text, line, remarks);
}

/// "2024-01-31 18:02:11.123 [INFO ] [openhab.event.ItemStateChangedEvent   ] - Item 'Hall' changed from OFF to ON", in
/// old versions without Item and quotes, of groups with "through" and a member behind it, in new ones with a source.
TextLines::Changes TextLines::of_openhab(std::string_view text) {
  constexpr std::string_view message = "] - ", changed = " changed from ", to = " to ";
  const std::size_t at = text.find(message), from = text.find(changed);
  if (at == std::string_view::npos || from == std::string_view::npos || from < at + message.size()) return {};
  const std::string_view before = text.substr(0, at);
  if (!has(before, "StateChangedEvent")) return {};
  std::string_view name = text.substr(at + message.size(), from - at - message.size());
  if (name.starts_with("Item '") && name.ends_with('\'')) name = name.substr(6, name.size() - 7);
  std::string_view state = text.substr(from + changed.size());
  for (const std::string_view tail : {" through ", " (source: "}) state = state.substr(0, state.rfind(tail));
  const std::size_t last = state.rfind(to);
  if (last == std::string_view::npos) return {};
  state.remove_prefix(last + to.size());
  if (state == "UNDEF" || state == "NULL") state = "unknown";
  return {{std::string(before.substr(0, before.find(" ["))), std::string(name), std::string(state)}};
}

/// "... MQTT publish: topic 'zigbee2mqtt/hall', payload '{"occupancy":true}'".
TextLines::Changes TextLines::of_zigbee2mqtt(std::string_view text) {
  const auto topic = between(text, publishes, with_payload);
  if (!topic) return {};
  const std::string_view payload = text.substr(text.find(with_payload) + with_payload.size());
  return of_message(std::string(time_in(text.substr(0, text.find(publishes)))), *topic,
                    payload.substr(0, payload.rfind('\'')));
}

/// What mosquitto_sub -F '%I %t %p' writes: time, topic and payload.
TextLines::Changes TextLines::of_mosquitto(std::string_view text) {
  const auto [time, topic, payload] = three_words(text);
  return of_message(std::string(time), topic, payload);
}

/// "07:00:44 MQT: stat/hall/SWITCH1 = ON"; JSON says the same a second time.
TextLines::Changes TextLines::of_tasmota(std::string_view text, int line, LogRemarks& remarks) {
  const auto us = console_time(text);
  if (!us) return {};
  std::string time = since_first_midnight(*us, line, remarks);
  const auto topic = between(text, has(text, " MQT: ") ? " MQT: " : " RSL: ", " = ");
  if (!topic) return {};
  std::string_view state = text.substr(text.find(" = ") + 3);
  state = state.substr(0, state.find(' '));  // "(retained)"
  if (state != "ON" && state != "OFF") return {};
  std::string sensor(topic->substr(topic->find('/') + 1));
  if (sensor.ends_with("/SWITCH1")) sensor.resize(sensor.rfind('/'));  // to which the sensor is wired, unlike POWER
  return {{std::move(time), std::move(sensor), std::string(state)}};
}

/// "2026-03-02_07:00:44 hall_Bewegung motion: on": device, reading and value; without a reading it is the state.
TextLines::Changes TextLines::of_fhem(std::string_view text) {
  auto [time, device, value] = three_words(text);
  std::string sensor(device);
  if (const std::size_t colon = value.find(": "); colon < value.find(' ')) {
    (sensor += '_') += value.substr(0, colon);
    value.remove_prefix(colon + 2);
  }
  if (value.empty()) return {};
  return {{std::string(time), std::move(sensor), std::string(trimmed(value))}};
}

/// Of the device's properties those that tell motion. With `output: attribute` each has a topic of its own. A device
/// that is offline isn't known.
TextLines::Changes TextLines::of_message(const std::string& time, std::string_view topic, std::string_view payload) {
  std::string device(topic.substr(topic.find('/') + 1));  // without the base topic; npos + 1 is 0
  const nlohmann::json message = nlohmann::json::parse(payload, nullptr, false);
  const std::size_t slash = device.rfind('/');
  const std::string last = slash == std::string::npos ? std::string() : device.substr(slash + 1);
  std::map<std::string, std::string> states;
  if (last == "availability") {
    device.resize(slash);
    if (!has(payload, "offline")) return {};
    for (const auto& [property, told] : told_[device]) states[property] = "unavailable";
  } else if (std::ranges::find(properties, last) != properties.end() && !message.is_object()) {
    device.resize(slash);
    states[last] = message.is_discarded() ? std::string(payload) : state_text(message);
  } else if (message.is_object()) {
    for (const std::string_view property : properties) {
      if (const auto found = message.find(property); found != message.end())
        states[std::string(property)] = state_text(*found);
    }
  }
  Changes changes;
  for (const auto& [property, state] : states) {
    Change& before = told_[device][property];
    Change now{time, device + '_' + property, state};
    if (before == now) continue;  // another property changed in this second
    before = now;
    changes.push_back(std::move(now));
  }
  return changes;
}

/// "[08:37:08][D][binary_sensor:036]: 'Hall PIR': Sending state ON", or "'Hall PIR' >> ON".
TextLines::Changes TextLines::of_esphome(std::string_view text, int line, LogRemarks& remarks) {
  const auto us = esphome_time(text);
  if (!us) return {};
  std::string time = since_first_midnight(*us, line, remarks);  // of all lines, since a day may pass without motion
  const std::size_t tag = text.find("][binary_sensor:");
  const std::size_t begin = text.find('\'', std::min(tag, text.size())), end = text.rfind('\'');
  if (begin == std::string_view::npos || end <= begin) return {};
  const std::string_view state = text.substr(text.find_last_of(' ') + 1);
  if (state != "ON" && state != "OFF" && state != "UNKNOWN") return {};
  return {{std::move(time), std::string(text.substr(begin + 1, end - begin - 1)), std::string(state)}};
}

/// Lines stand in the order in which they were written, so that a clock that steps back begins a day.
std::string TextLines::since_first_midnight(std::int64_t us, int line, LogRemarks& remarks) {
  constexpr std::int64_t a_jitter_us = 60 * us_per_s, an_hour_twice_us = 7200 * us_per_s;  // assumed
  constexpr std::uint64_t some = 10;
  const std::int64_t back_us = last_us_ - us;
  if (back_us != 0) ++(back_us > 0 ? n_back_ : n_ahead_);
  if (n_back_ > n_ahead_ + some)
    throw Error(ErrorCode::input, {file_, line, 1},
                "the times fall from line to line: turn the lines round, so that the oldest is the first");
  if (back_us > a_jitter_us) {
    days_us_ += us_per_day;
    if (back_us < an_hour_twice_us) {
      remarks.add("day turns", {file_, line, 0}, [&] {
        return "the times step back by " + fixed(static_cast<double>(back_us) / (60.0 * us_per_s), 0) +
               " min: it counts as the next day, unless clocks were put back here";
      });
    }
  }
  last_us_ = us;
  return fixed(static_cast<double>(days_us_ + us) / us_per_s, 6);
}

template <typename Message>
void LogFile::fault(std::string_view kind, int line, std::size_t column, Message message) {
  const bool are_parts = shape_.separator != ' ' && source().empty() && !json_;  // of the line as it stands
  int at = 1;
  for (std::size_t i = 0; i < std::min(column, fields_.size()) && are_parts; ++i)
    at += static_cast<int>(fields_[i].size()) + 1;
  reading_.faults.add(kind, {path_, line, at}, message);
  if (reading_.faults.count() > most_faults) throw Error(ErrorCode::input, reading_.faults.issues(Severity::error));
}

template <typename Message>
void LogFile::remark(std::string_view kind, int line, Message message) {
  reading_.remarks.add(kind, {path_, line, 0}, message);
}

LogFile::LogFile(const std::filesystem::path& path, LogReading& reading, const LogObserver& observer)
    : path_(path.string()), reading_(reading), observer_(observer), timer_({}, nullptr, 0.0) {
  if (is_database(path)) {
    std::vector<std::string> entities{reading.map.people};
    for (const LogMap::Sensor& sensor : reading.map.sensors) entities.push_back(sensor.in_log);
    database_.emplace(path, entities);
    reading.classes.merge(database_->device_classes());
    head_.push_back({std::string(HomeDatabase::header), 1});
  } else {
    lines_.emplace(path);
  }
  read_head();
  find_shape();
  timer_ = LogTimer(shape_.time, reading.zone, reading.map.shift_s);
  if (shape_.end) end_timer_.emplace(*shape_.end, reading.zone, reading.map.shift_s);
  if (shape_.header_line > 0) head_.erase(head_.begin());
  n_read_fields_ = shape_.n_read_fields();
  values_.resize(shape_.sensors.size(), log_state::unknown);
  if (shape_.people) values_.push_back(log_state::unknown_count);
  cells_.resize(shape_.form == LogMap::Form::wide ? values_.size() : 0);
  reading.rows = shape_.rows;
  reading.events.begin_file();
  reading.order.restart();
  for (const std::string& name : shape_.doubtful) {
    remark("left out " + name, shape_.header_line, [&] {
      return "column '" + name +
             "' holds states, but isn't called motion, as others are: it is left out; if it is a sensor, name all of "
             "them in a map (sensors)";
    });
  }
  if (shape_.rows != LogMap::Rows::readings) return;
  if (shape_.cadence.interval_us <= 0) refuse_head();
  readings_.emplace(shape_.cadence, values_);
}

template <typename Take>
void LogFile::each_row(Take take) {
  std::vector<HeadLine> rows;
  while (database_ || text_ || json_ || is_ruled_) {
    const auto line = next_line();
    if (!line) return;
    rows.assign(text_ ? 0 : 1, *line);
    if (text_) text_->read(*line, rows, reading_.remarks);
    for (const HeadLine& row : rows) take(row.text, row.line);
  }
  while (const auto line = lines_->next()) {  // without a copy of each
    if (!has_no_data(*line)) take(*line, lines_->where().line);
  }
}

/// Rows newest first are turned round, for which all of them are kept.
void LogFile::find_shape() {
  LogMap map = map_of_head();
  if (map.files == LogMap::Files::sensors) map.sensors.clear();  // which are named as the files are
  const auto shape = [&] {
    const auto n = static_cast<std::ptrdiff_t>(std::min(head_.size(), head_lines));
    return shape_of({head_.begin(), head_.begin() + n}, map, path_, reading_.zone, reading_.rows);
  };
  shape_ = shape();
  if (shape_.is_newest_first) {
    each_row([&](std::string_view line, int number) { head_.push_back({std::string(line), number}); });
    std::reverse(head_.begin() + (shape_.header_line > 0 ? 1 : 0), head_.end());
    map.order = LogMap::Order::oldest_first;
    shape_ = shape();
    remark("order", 0, [] { return "the newest row is the first: rows are read from the end"; });
  }
  if (map.files != LogMap::Files::sensors) return;
  if (!is_of_one_sensor())
    throw Error(ErrorCode::input, Where{path_}, "files: sensors: expected a column of states alone in each file");
  shape_.names[shape_.sensors.front()] = name_of_file(path_);
}

/// A document may be one line, or all that follows.
void LogFile::take_json(std::string text) {
  const int number = lines_->where().line;
  if (has_no_data(text) || json_->add(text, number)) return;
  const std::string rest(lines_->rest(longest_document));
  if (number > 1 && has_no_data(rest))
    return remark("last line", number, [] { return "the last line ends within a value: it is left out"; });
  (text += '\n') += rest;
  if (!json_->add(text, number)) throw Error(ErrorCode::input, {path_, number, 1}, "JSON that ends within a value");
}

std::optional<HeadLine> LogFile::next_object() {
  while (json_->size() == 0) {
    const auto line = lines_->next(longest_document);
    if (!line) break;
    take_json(std::string(*line));
  }
  return json_->size() == 0 ? std::nullopt : std::optional(HeadLine{json_->next(), lines_->where().line});
}

std::optional<HeadLine> LogFile::next_line() {
  if (database_) {
    auto row = database_->next();
    return row ? std::optional(HeadLine{std::move(*row), 0}) : std::nullopt;
  }
  if (json_) return next_object();
  while (const auto line = lines_->next()) {
    if (is_ruled_ && is_ruler(*line)) continue;
    if (!has_no_data(*line)) return HeadLine{is_ruled_ ? with_tabs(*line) : std::string(*line), lines_->where().line};
  }
  return std::nullopt;
}

/// Lines above the table: "sep=;" for a spreadsheet, HOBO's "Plot Title: Room 12" for people, a station's name.
void LogFile::skip_titles() {
  while (head_.size() > 2) {
    const char separator = separator_of(head_[1].text);
    const std::size_t n = n_fields(head_[1].text, separator);
    const bool is_one = head_[0].text.starts_with("sep=") || separator_of(head_[0].text) == ' ';
    if (separator == ' ' || n < 2 || !is_one || n_fields(head_[2].text, separator) != n) return;
    head_.erase(head_.begin());
  }
}

/// Objects of the first lines tell the columns.
void LogFile::read_json_head(std::string first) {
  json_.emplace(path_);
  take_json(std::move(first));
  while (json_->size() < head_lines) {
    const auto line = lines_->next(longest_document);
    if (!line) break;
    take_json(std::string(*line));
  }
  head_.push_back({json_->header(), 1});
  while (json_->size() > 0 && head_.size() < head_lines) head_.push_back({json_->next(), lines_->where().line});
}

void LogFile::read_head() {
  std::size_t bytes = 0;
  if (!database_ && std::string_view("{[").find(lines_->front()) != std::string_view::npos) {
    HeadLine first{std::string(*lines_->next(longest_document)), 1};
    if (is_json(first.text)) return read_json_head(std::move(first.text));
    head_.push_back(std::move(first));
  }
  while (head_.size() < head_lines && bytes < head_bytes) {
    auto line = next_line();
    if (!line) break;
    bytes += line->text.size();
    if (head_.empty() && is_comment(line->text)) continue;
    head_.push_back(std::move(*line));
  }
  if (head_.empty()) throw Error(ErrorCode::input, {path_, 1, 1}, "the log is empty");
  if (database_ && head_.size() == 1)
    throw Error(ErrorCode::input, Where{path_}, "the database has no state of a binary sensor");
  if (database_) return;
  if (const auto writer = TextLines::writer_of(head_)) return read_text_head(*writer);
  const auto ruler =
      std::ranges::find_if(head_ | std::views::take(2), [](const auto& line) { return is_ruler(line.text); });
  if (ruler != (head_ | std::views::take(2)).end()) {
    is_ruled_ = true;
    std::erase_if(head_, [](const HeadLine& line) { return is_ruler(line.text); });
    for (HeadLine& line : head_) line.text = with_tabs(line.text);
  }
  skip_titles();
  if (const std::string_view other = what_is_no_table(head_.front().text); !other.empty())
    throw Error(ErrorCode::input, {path_, head_.front().line, 1}, "expected a table, got " + std::string(other));
}

/// Until it tells something: in a program's log what is looked for may come late.
void LogFile::read_text_head(TextLines::Writer writer) {
  text_.emplace(writer, path_);
  std::vector<HeadLine> rows{{std::string(HomeDatabase::header), head_.front().line}};
  for (const HeadLine& line : head_) text_->read(line, rows, reading_.remarks);
  while (rows.size() == 1) {
    const auto line = next_line();
    if (!line) {
      throw Error(ErrorCode::input, {path_, 1, 1},
                  "none of the lines of " + std::string(text_->name()) + " tells that a sensor changed");
    }
    text_->read(*line, rows, reading_.remarks);
  }
  head_ = std::move(rows);
}

/// What is known of the columns: all, if they were made here.
LogMap LogFile::map_of_head() const {
  LogMap map = reading_.map;
  if (source().empty()) return map;
  if (map.form != LogMap::Form::found && map.form != LogMap::Form::events)
    throw Error(ErrorCode::input, Where{path_},
                std::string(source()) + " has the form `events`, not what the map says");
  map.form = LogMap::Form::events;
  map.order = LogMap::Order::oldest_first;
  map.time = {"time"};
  map.sensor_column = {"sensor"};
  map.state_column = "state";
  return map;
}

void LogReading::note_row(std::int64_t us, const std::string& path, int line) {
  first_us = std::min(first_us.value_or(us), us);
  last_us = std::max(last_us.value_or(us), us);
  const std::int64_t length = std::min(us_per_day, std::int64_t{std::llround(map.longest_gap_s.value_or(1e6) * 1e6)});
  auto here = busy.find(rounded_down(us, length));
  if (here == busy.end()) here = busy.emplace(rounded_down(us, length), Busy{us, us, &path, line}).first;
  here->second.first_us = std::min(here->second.first_us, us);
  here->second.last_us = std::max(here->second.last_us, us);
  ++here->second.n_rows;
}

std::vector<LogReading::Moments> LogReading::silences(std::int64_t longer_than_us) const {
  std::vector<Moments> found;
  for (auto at = busy.begin(); at != busy.end() && std::next(at) != busy.end(); ++at) {
    const Moments silence{at->second.last_us, std::next(at)->second.first_us};
    if (silence.last_us - silence.first_us > longer_than_us) found.push_back(silence);
  }
  return found;
}

/// No two rows have different times.
void LogFile::refuse_head() {
  readings_.emplace(ReadingTracks::Cadence{1, 1}, values_);
  for (const HeadLine& line : head_) take(line.text, line.line);
  if (broken_) refuse_fields(broken_->first, broken_->second);
  if (reading_.unset.count() > 0) throw Error(ErrorCode::input, reading_.unset.issues(Severity::error));
  if (reading_.faults.count() > 0) throw Error(ErrorCode::input, reading_.faults.issues(Severity::error));
  throw Error(ErrorCode::input, {path_, head_.front().line, 1},
              with_maps(head_.size() == 1 ? "one reading alone doesn't tell for how long it holds"
                                          : "all rows have one time, so that none tells for how long it holds",
                        {"interval_s: 30", "rows: changes"}));
}

// ---------------------------------------------------------------------------------------------------------------- rows

template <typename Message>
void LogFile::leave_out(std::string_view kind, int line, Message message) {
  if (reading_.n_left_out++ == 0) reading_.left_out = {Severity::error, {path_, line, 1}, message()};
  remark(kind, line, [&] { return message() + ": the row is left out"; });
}

void LogFile::read() {
  constexpr std::uint64_t now_and_then = 1U << 14U;
  const auto take_and_tell = [&](std::string_view line, int number) {
    take(line, number);
    if (observer_.read && reading_.n_rows % now_and_then == 0) observer_.read(reading_.n_rows);
  };
  for (const HeadLine& line : std::exchange(head_, {})) take_and_tell(line.text, line.line);
  each_row(take_and_tell);
  finish();
}

void LogFile::finish() {
  if (broken_) remark("last line", broken_->first, [] { return "the last line has too few fields: it is left out"; });
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const bool is_sensor = i < shape_.sensors.size();
    CellCounts& all = reading_.columns[shape_.names[is_sensor ? shape_.sensors[i] : *shape_.people]];
    if (all.n_other == 0) std::tie(all.odd_at, all.odd_text) = std::tie(cells_[i].odd_at, cells_[i].odd_text);
    all.n_states += cells_[i].n_states;
    all.n_other += cells_[i].n_other;
  }
  if (shape_.form != LogMap::Form::wide || readings_ || n_rows_ == 0) return;
  for (const std::size_t column : shape_.sensors)  // until its last row, though that may change nothing
    reading_.events.note(*reading_.events.track(shape_.names[column]), last_us_);
}

std::optional<std::int64_t> LogFile::limit(const std::string& key, const std::string& text) const {
  if (text.empty()) return std::nullopt;
  const bool is_elapsed = timer_.clock() == LogClock::elapsed;
  if (const auto stamp = parse_stamp(text, shape_.time.order)) {
    const bool counts = stamp->kind == Stamp::Kind::number || stamp->kind == Stamp::Kind::time_of_day;
    TimeColumns columns;
    columns.kind = stamp->kind == Stamp::Kind::date ? Stamp::Kind::local : stamp->kind;
    const auto us = LogTimer(columns, reading_.zone, 0.0).read_text(text).us;
    if (us && counts == is_elapsed) return us;
  }
  throw Error(ErrorCode::usage, key + ": '" + text + "' is no time of this log; expected " +
                                    (is_elapsed ? "seconds, or hours:minutes:seconds" : "2026-03-02T08:30"));
}

std::optional<std::int64_t> LogFile::time_of_row(LogTimer& timer, const TimeColumns& columns, int line) {
  LogTimer::Read read = timer.read(fields_);
  if (read.oddity == LogTimer::Oddity::unset) {
    take_unset(read.fault, line);
    return std::nullopt;
  }
  if (!read.us) {
    fault("time", line, columns.first, [&] { return read.fault; });
    return std::nullopt;
  }
  if (read.oddity == LogTimer::Oddity::ambiguous)
    remark("ambiguous", line, [&] {
      return "clocks were put back in this hour, which " + reading_.map.time_zone +
             " has twice; what comes before they step back is taken for the first one";
    });
  if (read.oddity == LogTimer::Oddity::missing)
    remark("missing", line, [&] {
      return quoted(fields_[columns.first]) + " is a time that " + reading_.map.time_zone +
             " left out, when clocks were put forward: is it another zone?";
    });
  return read.us;
}

void LogFile::refuse_fields(int line, std::size_t n) {
  fault("fields", line, 0,
        [&] { return "expected " + counted(least_fields(), "field") + ", got " + std::to_string(n); });
}

/// As a logger that starts anew writes it. A column without a name was given one; R's numbers of rows have no field.
bool LogFile::is_header_again() const {
  const std::vector<std::string>& names = shape_.names;
  if (shape_.header_line == 0 || fields_.size() > names.size() || fields_.size() + 1 < names.size()) return false;
  const auto is_name = [](std::string_view field, const std::string& name) { return field.empty() || field == name; };
  return std::equal(fields_.rbegin(), fields_.rend(), names.rbegin(), is_name) &&
         std::ranges::any_of(fields_, [](std::string_view field) { return !field.empty(); });
}

void LogFile::take(std::string_view line, int number) {
  if (broken_) refuse_fields(broken_->first, broken_->second);  // not the last line
  broken_.reset();
  if (!split_fields(line, shape_.separator, fields_, unquoted_)) {
    fields_.clear();
    return fault("quote", number, 0, [] { return "a quote that isn't closed, or text behind one that is"; });
  }
  if (is_header_again())
    return remark("header", number, [] { return "the names of the columns stand here again: the line is left out"; });
  if (const std::size_t most = shape_.n_fields(); most > 0 && fields_.size() > most)
    return refuse_fields(number, fields_.size());
  if (fields_.size() < least_fields()) {
    broken_ = {number, fields_.size()};
    return;
  }
  const auto us = time_of_row(timer_, shape_.time, number);
  if (!us) return;
  ++reading_.n_rows;
  constexpr std::int64_t half_a_day_us = 43'200'000'000;
  if (shape_.time.kind == Stamp::Kind::time_of_day && row_us_ && *us < *row_us_ - half_a_day_us) {
    fault("midnight", number, shape_.time.first, [] {
      return "the times of day step back over midnight, and no date tells which day it is: name columns of date and "
             "time in a map (time: [Date, Time])";
    });
  }
  row_us_ = us;
  reading_.note_row(*us, path_, number);
  if (shape_.form == LogMap::Form::events) return take_event(*us, number);
  if (shape_.form == LogMap::Form::intervals) return take_interval(*us, number);
  read_values(number);
  if (reading_.order.add(*us) && reading_.back_at.line == 0) reading_.back_at = {path_, number, 1};
  const bool is_earlier = n_rows_++ > 0 && *us < last_us_;
  last_us_ = is_earlier ? last_us_ : *us;
  if (readings_) return take_readings(*us, number);
  if (!is_earlier) return take_changes(*us, number);
  leave_out("backward", number, [] { return std::string("the times step back here"); });
}

/// Of the sensors and people in this row.
void LogFile::read_values(int line) {
  const bool keeps_empty = shape_.empty == LogMap::Empty::unchanged;
  for (std::size_t i = 0; i < shape_.sensors.size(); ++i) {
    const std::string_view text = fields_[shape_.sensors[i]];
    if (keeps_empty && is_empty_cell(text)) continue;
    const auto state = read_state(text, reading_.map.states);
    values_[i] = state.value_or(log_state::unknown);
    if (!state) cells_[i].add_odd(text, path_, line);
    cells_[i].n_states += state ? 1 : 0;
  }
  if (!shape_.people) return;
  const std::string_view text = fields_[*shape_.people];
  if (keeps_empty && is_empty_cell(text)) return;
  const auto count = read_count(text);
  values_.back() = count.value_or(log_state::unknown_count);
  if (!count) cells_.back().add_odd(text, path_, line);
  cells_.back().n_states += count ? 1 : 0;
}

void LogFile::require_one_run(int line) {
  if (shape_.runs.empty()) return;
  std::vector<std::string> run;
  for (const std::size_t column : shape_.runs) run.emplace_back(fields_[column]);
  if (run_.empty()) run_ = run;
  if (run == run_) return;
  fault("runs", line, shape_.runs.front(), [&] {
    return "another run begins here (" + joined(run, ", ") + " after " + joined(run_, ", ") +
           "): a log is one stretch of time in one room; give its rows alone";
  });
}

void LogFile::take_readings(std::int64_t us, int line) {
  require_one_run(line);
  const std::int64_t stamp = us + (reading_.map.stamps == LogMap::Stamps::begin ? readings_->cadence().interval_us : 0);
  if ((reading_.from_us && stamp <= *reading_.from_us) || (reading_.to_us && stamp > *reading_.to_us)) return;
  const auto order = readings_->add(stamp, values_);
  if (order == ReadingTracks::Order::same)
    leave_out("same time", line, [] { return std::string("a second reading has the same time"); });
  if (order == ReadingTracks::Order::earlier)
    leave_out("backward", line, [] { return std::string("the times step back here"); });
  if (readings_->n_changes() > limits::log_changes)
    throw Error(ErrorCode::input, {path_, line, 1}, "more than " + std::to_string(limits::log_changes) + " changes");
}

void LogFile::take_changes(std::int64_t us, int line) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (!last_values_.empty() && last_values_[i] == values_[i]) continue;
    const bool is_people = i == shape_.sensors.size();
    EventTracks::Track* track = track_of(shape_.names[is_people ? *shape_.people : shape_.sensors[i]], line);
    if (track == nullptr) return;
    ++track->n_states;
    reading_.events.add(*track, us, values_[i]);
  }
  last_values_ = values_;
}

/// A row from before the clock was set: its sensor may have changed since the row before.
void LogFile::take_unset(const std::string& why, int line) {
  reading_.unset.add("unset", {path_, line, 0},
                     [&] { return why + ": the clock wasn't set, so that the line is left out"; });
  if (!row_us_ || shape_.form == LogMap::Form::intervals) return;
  if (shape_.form == LogMap::Form::wide) {
    std::ranges::fill(values_, log_state::unknown);
    if (shape_.people) values_.back() = log_state::unknown_count;
    if (!readings_ && n_rows_ > 0) take_changes(*row_us_, line);
  } else if (EventTracks::Track* track = track_of_row(line)) {
    reading_.events.add(*track, *row_us_, log_state::unknown);
  }
}

/// What is no state: of another kind of sensor, or a sensor's fault. From there on nothing is known.
void LogFile::take_odd_event(EventTracks::Track& track, std::int64_t us, std::int32_t unknown, int line) {
  track.add_odd(fields_[*shape_.state], path_, line);
  if (track.n_states == 0 && track.events.size() == 2)  // of many in a row, the first and the last tell all
    track.events.back().us = us;
  else
    (void)reading_.events.add(track, us, unknown);
}

EventTracks::Track* LogFile::track_of(std::string_view name, int line) {
  EventTracks::Track* track = reading_.events.track(name);
  if (track == nullptr) {
    fault("sensors", line, 0, [] { return "more than " + std::to_string(limits::log_columns) + " sensors"; });
  }
  return track;
}

EventTracks::Track* LogFile::track_of_row(int line) {
  if (shape_.sensor.empty()) return track_of(name_of_file(path_), line);
  if (shape_.sensor.size() == 1) return track_of(trimmed(fields_[shape_.sensor.front()]), line);
  std::string name;
  for (const std::size_t column : shape_.sensor) (name += name.empty() ? "" : "_") += trimmed(fields_[column]);
  return track_of(name, line);
}

void LogFile::take_interval(std::int64_t us, int line) {
  const bool is_open = trimmed(fields_[shape_.end->first]).empty();  // it goes on
  const auto end = is_open ? std::optional(us) : time_of_row(*end_timer_, *shape_.end, line);
  if (!end) return;
  if (*end < us) {
    return fault("end", line, shape_.end->first, [&] {
      return "it ends at " + quoted(fields_[shape_.end->first]) + ", before it begins at " +
             quoted(fields_[shape_.time.first]);
    });
  }
  EventTracks::Track* track = track_of_row(line);
  if (track == nullptr) return;
  const auto state =
      shape_.state ? read_state(fields_[*shape_.state], reading_.map.states) : std::optional(log_state::on);
  if (!state || *state == log_state::unknown)
    return fault("state", line, *shape_.state,
                 [&] { return quoted(fields_[*shape_.state]) + " doesn't say whether this is motion"; });
  reading_.note_row(*end, path_, line);
  ++track->n_states;
  if (*state == log_state::off) return;  // as between all intervals
  reading_.events.add(*track, us, log_state::on);
  reading_.events.add(*track, *end, is_open ? log_state::unknown : log_state::off);
  require_few_events(line);
}

void LogFile::take_event(std::int64_t us, int line) {
  EventTracks::Track* track = track_of_row(line);
  if (track == nullptr) return;
  const std::string_view name = track->in_log, text = shape_.state ? fields_[*shape_.state] : "on";
  const bool is_people = !reading_.map.people.empty() && name == reading_.map.people;
  const auto value = is_people ? read_count(text) : read_state(text, reading_.map.states);
  const std::int32_t unknown = is_people ? log_state::unknown_count : log_state::unknown;
  if (!value) return take_odd_event(*track, us, unknown, line);
  ++track->n_states;
  if (!track->events.empty() && track->events.back() == LogChange{us, 0, *value}) {
    const bool has_label = shape_.separator == ' ' && fields_.size() > n_read_fields_;
    if (has_label) return;  // CASAS' logs tell of two activities in two lines
    return remark("same event", line, [&] { return "an event of " + quoted(name) + " stands here a second time"; });
  }
  if (!reading_.events.add(*track, us, *value)) {
    if (reading_.back_at.line == 0) reading_.back_at = {path_, line, 1};
    remark("backward", line,
           [&] { return "the times of " + quoted(name) + " step back here; its events are put in order"; });
  }
  require_few_events(line);
}

void LogFile::require_few_events(int line) const {
  if (reading_.events.n_events() > limits::log_changes)
    throw Error(ErrorCode::input, {path_, line, 1}, "more than " + std::to_string(limits::log_changes) + " events");
}

}  // namespace pirsim::io
