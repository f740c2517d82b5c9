// Made logs whose truth is known, in all forms, holds, gaps, lengths and orders of columns: each is read rightly, or
// refused with maps that settle it. What is told wrongly without a word is the one thing that must not happen.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "model/schema/clock.hpp"
#include "pirsim/log.hpp"
#include "support/catch.hpp"
#include "support/log_files.hpp"

using namespace pirsim;
using Texts = std::vector<std::string>;

namespace {

constexpr std::int64_t s = 1000;  // all times in milliseconds, since 2026-03-02T08:00

class Dice {
 public:
  explicit Dice(std::uint32_t seed) : random_(seed) {}
  std::size_t below(std::size_t n) { return random_() % n; }
  template <typename Value, std::size_t n>
  const Value& one_of(const std::array<Value, n>& values) {
    return values[below(n)];
  }
  /// Of the exponential distribution; the same on all machines.
  double after(double mean) { return -mean * std::log((static_cast<double>(random_()) + 1.0) / 4294967297.0); }

 private:
  std::mt19937 random_;
};

struct Pulse {
  std::int64_t on, off;
};
/// A sensor's truth; between lost_from and lost_to nothing was written.
struct Truth {
  std::vector<std::vector<Pulse>> sensors;
  std::int64_t end = 0, lost_from = 0, lost_to = 0;
  [[nodiscard]] bool is_on(std::size_t sensor, std::int64_t from, std::int64_t to) const {  // anywhere in [from, to)
    const auto& pulses = sensors[sensor];
    const auto at = std::ranges::upper_bound(pulses, from, {}, &Pulse::off);
    return at != pulses.end() && at->on < to;
  }
  [[nodiscard]] bool is_lost(std::int64_t from, std::int64_t to) const { return from < lost_to && to > lost_from; }
};

enum class Form { readings, changes, pivot, events, without_header, with_flags, one_dump, casas };
constexpr std::array all_forms{Form::readings,       Form::changes,    Form::pivot,    Form::events,
                               Form::without_header, Form::with_flags, Form::one_dump, Form::casas};
constexpr std::array form_names{"readings",   "changes",           "pivot", "events", "without header",
                                "with flags", "one sensor's dump", "CASAS"};

struct Case {
  Form form;
  double hold_s, pause_s;
  bool has_gap, has_count, is_in_ms, loses_rows;
  std::size_t n_rows, n_sensors, time_at;
  Texts names;
  std::int64_t interval;  ///< of readings
};

Truth truth_of(const Case& one, Dice& dice) {
  Truth truth;
  const std::int64_t grain = one.is_in_ms ? 1 : s;
  const auto rounded = [&](double seconds) {
    return std::max<std::int64_t>(1, std::llround(seconds * 1e3 / static_cast<double>(grain))) * grain;
  };
  const bool are_readings = one.form == Form::readings;
  const double cycle_s = one.pause_s + std::max(one.hold_s, 5.0);
  truth.end = are_readings
                  ? static_cast<std::int64_t>(one.n_rows) * one.interval
                  : rounded(cycle_s * static_cast<double>(one.n_rows) / (2.0 * static_cast<double>(one.n_sensors)));
  if (one.has_gap) {
    truth.lost_from = truth.end / 2 / one.interval * one.interval;
    truth.lost_to = truth.lost_from + 3600 * s;
    truth.end += 3600 * s;
  }
  for (std::size_t i = 0; i < one.n_sensors; ++i) {
    std::vector<Pulse>& pulses = truth.sensors.emplace_back();
    for (std::int64_t at = rounded(dice.after(one.pause_s));;
         at = pulses.back().off + rounded(dice.after(one.pause_s))) {
      double length = one.hold_s > 0.0 ? one.hold_s : 1.0 + dice.after(8.0);
      while (one.hold_s > 0.0 && dice.below(3) == 0) length += one.hold_s * static_cast<double>(dice.below(1000)) / 1e3;
      const Pulse pulse{at, at + rounded(length)};
      if (pulse.off >= truth.end) break;
      pulses.push_back(pulse);
    }
  }
  return truth;
}

std::string stamp(std::int64_t ms, std::size_t how) {
  constexpr std::int64_t begin_s = 1772438400;  // 2026-03-02T08:00
  if (how == 2) return std::to_string(begin_s + ms / s);
  std::string text = RunClock{begin_s + ms / s}.text(0.0);
  if (how == 0) text[10] = ' ';
  if (ms % s != 0) {
    std::array<char, 8> digits{};
    std::snprintf(digits.data(), digits.size(), ".%03d", static_cast<int>(ms % s));
    text += digits.data();
  }
  return text + (how == 1 ? "Z" : "");
}

/// Cells in the order of this case.
std::string line_of(const Case& one, const std::string& time, Texts cells) {
  cells.insert(cells.begin() + static_cast<std::ptrdiff_t>(std::min(one.time_at, cells.size())), time);
  std::string line = cells.front();
  for (std::size_t i = 1; i < cells.size(); ++i) line += ',' + cells[i];
  return line + '\n';
}

struct Change {
  std::int64_t at;
  std::size_t sensor;
  std::string state;
};
std::vector<Change> changes_in(const Truth& truth, const Texts& words) {
  std::vector<Change> changes;
  for (std::size_t i = 0; i < truth.sensors.size(); ++i) {
    const auto add = [&](std::int64_t at, const std::string& state) {
      if (!truth.is_lost(at, at + 1)) changes.push_back({at, i, state});
    };
    add(0, words[0]);
    for (const Pulse& pulse : truth.sensors[i]) {
      add(pulse.on, words[1]);
      add(pulse.off, words[0]);
    }
    if (truth.lost_to == 0) continue;
    changes.push_back({truth.lost_from, i, "unavailable"});
    changes.push_back({truth.lost_to, i, words[truth.is_on(i, truth.lost_to, truth.lost_to + 1) ? 1 : 0]});
  }
  std::ranges::stable_sort(changes, {}, &Change::at);
  return changes;
}

std::string log_text(const Case& one, const Truth& truth, Dice& dice) {
  const std::size_t how = one.is_in_ms ? dice.below(2) : dice.below(3), n = one.n_sensors;
  const std::array<Texts, 3> vocabularies{Texts{"0", "1"}, Texts{"off", "on"}, Texts{"false", "true"}};
  Texts words = dice.one_of(vocabularies);
  const std::array time_names{"time", "timestamp", "last_changed"};
  const std::string time_name = dice.one_of(time_names);
  const auto count_at = [&](std::int64_t at) { return std::to_string(at / (1200 * s) % 4); };
  std::string text;
  if (one.form == Form::readings) {
    Texts names = one.names;
    if (one.has_count) names.push_back("people");
    text = line_of(one, time_name, names);
    for (std::int64_t at = one.interval; at <= truth.end; at += one.interval) {
      if (truth.is_lost(at - one.interval, at) || (one.loses_rows && at > 2 * one.interval && dice.below(20) == 0))
        continue;
      Texts cells;
      for (std::size_t i = 0; i < n; ++i) cells.push_back(words[truth.is_on(i, at - one.interval, at) ? 1 : 0]);
      if (one.has_count) cells.push_back(count_at(at));
      text += line_of(one, stamp(at, how), cells);
    }
    return text;
  }
  const std::vector<Change> changes = changes_in(truth, one.form == Form::casas ? (words = {"OFF", "ON"}) : words);
  if (one.form == Form::changes || one.form == Form::pivot) {
    Texts names = one.names, cells(n, "");
    if (one.has_count) names.push_back("occupants");
    text = line_of(one, time_name, names);
    for (std::size_t i = 0; i < changes.size(); ++i) {
      cells[changes[i].sensor] = changes[i].state;
      if (i + 1 < changes.size() && changes[i + 1].at == changes[i].at) continue;
      Texts row = cells;
      if (one.has_count) row.push_back(count_at(changes[i].at));
      text += line_of(one, stamp(changes[i].at, how), row);
      if (one.form == Form::pivot) cells.assign(n, "");
    }
    return text;
  }
  const std::array sensor_names{"entity_id", "device", "sensor", "room", "who"};
  const std::array state_names{"state", "value", "motion", "val"};
  const std::string sensor_name = dice.one_of(sensor_names), state_name = dice.one_of(state_names);
  const bool has_tail = dice.below(2) == 0;
  if (one.form == Form::events) text = line_of(one, time_name, {sensor_name, state_name});
  if (one.form == Form::with_flags)
    text = line_of(one, time_name,
                   has_tail ? Texts{sensor_name, state_name, "battery_low", "tamper"}
                            : Texts{sensor_name, state_name, "ack", "q"});
  if (one.form == Form::one_dump) text = line_of(one, time_name, {state_name});
  for (const Change& change : changes) {
    const std::string& name = one.names[change.sensor];
    if (one.form == Form::casas) {
      std::string time = stamp(change.at, 0);
      text += time + " M00" + std::to_string(change.sensor + 1) + ' ' + change.state +
              (change.at % 7 == 0 ? " Sleep begin\n" : "\n");
    } else if (one.form == Form::one_dump) {
      text += line_of(one, stamp(change.at, how), {change.state});
    } else if (one.form == Form::with_flags) {
      const std::string flag = change.at / (900 * s) % 5 == 4 ? words[1] : words[0];
      text += line_of(one, stamp(change.at, how),
                      has_tail ? Texts{name, change.state, flag, words[0]} : Texts{name, change.state, "true", "0"});
    } else if (one.form == Form::without_header) {
      text += stamp(change.at, how) + ',' + name + ',' + change.state + '\n';
    } else {
      text += line_of(one, stamp(change.at, how), {name, change.state});
    }
  }
  return text;
}

Case case_of(Dice& dice) {
  Case one{};
  one.form = dice.one_of(all_forms);
  const std::array holds{0.0, 2.5, 10.0, 30.0, 90.0, 180.0};
  const std::array pauses{20.0, 60.0, 150.0, 400.0};
  one.hold_s = dice.one_of(holds);
  one.pause_s = dice.one_of(pauses);
  one.has_gap = dice.below(3) == 0;
  one.has_count = dice.below(3) == 0;
  one.is_in_ms = dice.below(2) == 0;
  one.loses_rows = dice.below(4) == 0;
  const std::array<std::size_t, 8> lengths{5, 6, 8, 12, 30, 100, 400, 2000};
  one.n_rows = dice.one_of(lengths);
  one.n_sensors = one.form == Form::one_dump ? 1 : 1 + dice.below(3);
  if (one.form == Form::pivot) one.n_sensors = std::max<std::size_t>(2, one.n_sensors);
  const std::array<Texts, 10> names{Texts{"hall_motion", "desk_motion", "wc_motion"},
                                    Texts{"hall_occupancy", "desk_occupancy", "wc_occupancy"},
                                    Texts{"hall_presence", "desk_presence", "wc_presence"},
                                    Texts{"PIR1", "PIR2", "PIR3"},
                                    Texts{"S6_PIR", "S7_PIR", "S8_PIR"},
                                    Texts{"hall_door_pir", "front_door_pir", "wc_door_pir"},
                                    Texts{"0x00158d0001a2", "0x00158d0001a3", "0x00158d0001a4"},
                                    Texts{"hall", "desk", "wc"},
                                    Texts{"3", "7", "12"},
                                    Texts{"0", "1", "2"}};
  one.names = dice.one_of(names);
  one.names.resize(one.n_sensors);
  one.time_at = dice.below(4);
  const std::array<std::int64_t, 5> intervals{1 * s, 5 * s, 10 * s, 30 * s, 60 * s};
  one.interval = dice.one_of(intervals);
  one.loses_rows = one.loses_rows && one.interval >= 5 * s;  // stamps of whole seconds hide a lost second
  return one;
}

/// Empty: as the truth. Otherwise what is wrong.
std::string compared(const Case& one, const Truth& truth, const Log& log) {
  const std::int64_t window = one.form == Form::readings ? one.interval : 10 * s;
  if (log.sensors.size() != one.n_sensors) return std::to_string(log.sensors.size()) + " sensors";
  const bool counts =
      one.has_count && (one.form == Form::readings || one.form == Form::changes || one.form == Form::pivot);
  if (log.people.has_value() != counts) return "people";
  const LogRows rows = LogWindows(log, static_cast<double>(window) / 1e3).rows();
  std::size_t n_wrong = 0, n_unknown = 0, n_all = 0;
  for (std::size_t sensor = 0; sensor < one.n_sensors; ++sensor) {
    std::size_t of = sensor;
    for (std::size_t i = 0; i < one.n_sensors && one.form != Form::casas && one.form != Form::one_dump; ++i) {
      if (one.names[i] == rows.sensors[sensor]) of = i;
    }
    for (std::size_t i = 0; i < rows.n_windows(); ++i) {
      const std::int64_t from = rows.begin[i].us / 1000 - 1772438400 * s;
      if (from < 0 || from + window > truth.end || truth.is_lost(from, from + window)) continue;
      ++n_all;
      const std::uint8_t state = rows.at(i, sensor);
      n_unknown += state == log_state::unknown ? 1 : 0;
      n_wrong += state != log_state::unknown && state != (truth.is_on(of, from, from + window) ? 1 : 0) ? 1 : 0;
    }
  }
  if (n_all == 0 && truth.end > 300 * s) return "no window of its time";
  if (n_wrong > 0) return std::to_string(n_wrong) + " wrong windows of " + std::to_string(n_all);
  if (20 * n_unknown > (one.loses_rows ? 4 : 1) * n_all + 60)
    return std::to_string(n_unknown) + " unknown windows of " + std::to_string(n_all);
  return {};
}

}  // namespace

