// Logs of real sensors, counts of people from them, and light that sensors switch.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <pirsim/calibrate.hpp>
#include <pirsim/control.hpp>
#include <pirsim/counting.hpp>
#include <pirsim/dataset.hpp>
#include <pirsim/log.hpp>
#include <pirsim/model.hpp>
#include <sstream>

#include "attend.hpp"
#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

using counting::Counter, counting::RoomModel, counting::Settings;

template <typename T, int n>
using Array = nb::ndarray<const T, nb::ndim<n>, nb::c_contig, nb::device::cpu>;
using Bits = Array<std::uint8_t, 2>;
using People = Array<std::int32_t, 1>;

// -- logs -------------------------------------------------------------------------------------------------------------

nb::tuple lengths(const LogLengths& found) {
  return nb::make_tuple(found.n, found.floor_s, found.floor_share, found.shortest_s, found.q05_s, found.q25_s,
                        found.median_s, found.q75_s, found.q95_s, found.longest_s);
}

nb::tuple sensor(const LogSensorFacts& facts) {
  const bool is_known = facts.false_triggers.has_value();
  return nb::make_tuple(to_python(facts.name), to_python(facts.motion_share()), facts.known_s, facts.unknown_s,
                        lengths(facts.pulses), lengths(facts.pauses), to_python(facts.motion_by_hour),
                        is_known ? nb::object(nb::int_(facts.false_triggers->n)) : nb::none(),
                        is_known ? facts.false_triggers->hours : 0.0, to_python(facts.hold_s));
}

/// Microseconds of the windows' ends: UTC and local.
nb::dict times(const LogWindows& windows) {
  std::vector<std::int64_t> utc, local;
  for (std::size_t i = 1; i <= windows.size(); ++i) {
    const LogMoment end = windows.begin(i);
    utc.push_back(end.us);
    local.push_back(end.local_us());
  }
  const std::size_t n = utc.size();
  nb::dict result;
  result["utc_us"] = to_numpy(std::move(utc), {n});
  result["local_us"] = to_numpy(std::move(local), {n});
  return result;
}

nb::dict read(const std::vector<std::string>& files, const std::string& map_file, const std::string& map_text,
              double window_s) {
  Log log;
  LogFacts facts;
  LogRows rows;
  attend(nb::none(), [&](Job& job) {
    const LogMap map = !map_file.empty()   ? io::read_log_map(map_file)
                       : !map_text.empty() ? io::parse_log_map(map_text, "map")
                                           : LogMap{};
    const std::vector<std::filesystem::path> paths(files.begin(), files.end());
    log = io::read_log(paths, map, {[&](std::uint64_t) { job.step_or_stop(); }});
    facts = facts_of(log);
    rows = LogWindows(log, window_s).rows();
  });
  const std::size_t n = rows.n_windows(), n_sensors = rows.sensors.size();
  nb::dict result = times(LogWindows(log, window_s));
  result["sensors"] = nb::tuple(to_python(rows.sensors));
  result["motion"] = to_numpy(std::move(rows.motion), {n, n_sensors});
  result["people_means"] = rows.people_mean == LogMap::People::presence ? "presence" : "count";
  result["people"] = log.people ? to_numpy(std::move(rows.people), {n}) : nb::none();
  result["window_s"] = rows.window_s;
  result["clock"] = nb::str(log.clock == LogClock::elapsed ? "elapsed"
                            : log.clock == LogClock::local ? "local"
                                                           : "zoned");
  result["interval_s"] = facts.interval_s;
  result["map"] = to_python(io::to_yaml(log.map));
  result["remarks"] = to_python(log.remarks);
  result["facts"] = listed(facts.sensors, sensor);
  result["pairs"] = listed(facts.pairs, [&](const LogPair& pair) {
    return nb::make_tuple(to_python(facts.sensors[pair.a].name), to_python(facts.sensors[pair.b].name),
                          to_python(pair.phi), to_python(pair.b_after_a_s), pair.n_together, pair.has_leader());
  });
  return result;
}

