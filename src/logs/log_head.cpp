#include "logs/log_head.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "files/disk/file.hpp"
#include "files/read/csv_reader.hpp"
#include "files/read/state_words.hpp"
#include "logs/log_proof.hpp"
#include "logs/times.hpp"
#include "model/core/text.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {
namespace {

template <typename Words>
bool is_one_of(const Words& words, std::string_view text) {
  return std::ranges::any_of(words, [&](std::string_view word) { return word == text; });
}

bool begins_with_one_of(const std::vector<std::string>& words, const auto& beginnings) {
  return std::ranges::any_of(words, [&](const std::string& word) {
    return std::ranges::any_of(beginnings, [&](std::string_view beginning) { return word.starts_with(beginning); });
  });
}

/// A first line of names has no time and no value in it, or names the time beside sensors that are numbers. "UTC"
/// beside a date names nothing.
bool is_header(const std::vector<std::string>& fields, const std::string& time_format) {
  const auto is_value = [&](const std::string& field) {
    return parse_stamp(field, LogMap::Dates::found, time_format) || parse_stamp(field, LogMap::Dates::found) ||
           order_of_date(field);
  };
  const auto is_moment = [&](const std::string& field) { return is_value(field) && !is_number(field); };
  const auto is_time = [](const std::string& field) { return what_name_says(field) == NameSays::time; };
  return std::ranges::none_of(fields, is_value) ||
         (std::ranges::any_of(fields, is_time) && std::ranges::none_of(fields, is_moment));
}

std::vector<std::string> fields_of(const HeadLine& line, char separator, const std::string& file) {
  std::vector<std::string_view> fields;
  std::vector<std::string> unquoted;
  if (!split_fields(line.text, separator, fields, unquoted))
    throw Error(ErrorCode::input, {file, line.line, 1}, "a quote that isn't closed, or text behind one that is");
  if (fields.size() > limits::log_columns) {
    throw Error(ErrorCode::input, {file, line.line, 1}, "more than " + std::to_string(limits::log_columns) + " fields");
  }
  std::vector<std::string> result;
  for (const std::string_view field : fields) result.emplace_back(trimmed(field));
  return result;
}

void check_names(const HeadTable& table) {
  std::set<std::string> known;
  for (std::size_t i = 0; i < table.n_columns(); ++i) {
    const std::string& name = table.names[i];
    const Where where{table.file, table.header_line, 1};
    if (!known.insert(name).second) throw Error(ErrorCode::input, where, "column '" + name + "' appears twice");
    if (const std::string found = invisible_character(name, Lines::many); !found.empty())
      throw Error(ErrorCode::input, where, "the name of column " + std::to_string(i + 1) + " contains " + found);
  }
}

constexpr std::array all_kinds{Stamp::Kind::absolute, Stamp::Kind::local, Stamp::Kind::date, Stamp::Kind::time_of_day,
                               Stamp::Kind::number};

using KindCounts = std::array<std::size_t, all_kinds.size()>;
void count_kind(const std::optional<Stamp>& stamp, KindCounts& n) {
  if (stamp) ++n[static_cast<std::size_t>(std::ranges::find(all_kinds, stamp->kind) - all_kinds.begin())];
}
std::optional<Stamp::Kind> kind_of_most(const KindCounts& n, std::size_t n_rows) {
  const auto most = std::ranges::max_element(n);
  if (*most == 0 || 2 * *most < n_rows) return std::nullopt;
  return all_kinds[static_cast<std::size_t>(most - n.begin())];
}

bool is_moment(std::optional<Stamp::Kind> kind) { return kind == Stamp::Kind::absolute || kind == Stamp::Kind::local; }

std::string in_map(const TimeColumns& time, const std::vector<std::string>& names) {
  if (time.more.empty()) return "time: " + quoted_yaml(names[time.first]);
  std::vector<std::string> columns{names[time.first]};
  for (const std::size_t column : time.more) columns.push_back(names[column]);
  return "time: " + quoted_yaml(columns);
}

}  // namespace

