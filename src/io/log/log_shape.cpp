#include "io/log/log_shape.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <span>
#include <utility>

#include "core/text.hpp"
#include "io/log/log_words.hpp"
#include "schema/columns.hpp"
#include "schema/limits.hpp"

namespace pirsim::io {
namespace {

/// The head as a table; every row has as many fields as the first line, the missing ones being empty.
struct HeadTable {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> names;
  int header_line = 0;

  [[nodiscard]] std::size_t n_columns() const { return names.size(); }
  /// Of the rows' fields in this column.
  [[nodiscard]] std::size_t count(std::size_t column, const std::function<bool(const std::string&)>& holds) const {
    return static_cast<std::size_t>(std::ranges::count_if(rows, [&](const auto& row) { return holds(row[column]); }));
  }
  [[nodiscard]] bool is_mostly(std::size_t column, const std::function<bool(const std::string&)>& holds) const {
    return !rows.empty() && 2 * count(column, holds) >= rows.size();
  }
};

char separator_of(const std::string& line) {
  constexpr std::array separators{',', ';', '\t'};
  const auto n = [&](char c) { return std::ranges::count(line, c); };
  const char most = *std::ranges::max_element(separators, {}, n);
  return n(most) == 0 ? ' ' : most;
}

bool is_of_kind(const std::string& text, Stamp::Kind kind, LogMap::Dates order) {
  const auto stamp = parse_stamp(text, order);
  return stamp && stamp->kind == kind;
}

bool is_number(const std::string& text) { return is_of_kind(text, Stamp::Kind::number, LogMap::Dates::found); }

/// A first line of names has no time and no value in it.
bool is_header(const std::vector<std::string>& fields) {
  return std::ranges::none_of(
      fields, [](const std::string& field) { return parse_stamp(field, LogMap::Dates::found).has_value(); });
}

std::vector<std::string> fields_of(const HeadLine& line, char separator, const std::string& file) {
  std::vector<std::string_view> fields;
  std::vector<std::string> unquoted;
  if (!split_fields(line.text, separator, fields, unquoted))
    throw Error(ErrorCode::input, {file, line.line, 1}, "a quote that isn't closed, or text behind one that is");
  if (fields.size() > limits::log_columns) {
    throw Error(ErrorCode::input, {file, line.line, 1}, "more than " + std::to_string(limits::log_columns) + " fields");
  }
  return {fields.begin(), fields.end()};
}

void check_names(const HeadTable& table, const std::string& file) {
  std::set<std::string> known;
  for (std::size_t i = 0; i < table.n_columns(); ++i) {
    const std::string& name = table.names[i];
    const Where where{file, table.header_line, 1};
    if (!known.insert(name).second) throw Error(ErrorCode::input, where, "column '" + name + "' appears twice");
    if (const std::string found = invisible_character(name, Lines::many); !found.empty())
      throw Error(ErrorCode::input, where, "the name of column " + std::to_string(i + 1) + " contains " + found);
  }
}

HeadTable table_of(const std::vector<HeadLine>& head, char separator, const std::string& file) {
  HeadTable table;
  for (const HeadLine& line : head) table.rows.push_back(fields_of(line, separator, file));
  const std::size_t n = table.rows.front().size();
  if (is_header(table.rows.front())) {
    table.header_line = head.front().line;
    table.names = table.rows.front();
    table.rows.erase(table.rows.begin());
  } else {
    table.names.resize(n);
  }
  for (std::size_t i = 0; i < n; ++i) {
    std::string& name = table.names[i];
    while (name.starts_with(' ')) name.erase(0, 1);
    while (name.ends_with(' ')) name.pop_back();
    if (name.empty()) name = "column " + std::to_string(i + 1);
  }
  check_names(table, file);
  // What isn't a row of this table is told when it is read.
  const auto is_other = [&](const auto& row) { return row.size() != n; };
  if (table.header_line > 0 && !table.rows.empty() && std::ranges::all_of(table.rows, is_other)) {
    throw Error(ErrorCode::input, {file, head[1].line, 1},
                "expected " + counted(n, "field") + ", got " + std::to_string(table.rows.front().size()));
  }
  if (table.header_line > 0) std::erase_if(table.rows, is_other);
  for (auto& row : table.rows) row.resize(n);
  return table;
}

// What the columns are.

class Finder {
 public:
  Finder(const HeadTable& table, const LogMap& map, const std::string& file) : table_(table), map_(map), file_(file) {}