nb::object pair_of(const std::optional<Interval>& interval) {
  return interval ? nb::object(nb::make_tuple(interval->low, interval->high)) : nb::none();
}

/// Each column of a table, by name: texts or numbers, NaN where nothing is known.
template <typename Row>
nb::dict columns_of_rows(const std::vector<Row>& rows) {
  nb::dict columns;
  for (const Column<Row>& column : columns_of<Row>()) {
    nb::list cells;
    for (const Row& row : rows) {
      const Cell cell = column.value(row);
      if (const auto* text = std::get_if<std::string_view>(&cell))
        cells.append(nb::str(text->data(), text->size()));
      else if (const auto* count = std::get_if<std::int64_t>(&cell))
        cells.append(static_cast<double>(*count));
      else
        cells.append(std::holds_alternative<double>(cell) ? std::get<double>(cell) : std::nan(""));
    }
    columns[nb::str(column.name.data(), column.name.size())] = cells;
  }
  return columns;
}

// -- counters --------------------------------------------------------------------------------------------------------

/// (rooms)
template <typename Value>
nb::object of_rooms(const Counter& counter, Value RoomModel::*member) {
  std::vector<Value> all;
  for (const RoomModel& room : counter.rooms) all.push_back(room.*member);
  return to_numpy(std::move(all), {counter.rooms.size()});
}

/// (rooms x states) of what has a number a state, else (rooms x states x symbols).
nb::object tables_of_rooms(const Counter& counter, std::vector<double> RoomModel::*member) {
  std::vector<double> all;
  for (const RoomModel& room : counter.rooms) all.insert(all.end(), (room.*member).begin(), (room.*member).end());
  const std::size_t n_rooms = counter.rooms.size(), n_states = static_cast<std::size_t>(counter.n_states());
  const std::size_t n_columns = all.size() / (n_rooms * n_states);
  if (n_columns == 1) return to_numpy(std::move(all), {n_rooms, n_states});
  return to_numpy(std::move(all), {n_rooms, n_states, n_columns});
}

counting::Stretch stretch_of(const Bits& motion) {
  return {static_cast<int>(motion.shape(1)), {motion.data(), motion.data() + motion.size()}};
}

/// days: (room's number, motion, people) of each, a room's days one after the other.
Counter train(const std::vector<nb::tuple>& days, const Settings& settings, unsigned threads) {
  std::vector<counting::LabelledRoom> rooms;
  for (const nb::tuple& day : days) {
    const auto number = nb::cast<int>(day[0]);
    if (rooms.empty() || rooms.back().number != number) rooms.push_back({number, {}});
    counting::Stretch& stretch = rooms.back().days.emplace_back(stretch_of(nb::cast<Bits>(day[1])));
    const auto people = nb::cast<People>(day[2]);
    stretch.people.assign(people.data(), people.data() + people.size());
  }
  Counter counter;
  attend(nb::none(), [&](Job&) { counter = counting::train(rooms, settings, threads); });
  return counter;
}

// -- readings --------------------------------------------------------------------------------------------------------

/// end_us: local time at each reading's end, or since the log's zero.
LogRows readings_of(const Bits& bits, const std::optional<People>& people, std::vector<std::string> sensors,
                    double step_s, const Array<std::int64_t, 1>& end_us, bool has_clock) {
  LogRows rows;
  rows.sensors = std::move(sensors);
  rows.window_s = step_s;
  rows.clock = has_clock ? LogClock::local : LogClock::elapsed;
  for (std::size_t i = 0; i < bits.shape(0); ++i) rows.begin.push_back({end_us(i) - std::llround(step_s * 1e6), 0});
  rows.motion.assign(bits.data(), bits.data() + bits.size());
  if (people) rows.people.assign(people->data(), people->data() + people->size());
  return rows;
}