std::optional<std::int32_t> read_state(std::string_view text) {
  if (text == "0" || text == "OFF" || text == "off") return log_state::off;
  if (text == "1" || text == "ON" || text == "on") return log_state::on;
  if (text.size() > longest_state) return std::nullopt;
  const std::string word = small_letters(text);
  if (is_one_of(on_words, word)) return log_state::on;
  if (is_one_of(off_words, word)) return log_state::off;
  if (is_one_of(unknown_words, word)) return log_state::unknown;
  const auto number = decimal_number(word);
  if (number == 0.0) return log_state::off;
  if (number == 1.0) return log_state::on;
  return std::nullopt;
}

std::optional<std::int32_t> read_state(std::string_view text, const LogMap::States& words) {
  const auto number = decimal_number(text);
  const auto has = [&](const std::vector<std::string>& list) {
    return std::ranges::any_of(list, [&](const std::string& word) {
      return small_letters(word) == small_letters(text) || (number && number == decimal_number(word));
    });
  };
  if (has(words.on)) return log_state::on;
  if (has(words.off)) return log_state::off;
  if (words.above && number) return *number > *words.above ? log_state::on : log_state::off;
  return read_state(text);
}

bool is_empty_cell(std::string_view text) {
  if (text.empty()) return true;
  if (text.size() > longest_state) return false;
  const std::string word = small_letters(text);
  return word.empty() || word == "nan" || word == "null" || word == "<na>";
}

std::optional<std::int32_t> read_count(std::string_view text) {
  constexpr double most = 1e6;  // assumed: a stadium has fewer
  if (text.size() > longest_state) return std::nullopt;
  const std::string word = small_letters(text);
  if (is_one_of(unknown_words, word)) return log_state::unknown_count;
  if (const auto number = decimal_number(word);
      number && *number >= 0.0 && *number <= most && *number == std::floor(*number))
    return static_cast<std::int32_t>(*number);
  const auto state = read_state(word);
  return state && *state != log_state::unknown ? state : std::nullopt;
}

std::vector<std::string> words_of_name(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  bool is_small = false;
  for (const char letter : name) {
    const bool is_capital = letter >= 'A' && letter <= 'Z';
    const char c = lower(letter);
    const bool is_part = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80U;
    if ((!is_part || (is_capital && is_small)) && !word.empty()) words.push_back(std::exchange(word, {}));
    if (is_part) word += c;
    is_small = letter >= 'a' && letter <= 'z';
  }
  if (!word.empty()) words.push_back(word);
  return words;
}

NameSays what_name_says(std::string_view name) {
  constexpr std::array times{
      "time",      "timestamp",  "datetime", "date_time", "date",       "time_s",     "_time",        "ts",
      "t",         "epoch",      "unix",     "unixtime",  "when",       "time stamp", "last_changed", "last_updated",
      "unix_time", "created_at", "received", "utc",       "local_time", "time_ms",    "seconds",      "epoch_s"};
  constexpr std::array sensors{"entity_id", "entity", "sensor", "sensor_id", "sensorid", "device", "sensor_name",
                               "device_id", "name",   "id",     "object_id", "node",     "topic",  "friendly_name"};
  constexpr std::array states{"state",   "value",     "message", "status",  "event",
                              "reading", "new_state", "_value",  "payload", "val"};
  constexpr std::array motions{"pir", "motion", "movement"};
  constexpr std::array counts{"people", "persons", "occupants", "headcount"};
  constexpr std::array presences{"occupancy", "occupied", "presence"};
  constexpr std::array quantities{"light",    "lux",   "illumin", "temp",        "sound", "noise",
                                  "co2",      "humid", "slope",   "volt",        "batt",  "power",
                                  "pressure", "rssi",  "energy",  "linkquality", "lqi"};
  constexpr std::array devices{"door", "window", "switch", "lock", "hvac", "contact", "tamper"};
  constexpr std::array asides{"tamper",  "batt",      "lowbat", "connectiv",
                              "problem", "vibration", "avail",  "since"};  // that a motion sensor tells, too
  const std::string word = small_letters(name);
  if (is_one_of(times, word) || word.ends_with("_ts")) return NameSays::time;
  if (is_one_of(sensors, word)) return NameSays::sensor;
  if (is_one_of(states, word)) return NameSays::state;
  if (word == "count") return NameSays::count;
  const std::vector<std::string> words = words_of_name(name);
  if (words.size() > 1 && words.front() == "g") return NameSays::nothing;  // openHAB's gMotion, a group
  const bool counts_something = std::ranges::find(words, "count") != words.end();
  constexpr std::array countable{"occup", "presence", "person"};
  if (begins_with_one_of(words, counts) || (counts_something && begins_with_one_of(words, countable)))
    return NameSays::count;
  const bool is_motion = begins_with_one_of(words, motions) || begins_with_one_of(words, presences);
  if (is_motion && (begins_with_one_of(words, asides) || words.back() == "led")) return NameSays::other_quantity;
  if (begins_with_one_of(words, motions)) return NameSays::motion;
  if (begins_with_one_of(words, presences)) return NameSays::presence;
  if (begins_with_one_of(words, quantities)) return NameSays::other_quantity;
  if (begins_with_one_of(words, devices)) return NameSays::other_device;
  return NameSays::nothing;
}