  void find(LogShape& shape) {
    if (find_intervals(shape)) return;
    find_time(shape.time, map_.time);
    const auto events = map_.form == LogMap::Form::wide ? std::nullopt : sensor_and_state(shape.time);
    if (map_.form == LogMap::Form::events && !events)
      refuse("events need columns of sensors and their states; name them in a map: sensor and state");
    shape.form = events ? LogMap::Form::events : LogMap::Form::wide;
    if (events) {
      shape.sensor = events->first;
      shape.state = events->second;
    } else {
      find_wide(shape);
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(ErrorCode::input, {file_, std::max(table_.header_line, 1), 1}, why);
  }
  /// The columns with their first values, for messages.
  [[nodiscard]] std::string columns_in_words() const {
    constexpr std::size_t most = 12;
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < std::min(most, table_.n_columns()); ++i) {
      const std::string value = table_.rows.empty() ? "" : table_.rows.front()[i];
      texts.push_back(shortened(table_.names[i]) + " ('" + value + "')");
    }
    return joined(texts, ", ") + (table_.n_columns() > most ? ", ..." : "");
  }
  [[nodiscard]] std::size_t named(const std::string& name) const {
    const auto found = std::ranges::find(table_.names, name);
    if (found == table_.names.end()) refuse("there is no column '" + name + "'" + near_or_all(name, table_.names));
    return static_cast<std::size_t>(found - table_.names.begin());
  }
  [[nodiscard]] NameSays says(std::size_t column) const { return what_name_says(table_.names[column]); }
  [[nodiscard]] bool is_time(std::size_t column, Stamp::Kind kind, LogMap::Dates order) const {
    return table_.is_mostly(column, [&](const std::string& text) { return is_of_kind(text, kind, order); });
  }

  // Times.