/// Probabilities, and what the counter may not be made for.
nb::tuple estimate(const Counter& counter, const LogRows& readings, const calibrate::LogTraits& log, bool smoothed) {
  calibrate::LogCounts counts;
  attend(nb::none(), [&](Job&) {
    counts =
        calibrate::count_log(counter, readings, log, smoothed ? counting::Pass::smoothed : counting::Pass::forward);
  });
  return nb::make_tuple(to_numpy(std::move(counts.estimates.probabilities),
                                 {readings.n_windows(), static_cast<std::size_t>(counter.n_counts)}),
                        counts.remarks);
}

/// (readings) 1: a counter that looks back tells a number.
nb::object told_readings(const Bits& motion, double step_s) {
  const std::vector<char> told = counting::told_readings(stretch_of(motion), step_s, counting::Pass::forward);
  return to_numpy(std::vector<std::uint8_t>(told.begin(), told.end()), {told.size()});
}

counting::Estimates estimates_of(const Array<double, 2>& probabilities) {
  return {static_cast<int>(probabilities.shape(1)),
          {probabilities.data(), probabilities.data() + probabilities.size()}};
}

std::string counts_csv(const LogRows& readings, const Array<double, 2>& probabilities) {
  std::ostringstream text;
  calibrate::write_counts(text, {readings, estimates_of(probabilities), {}, {}});
  return text.str();
}

/// (readings) the least and the most of nine in ten; -1 where none is told.
nb::tuple bands(const Array<double, 2>& probabilities) {
  const counting::Estimates estimates = estimates_of(probabilities);
  const std::size_t n = probabilities.shape(0);
  std::vector<std::int64_t> least(n, -1), most(n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    if (!estimates.is_told(i)) continue;
    const auto band = estimates.band(i, calibrate::band_share);
    least[i] = band.least, most[i] = band.most;
  }
  return nb::make_tuple(to_numpy(std::move(least), {n}), to_numpy(std::move(most), {n}));
}

/// By name, (on average, in nine of ten cases at most); or None.
nb::object told_off(const std::optional<counting::FiguresOff>& off) {
  if (!off) return nb::none();
  nb::dict told;
  for (const auto& [name, member] : counting::figure_names)
    told[name] = nb::make_tuple(((*off).*member).mean, ((*off).*member).most);
  return told;
}

/// Columns of `pirsim count --by-day` and `--by-hour`. off: as told_off() gives it.
nb::tuple figures(const LogRows& readings, const Array<double, 2>& probabilities, const nb::object& off) {
  calibrate::LogCounts counts{readings, estimates_of(probabilities), {}, {}};
  if (!off.is_none()) {
    counts.figures_off.emplace();
    for (const auto& [name, member] : counting::figure_names)
      (*counts.figures_off).*member = {nb::cast<double>(off[name][0]), nb::cast<double>(off[name][1])};
  }
  return nb::make_tuple(columns_of_rows(calibrate::counted_days(counts)),
                        columns_of_rows(calibrate::counted_hours(counts)));
}

/// A dataset's days of one part as readings, (room, seconds of a row, motion, people) of each.
nb::list read_room_days(const std::string& folder, const std::string& part, double step_s, unsigned threads) {
  using dataset::Part;
  static constexpr std::pair<const char*, Part> parts[]{{"train", Part::train},
                                                        {"validation", Part::validation},
                                                        {"test_days", Part::test_days},
                                                        {"test_rooms", Part::test_rooms}};
  const auto* named = std::ranges::find_if(parts, [&](const auto& one) { return part == one.first; });
  if (named == std::end(parts))
    throw Error(ErrorCode::usage, "part: expected train, validation, test_days or test_rooms, got '" + part + "'");
  std::vector<dataset::RoomDayRows> days;
  attend(nb::none(), [&](Job&) { days = dataset::read_room_days(folder, named->second, threads); });
  return listed(days, [&](const dataset::RoomDayRows& day) {
    counting::Stretch readings = calibrate::readings_of(day, step_s);
    const std::size_t n = readings.people.size(), n_sensors = day.sensors.size();
    return nb::make_tuple(day.room, day.window_s, to_numpy(std::move(readings.motion), {n, n_sensors}),
                          to_numpy(std::move(readings.people), {n}));
  });
}