int rank_as_time(std::string_view name) {
  constexpr std::array surest{"time", "timestamp", "ts", "last_changed"};
  constexpr std::array late{"received", "created_at", "last_updated"};
  const std::string word = small_letters(name);
  if (is_one_of(surest, word)) return 3;
  return what_name_says(name) == NameSays::time && !is_one_of(late, word) && !word.ends_with("_ts") ? 2 : 1;
}

std::string quoted_yaml(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string quoted_yaml(const std::vector<std::string>& list) {
  std::vector<std::string> quoted;
  for (const std::string& text : list) quoted.push_back(quoted_yaml(text));
  return "[" + joined(quoted, ", ") + "]";
}

bool is_casas_motion(std::string_view name) {
  if (!name.starts_with('M')) return false;
  name.remove_prefix(1);
  if (name.starts_with('A')) name.remove_prefix(1);  // one that sees a whole area
  return !name.empty() && std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
}

bool is_number(const std::string& text) {
  const auto stamp = parse_stamp(text, LogMap::Dates::found);
  return stamp && stamp->kind == Stamp::Kind::number;
}

std::size_t HeadTable::count(std::size_t column, const std::function<bool(const std::string&)>& holds) const {
  return static_cast<std::size_t>(std::ranges::count_if(rows, [&](const auto& row) { return holds(row[column]); }));
}

std::size_t HeadTable::n_values(std::size_t column) const {
  std::set<std::string_view> values;
  for (const auto& row : rows) values.insert(row[column]);
  return values.size();
}

std::size_t HeadTable::named(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) refuse("there is no column '" + name + "'" + near_or_all(name, names));
  return static_cast<std::size_t>(found - names.begin());
}

std::string HeadTable::columns_in_words() const {
  constexpr std::size_t most = 12;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(most, n_columns()); ++i)
    texts.push_back(shortened(names[i]) + " ('" + (rows.empty() ? "" : rows.front()[i]) + "')");
  return "; the columns and their first values: " + joined(texts, ", ") + (n_columns() > most ? ", ..." : "");
}

void HeadTable::refuse(const std::string& why) const {
  throw Error(ErrorCode::input, {file, std::max(header_line, 1), 1}, why);
}

void HeadTable::refuse_with(const std::string& why, const std::vector<std::string>& maps) const {
  refuse(with_maps(why, maps) + columns_in_words());
}

