#include "logs/log_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ranges>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "logs/log_head.hpp"
#include "logs/log_proof.hpp"
#include "model/core/text.hpp"
#include "model/schema/columns.hpp"

namespace pirsim::io {
namespace {

// What the columns are.

class Finder {
 public:
  Finder(const HeadTable& table, const LogMap& map, LogZone* zone)
      : table_(table), map_(map), time_finder_(table, map, zone), states_(table.n_columns()) {
    for (const auto& row : table.rows) {
      for (std::size_t i = 0; i < states_.size(); ++i) {
        const auto state = state_of(row[i]);
        if (state && *state != log_state::unknown) states_[i].insert(*state);
      }
    }
  }

  void find(LogShape& shape, LogMap::Rows before) {
    if (find_intervals(shape)) return;
    time_ = time_finder_.find(map_.time);
    shape.time = time_;
    are_words_ = shape.separator == ' ';
    times_ = time_finder_.times(time_);
    require_unit();
    shape.is_newest_first =
        map_.order == LogMap::Order::newest_first || (map_.order == LogMap::Order::found && times_fall());
    if (shape.is_newest_first) return;
    auto events = sensor_and_state();
    if (map_.form == LogMap::Form::events && !events)
      table_.refuse("events need columns of sensors and their states; name them in a map: sensor and state");
    shape.form = events ? LogMap::Form::events : LogMap::Form::wide;
    if (events) {
      if (events->state && map_.state_column.empty()) take_new_state(*events);
      if (events->state) require_words(*events->state, in_map(*events) + ", ");
      if (map_.form == LogMap::Form::found && events->state) require_events(*events);
      shape.sensor = events->sensor;
      shape.state = events->state;
    } else {
      find_wide(shape);
      find_rows(shape, before);
    }
  }

 private:
  [[nodiscard]] NameSays says(std::size_t column) const { return table_.says(column); }
  [[nodiscard]] std::optional<std::int32_t> state_of(std::string_view text) const {
    return read_state(text, map_.states);
  }
  /// From row to row, as histories list them whose newest row is the first.
  [[nodiscard]] bool times_fall() const {
    constexpr std::size_t fewest = 3;
    std::size_t n_back = 0, n_on = 0;
    for (std::size_t i = 1; i < times_.size(); ++i) {
      if (!times_[i] || !times_[i - 1]) continue;
      n_back += *times_[i] < *times_[i - 1] ? 1 : 0;
      n_on += *times_[i] > *times_[i - 1] ? 1 : 0;
    }
    return n_back >= fewest && 10 * n_back >= 9 * (n_back + n_on);
  }
  /// Whole thousands are Arduino's milliseconds, or seconds.
  void require_unit() const {
    const std::string& name = table_.names[time_.first];
    const bool is_open = time_.kind == Stamp::Kind::number && time_.zero == TimeColumns::Zero::own && !unit_in(name);
    const auto is_whole = [](const auto& us) { return us.value_or(0) % (1000 * us_per_s) == 0; };
    if (!is_open || !map_.time_format.empty() || times_.size() < 3 || !std::ranges::all_of(times_, is_whole)) return;
    table_.refuse_with("'" + name + "' counts whole thousands, which may be milliseconds or seconds",
                       {"time_format: milliseconds", "time_format: seconds"});
  }
  /// Of a row: sensors may be named in several columns.
  [[nodiscard]] std::string name_in(std::size_t row, const std::vector<std::size_t>& columns) const {
    std::vector<std::string> names;
    for (const std::size_t column : columns) names.push_back(table_.rows[row][column]);
    return joined(names, "_");
  }
  [[nodiscard]] bool is_called_motion(std::size_t column) const {
    return says(column) == NameSays::motion || says(column) == NameSays::presence;
  }

  // Intervals.

