// Counting people: counters, what they count from, calibration by a log.
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <pirsim/calibrate.hpp>
#include <pirsim/counting.hpp>
#include <pirsim/dataset.hpp>
#include <pirsim/log.hpp>
#include <sstream>

#include "arrays.hpp"
#include "attend.hpp"
#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

namespace nb = nanobind;
using counting::Counter;
using counting::Settings;

using Bits = nb::ndarray<const std::uint8_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Row = nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using People = nb::ndarray<const std::int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Times = nb::ndarray<const std::int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Probabilities = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

nb::object pair_of(const std::optional<Interval>& interval) {
  return interval ? nb::object(nb::make_tuple(interval->low, interval->high)) : nb::none();
}

template <typename Item, typename Tell>
nb::list listed(std::vector<Item>& items, const Tell& tell) {
  nb::list all;
  for (Item& item : items) all.append(tell(item));
  return all;
}

// -- counters --------------------------------------------------------------------------------------------------------

/// Of all rooms one after the other: (rooms x ...).
template <typename T, typename Of>
nb::object of_rooms(const Counter& counter, const Of& of, std::initializer_list<std::size_t> shape) {
  std::vector<T> all;
  for (const counting::RoomModel& room : counter.rooms) of(room, all);
  return to_numpy(std::move(all), shape);
}

nb::object numbers_of(const Counter& counter) {
  return of_rooms<std::int32_t>(counter, [](const auto& room, auto& all) { all.push_back(room.number); },
                                {counter.rooms.size()});
}

nb::object weights_of(const Counter& counter) {
  return of_rooms<double>(counter, [](const auto& room, auto& all) { all.push_back(room.weight); },
                          {counter.rooms.size()});
}

nb::object first_of(const Counter& counter) {
  return of_rooms<double>(
      counter, [](const auto& room, auto& all) { all.insert(all.end(), room.first.begin(), room.first.end()); },
      {counter.rooms.size(), static_cast<std::size_t>(counter.n_states())});
}

nb::object emissions_of(const Counter& counter) {
  return of_rooms<double>(
      counter, [](const auto& room, auto& all) { all.insert(all.end(), room.emissions.begin(), room.emissions.end()); },
      {counter.rooms.size(), static_cast<std::size_t>(counter.n_states()),
       static_cast<std::size_t>(counter.n_symbols())});
}

nb::object moves_of(const Counter& counter) {
  const auto n = static_cast<std::size_t>(counter.n_states());
  return to_numpy(std::vector<double>(counter.moves), {n, n});
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
                    double step_s, const Times& end_us, bool has_clock) {
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

std::string counts_csv(const LogRows& readings, const Probabilities& probabilities) {
  std::ostringstream text;
  calibrate::write_counts(text, {readings,
                                 {static_cast<int>(probabilities.shape(1)),
                                  {probabilities.data(), probabilities.data() + probabilities.size()}},
                                 std::nullopt});
  return text.str();
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

const char* word_of(calibrate::Verdict verdict) {
  switch (verdict) {
    case calibrate::Verdict::like_these:
      return "like-these";
    case calibrate::Verdict::none_like_it:
      return "none-like-it";
    case calibrate::Verdict::too_little_told:
      break;
  }
  return "too-little-told";
}

nb::dict told(calibrate::Calibration&& made) {
  nb::dict result;
  result["verdict"] = word_of(made.verdict);
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
                          one.advice);
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
    const Interval hours = calibrate::hours_of(dataset::read_recipe(folder / "recipe.yaml"));
    days = calibrate::days_of(log, hours);
    auto rooms = calibrate::read_pool(folder, static_cast<int>(log.sensors.size()), settings.step_s, threads);
    made = calibrate::Pool(std::move(rooms), settings, threads)
               .calibrate(std::vector{calibrate::whole_log(log)}, days.whole);
    calibrate::remember(traits, made.counter);
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
      .def_prop_ro("rooms", &numbers_of)
      .def_prop_ro("weights", &weights_of)
      .def_prop_ro("first", &first_of)
      .def_prop_ro("moves", &moves_of)
      .def_prop_ro("emissions", &emissions_of)
      .def(
          "write", [](const Counter& counter, const std::string& file) { counting::write_counter(file, counter); },
          nb::arg("file"));
  nb::class_<counting::LiveCount>(module, "LiveCount", "What pirsim.counting.LiveCount holds.")
      .def(nb::init<const Counter&>(), nb::arg("counter"), nb::keep_alive<1, 2>())
      .def(
          "next",
          [](counting::LiveCount& live, const Row& bits) {
            std::vector<double> counts = live.next({bits.data(), bits.size()});
            const std::size_t n = counts.size();
            return to_numpy(std::move(counts), {n});
          },
          nb::arg("bits"));
  module.def("train_counter", &train, nb::arg("days"), nb::arg("settings"), nb::arg("threads"), "A Counter.");
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
      nb::arg("file"), "Of a file that isn't larger than a counter's may be.");
  module.def(
      "parse_counter",
      [](const nb::bytes& bytes, const std::string& name) {
        return counting::parse_counter({bytes.c_str(), bytes.size()}, name);
      },
      nb::arg("bytes"), nb::arg("name"), "A Counter.");
}

}  // namespace

void add_counting(nb::module_& module) {
  add_counters(module);
  nb::class_<LogRows>(module, "Readings", "A log in readings of one length.");
  nb::class_<calibrate::LogTraits>(module, "LogTraits", "What a counter remembers of a log.")
      .def(
          "__init__",
          [](calibrate::LogTraits* self, double interval_s, std::vector<std::string> sensors,
             std::vector<std::optional<double>> holds_s) {
            new (self) calibrate::LogTraits{interval_s, std::move(sensors), std::move(holds_s)};
          },
          nb::arg("interval_s"), nb::arg("sensors"), nb::arg("holds_s"));
  module.def("readings", &readings_of, nb::arg("bits"), nb::arg("people").none(), nb::arg("sensors"), nb::arg("step_s"),
             nb::arg("end_us"), nb::arg("has_clock"), "Readings of arrays.");
  module.def("estimate", &estimate, nb::arg("counter"), nb::arg("readings"), nb::arg("log"), nb::arg("smoothed"),
             "Probabilities of counts, an array, and remarks.");
  module.def("told_readings", &told_readings, nb::arg("motion"), nb::arg("step_s"), "0 or 1, an array.");
  module.def("counts_csv", &counts_csv, nb::arg("readings"), nb::arg("probabilities"), "As pirsim count writes them.");
  module.def("read_room_days", &read_room_days, nb::arg("folder"), nb::arg("part"), nb::arg("step_s"),
             nb::arg("threads"), "Days of a dataset, as tuples.");
  module.def("calibrate", &calibrated, nb::arg("pool"), nb::arg("log"), nb::arg("traits"), nb::arg("settings"),
             nb::arg("threads"), "Parts of pirsim.counting.Calibration, by name.");
}

}  // namespace pirsim::python