HeadTable table_of(const std::vector<HeadLine>& head, char separator, const std::string& file,
                   const std::string& time_format) {
  HeadTable table;
  table.file = file;
  for (const HeadLine& line : head) table.rows.push_back(fields_of(line, separator, file));
  if (is_header(table.rows.front(), time_format)) {
    table.header_line = head.front().line;
    table.names = table.rows.front();
    std::erase(table.rows, table.names);  // also again, as a logger that starts anew writes them
    const auto has_more = [&](const auto& row) { return row.size() == table.names.size() + 1; };
    if (separator != ' ' && !table.rows.empty() && std::ranges::all_of(table.rows, has_more))
      table.names.insert(table.names.begin(), "");  // R's numbers of rows have no name
  } else {
    table.names.resize(table.rows.front().size());
  }
  const std::size_t n = table.names.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (table.names[i].empty()) table.names[i] = "column " + std::to_string(i + 1);
  }
  check_names(table);
  // What isn't a row of this table is told when it is read.
  const auto is_other = [&](const auto& row) { return row.size() != n; };
  if (table.header_line > 0 && !table.rows.empty() && std::ranges::all_of(table.rows, is_other)) {
    throw Error(ErrorCode::input, {file, head[1].line, 1},
                "expected " + counted(n, "field") + ", got " + std::to_string(table.rows.front().size()));
  }
  if (table.header_line > 0) std::erase_if(table.rows, is_other);
  constexpr std::size_t fewest = 9;  // of fewer rows a shorter one may be a kind of its own
  if (table.rows.size() >= fewest && table.rows.back().size() < n) table.rows.pop_back();  // cut off
  for (auto& row : table.rows) row.resize(n);
  return table;
}

// Dates.

/// Of dates whose order isn't told by themselves, by what the head says.
LogMap::Dates TimeFinder::order_in(std::size_t column) const {
  if (map_.dates != LogMap::Dates::found) return map_.dates;
  std::set<int> first, last;
  LogMap::Dates year_last = LogMap::Dates::found;
  bool is_open = false, has_short_years = false;
  for (const auto& row : table_.rows) {
    const auto order = order_of_date(row[column]);
    if (!order) continue;
    if (order->order != LogMap::Dates::found) return order->order;
    is_open = true;
    has_short_years = order->last < 100;
    first.insert(order->first);
    last.insert(order->last);
    if (order->year_last != LogMap::Dates::found) year_last = order->year_last;
  }
  if (!is_open) return LogMap::Dates::found;
  // Days change before years do.
  if (has_short_years && first.size() == 1 && last.size() > 1) return LogMap::Dates::year_first;
  const bool is_year_last = !has_short_years || (last.size() == 1 && first.size() > 1);
  if (is_year_last && year_last != LogMap::Dates::found) return year_last;
  std::vector<std::string> maps{"dates: day_first"};
  if (year_last == LogMap::Dates::found) maps.push_back("dates: month_first");
  if (!is_year_last) maps.push_back("dates: year_first");
  table_.refuse(
      with_maps("'" + table_.rows.front()[column] + "' can be several dates, and no other one tells which", maps));
}

TimeColumns TimeFinder::with_date(TimeColumns time) const {
  if (time.kind != Stamp::Kind::time_of_day) return time;
  std::vector<Candidate> pairs;
  for (std::size_t i = 0; i < table_.n_columns(); ++i) {
    if (kind_of(i) == Stamp::Kind::date) pairs.push_back({pair_of(i, time.first), rank_as_time(table_.names[i])});
  }
  return pairs.empty() ? time : surest(pairs);
}

// What columns hold.

TimeFinder::TimeFinder(const HeadTable& table, const LogMap& map, LogZone* zone)
    : table_(table), map_(map), zone_(zone) {
  for (std::size_t i = 0; i < table.n_columns(); ++i) kinds_.push_back(kind_in(i));
}

std::optional<Stamp::Kind> TimeFinder::kind_in(std::size_t column) const {
  if (!table_.rows.empty() && table_.count(column, is_date_of_digits) == table_.rows.size()) return Stamp::Kind::date;
  for (const auto order : {LogMap::Dates::found, LogMap::Dates::day_first, LogMap::Dates::year_first}) {
    KindCounts n{};
    for (const auto& row : table_.rows) count_kind(stamp_of(row[column], order), n);
    if (const auto kind = kind_of_most(n, table_.rows.size())) return kind;
  }
  return std::nullopt;
}

std::optional<Stamp::Kind> TimeFinder::kind_of(const TimeColumns& time) const {
  KindCounts n{};
  for (const auto& row : table_.rows) {
    std::string text = row[time.first];
    for (const std::size_t column : time.more) (text += ' ') += row[column];
    count_kind(stamp_of(text, time.order), n);
  }
  return kind_of_most(n, table_.rows.size());
}