TEST_CASE("a grid of made logs: each is read rightly, or refused with a map that settles it", "[seconds]") {
  constexpr std::size_t n = 2000;
  const TemporaryFolder folder;
  std::map<std::string, std::array<std::size_t, 3>> found;  // read, refused, wrong
  std::size_t n_refused = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Dice dice(static_cast<std::uint32_t>(i + 1));
    const Case one = case_of(dice);
    const Truth truth = truth_of(one, dice);
    const std::string text = log_text(one, truth, dice);
    if (std::ranges::count(text, '\n') < 4) continue;
    auto& [read, refused, wrong] = found[form_names[static_cast<std::size_t>(one.form)]];
    const std::filesystem::path file = folder.write("log.csv", text);
    std::string fault;
    try {
      fault = compared(one, truth, io::read_log({&file, 1}));
      ++(fault.empty() ? read : wrong);
    } catch (const Error& error) {
      ++refused;
      ++n_refused;
      fault = std::string(error.what()).find("{pirsim_log: 1, ") == std::string::npos ? error.what() : "";
    }
    INFO("log " << i << " (" << form_names[static_cast<std::size_t>(one.form)] << ", hold " << one.hold_s
                << " s, pause " << one.pause_s << " s): " << fault << "\n"
                << text.substr(0, 1500));
    CHECK(fault.empty());
  }
  std::string table;
  for (const auto& [form, numbers] : found) {
    table += form + ": read " + std::to_string(numbers[0]) + ", refused " + std::to_string(numbers[1]) + ", wrong " +
             std::to_string(numbers[2]) + "\n";
  }
  INFO(table);
  CHECK(20 * n_refused < n);
}