  /// Of dates that end in their year, by what the head says.
  [[nodiscard]] LogMap::Dates order_in(std::size_t column) const {
    if (map_.dates != LogMap::Dates::found) return map_.dates;
    bool is_open = false;
    for (const auto& row : table_.rows) {
      const auto order = order_of_date(row[column]);
      if (order && *order != LogMap::Dates::found) return *order;
      is_open = is_open || order.has_value();
    }
    if (is_open) {
      refuse(
          "'" + table_.rows.front()[column] +
          "' can be two dates, and no other one tells which: say `dates: month_first` or `dates: day_first` in a map");
    }
    return LogMap::Dates::found;
  }
  void set_first(TimeColumns& time, std::size_t column, Stamp::Kind kind) const {
    time.first = column;
    time.kind = kind;
    if (kind == Stamp::Kind::number) return set_numbers(time);
    if (kind != Stamp::Kind::time_of_day) time.order = order_in(column);
  }
  void set_numbers(TimeColumns& time) const {
    std::vector<double> numbers;
    for (const auto& row : table_.rows) {
      const auto stamp = parse_stamp(row[time.first], LogMap::Dates::found);
      if (stamp && stamp->kind == Stamp::Kind::number) numbers.push_back(stamp->number);
    }
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    std::nth_element(numbers.begin(), middle, numbers.end());
    set_unit(time, *middle, table_.names[time.first]);
  }
  /// The kind of most of a column's fields.
  [[nodiscard]] std::optional<Stamp::Kind> kind_of(std::size_t column) const {
    for (const Stamp::Kind kind : {Stamp::Kind::absolute, Stamp::Kind::local, Stamp::Kind::date,
                                   Stamp::Kind::time_of_day, Stamp::Kind::number}) {
      if (is_time(column, kind, LogMap::Dates::found) || is_time(column, kind, LogMap::Dates::day_first)) return kind;
    }
    return std::nullopt;
  }
  void find_time(TimeColumns& time, const std::vector<std::string>& told) const {
    std::vector<std::size_t> columns;
    for (const std::string& name : told) columns.push_back(named(name));
    const bool is_told = !columns.empty();
    if (!is_told) {
      for (std::size_t i = 0; i < table_.n_columns(); ++i) columns.push_back(i);
      std::ranges::stable_partition(columns, [&](std::size_t i) { return says(i) == NameSays::time; });
    }
    std::vector<std::optional<Stamp::Kind>> kinds;
    for (const std::size_t column : columns) kinds.push_back(kind_of(column));
    const auto first_of = [&](Stamp::Kind kind) -> std::optional<std::size_t> {
      const auto found = std::ranges::find(kinds, std::optional(kind));
      return found == kinds.end() ? std::nullopt
                                  : std::optional(columns[static_cast<std::size_t>(found - kinds.begin())]);
    };
    for (const Stamp::Kind kind : {Stamp::Kind::absolute, Stamp::Kind::local}) {
      if (const auto column = first_of(kind)) return set_first(time, *column, kind);
    }
    const auto date = first_of(Stamp::Kind::date), hour = first_of(Stamp::Kind::time_of_day);
    if (date && hour) {
      set_first(time, *date, Stamp::Kind::local);
      time.second = *hour;
      time.kind = kind_of_pair(time);
      return;
    }
    const auto number = first_of(Stamp::Kind::number);
    if (number && (is_told || says(*number) == NameSays::time || (table_.header_line == 0 && *number == 0)))
      return set_first(time, *number, Stamp::Kind::number);
    if (hour) return set_first(time, *hour, Stamp::Kind::time_of_day);
    refuse((is_told ? "no times can be read from '" + joined(told, "', '") + "'"
                    : std::string("no column holds times; name it in a map: time")) +
           "; the columns and their first values: " + columns_in_words());
  }
  /// With its time of day a date may have an offset.
  [[nodiscard]] Stamp::Kind kind_of_pair(const TimeColumns& time) const {
    const auto is_absolute = [&](const auto& row) {
      const auto stamp = parse_stamp(row[time.first] + " " + row[*time.second], time.order);
      return stamp && stamp->kind == Stamp::Kind::absolute;
    };
    return std::ranges::any_of(table_.rows, is_absolute) ? Stamp::Kind::absolute : Stamp::Kind::local;
  }
  [[nodiscard]] static bool is_of(const TimeColumns& time, std::size_t column) {
    return column == time.first || column == time.second;
  }

  // Intervals.