TimeColumns TimeFinder::column_of(std::size_t column, Stamp::Kind kind) const {
  TimeColumns time;
  time.first = column;
  time.kind = kind;
  time.format = map_.time_format;
  if (kind == Stamp::Kind::time_of_day) return time;
  if (kind != Stamp::Kind::number) {
    if (time.format.empty()) time.order = order_in(column);
    require_zone(column, time.order);
    return time;
  }
  std::vector<double> numbers;
  for (const auto& row : table_.rows) {
    const auto stamp = stamp_of(row[column], LogMap::Dates::found);
    if (stamp && stamp->kind == Stamp::Kind::number) numbers.push_back(stamp->number);
  }
  std::ranges::sort(numbers);
  set_unit(time, numbers[numbers.size() / 2], table_.names[column]);
  set_days(time, numbers);
  return time;
}

/// The name of a zone, as "CET", doesn't tell when its clocks are changed.
void TimeFinder::require_zone(std::size_t column, LogMap::Dates order) const {
  for (const auto& row : table_.rows) {
    const auto stamp = stamp_of(row[column], order);
    if (zone_ != nullptr || !stamp || stamp->zone_name.empty()) continue;
    table_.refuse(with_maps("'" + row[column] + "' has the name of a zone, which doesn't tell its summer time",
                            {"time_zone: " + zone_called(stamp->zone_name)}));
  }
}

/// Days, as spreadsheets and MATLAB count them: as seconds they would be parts of one apart. numbers: in order.
void TimeFinder::set_days(TimeColumns& time, const std::vector<double>& numbers) const {
  using Zero = TimeColumns::Zero;
  struct Days {
    Zero zero;
    const char* name;
    double from, to;
  };
  constexpr std::array all{Days{Zero::excel, "excel_days", 30'000.0, 75'000.0},  // 1982 to 2105
                           Days{Zero::matlab, "matlab_days", 720'000.0, 770'000.0}};
  const double span = numbers.back() - numbers.front(), apart = span / static_cast<double>(numbers.size());
  constexpr double longest = 3'660.0, too_fast_s = 0.05;  // assumed: no log of motion has 20 rows a second
  for (const Days& days : all) {
    const bool may_be = numbers.front() >= days.from && numbers.back() <= days.to && span <= longest &&
                        std::ranges::any_of(numbers, [](double number) { return number != std::floor(number); });
    const bool is_told = map_.time_format == days.name;
    if (!is_told && (!may_be || map_.time_format == "seconds")) continue;
    if (!is_told && apart >= too_fast_s) {
      table_.refuse_with("'" + table_.names[time.first] + "' may be days, as a spreadsheet counts them, or seconds",
                         {std::string("time_format: ") + days.name, "time_format: seconds"});
    }
    std::size_t decimals = 0;
    for (const auto& row : table_.rows) {
      const std::size_t point = row[time.first].find_first_of(".,");
      if (point != std::string::npos) decimals = std::max(decimals, row[time.first].size() - point - 1);
    }
    time.zero = days.zero;
    time.unit_us = decimals <= 6 ? us_per_s : us_per_ms;  // a millionth of a day is a tenth of a second
    return;
  }
}

/// With its time of day a date may have an offset.
TimeColumns TimeFinder::pair_of(std::size_t date, std::size_t hour) const {
  TimeColumns time = column_of(date, Stamp::Kind::local);
  time.more = {hour};
  time.kind = kind_of(time).value_or(Stamp::Kind::local);
  return time;
}

/// AM and PM, or an offset, in columns of their own.
TimeColumns TimeFinder::with_rest(TimeColumns time, const Columns& columns) const {
  for (const auto is_part : {is_half_of_day, is_offset}) {
    for (const std::size_t i : columns) {
      if (time.has(i) || table_.count(i, [&](const std::string& text) { return is_part(text); }) < table_.rows.size())
        continue;
      TimeColumns longer = time;
      longer.more.push_back(i);
      const auto kind = kind_of(longer);
      if (!kind) continue;
      longer.kind = *kind;
      time = longer;
      break;
    }
  }
  return time;
}