  /// Columns of times that are called so.
  [[nodiscard]] std::vector<std::string> times_called(std::span<const std::string_view> words) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      const auto kind = has_word(i, words) ? time_finder_.kind_of(i) : std::nullopt;
      const auto is_state = [&](const std::string& text) { return state_of(text).has_value(); };
      if (kind && (kind != Stamp::Kind::number || table_.count(i, is_state) < table_.rows.size()))
        names.push_back(table_.names[i]);
    }
    return names;
  }
  /// A begin and an end in each row, called so by the header or a map: two times alone may be when something was seen
  /// and when it was written down.
  [[nodiscard]] bool find_intervals(LogShape& shape) const {
    constexpr std::array<std::string_view, 7> begins{"start", "begin", "started", "from", "beginn", "anfang", "von"};
    constexpr std::array<std::string_view, 8> ends{"end", "stop", "ended", "stopped", "finish", "to", "ende", "bis"};
    if (map_.form == LogMap::Form::wide || map_.form == LogMap::Form::events) return false;
    const bool is_told = map_.form == LogMap::Form::intervals || !map_.end.empty();
    if (!is_told && is_told_wide()) return false;
    const std::vector<std::string> begin = map_.time.empty() ? times_called(begins) : map_.time;
    const std::vector<std::string> end = map_.end.empty() ? times_called(ends) : map_.end;
    if (begin.empty() || end.empty()) {
      if (is_told) table_.refuse("intervals need columns of their begins and ends; name them in a map: time and end");
      return false;
    }
    // The range of a query, as InfluxDB tells it in each row.
    const auto is_constant = [&](const std::string& name) { return table_.n_values(table_.named(name)) == 1; };
    if (!is_told && table_.rows.size() > 1 && is_constant(begin.front()) && is_constant(end.front())) return false;
    shape.time = time_finder_.find(begin);
    shape.end = time_finder_.find(end);
    if (map_.time.empty() && map_.end.empty()) {
      shape.time = time_finder_.with_date(shape.time);
      shape.end = time_finder_.with_date(*shape.end);
    }
    if (shape.end->kind != shape.time.kind || shape.end->zero != shape.time.zero)
      table_.refuse("begins and ends of intervals are different kinds of time");
    shape.form = LogMap::Form::intervals;
    find_sensor_and_state(shape);
    return true;
  }
  void find_sensor_and_state(LogShape& shape) const {
    std::vector<std::size_t> called, texts, states, open;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      if (shape.time.has(i) || shape.end->has(i)) continue;
      if ((is_called_motion(i) || says(i) == NameSays::state) && has_states(i)) states.push_back(i);
      if (says(i) == NameSays::nothing && is_state_like(i) && known_states(i).size() > 1) open.push_back(i);
      if (says(i) == NameSays::sensor) called.push_back(i);
      if (is_text(i)) texts.push_back(i);
    }
    if (map_.state_column.empty() && (states.size() > 1 || (states.empty() && !open.empty()))) {
      const std::string& name = table_.names[states.empty() ? open.front() : states.front()];
      table_.refuse_with("rows have a begin and an end, and '" + name + "' may be their state, or a sensor",
                         {"form: intervals, state: " + quoted_yaml(name),
                          "form: wide, rows: readings, time: " + quoted_yaml(table_.names[shape.end->first])});
    }
    if (!states.empty()) shape.state = states.front();
    if (!map_.state_column.empty()) shape.state = table_.named(map_.state_column);
    const std::vector<std::size_t>& sensors = called.empty() ? texts : called;
    if (map_.sensor_column.empty() && sensors.size() != 1) {
      table_.refuse("intervals, of which no column or several may name the sensor; say which in a map: sensor" +
                    table_.columns_in_words());
    }
    shape.sensor = map_.sensor_column.empty() ? std::vector{sensors.front()} : named(map_.sensor_column);
  }
  [[nodiscard]] std::vector<std::size_t> named(const std::vector<std::string>& names) const {
    std::vector<std::size_t> columns;
    for (const std::string& name : names) columns.push_back(table_.named(name));
    return columns;
  }

  /// Two texts that no table of words has, or one beside a state that is known, may be states.
  void require_words(std::size_t column, const std::string& keys) const {
    std::set<std::string> words;
    for (const auto& row : table_.rows) {
      const std::string& text = row[column];
      if (!is_empty_cell(text) && text != "unavailable" && text != "unknown") words.insert(text);
      if (words.size() > 2) return;
    }
    if (words.size() != 2 || known_states(column).size() == 2) return;
    const std::string &one = *words.begin(), &other = *std::next(words.begin());
    if (is_number(one) && is_number(other) && state_of(one) != log_state::off) return;  // in order: 0 is first
    const auto map = [&](const std::string& on, const std::string& off) {
      return keys + "states: {on: [" + quoted_yaml(on) + "], off: [" + quoted_yaml(off) + "]}";
    };
    std::vector<std::string> maps;
    if (state_of(one) != log_state::on && state_of(other) != log_state::off) maps.push_back(map(other, one));
    if (state_of(one) != log_state::off && state_of(other) != log_state::on) maps.push_back(map(one, other));
    table_.refuse_with("'" + one + "' and '" + other + "' in '" + table_.names[column] +
                           "' may be states, of which no word says that it is motion",
                       maps);
  }

  /// Where one of two texts follows on the other, name by name of another column, they are states of its sensors.
  void require_words_of_names() const {
    constexpr double nearly_all = 0.9;  // assumed
    const std::size_t n_rows = table_.rows.size();
    for (std::size_t sensor = 0; sensor < table_.n_columns(); ++sensor) {
      if (time_.has(sensor) || table_.n_values(sensor) < 2 || 2 * table_.n_values(sensor) > n_rows) continue;
      for (std::size_t state = 0; state < table_.n_columns(); ++state) {
        if (state == sensor || time_.has(state) || table_.n_values(state) != 2) continue;
        std::vector<NamedRow> rows;
        for (const auto& row : table_.rows)
          rows.push_back({0, row[sensor], row[state] == table_.rows.front()[state] ? log_state::on : log_state::off});
        if (proof_of_names(rows).own_turns >= nearly_all) require_words(state, in_map({{sensor}, state}) + ", ");
      }
    }
  }

  // Events.

  struct SensorAndState {
    std::vector<std::size_t> sensor;
    std::optional<std::size_t> state;  ///< none: each row is motion that begins
  };
  [[nodiscard]] std::string in_map(const SensorAndState& pair) const {
    return "form: events, sensor: " + quoted_yaml(table_.names[pair.sensor.front()]) +
           ", state: " + quoted_yaml(table_.names[*pair.state]);
  }
  [[nodiscard]] static std::vector<SensorAndState> pairs_of(const std::vector<std::size_t>& sensor,
                                                            const std::vector<std::size_t>& states) {
    std::vector<SensorAndState> pairs;
    for (const std::size_t i : states) pairs.push_back({sensor, i});
    return pairs;
  }
  [[noreturn]] void refuse_pairs(const std::string& why, const std::vector<SensorAndState>& pairs) const {
    std::vector<std::string> maps;
    for (const SensorAndState& pair : pairs) maps.push_back(in_map(pair));
    table_.refuse_with(why, maps);
  }

  [[nodiscard]] bool has_states(std::size_t column) const { return !known_states(column).empty(); }
  [[nodiscard]] const std::set<std::int32_t>& known_states(std::size_t column) const { return states_[column]; }
  [[nodiscard]] bool is_text(std::size_t column) const {
    return table_.is_mostly(
        column, [&](const std::string& text) { return !text.empty() && !is_number(text) && !state_of(text); });
  }
  /// Rows that have the same value in `a` have the same in `b`.
  [[nodiscard]] bool tells(std::size_t a, std::size_t b) const {
    std::map<std::string_view, std::string_view> of;
    return std::ranges::all_of(table_.rows,
                               [&](const auto& row) { return of.try_emplace(row[a], row[b]).first->second == row[b]; });
  }
  /// 1, 2, 3, ... from row to row.
  [[nodiscard]] bool numbers_rows(std::size_t column) const {
    std::optional<std::int32_t> last;
    return std::ranges::all_of(table_.rows, [&](const auto& row) {
      const auto number = read_count(row[column]);
      const bool follows = number && (!last || *number == *last + 1);
      last = number;
      return follows;
    });
  }
  [[nodiscard]] bool is_left_open(std::size_t column) const {
    const bool is_other = time_.has(column) || is_bookkeeping(column) || numbers_rows(column);
    return says(column) == NameSays::nothing && !is_other;
  }

  /// Whether `old` tells in each row what `now` told in the sensor's row before; `assumed`: a tenth of them got lost.
  [[nodiscard]] bool is_before(const std::vector<std::size_t>& sensor, std::size_t old, std::size_t now) const {
    std::map<std::string, std::size_t> last;
    std::size_t n_turns = 0, n_odd = 0;
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
      const auto [at, is_first] = last.try_emplace(name_in(i, sensor), i);
      const std::size_t before = std::exchange(at->second, i);
      n_turns += cell(i, now) != cell(before, now) ? 1 : 0;
      n_odd += !is_first && cell(i, old) != cell(before, now) ? 1 : 0;
    }
    return n_turns >= 2 && 10 * n_odd <= n_turns;
  }
  [[nodiscard]] bool has_word(std::size_t column, std::span<const std::string_view> words) const {
    return std::ranges::any_of(words_of_name(table_.names[column]),
                               [&](const std::string& word) { return std::ranges::find(words, word) != words.end(); });
  }
  /// 1: "old_state", -1: "new"; 0: neither.
  [[nodiscard]] int age(std::size_t column) const {
    constexpr std::array<std::string_view, 8> old{"old", "from", "before", "previous", "prev", "last", "alt", "von"};
    constexpr std::array<std::string_view, 8> now{"new", "to", "after", "current", "now", "next", "neu", "nach"};
    return (has_word(column, old) ? 1 : 0) - (has_word(column, now) ? 1 : 0);
  }
  /// Of an old and a new state in each row the new one. Where each row is a change, names alone tell them apart.
  void take_new_state(SensorAndState& pair) const {
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      if (known_states(i).size() < 2 || !is_before(pair.sensor, *pair.state, i)) continue;
      const int younger = is_before(pair.sensor, i, *pair.state) ? age(*pair.state) - age(i) : 1;
      if (younger == 0 && says(*pair.state) == says(i))
        refuse_pairs("two columns say the contrary of each other in each row, so that one is the state before",
                     {pair, {pair.sensor, i}});
      if (younger > 0) pair.state = i;
    }
  }

  /// Columns that may hold the states of sensors that `sensor` names: called so; or called motion, or presence; or any.
  [[nodiscard]] std::vector<std::size_t> states_beside(const std::vector<std::size_t>& sensor) const {
    std::array<std::vector<std::size_t>, 3> by_rank;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      if (std::ranges::find(sensor, i) != sensor.end() || time_.has(i) || is_bookkeeping(i)) continue;
      if (says(i) == NameSays::state) by_rank[0].push_back(i);  // also where the first lines are of other quantities
      if (!has_states(i)) continue;
      if (is_called_motion(i)) by_rank[1].push_back(i);
      if (says(i) == NameSays::nothing && looks_like_motion(i)) by_rank[2].push_back(i);
    }
    for (std::vector<std::size_t>& columns : by_rank) {
      const bool is_left = &columns == by_rank.data() && !by_rank[1].empty() &&  // "online" beside motion's 1
                           std::ranges::none_of(columns, [&](std::size_t i) { return has_states(i); });
      if (columns.empty() || is_left) continue;
      std::size_t most = 0;  // flags that never change are no states beside those that do
      for (const std::size_t i : columns) most = std::max(most, known_states(i).size());
      std::erase_if(columns, [&](std::size_t i) { return known_states(i).size() < most; });
      std::erase_if(columns, [&](std::size_t i) {  // another one's copy
        return i != columns.front() && tells(i, columns.front()) && tells(columns.front(), i) &&
               known_states(i).size() > 1;
      });
      return columns;
    }
    return {};
  }
  /// The one that names all others' things, too.
  [[nodiscard]] std::optional<std::size_t> finest(const std::vector<std::size_t>& columns) const {
    for (const std::size_t column : columns) {
      if (std::ranges::all_of(columns, [&](std::size_t other) { return tells(column, other); })) return column;
    }
    return std::nullopt;
  }

  /// Of sensors and people, by the map: columns, or entities.
  [[nodiscard]] std::vector<std::string> told_names() const {
    std::vector<std::string> names;
    for (const LogMap::Sensor& sensor : map_.sensors) names.push_back(sensor.in_log);
    if (!map_.people.empty()) names.push_back(map_.people);
    return names;
  }
  [[nodiscard]] bool is_told_wide() const {
    return map_.rows != LogMap::Rows::found || map_.interval_s ||
           std::ranges::any_of(told_names(), [&](const std::string& name) { return is_called(name); });
  }
  [[nodiscard]] std::optional<SensorAndState> sensor_and_state() const {
    if (map_.form == LogMap::Form::wide) return std::nullopt;
    if (!map_.sensor_column.empty() && !map_.state_column.empty())
      return SensorAndState{named(map_.sensor_column), table_.named(map_.state_column)};
    if (!map_.sensor_column.empty()) {
      const std::vector<std::size_t> sensor = named(map_.sensor_column), states = states_beside(sensor);
      if (states.size() > 1) refuse_pairs("several columns hold states of each sensor", pairs_of(sensor, states));
      if (states.size() == 1) return SensorAndState{sensor, states.front()};
    }
    if (map_.form == LogMap::Form::events && map_.state_column.empty() && map_.hold_s != LogMap::Seconds{})
      return SensorAndState{named(map_.sensor_column), std::nullopt};
    if (map_.form == LogMap::Form::found && is_told_wide()) return std::nullopt;
    if (table_.header_line == 0) {
      if (const auto found = behind()) return found;
    }
    const auto found = called();
    return found ? found : proven();
  }
  /// Without names: a sensor and its state follow the time.
  [[nodiscard]] std::optional<SensorAndState> behind() const {
    const std::size_t sensor = time_.last() + 1;
    const auto is_casas = [](const std::string& text) { return is_casas_motion(text); };
    std::size_t state = sensor + 1;
    if (sensor < table_.n_columns() && table_.count(sensor, is_casas) > 0)  // whose places may follow
      while (state + 1 < table_.n_columns() && !has_states(state)) ++state;
    if (state >= table_.n_columns() || !is_text(sensor) || !has_states(state)) return std::nullopt;
    const bool is_sentence =  // "hall motion detected"
        are_words_ && known_states(state).size() < 2 && table_.count(sensor, is_casas) == 0;
    return is_sentence ? std::nullopt : std::optional(SensorAndState{{sensor}, state});
  }
  /// A column that is called as sensors' names are.
  [[nodiscard]] std::optional<SensorAndState> called() const {
    const std::size_t n = table_.rows.size();
    std::vector<std::size_t> sensors;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      const bool is_number_of_row = table_.n_values(i) == n && (n >= 8 || !is_text(i));
      if (says(i) == NameSays::sensor && !time_.has(i) && !is_number_of_row) sensors.push_back(i);
    }
    const auto is_constant = [&](std::size_t i) { return table_.n_values(i) == 1; };
    if (!std::ranges::all_of(sensors, is_constant)) std::erase_if(sensors, is_constant);
    if (sensors.empty()) return std::nullopt;
    const std::size_t sensor = finest(sensors).value_or(sensors.front());
    const std::vector<std::size_t> states = states_beside({sensor});
    if (states.empty()) return std::nullopt;
    const bool is_one_device = table_.n_values(sensor) == 1 && says(states.front()) != NameSays::state;
    if (is_one_device && map_.form != LogMap::Form::events) return std::nullopt;
    if (!finest(sensors)) {
      std::vector<SensorAndState> pairs;
      for (const std::size_t i : sensors) pairs.push_back({{i}, states.front()});
      refuse_pairs("several columns name sensors", pairs);
    }
    if (states.size() > 1)
      refuse_pairs("several columns hold states of each '" + table_.names[sensor] + "'", pairs_of({sensor}, states));
    return SensorAndState{{sensor}, states.front()};
  }
  /// Names that return in step, mostly with the same state, are readings, which hold for the time before them.
  void require_events(const SensorAndState& pair) const {
    constexpr std::size_t few_rows = 8;
    std::map<std::string, std::vector<StateRow>> by_name;
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
      if (times_[i]) by_name[name_in(i, pair.sensor)].push_back({*times_[i], {cell(i, *pair.state)}});
    }
    std::size_t n_readings = 0, n_others = 0;
    for (const auto& [name, rows] : by_name) {
      if (rows.size() < few_rows) continue;
      const RowsProof proof = proof_of_rows(rows);
      std::size_t n_same = 0;
      for (std::size_t i = 1; i < rows.size(); ++i) n_same += rows[i].states == rows[i - 1].states ? 1 : 0;
      (proof.are == RowsProof::Are::readings && 2 * n_same > rows.size() ? n_readings : n_others) += rows.size();
    }
    if (n_readings <= n_others) return;
    table_.refuse_with(
        "each name returns in step, and mostly nothing changed: these are readings, each of the time before it, which "
        "are read from a table with a column a sensor; or events with a heartbeat",
        {in_map(pair)});
  }
  enum class Proof { none, open, given };
  /// Whether rows tell that these are sensors and their states, though no name says so.
  [[nodiscard]] Proof proof_of(std::size_t sensor, std::size_t state) const {
    const std::size_t n = table_.n_values(sensor), n_rows = table_.rows.size();
    const bool has_names = is_text(sensor);
    const bool has_all = table_.count(sensor, [](const std::string& text) { return text.empty(); }) == 0 && n >= 2;
    const bool are_states = is_state_like(sensor);
    if (!has_all || known_states(state).size() < 2) return Proof::none;
    const bool are_few = n_rows < 8;
    if (2 * n > n_rows && !are_few) return Proof::none;
    const auto is_whole = [](const std::string& text) { return read_count(text).has_value(); };
    if (!has_names && table_.count(sensor, is_whole) < n_rows) return Proof::none;
    std::vector<NamedRow> rows;
    std::vector<StateRow> merged;
    for (std::size_t i = 0; i < n_rows; ++i) {
      if (!times_[i]) continue;
      rows.push_back({*times_[i], table_.rows[i][sensor], cell(i, state)});
      merged.push_back({*times_[i], {rows.back().state}});
    }
    const NamesProof names = proof_of_names(rows);
    constexpr double nearly_all = 0.9, many = 0.3, some = 0.1;  // assumed, as in log_proof.cpp
    const bool own = names.own_turns >= nearly_all, all = names.all_turns >= nearly_all;
    if (are_states) {  // another sensor's, one of which changes at a time; or numbers of sensors
      const bool are_readings = proof_of_rows(state_rows({sensor, state})).are == RowsProof::Are::readings;
      return !own || are_readings || (all && names.turns_at_switch == 0.0) ? Proof::none : Proof::open;
    }
    if (own && !all) return Proof::given;
    if (2 * n > n_rows) return Proof::open;
    if (!has_names) return own ? Proof::open : Proof::none;
    if (names.same_time >= many) return Proof::given;
    if (proof_of_rows(merged).are == RowsProof::Are::readings) return Proof::none;
    return names.switches >= some ? Proof::given : Proof::open;
  }
  /// Columns whose names and states prove each other.
  [[nodiscard]] std::optional<SensorAndState> proven() const {
    constexpr std::size_t most = 20;  // assumed: tables of events are narrow, many columns of states are many sensors
    std::vector<SensorAndState> given, open;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      if (table_.n_columns() > most && is_state_like(i)) continue;
      const auto has = [&](const std::string& name) {
        return table_.count(i, [&](const std::string& text) { return text == name; }) > 0;
      };
      const std::vector<std::string> told = told_names();
      if (!is_left_open(i) || (!told.empty() && std::ranges::none_of(told, has))) continue;
      for (const std::size_t state : states_beside({i})) {
        const Proof proof = proof_of(i, state);
        if (proof == Proof::given) given.push_back({{i}, state});
        if (proof == Proof::open) open.push_back({{i}, state});
      }
    }
    if (given.size() == 1) return given.front();
    if (given.size() > 1) refuse_pairs("several columns may name sensors, or hold their states", given);
    if (open.empty()) return std::nullopt;
    table_.refuse_with(
        "'" + table_.names[open.front().sensor.front()] + "' may name sensors, whose events these are, or not",
        {in_map(open.front()), "form: wide"});
  }

  // Wide logs.

  [[nodiscard]] bool is_state_like(std::size_t column) const {
    return has_states(column) && table_.count(column, [&](const auto& text) { return !state_of(text); }) == 0;
  }
  [[nodiscard]] bool looks_like_motion(std::size_t column) const {
    if (says(column) == NameSays::other_quantity) return false;
    const auto is_odd = [&](const std::string& text) { return !state_of(text); };
    const auto is_quantity = [&](const std::string& text) { return !state_of(text) && is_number(text); };
    const bool is_called_so = says(column) == NameSays::motion;
    const std::size_t n_odd = table_.count(column, is_odd);
    if (n_odd == 0) return has_states(column) || is_called_so;
    // Some odd words, but no number, may be a logger's; assumed: one in twenty.
    const bool is_rare = 20 * n_odd <= table_.rows.size() && table_.count(column, is_quantity) == 0;
    return has_states(column) && (is_called_so || is_rare);
  }
  /// In numbers: `people_detected` is on and off.
  [[nodiscard]] std::size_t n_counts(std::size_t column) const {
    return table_.count(column, [](const std::string& text) {
      const bool is_word = !is_number(text) && read_state(text) != log_state::unknown;
      return read_count(text).has_value() && !is_word;
    });
  }
  [[nodiscard]] bool is_count(std::size_t column) const { return n_counts(column) == table_.rows.size(); }
  /// Also if one number in a hundred is none of people: a door's counter falls below 0 now and then.
  [[nodiscard]] bool counts_people(std::size_t column) const {
    const auto is_odd = [](const std::string& text) { return is_number(text) && !read_count(text); };
    const std::size_t n_odd = table_.count(column, is_odd);
    return says(column) == NameSays::count && n_odd <= std::max<std::size_t>(1, table_.rows.size() / 100) &&
           n_counts(column) + n_odd == table_.rows.size();
  }
  /// The bookkeeping of pirsim's own rows, which tells nothing of sensors.
  [[nodiscard]] bool is_bookkeeping(std::size_t column) const {
    return is_of_area(column) || (is_called("time_s") && is_column_name(table_.names[column]));
  }
  /// Counts the people of a part of the room, not all of them, or is a door's.
  [[nodiscard]] bool is_of_area(std::size_t column) const {
    return owner_of(table_.names[column]) != Each::sensor && is_count(column);
  }
  [[nodiscard]] bool is_mapped(std::size_t column) const {
    return std::ranges::find(map_.sensors, table_.names[column], &LogMap::Sensor::in_log) != map_.sensors.end();
  }
  [[nodiscard]] std::string people_map(std::size_t column) const {
    return "people: " + quoted_yaml(table_.names[column]);
  }
  /// Counts by their name. What is called presence is as well a sensor, so that only a map makes it the truth.
  void find_people(LogShape& shape) const {
    shape.people_mean = map_.people_mean;
    if (map_.people_mean == LogMap::People::none) return;
    if (!map_.people.empty()) {
      shape.people = table_.named(map_.people);
      if (is_mapped(*shape.people)) table_.refuse("'" + map_.people + "' can't be a sensor and the people");
      return;
    }
    std::vector<std::size_t> counts, presences, sensors;
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      if (time_.has(i) || is_of_area(i) || is_mapped(i)) continue;
      if (counts_people(i)) {
        counts.push_back(i);
      } else if ((says(i) == NameSays::presence || says(i) == NameSays::count) && looks_like_motion(i) &&
                 !is_bookkeeping(i)) {
        presences.push_back(i);
      } else if (looks_like_motion(i) && !is_bookkeeping(i)) {
        sensors.push_back(i);
      }
    }
    if (counts.size() > 1) {
      table_.refuse_with(
          "'" + table_.names[counts[0]] + "' and '" + table_.names[counts[1]] + "' may both count the people",
          {people_map(counts[0]), people_map(counts[1]), "people: none"});
    }
    if (counts.size() == 1) shape.people = counts.front();
    if (presences.size() == 1 && counts.empty() && !sensors.empty() && map_.sensors.empty()) {
      const std::string name = quoted_yaml(table_.names[presences.front()]);
      table_.refuse_with("'" + table_.names[presences.front()] + "' may be a sensor, or tell whether anybody is there",
                         {"people: none", "people: {column: " + name + ", means: presence}"});
    }
  }
  void find_sensors(LogShape& shape) const {
    for (const LogMap::Sensor& sensor : map_.sensors) {
      const auto is_here = [&](const LogMap::Sensor& other) {
        return other.name == sensor.name && is_called(other.in_log);
      };
      if (is_called(sensor.in_log) || std::ranges::none_of(map_.sensors, is_here))  // else another file has this name
        shape.sensors.push_back(table_.named(sensor.in_log));
    }
    if (!shape.sensors.empty()) return;
    const bool are_ours = is_called("time_s");
    const bool is_beside_motion = has_motion();
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      if (time_.has(i) || counts_people(i) || i == shape.people || is_bookkeeping(i) || !looks_like_motion(i)) continue;
      // Beside sure ones, devices of other kinds are none, nor are flags and numbers that never change.
      const bool may_be_flag = says(i) == NameSays::other_device || says(i) == NameSays::sensor ||
                               (says(i) == NameSays::nothing && known_states(i).size() < 2);
      if (is_told_by_count(i, shape) || (may_be_flag && has_sure_sensors())) continue;
      if (says(i) == NameSays::nothing && is_beside_motion && !are_ours) {
        shape.doubtful.push_back(table_.names[i]);
        continue;
      }
      shape.sensors.push_back(i);
    }
  }
  [[nodiscard]] bool is_called(const std::string& name) const {
    return std::ranges::find(table_.names, name) != table_.names.end();
  }
  /// Beside what is called motion or presence, other states may be the truth, or doors.
  [[nodiscard]] bool has_motion() const {
    return std::ranges::any_of(std::views::iota(std::size_t{0}, table_.n_columns()), [&](std::size_t i) {
      return !time_.has(i) && is_called_motion(i) && has_states(i) && !is_bookkeeping(i);
    });
  }
  [[nodiscard]] bool has_sure_sensors() const {
    return std::ranges::any_of(std::views::iota(std::size_t{0}, table_.n_columns()), [&](std::size_t i) {
      const bool is_sure = table_.header_line == 0 && is_state_like(i) && known_states(i).size() > 1;
      return !time_.has(i) && has_states(i) && (is_called_motion(i) || says(i) == NameSays::state || is_sure);
    });
  }
  /// Whether anybody is there, beside how many.
  [[nodiscard]] bool is_told_by_count(std::size_t column, const LogShape& shape) const {
    const auto agrees = [&](const auto& row) {
      const auto count = read_count(row[*shape.people]), state = state_of(row[column]);
      return count && state && (*count > 0) == (*state == log_state::on);
    };
    return shape.people && says(column) == NameSays::presence && known_states(column).size() > 1 &&
           std::ranges::all_of(table_.rows, agrees);
  }
  void require_no_opposites(const LogShape& shape) const {
    constexpr std::size_t most = 20;  // assumed: of more, nobody tells each twice
    if (!map_.sensors.empty() || shape.sensors.size() > most) return;
    const std::vector<StateRow> rows = state_rows(shape.sensors);
    for (std::size_t a = 0; a < shape.sensors.size(); ++a) {
      for (std::size_t b = a + 1; b < shape.sensors.size(); ++b) {
        if (!are_opposites(rows, a, b)) continue;
        const std::string &one = table_.names[shape.sensors[a]], &other = table_.names[shape.sensors[b]];
        table_.refuse_with("'" + one + "' is always on when '" + other + "' is off: one of them is no sensor",
                           {"sensors: [" + quoted_yaml(one) + "]", "sensors: [" + quoted_yaml(other) + "]"});
      }
    }
  }

  // Their rows.

  /// What a cell says, and `not_told` where it says that the state isn't known, which an empty one doesn't.
  static constexpr std::int32_t not_told = log_state::unknown + 1;
  [[nodiscard]] std::int32_t cell(std::size_t row, std::size_t column) const {
    const std::string& text = table_.rows[row][column];
    if (is_empty_cell(text)) return log_state::unknown;
    const auto state = state_of(text);
    return state && *state != log_state::unknown ? *state : not_told;
  }
  [[nodiscard]] std::vector<StateRow> state_rows(const std::vector<std::size_t>& columns) const {
    std::vector<StateRow> rows;
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
      if (!times_[i]) continue;
      StateRow& row = rows.emplace_back(StateRow{*times_[i], {}});
      for (const std::size_t column : columns) row.states.push_back(cell(i, column));
    }
    return rows;
  }
  /// What empty cells mean; where they mean no change, they are filled.
  void find_empty(LogShape& shape, std::vector<StateRow>& rows) const {
    shape.empty = map_.empty;
    if (map_.empty == LogMap::Empty::found) {
      const Cells cells = cells_of(rows);
      if (cells == Cells::scattered) {
        table_.refuse_with("many cells are empty: their states may be unchanged, or unknown",
                           {"empty: unchanged", "empty: unknown"});
      }
      shape.empty = cells == Cells::pivot ? LogMap::Empty::unchanged : LogMap::Empty::unknown;
    }
    if (shape.empty != LogMap::Empty::unchanged) return;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      for (std::size_t k = 0; k < rows[i].states.size(); ++k) {
        if (rows[i].states[k] == log_state::unknown) rows[i].states[k] = rows[i - 1].states[k];
      }
    }
  }
  /// Whether rows are readings or changes. `before`: what they are in files that were read before, or found.
  void find_rows(LogShape& shape, LogMap::Rows before) const {
    std::vector<StateRow> rows = state_rows(shape.sensors);
    find_empty(shape, rows);
    for (std::size_t i = 0, row = 0; i < table_.rows.size() && shape.people; ++i) {
      if (times_[i]) rows[row++].states.push_back(read_count(table_.rows[i][*shape.people]).value_or(not_told));
    }
    const RowsProof proof = proof_of_rows(rows);
    shape.cadence = proof.usual;
    shape.rows = map_.interval_s ? LogMap::Rows::readings : map_.rows;
    if (shape.rows == LogMap::Rows::found) {
      const bool is_either = proof.are == RowsProof::Are::either;
      const bool are_ours = proof.are_in_step && table_.names[time_.first] == "time_s";
      shape.rows = proof.are == RowsProof::Are::changes ? LogMap::Rows::changes : LogMap::Rows::readings;
      if (before != LogMap::Rows::found && (is_either || rows.size() < 8)) {
        shape.rows = before;
      } else if (is_either && shape.empty == LogMap::Empty::unchanged) {
        shape.rows = LogMap::Rows::changes;
      } else if (is_either && !are_ours && shape.cadence.interval_us > 0) {
        table_.refuse_with(
            "rows may be readings, each of the time before it, or changes that hold until the next: " + proof.why,
            {"rows: readings", "rows: changes"});
      }
    }
    if (map_.interval_s) {
      shape.cadence.interval_us = std::llround(*map_.interval_s * 1e6);
      shape.cadence.longest_gap_us = 3 * shape.cadence.interval_us / 2;
    }
    if (map_.longest_gap_s) shape.cadence.longest_gap_us = std::llround(*map_.longest_gap_s * 1e6);
  }
  /// No column has states: they may be called otherwise, or rows are the begins of motion.
  [[noreturn]] void refuse_wide(bool are_of_sentence) const {
    std::vector<std::string> sensor;
    bool has_more = false;
    if (!are_words_ && map_.sensors.empty()) require_words_of_names();
    for (std::size_t i = 0; i < table_.n_columns() && map_.sensors.empty(); ++i) {
      if (time_.has(i)) continue;
      const bool may_be = says(i) == NameSays::nothing || says(i) == NameSays::state || is_called_motion(i);
      if (!are_words_ && may_be && !is_bookkeeping(i)) require_words(i, "");
      has_more = has_more || !is_text(i) || !sensor.empty();
      sensor = {table_.names[i]};
    }
    if (!has_more) {
      table_.refuse_with(
          "no column is a motion sensor's, and each row may be motion that begins and lasts for some time",
          {"form: events, " + (sensor.empty() ? "" : "sensor: " + quoted_yaml(sensor.front()) + ", ") + "hold_s: 5"});
    }
    table_.refuse((are_of_sentence ? "its lines are words, not a table: write a line a change, with its time, sensor "
                                     "and state"
                                   : "no column is a motion sensor's (0 and 1, on and off, true and false)") +
                  table_.columns_in_words());
  }
  void find_wide(LogShape& shape) const {
    find_people(shape);
    find_sensors(shape);
    const bool are_of_sentence = table_.header_line == 0 && are_words_ && map_.sensors.empty();
    if (shape.sensors.empty() || are_of_sentence) refuse_wide(are_of_sentence);
    require_no_opposites(shape);
    const LogTimer timer(shape.time, nullptr, 0.0);
    for (std::size_t i = 0; i < table_.n_columns(); ++i) {
      const std::string& name = table_.names[i];
      const bool tells_runs = name == "room" || (timer.clock() == LogClock::elapsed &&
                                                 (name == "trial" || name == "seat" || name == "replicate"));
      if (is_bookkeeping(i) && tells_runs) shape.runs.push_back(i);
      const bool is_read =
          shape.time.has(i) || i == shape.people || std::ranges::find(shape.sensors, i) != shape.sensors.end();
      if (!is_read && !is_bookkeeping(i)) shape.others.push_back(name);
    }
  }

  const HeadTable& table_;
  const LogMap& map_;
  TimeFinder time_finder_;
  std::vector<std::set<std::int32_t>> states_;  ///< (columns) that are known
  TimeColumns time_;
  std::vector<std::optional<std::int64_t>> times_;  ///< of the rows
  bool are_words_ = false;                          ///< cut at spaces
};

}  // namespace

std::size_t LogShape::n_read_fields() const {
  std::size_t last = std::max({time.last(), state.value_or(0), people.value_or(0)});
  for (const std::size_t column : sensor) last = std::max(last, column);
  if (end) last = std::max(last, end->last());
  for (const std::size_t column : sensors) last = std::max(last, column);
  return last + 1;
}

LogShape shape_of(const std::vector<HeadLine>& head, const LogMap& map, const std::string& file, LogZone* zone,
                  LogMap::Rows before) {
  LogShape shape;
  shape.separator = separator_of(head.front().text);
  HeadTable table = table_of(head, shape.separator, file, map.time_format);
  if (table.rows.empty())
    throw Error(ErrorCode::input, {file, table.header_line, 1}, "there are names of columns, but no row");
  shape.header_line = table.header_line;
  shape.names = table.names;
  Finder(table, map, zone).find(shape, before);
  shape.head = std::move(table);
  return shape;
}

}  // namespace pirsim::io