// -- calibration -----------------------------------------------------------------------------------------------------

nb::dict told(calibrate::Calibration&& made) {
  nb::dict result;
  result["verdict"] = to_python(calibrate::word_of(made.verdict));
  result["p"] = made.p;
  result["finding"] = calibrate::finding(made);
  result["effective_rooms"] = made.effective_rooms;
  result["mean_error"] = made.mean_error;
  result["mean_error_alike"] = made.error_alike;
  result["rooms"] = listed(made.rooms, [](const calibrate::WeighedRoom& one) {
    return nb::make_tuple(one.number, one.weight, one.log_likelihood, one.error);
  });
  result["statistics"] = listed(made.statistics, [](const calibrate::Statistic& one) {
    return nb::make_tuple(one.name, one.unit, one.of_log, pair_of(one.of_rooms), pair_of(one.of_weighty), one.p,
                          calibrate::word_of(one.about), one.share, one.sign, one.advice);
  });
  result["parameters"] = listed(made.parameters, [](const calibrate::ParameterRange& one) {
    return nb::make_tuple(one.name, pair_of(one.before), pair_of(one.after), one.mean_before, one.mean_after,
                          one.narrowed);
  });
  result["counter"] = std::move(made.counter);
  return result;
}

nb::dict calibrated(const std::string& pool, const LogRows& log, const calibrate::LogTraits& traits,
                    const Settings& settings, unsigned threads) {
  calibrate::Calibration made;
  calibrate::LogDays days;
  attend(nb::none(), [&](Job&) {
    const std::filesystem::path folder = pool;
    days = calibrate::days_of(log, calibrate::hours_of(dataset::read_recipe(folder / "recipe.yaml")));
    made = calibrate::weigh_rooms(folder, {log, traits}, days, settings, threads);
  });
  nb::dict result = told(std::move(made));
  result["partial_days"] = days.partial;
  return result;
}

// -- what the module has ---------------------------------------------------------------------------------------------

void add_counters(nb::module_& module) {
  nb::class_<Settings>(module, "CountingSettings", "Of training a hidden Markov counter.")
      .def(nb::init<>())
      .def_rw("step_s", &Settings::step_s)
      .def_rw("modes", &Settings::modes)
      .def_rw("shrinkage", &Settings::shrinkage)
      .def_rw("iterations", &Settings::iterations)
      .def_rw("weight_power", &Settings::weight_power);
  nb::class_<Counter>(module, "Counter", "What pirsim.counting.HiddenMarkovCounter holds.")
      .def_prop_ro("step_s", [](const Counter& counter) { return counter.settings.step_s; })
      .def_prop_ro("modes", [](const Counter& counter) { return counter.settings.modes; })
      .def_ro("n_sensors", &Counter::n_sensors)
      .def_ro("n_counts", &Counter::n_counts)
      .def_ro("sensors", &Counter::sensors)
      .def_ro("holds_s", &Counter::holds_s)
      .def_prop_ro("expected_error", [](const Counter& counter) { return pair_of(counter.expected_error); })
      .def_prop_ro("figures_off", [](const Counter& counter) { return told_off(counter.figures_off); })
      .def_prop_ro("rooms", [](const Counter& counter) { return of_rooms(counter, &RoomModel::number); })
      .def_prop_ro("weights", [](const Counter& counter) { return of_rooms(counter, &RoomModel::weight); })
      .def_prop_ro("first", [](const Counter& counter) { return tables_of_rooms(counter, &RoomModel::first); })
      .def_prop_ro("liveliness", [](const Counter& counter) { return of_rooms(counter, &RoomModel::liveliness); })
      .def_prop_ro("moves", [](const Counter& counter) { return tables_of_rooms(counter, &RoomModel::moves); })
      .def_prop_ro("emissions", [](const Counter& counter) { return tables_of_rooms(counter, &RoomModel::emissions); })
      .def(
          "write", [](const Counter& counter, const std::string& file) { counting::write_counter(file, counter); },
          "file"_a);
  nb::class_<counting::LiveCount>(module, "LiveCount", "What pirsim.counting.LiveCount holds.")
      .def(nb::init<const Counter&>(), "counter"_a, nb::keep_alive<1, 2>())
      .def(
          "next",
          [](counting::LiveCount& live, const Array<std::uint8_t, 1>& bits) {
            std::vector<double> counts = live.next({bits.data(), bits.size()});
            const std::size_t n = counts.size();
            return to_numpy(std::move(counts), {n});
          },
          "bits"_a);
  module.def("train_counter", &train, "days"_a, "settings"_a, "threads"_a, "A Counter.");
  module.def(
      "read_counter_bytes",
      [](const std::string& file) {
        std::string bytes;
        {
          const nb::gil_scoped_release release;  // whoever writes a pipe may be another thread
          bytes = counting::read_counter_bytes(file);
        }
        return nb::bytes(bytes.data(), bytes.size());
      },
      "file"_a, "Of a file that isn't larger than a counter's may be.");
  module.def(
      "parse_counter",
      [](const nb::bytes& bytes, const std::string& name) {
        return counting::parse_counter({bytes.c_str(), bytes.size()}, name);
      },
      "bytes"_a, "name"_a, "A Counter.");
}