/// What a column of numbers tells of being the time: its name, its size, and that it grows.
TimeFinder::Numbers TimeFinder::numbers_of(std::size_t column) const {
  std::size_t n_back = 0, n_since_1970 = 0, n = 0;
  double first = 0.0, last = 0.0;
  for (const auto& row : table_.rows) {
    const auto stamp = stamp_of(row[column], LogMap::Dates::found);
    if (!stamp || stamp->kind != Stamp::Kind::number) continue;
    n_back += n > 0 && stamp->number < last ? 1 : 0;
    last = stamp->number;
    if (n++ == 0) first = last;
    double s = last;
    while (s > 1e11) s /= 1e3;
    n_since_1970 += s >= 631'152'000.0 && s < 4'102'444'800.0 ? 1 : 0;  // from 1990 to 2099
  }
  Numbers numbers;
  numbers.are_since_1970 = n_since_1970 == n;
  numbers.grow = 10 * n_back <= n && (last > first || n == 1);
  if (table_.says(column) == NameSays::time) {
    numbers.are = numbers.grow ? NumberIs::called_so_in_order : NumberIs::called_so;
  } else if (numbers.are_since_1970) {
    numbers.are = NumberIs::since_1970;
  } else if (numbers.grow && table_.header_line == 0) {
    numbers.are = NumberIs::in_order;
  }
  return numbers;
}

std::vector<std::optional<std::int64_t>> TimeFinder::times(const TimeColumns& time) const {
  LogTimer timer(time, zone_, 0.0);
  std::vector<std::optional<std::int64_t>> times;
  for (const auto& row : table_.rows)
    times.push_back(timer.read(std::vector<std::string_view>(row.begin(), row.end())).us);
  return times;
}

// Which is the time.

/// Columns of date and time, pairs of such columns, and seconds since 1970.
std::vector<TimeFinder::Candidate> TimeFinder::moments(const Columns& columns, const Columns& dates,
                                                       const Columns& hours) const {
  const auto rank = [&](std::size_t i) { return rank_as_time(table_.names[i]); };
  std::vector<Candidate> found;
  for (const Stamp::Kind kind : {Stamp::Kind::absolute, Stamp::Kind::local}) {
    for (const std::size_t i : columns) {
      if (kind_of(i) == kind) found.push_back({column_of(i, kind), 2 * rank(i)});
    }
  }
  // Where dates are called so, they are as sure as what is called time.
  for (const std::size_t date : dates) {
    for (const std::size_t hour : hours)
      found.push_back({pair_of(date, hour), rank(hour) + (table_.says(date) == NameSays::time ? 3 : 1)});
  }
  for (const std::size_t i : columns) {
    if (kind_of(i) != Stamp::Kind::number) continue;
    const Numbers numbers = numbers_of(i);
    if (numbers.are_since_1970 && (numbers.grow || numbers.are == NumberIs::called_so))
      found.push_back({column_of(i, Stamp::Kind::number), 2 * rank(i)});
  }
  return found;
}

std::vector<TimeFinder::Candidate> TimeFinder::own_numbers(const Columns& columns) const {
  NumberIs best = NumberIs::in_order;
  std::vector<Candidate> found;
  for (const std::size_t i : columns) {
    if (kind_of(i) != Stamp::Kind::number) continue;
    const NumberIs are = numbers_of(i).are;
    if (are > best) found.clear();
    best = std::max(best, are);
    if (are == best) found.push_back({column_of(i, Stamp::Kind::number), rank_as_time(table_.names[i])});
  }
  return found;
}

/// The same moments, to the second; of elapsed times as far apart.
bool TimeFinder::tell_the_same(const TimeColumns& a, const TimeColumns& b) const {
  const auto one = times(a), other = times(b);
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), most = std::numeric_limits<std::int64_t>::min();
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (!one[i] || !other[i]) continue;
    least = std::min(least, *other[i] - *one[i]);
    most = std::max(most, *other[i] - *one[i]);
  }
  if (most < least) return false;
  const bool are_elapsed = LogTimer(a, zone_, 0.0).clock() == LogClock::elapsed;
  return most - least <= us_per_s && (are_elapsed || (std::abs(least) <= us_per_s && std::abs(most) <= us_per_s));
}