  /// Columns of times that are called so.
  [[nodiscard]] std::vector<std::string> times_called(std::span<const std::string_view> words) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      const bool is_called_so = std::ranges::any_of(words_of_name(table_.names[i]), [&](const std::string& word) {
        return std::ranges::find(words, word) != words.end();
      });
      const auto kind = is_called_so ? kind_of(i) : std::nullopt;
      const auto is_state = [](const std::string& text) { return read_state(text).has_value(); };
      if (kind && (kind != Stamp::Kind::number || table_.count(i, is_state) < table_.rows.size()))
        names.push_back(table_.names[i]);
    }
    return names;
  }
  /// A begin and an end in each row, called so by the header or a map: two times alone may be when something was seen
  /// and when it was written down.
  [[nodiscard]] bool find_intervals(LogShape& shape) const {
    constexpr std::array<std::string_view, 4> begins{"start", "begin", "started", "from"};
    constexpr std::array<std::string_view, 6> ends{"end", "stop", "ended", "stopped", "finish", "to"};
    if (map_.form == LogMap::Form::wide || map_.form == LogMap::Form::events) return false;
    const bool is_told = map_.form == LogMap::Form::intervals || !map_.end.empty();
    const std::vector<std::string> begin = map_.time.empty() ? times_called(begins) : map_.time;
    const std::vector<std::string> end = map_.end.empty() ? times_called(ends) : map_.end;
    if (begin.empty() || end.empty()) {
      if (is_told) refuse("intervals need columns of their begins and ends; name them in a map: time and end");
      return false;
    }
    find_time(shape.time, begin);
    find_time(shape.end.emplace(), end);
    if (shape.end->kind != shape.time.kind || shape.end->zero != shape.time.zero)
      refuse("begins and ends of intervals are different kinds of time");
    shape.form = LogMap::Form::intervals;
    find_sensor_and_state(shape);
    return true;
  }
  void find_sensor_and_state(LogShape& shape) const {
    std::vector<std::size_t> called, texts;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      if (is_of(shape.time, i) || is_of(*shape.end, i)) continue;
      if (says(i) == NameSays::state && has_states(i)) shape.state = i;
      if (says(i) == NameSays::sensor) called.push_back(i);
      if (is_text(i)) texts.push_back(i);
    }
    if (!map_.state_column.empty()) shape.state = named(map_.state_column);
    const std::vector<std::size_t>& sensors = called.empty() ? texts : called;
    if (map_.sensor_column.empty() && sensors.size() != 1) {
      refuse(
          "intervals, of which no column or several may name the sensor; say which in a map: sensor; the columns and "
          "their first values: " +
          columns_in_words());
    }
    shape.sensor = map_.sensor_column.empty() ? sensors.front() : named(map_.sensor_column);
  }

  // Events.

  using SensorAndState = std::pair<std::size_t, std::size_t>;
  [[nodiscard]] bool has_states(std::size_t column) const {
    return table_.count(column, [](const std::string& text) {
      const auto state = read_state(text);
      return state && *state != log_state::unknown;
    }) > 0;
  }
  [[nodiscard]] bool is_text(std::size_t column) const {
    return table_.is_mostly(
        column, [](const std::string& text) { return !text.empty() && !is_number(text) && !read_state(text); });
  }
  [[nodiscard]] std::optional<SensorAndState> sensor_and_state(const TimeColumns& time) const {
    if (!map_.sensor_column.empty() || !map_.state_column.empty()) {
      if (map_.sensor_column.empty() || map_.state_column.empty())
        refuse("a map of events names both columns, sensor and state");
      return SensorAndState{named(map_.sensor_column), named(map_.state_column)};
    }
    if (table_.header_line == 0) return behind(time);
    std::optional<std::size_t> sensor, state;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      if (is_of(time, i)) continue;
      if (!sensor && says(i) == NameSays::sensor) sensor = i;
      if (!state && says(i) == NameSays::state) state = i;
    }
    if (sensor && state) return SensorAndState{*sensor, *state};
    return table_.n_columns() == 3 && !time.second ? of_three(time) : std::nullopt;
  }
  /// Without names: a sensor and its state follow the time.
  [[nodiscard]] std::optional<SensorAndState> behind(const TimeColumns& time) const {
    const std::size_t sensor = time.second.value_or(time.first) + 1;
    if (sensor + 1 >= table_.n_columns() || !is_text(sensor) || !has_states(sensor + 1)) return std::nullopt;
    return SensorAndState{sensor, sensor + 1};
  }
  [[nodiscard]] std::optional<SensorAndState> of_three(const TimeColumns& time) const {
    std::array<std::size_t, 2> rest{};
    std::size_t n = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (i != time.first) rest[n++] = i;
    }
    if (is_text(rest[0]) && has_states(rest[1])) return SensorAndState{rest[0], rest[1]};
    if (is_text(rest[1]) && has_states(rest[0])) return SensorAndState{rest[1], rest[0]};
    return std::nullopt;
  }

  // Wide logs.

  [[nodiscard]] bool looks_like_motion(std::size_t column) const {
    if (says(column) == NameSays::other_quantity) return false;
    const auto is_odd = [](const std::string& text) { return !read_state(text); };
    const auto is_quantity = [](const std::string& text) { return !read_state(text) && is_number(text); };
    const bool is_called_so = says(column) == NameSays::motion;
    const std::size_t n_odd = table_.count(column, is_odd);
    if (n_odd == 0) return has_states(column) || is_called_so;
    // Some odd words, but no number, may be a logger's; assumed: one in twenty.
    const bool is_rare = 20 * n_odd <= table_.rows.size() && table_.count(column, is_quantity) == 0;
    return has_states(column) && (is_called_so || is_rare);
  }
  [[nodiscard]] bool is_count(std::size_t column) const {
    const auto is_number = [](const std::string& text) { return read_count(text).has_value(); };
    return table_.count(column, is_number) == table_.rows.size();
  }
  /// The bookkeeping of pirsim's own rows, which tells nothing of sensors.
  [[nodiscard]] bool is_bookkeeping(std::size_t column) const {
    const bool is_ours = std::ranges::find(table_.names, "time_s") != table_.names.end();
    return is_of_area(column) || (is_ours && is_column_name(table_.names[column]));
  }
  /// Counts the people of a part of the room, not all of them, or is a door's.
  [[nodiscard]] bool is_of_area(std::size_t column) const {
    return owner_of(table_.names[column]) != Each::sensor && is_count(column);
  }
  void find_people(LogShape& shape) const {
    shape.people_mean = map_.people_mean;
    if (!map_.people.empty()) {
      shape.people = named(map_.people);
      return;
    }
    for (const NameSays wanted : {NameSays::count, NameSays::presence}) {
      for (std::size_t i = 0; i < table_.n_columns() && !shape.people; ++i) {
        if (is_of(shape.time, i) || says(i) != wanted || !is_count(i) || is_of_area(i)) continue;
        shape.people = i;
        if (wanted == NameSays::presence) shape.people_mean = LogMap::People::presence;
      }
    }
  }
  void find_sensors(LogShape& shape) const {
    for (const LogMap::Sensor& sensor : map_.sensors) shape.sensors.push_back(named(sensor.in_log));
    if (!shape.sensors.empty()) return;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      if (!is_of(shape.time, i) && i != shape.people && !is_bookkeeping(i) && looks_like_motion(i))
        shape.sensors.push_back(i);
    }
    // "occupancy" alone is the sensor, beside sensors it is what they are to tell.
    if (shape.sensors.empty() && shape.people && map_.people.empty() && shape.people_mean == LogMap::People::presence) {
      shape.sensors.push_back(*std::exchange(shape.people, std::nullopt));
      shape.people_mean = LogMap::People::count;
    }
  }
  void find_wide(LogShape& shape) const {
    if (table_.rows.empty()) refuse("there are names of columns, but no row");
    find_people(shape);
    find_sensors(shape);
    if (shape.sensors.empty()) {
      refuse(
          "no column is a motion sensor's (0 and 1, on and off, true and false); the columns and their first values: " +
          columns_in_words() + "; name the sensors in a map");
    }
    const LogTimer timer(shape.time, nullptr, 0.0);
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      const std::string& name = table_.names[i];
      const bool tells_runs = name == "room" || (timer.clock() == LogClock::elapsed &&
                                                 (name == "trial" || name == "seat" || name == "replicate"));
      if (is_bookkeeping(i) && tells_runs) shape.runs.push_back(i);
      const bool is_read =
          is_of(shape.time, i) || i == shape.people || std::ranges::find(shape.sensors, i) != shape.sensors.end();
      if (!is_read && !is_bookkeeping(i)) shape.others.push_back(name);
    }
  }

  const HeadTable& table_;
  const LogMap& map_;
  const std::string& file_;
};

}  // namespace

std::size_t LogShape::n_read_fields() const {
  std::size_t last = std::max({time.first, time.second.value_or(0), sensor, state.value_or(0), people.value_or(0)});
  if (end) last = std::max({last, end->first, end->second.value_or(0)});
  for (const std::size_t column : sensors) last = std::max(last, column);
  return last + 1;
}

LogShape shape_of(const std::vector<HeadLine>& head, const LogMap& map, const std::string& file) {
  LogShape shape;
  shape.separator = separator_of(head.front().text);
  const HeadTable table = table_of(head, shape.separator, file);
  if (table.rows.empty())
    throw Error(ErrorCode::input, {file, table.header_line, 1}, "there are names of columns, but no row");
  shape.header_line = table.header_line;
  shape.names = table.names;
  Finder(table, map, file).find(shape);
  return shape;
}

}  // namespace pirsim::io