// What stands beside the time, how rows come, and what several files tell.

namespace {

enum class Trap {
  half_of_day,
  digits,
  own_offset,
  two_times,
  number_and_text,
  short_year,
  padded,
  truth_beside,
  file_each,
  one_name,
  long_readings,
  jitter,
  polls
};
constexpr std::size_t n_traps = 13;
constexpr std::array<const char*, n_traps> trap_names{"AM and PM beside the time",
                                                      "dates of digits",
                                                      "an offset beside the time",
                                                      "two columns of times",
                                                      "numbers beside dates",
                                                      "years of two digits",
                                                      "padded names",
                                                      "a truth beside sensors",
                                                      "a file a sensor",
                                                      "two files of a name",
                                                      "readings of one at a time",
                                                      "readings with jitter",
                                                      "polls at any time"};

Texts events_of(Trap trap, const Case& one, const Truth& truth, Dice& dice) {
  const std::size_t how = dice.below(3);
  const std::array two_names{"time", "timestamp", "ts", "happened"};
  const std::array late_names{"received", "created_at", "written"};
  const std::string name = dice.one_of(two_names), late = dice.one_of(late_names);
  const bool has_header = dice.below(3) > 0, is_late_first = dice.below(2) == 0;
  const std::array headers{"date,time,ampm", "date,time", "date,time,zone"};
  std::string text;
  if (trap == Trap::two_times) text = is_late_first ? late + ',' + name : name + ',' + late;
  if (trap == Trap::number_and_text) text = name == "happened" ? "ts,changed" : name + ",changed";
  if (trap == Trap::short_year || trap == Trap::padded) text = "time";
  if (trap <= Trap::own_offset && has_header) text = headers[static_cast<std::size_t>(trap)];
  if (!text.empty()) text += ",sensor,state\n";
  for (const Change& change : changes_in(truth, {"off", "on"})) {
    const std::string full = stamp(change.at, 0), date = full.substr(0, 10), hour = full.substr(11);
    std::string time = full;
    if (trap == Trap::half_of_day) {
      const int h = std::stoi(hour.substr(0, 2));
      time = date + ',' + std::to_string((h + 11) % 12 + 1) + hour.substr(2) + (h < 12 ? ",AM" : ",PM");
    } else if (trap == Trap::digits) {
      time = date.substr(0, 4) + date.substr(5, 2) + date.substr(8) + ',' + hour;
    } else if (trap == Trap::own_offset) {
      const std::array offsets{"UTC", "+0000", "+00:00"};
      time = date + ',' + hour + ',' + offsets[how];
    } else if (trap == Trap::two_times) {
      const std::string batch = stamp((change.at / (300 * s) + 1) * 300 * s, 0);
      time = is_late_first ? batch + ',' + full : full + ',' + batch;
    } else if (trap == Trap::number_and_text) {
      time = stamp(change.at, 2) + ',' + stamp(change.at / (1800 * s) * 1800 * s, 0);
    } else if (trap == Trap::short_year) {
      const std::string year = date.substr(2, 2), month = date.substr(5, 2), day = date.substr(8);
      const char between = how == 0 ? '-' : how == 1 ? '/' : '.';
      time = (is_late_first ? year + between + month + between + day : day + between + month + between + year) + ' ' +
             hour;
    }
    const std::string pad = trap == Trap::padded && dice.below(2) == 0 ? " " : "";
    text += time + ',' + pad + one.names[change.sensor] + pad + ',' + change.state + '\n';
  }
  return {text};
}

Texts rows_of(Trap trap, const Case& one, const Truth& truth, Dice& dice) {
  std::string text = "time", more;
  if (trap == Trap::file_each || trap == Trap::one_name) {
    Texts files;
    for (std::size_t i = 0; i < 2; ++i) {
      std::string& file = files.emplace_back("time," + (trap == Trap::one_name ? "motion" : one.names[i]) + '\n');
      for (const Change& change : changes_in(truth, {"0", "1"}))
        if (change.sensor == i) file += stamp(change.at, 0) + ',' + change.state + '\n';
    }
    return files;
  }
  const std::array truths{"ground_truth", "isOccupied", "personCount", "frontDoor", "Anwesenheit", "label"};
  if (trap == Trap::long_readings) text += ",device,motion";
  for (const std::string& name : one.names) text += trap == Trap::long_readings ? "" : ',' + name;
  if (trap == Trap::truth_beside) text += std::string(",") + dice.one_of(truths);
  text += '\n';
  std::int64_t before = 0;
  for (std::int64_t at = one.interval; at <= truth.end;) {
    const std::string time = stamp(at, 0);
    text += trap == Trap::long_readings ? "" : time;
    for (std::size_t i = 0; i < one.n_sensors; ++i) {
      const bool is_on = truth.is_on(i, trap == Trap::polls ? at : before, trap == Trap::polls ? at + 1 : at);
      const std::string state = is_on ? "1" : "0";
      text += trap == Trap::long_readings ? time + ',' + one.names[i] + ',' + state + '\n' : ',' + state;
    }
    if (trap == Trap::truth_beside) text += at / (1200 * s) % 2 == 0 ? ",0" : ",1";
    text += trap == Trap::long_readings ? "" : "\n";
    before = at;
    const auto jitter = static_cast<std::int64_t>(dice.below(static_cast<std::size_t>(one.interval / s))) * s;
    at += trap == Trap::jitter  ? one.interval / 2 + jitter
          : trap == Trap::polls ? s + std::llround(dice.after(static_cast<double>(one.interval) / 1e3)) * s
                                : one.interval;
  }
  return {text};
}

}  // namespace