// -- light ------------------------------------------------------------------------------------------------------------

template <typename To, typename From>
void copy_row(const Array<From, 2>& from, std::size_t row, std::vector<To>& to) {
  const From* begin = from.data() + row * from.shape(1);
  to.assign(begin, begin + from.shape(1));
}

/// (lights x delays) of each column of `pirsim control -o`.
nb::dict columns_of_costs(const control::Costs& costs) {
  std::vector<control::CostLine> lines;
  for (const control::LightCosts& light : costs.lights) {
    for (const control::DelayCosts& at : light.by_delay) lines.push_back({light, at});
  }
  return columns_of_rows(lines);
}

/// Columns of rows, one after the other, by their names in pirsim.Result.
struct ControlRows {
  explicit ControlRows(const nb::dict& rows)
      : owners{nb::cast<std::vector<std::string>>(rows["sensors"]), nb::cast<std::vector<std::string>>(rows["areas"]),
               nb::cast<std::vector<std::string>>(rows["doors"])},
        window_s(nb::cast<double>(rows["window_s"])),
        clock(nb::cast<std::vector<std::string>>(rows["clock"])),
        run(nb::cast<People>(rows["run"])),
        people(nb::cast<People>(rows["people"])),
        phases(nb::cast<std::vector<std::string>>(rows["phases"])),
        phase_code(nb::cast<People>(rows["phase_code"])),
        time_s(nb::cast<Array<double, 1>>(rows["time_s"])),
        people_of_areas(nb::cast<Array<std::int32_t, 2>>(rows["people_of_areas"])),
        door_open(nb::cast<Bits>(rows["door_open"])),
        bits(nb::cast<Bits>(rows["bits"])) {}

  [[nodiscard]] std::size_t size() const { return bits.shape(0); }
  void read(std::size_t i, Sample& row) const {
    row.replicate = run(i);
    row.time_s = time_s(i);
    if (!clock.empty()) row.clock = clock[i];
    row.phase = phases[static_cast<std::size_t>(phase_code(i))];
    row.people = people(i);
    copy_row(people_of_areas, i, row.people_of_areas);
    copy_row(door_open, i, row.doors);
    copy_row(bits, i, row.bits);
  }

  ColumnOwners owners;
  double window_s;
  std::vector<std::string> clock;  ///< local time at each row's end, since 1970; empty: none
  People run, people;
  std::vector<std::string> phases;
  People phase_code;  ///< index into `phases`
  Array<double, 1> time_s;
  Array<std::int32_t, 2> people_of_areas;
  Bits door_open, bits;
};