TimeColumns TimeFinder::surest(std::vector<Candidate> candidates) const {
  const int best = std::ranges::max_element(candidates, {}, &Candidate::rank)->rank;
  std::erase_if(candidates, [&](const Candidate& candidate) { return candidate.rank < best; });
  const TimeColumns& first = candidates.front().time;
  std::vector<std::string> maps{in_map(first, table_.names)};
  for (const Candidate& other : candidates) {
    if (&other == &candidates.front() || tell_the_same(first, other.time)) continue;
    maps.push_back(in_map(other.time, table_.names));
  }
  if (maps.size() > 1) table_.refuse_with("several columns may be the time", maps);
  return first;
}

TimeColumns TimeFinder::find(const std::vector<std::string>& told) const {
  Columns columns;
  for (const std::string& name : told) columns.push_back(table_.named(name));
  for (std::size_t i = 0; told.empty() && i < table_.n_columns(); ++i) columns.push_back(i);
  // One that never changes isn't the time: when a sensor was bought.
  const auto is_still = [&](std::size_t i) { return table_.n_values(i) == 1; };
  const auto is_moving = [&](std::size_t i) { return is_moment(kind_of(i)) && !is_still(i); };
  if (told.empty() && std::ranges::any_of(columns, is_moving))
    std::erase_if(columns, [&](std::size_t i) { return is_moment(kind_of(i)) && is_still(i); });
  const auto of_kind = [&](Stamp::Kind kind) {
    Columns found;
    std::ranges::copy_if(columns, std::back_inserter(found), [&](std::size_t i) { return kind_of(i) == kind; });
    return found;
  };
  const Columns dates = of_kind(Stamp::Kind::date), hours = of_kind(Stamp::Kind::time_of_day);
  if (const auto found = moments(columns, dates, hours); !found.empty()) return with_rest(surest(found), columns);
  std::vector<Candidate> numbers = own_numbers(columns);
  if (numbers.empty() && !told.empty()) {
    for (const std::size_t i : of_kind(Stamp::Kind::number)) numbers.push_back({column_of(i, Stamp::Kind::number)});
  }
  if (!numbers.empty() && !hours.empty()) {  // a date, perhaps, of a kind that isn't read
    for (Candidate& candidate : numbers) candidate.rank = 0;
    for (const std::size_t i : hours) numbers.push_back({column_of(i, Stamp::Kind::time_of_day)});
  }
  if (!numbers.empty()) return surest(numbers);
  if (!hours.empty()) {
    for (const std::size_t i : hours)
      numbers.push_back({column_of(i, Stamp::Kind::time_of_day), rank_as_time(table_.names[i])});
    return with_rest(surest(numbers), columns);
  }
  const auto is_unread = [](const std::string& text) {
    constexpr int fewest = 5;
    return std::ranges::count_if(text, [](char c) { return c >= '0' && c <= '9'; }) >= fewest;
  };
  for (const std::size_t i : columns) {
    if (!table_.is_mostly(i, is_unread) || (told.empty() && is_still(i))) continue;
    if (kind_of(i) == Stamp::Kind::number)
      table_.refuse_with("no column is called a time; '" + table_.names[i] + "' has numbers that may be times",
                         {in_map(column_of(i, Stamp::Kind::number), table_.names)});
    table_.refuse(
        "'" + table_.rows.front()[i] + "' in '" + table_.names[i] + "' may be a time, but none that can be " +
        (map_.time_format.empty() ? "read" : "read by time_format, '" + map_.time_format + "'") +
        "; write it as 2026-03-02 07:00:00, or give its pattern in a map (time_format: \"%d.%m.%Y %H:%M:%S\")");
  }
  table_.refuse((told.empty() ? std::string("no column holds times")
                              : "no times can be read from '" + joined(told, "', '") + "'") +
                table_.columns_in_words());
}

}  // namespace pirsim::io