TEST_CASE("a grid of traps: each log is read rightly, or refused", "[seconds]") {
  constexpr std::size_t n = 650;
  const TemporaryFolder folder;
  std::array<std::array<std::size_t, 2>, n_traps> found{};  // read, refused
  std::array<std::string, n_traps> refusals;
  for (std::size_t i = 0; i < n; ++i) {
    Dice dice(static_cast<std::uint32_t>(70'000 + i));
    const auto trap = static_cast<Trap>(i % n_traps);
    Case one = case_of(dice);
    const bool are_rows = trap >= Trap::long_readings || trap == Trap::truth_beside;
    one.form = are_rows ? Form::readings : Form::events;
    one.names = {"hall_motion", "desk_motion"};
    one.n_sensors = 2;
    one.has_count = one.has_gap = one.is_in_ms = one.loses_rows = false;
    one.n_rows = std::max<std::size_t>(one.n_rows, 100);
    one.interval = (trap >= Trap::jitter ? 30 : 10) * s;
    const Truth truth = truth_of(one, dice);
    const Texts texts =
        trap >= Trap::truth_beside ? rows_of(trap, one, truth, dice) : events_of(trap, one, truth, dice);
    std::vector<std::filesystem::path> files;
    for (std::size_t k = 0; k < texts.size(); ++k)
      files.push_back(folder.write("log" + std::to_string(k) + ".csv", texts[k]));
    LogMap map;
    if (trap == Trap::own_offset) map.time_zone = "Europe/Berlin";
    std::string fault;
    auto& [read, refused] = found[i % n_traps];
    try {
      const Log log = io::read_log(files, map);
      ++read;
      one.has_count = log.map.people == "personCount";
      const bool is_uneven = trap == Trap::jitter || trap == Trap::polls;  // no window has one reading's truth
      fault = !is_uneven ? compared(one, truth, log) : log.has_readings() ? "" : "rows of changes";
    } catch (const Error& error) {
      ++refused;
      refusals[i % n_traps] = error.what();
      CHECK(error.code() == ErrorCode::input);
    }
    INFO("log " << i << " (" << trap_names[i % n_traps] << "): " << fault << "\n" << texts[0].substr(0, 1500));
    CHECK(fault.empty());
  }
  std::string table;
  for (std::size_t i = 0; i < n_traps; ++i) {
    table += std::string(trap_names[i]) + ": read " + std::to_string(found[i][0]) + ", refused " +
             std::to_string(found[i][1]) + ' ' + refusals[i] + '\n';
  }
  INFO(table);
  const auto all_read = [&](Trap trap) { return found[static_cast<std::size_t>(trap)][1] == 0; };
  for (const Trap trap : {Trap::half_of_day, Trap::digits, Trap::own_offset, Trap::number_and_text, Trap::padded,
                          Trap::file_each, Trap::one_name})
    CHECK(all_read(trap));
  for (const Trap trap : {Trap::two_times, Trap::truth_beside, Trap::jitter})
    CHECK(found[static_cast<std::size_t>(trap)][0] > 10);
}