/// rule: a file, the text of one in `rule_text`, or neither. model: what made the rows, or None.
nb::dict control_light(const std::string& rule_file, const std::string& rule_text, const Model* model,
                       const nb::dict& columns) {
  const ControlRows rows(columns);
  control::RuleSpec rule;
  std::vector<Issue> remarks;
  std::vector<std::uint8_t> lit;
  control::Costs costs;
  attend(nb::none(), [&](Job&) {
    std::optional<control::RuleSpec> given;
    if (!rule_file.empty()) given = control::read_rule(rule_file);
    if (!rule_text.empty()) given = control::parse_rule(rule_text, "rule");
    const SceneSpec* scene = model != nullptr ? &model->scene() : nullptr;
    rule = control::rule_for(std::move(given), scene, scene != nullptr ? scene->name : "", remarks);
    if (model != nullptr) {
      const std::vector<Issue> deaf = control::deaf_seats(rule, *model);
      remarks.insert(remarks.end(), deaf.begin(), deaf.end());
    }
    control::Control control(rule, rows.owners, rows.window_s);
    Sample row;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows.read(i, row);
      const control::LitRow now = control.add(row);
      lit.insert(lit.end(), now.lit.begin(), now.lit.end());
    }
    costs = control.finish();
  });
  remarks.insert(remarks.end(), costs.remarks.begin(), costs.remarks.end());
  nb::dict result;
  result["lights"] =
      nb::tuple(listed(rule.lights, [](const control::LightSpec& light) { return to_python(light.id); }));
  result["columns"] = columns_of_costs(costs);
  result["lit"] = to_numpy(std::move(lit), {rows.size(), rule.lights.size()});
  result["remarks"] = listed(remarks, [](const Issue& remark) { return to_python(remark.message); });
  return result;
}

}  // namespace

void add_logs(nb::module_& module) {
  module.def("read_log", &read, "files"_a, "map_file"_a, "map_text"_a, "window_s"_a, "Parts of pirsim.Log, by name.");
  add_counters(module);
  nb::class_<LogRows>(module, "Readings", "A log in readings of one length.");
  nb::class_<calibrate::LogTraits>(module, "LogTraits", "What a counter remembers of a log.")
      .def(nb::init<double, std::vector<std::string>, std::vector<std::optional<double>>>(), "interval_s"_a,
           "sensors"_a, "holds_s"_a);
  module.def("readings", &readings_of, "bits"_a, "people"_a.none(), "sensors"_a, "step_s"_a, "end_us"_a, "has_clock"_a,
             "Readings of arrays.");
  module.def("estimate", &estimate, "counter"_a, "readings"_a, "log"_a, "smoothed"_a,
             "Probabilities of counts, an array, and remarks.");
  module.def("told_readings", &told_readings, "motion"_a, "step_s"_a, "0 or 1, an array.");
  module.def("counts_csv", &counts_csv, "readings"_a, "probabilities"_a, "As pirsim count writes them.");
  module.def("bands", &bands, "probabilities"_a, "The least and the most of nine in ten, arrays.");
  module.def("figures", &figures, "readings"_a, "probabilities"_a, "off"_a.none(), "Columns of days, and of hours.");
  module.def("read_room_days", &read_room_days, "folder"_a, "part"_a, "step_s"_a, "threads"_a,
             "Days of a dataset, as tuples.");
  module.def("calibrate", &calibrated, "pool"_a, "log"_a, "traits"_a, "settings"_a, "threads"_a,
             "Parts of pirsim.counting.Calibration, by name.");
  module.def("control_light", &control_light, "rule_file"_a, "rule_text"_a, "model"_a.none(), "rows"_a,
             "Parts of pirsim.LightCosts, by name, and remarks.");
}

}  // namespace pirsim::python
