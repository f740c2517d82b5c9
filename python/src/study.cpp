// Models, runs and recordings, and the rows of many runs as arrays.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <limits>
#include <map>
#include <numeric>
#include <pirsim/columns.hpp>
#include <pirsim/model.hpp>
#include <pirsim/response.hpp>
#include <variant>

#include "attend.hpp"
#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

// -- rows of many runs as arrays [run, window, sensor] ----------------------------------------------------------------

constexpr std::int64_t no_time = std::numeric_limits<std::int64_t>::min();  // numpy's NaT

/// Seconds since 1970 of "2026-03-02T08:30:00".
std::int64_t seconds_of(const std::string& clock) {
  const auto number = [&](std::size_t begin, std::size_t length) {
    int value = 0;
    std::from_chars(clock.data() + begin, clock.data() + begin + length, value);
    return value;
  };
  if (clock.size() < 19) return no_time;
  const std::chrono::year_month_day day{std::chrono::year(number(0, 4)),
                                        std::chrono::month(static_cast<unsigned>(number(5, 2))),
                                        std::chrono::day(static_cast<unsigned>(number(8, 2)))};
  const std::int64_t days = std::chrono::sys_days(day).time_since_epoch().count();
  return ((days * 24 + number(11, 2)) * 60 + number(14, 2)) * 60 + number(17, 2);
}

/// (n_runs x n_windows x width) of runs of different length, which are given back on the way.
template <typename T, typename Rows>
std::vector<T> padded(std::vector<Rows>& rows, std::vector<T> Rows::*column, std::size_t n_windows, std::size_t width,
                      T beyond = {}) {
  std::vector<T> all(rows.size() * n_windows * width, beyond);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<T>& part = rows[i].*column;
    std::copy(part.begin(), part.end(), all.begin() + static_cast<std::ptrdiff_t>(i * n_windows * width));
    std::vector<T>().swap(part);
  }
  return all;
}

template <typename As, typename T>
nb::object column_as(std::vector<T>& values) {
  const std::size_t n = values.size();
  return to_numpy_as<As>(std::move(values), {n});
}
template <typename T>
nb::object column(std::vector<T>& values) {
  return column_as<T>(values);
}

/// Takes results in order, without the GIL; to_dict() gives the arrays, with it.
class RunArrays {
 public:
  /// n_areas: of Model::areas().
  RunArrays(std::size_t n_sensors, std::size_t n_areas, std::size_t n_doors,
            const std::vector<SensorSpec>& arrays = {});

  void add(const RunResult& result);
  /// Runs differ in length: arrays are as long as the longest, zeros behind the end of a run, where `valid` is false.
  [[nodiscard]] nb::dict to_dict() &&;

 private:
  struct Rows {
    std::vector<std::uint8_t> bits;   ///< (n_windows x n_sensors)
    std::vector<std::uint8_t> doors;  ///< (n_windows x n_doors)
    std::vector<std::uint16_t> people, phase;
    std::vector<std::uint16_t> people_of_areas;  ///< (n_windows x n_areas)
    std::vector<std::int64_t> clock;             ///< seconds since 1970; empty without a clock
  };
  struct Fault {
    std::uint32_t run = 0;
    RunFault fault;
  };
  struct Incident {
    std::uint32_t run = 0;
    RunIncident incident;
  };
  /// A column of the command line's table, of all runs together.
  struct TableColumn {
    const Column<OccupantLine>* column;
    std::vector<double> numbers;
    std::vector<std::uint16_t> texts;  ///< by number
  };
  struct Signals {
    std::vector<std::uint32_t> run;
    std::vector<std::int64_t> tick;
    std::vector<std::uint16_t> sensor, zone, person, part;
    std::vector<double> power_w, signal_v, share_v;
    std::vector<std::uint8_t> output;
  };
  /// Texts by number, in the order in which they are met; the first is the empty one.
  class Words {
   public:
    [[nodiscard]] std::uint16_t number(std::string_view text);
    [[nodiscard]] nb::tuple all() const;

   private:
    std::map<std::string, std::uint16_t, std::less<>> numbers_{{"", 0}};
    std::vector<std::string> texts_{""};
  };

  void add_occupants(const RunResult& result);
  void add_signals(const RunResult& result);
  void add_zones(const RunResult& result);
  void add_frames(const RunResult& result);
  [[nodiscard]] nb::dict occupants();
  [[nodiscard]] nb::dict signals();
  [[nodiscard]] nb::list zones();
  void add_rows(nb::dict& arrays);
  void add_frames(nb::dict& arrays);

  std::size_t n_sensors_, n_areas_, n_doors_;
  std::size_t n_windows_ = 0;  ///< of the longest run
  bool has_clock_ = false;
  std::vector<double> time_s_;
  std::vector<Rows> rows_;
  std::vector<std::uint32_t> run_;
  std::vector<std::int32_t> replicate_;
  std::vector<std::string> trial_;
  std::vector<Fault> faults_;
  std::vector<Incident> incidents_;
  Words phases_, texts_;
  std::vector<std::uint32_t> occupant_run_;
  std::vector<TableColumn> occupants_;
  Signals signals_;
  struct Zones {
    std::size_t n_ticks = 0;
    std::vector<std::uint8_t> active;  ///< (n_ticks x n_zones)
  };
  std::vector<Zones> zones_;
  struct Stacks {
    std::string id;
    FrameStack longest;  ///< its times; no temperatures
    std::vector<std::vector<float>> runs;
  };
  std::vector<Stacks> stacks_;
};

std::uint16_t RunArrays::Words::number(std::string_view text) {
  const auto found = numbers_.find(text);
  if (found != numbers_.end()) return found->second;
  if (texts_.size() > std::numeric_limits<std::uint16_t>::max())
    throw Error(ErrorCode::usage, "more than 65535 different phases or names in one result");
  const auto n = static_cast<std::uint16_t>(texts_.size());
  texts_.emplace_back(text);
  numbers_.emplace(text, n);
  return n;
}

nb::tuple RunArrays::Words::all() const { return nb::tuple(to_python(texts_)); }

RunArrays::RunArrays(std::size_t n_sensors, std::size_t n_areas, std::size_t n_doors,
                     const std::vector<SensorSpec>& arrays)
    : n_sensors_(n_sensors), n_areas_(n_areas), n_doors_(n_doors) {
  for (const SensorSpec& array : arrays) stacks_.push_back({array.id, {}, {}});
  for (const Column<OccupantLine>& one : columns_of<OccupantLine>()) {
    const bool told_by_run = one.name == "replicate" || one.name == "trial" || one.holds == Holds::moment;
    if (one.when == When::with_areas && n_areas == 0) continue;
    if (!told_by_run) occupants_.push_back({&one, {}, {}});
  }
}

void RunArrays::add(const RunResult& result) {
  run_.push_back(result.run);
  replicate_.push_back(result.replicate);
  trial_.push_back(result.trial);
  Rows& rows = rows_.emplace_back();
  rows.bits.reserve(result.samples.size() * n_sensors_);
  for (const Sample& sample : result.samples) {
    rows.bits.insert(rows.bits.end(), sample.bits.begin(), sample.bits.end());
    rows.doors.insert(rows.doors.end(), sample.doors.begin(), sample.doors.end());
    rows.people.push_back(static_cast<std::uint16_t>(sample.people));
    for (const int people : sample.people_of_areas) rows.people_of_areas.push_back(static_cast<std::uint16_t>(people));
    rows.phase.push_back(phases_.number(sample.phase));
    if (!sample.clock.empty()) rows.clock.push_back(seconds_of(sample.clock));
  }
  has_clock_ = has_clock_ || !rows.clock.empty();
  for (std::size_t i = n_windows_; i < result.samples.size(); ++i) time_s_.push_back(result.samples[i].time_s);
  n_windows_ = std::max(n_windows_, result.samples.size());
  if (result.fault) faults_.push_back({result.run, *result.fault});
  for (const RunIncident& incident : result.incidents) incidents_.push_back({result.run, incident});
  add_occupants(result);
  add_signals(result);
  add_zones(result);
  add_frames(result);
}

void RunArrays::add_frames(const RunResult& result) {
  for (std::size_t i = 0; i < stacks_.size(); ++i) {
    stacks_[i].runs.emplace_back();
    if (result.frames.empty()) continue;  // of a run that couldn't go on
    const FrameStack& frames = result.frames[i];
    stacks_[i].runs.back() = frames.celsius;
    if (frames.times_s.size() >= stacks_[i].longest.times_s.size())
      stacks_[i].longest = {frames.rows, frames.columns, frames.times_s, {}};
  }
}

void RunArrays::add_frames(nb::dict& arrays) {
  nb::dict frames, times;
  for (Stacks& stack : stacks_) {
    const auto n_frames = stack.longest.times_s.size(), rows = static_cast<std::size_t>(stack.longest.rows),
               columns = static_cast<std::size_t>(stack.longest.columns), size = n_frames * rows * columns;
    std::vector<float> all(stack.runs.size() * size, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < stack.runs.size(); ++i)
      std::ranges::copy(stack.runs[i], all.begin() + static_cast<std::ptrdiff_t>(i * size));
    frames[stack.id.c_str()] = to_numpy(std::move(all), {stack.runs.size(), n_frames, rows, columns});
    times[stack.id.c_str()] = column(stack.longest.times_s);
  }
  arrays["frames"] = frames;
  arrays["frame_time"] = times;
}

void RunArrays::add_occupants(const RunResult& result) {
  for (const OccupantRow& row : result.occupants) {
    occupant_run_.push_back(result.run);
    for (TableColumn& one : occupants_) {
      const Cell cell = one.column->value({result.replicate, result.trial, row});
      if (const auto* number = std::get_if<double>(&cell)) one.numbers.push_back(*number);
      if (const auto* text = std::get_if<std::string_view>(&cell)) one.texts.push_back(texts_.number(*text));
    }
  }
}

void RunArrays::add_signals(const RunResult& result) {
  for (const TraceRow& row : result.trace) {
    signals_.run.push_back(result.run);
    signals_.tick.push_back(row.tick);
    signals_.sensor.push_back(static_cast<std::uint16_t>(row.sensor));
    signals_.power_w.push_back(row.power_w);
    signals_.signal_v.push_back(row.signal_v);
    signals_.output.push_back(row.output);
    signals_.zone.push_back(static_cast<std::uint16_t>(row.zone));
    signals_.person.push_back(texts_.number(row.person));
    signals_.part.push_back(texts_.number(row.part));
    signals_.share_v.push_back(row.share_v);
  }
}

void RunArrays::add_zones(const RunResult& result) {
  Zones& zones = zones_.emplace_back();
  zones.n_ticks = result.zones.size();
  for (const ZoneSet& tick : result.zones) {
    for (std::size_t zone = 0; zone < tick.size(); ++zone) zones.active.push_back(tick.test(zone) ? 1 : 0);
  }
}

nb::dict RunArrays::occupants() {
  nb::dict table;
  table["run"] = column(occupant_run_);
  for (TableColumn& one : occupants_) {
    const nb::str name(one.column->name.data(), one.column->name.size());
    table[name] = one.column->holds == Holds::text ? column(one.texts) : column(one.numbers);
  }
  return table;
}

nb::dict RunArrays::signals() {
  nb::dict table;
  table["run"] = column(signals_.run);
  table["tick"] = column(signals_.tick);
  table["sensor"] = column(signals_.sensor);
  table["power_w"] = column(signals_.power_w);
  table["signal_v"] = column(signals_.signal_v);
  table["output"] = column_as<bool>(signals_.output);
  table["zone"] = column(signals_.zone);
  table["person"] = column(signals_.person);
  table["part"] = column(signals_.part);
  table["share_v"] = column(signals_.share_v);
  return table;
}

nb::list RunArrays::zones() {
  nb::list all;
  for (Zones& zones : zones_) {
    const std::size_t n_zones = zones.n_ticks == 0 ? 0 : zones.active.size() / zones.n_ticks;
    all.append(to_numpy(std::move(zones.active), {zones.n_ticks, n_zones}));
  }
  return all;
}

void RunArrays::add_rows(nb::dict& arrays) {
  const std::size_t n_runs = rows_.size();
  std::vector<std::uint8_t> valid(n_runs * n_windows_);
  for (std::size_t i = 0; i < n_runs; ++i) {
    const auto begin = valid.begin() + static_cast<std::ptrdiff_t>(i * n_windows_);
    std::fill(begin, begin + static_cast<std::ptrdiff_t>(rows_[i].people.size()), std::uint8_t{1});
  }
  arrays["valid"] = to_numpy_as<bool>(std::move(valid), {n_runs, n_windows_});
  if (has_clock_) arrays["clock"] = to_numpy(padded(rows_, &Rows::clock, n_windows_, 1, no_time), {n_runs, n_windows_});
  arrays["bits"] = to_numpy(padded(rows_, &Rows::bits, n_windows_, n_sensors_), {n_runs, n_windows_, n_sensors_});
  arrays["phase_code"] = to_numpy(padded(rows_, &Rows::phase, n_windows_, 1), {n_runs, n_windows_});
  arrays["people_of_areas"] =
      to_numpy(padded(rows_, &Rows::people_of_areas, n_windows_, n_areas_), {n_runs, n_windows_, n_areas_});
  arrays["door_open"] = to_numpy(padded(rows_, &Rows::doors, n_windows_, n_doors_), {n_runs, n_windows_, n_doors_});
  arrays["people"] = to_numpy(padded(rows_, &Rows::people, n_windows_, 1), {n_runs, n_windows_});
}

nb::dict RunArrays::to_dict() && {
  nb::dict arrays;
  add_rows(arrays);
  add_frames(arrays);
  arrays["time"] = column(time_s_);
  arrays["run"] = column(run_);
  arrays["replicate"] = column(replicate_);
  arrays["trial"] = to_python(trial_);
  arrays["phases"] = phases_.all();
  arrays["occupants"] = occupants();
  arrays["signals"] = signals();
  arrays["texts"] = texts_.all();
  arrays["zones"] = zones();
  arrays["faults"] = listed(faults_, [](const Fault& one) {
    return nb::make_tuple(one.run, one.fault.time_s, to_python(one.fault.message));
  });
  arrays["incidents"] = listed(incidents_, [](const Incident& one) {
    return nb::make_tuple(one.run, to_python(one.incident.kind), one.incident.time_s, to_python(one.incident.person),
                          to_python(one.incident.place_m));
  });
  return arrays;
}

// -- models, runs, recordings -----------------------------------------------------------------------------------------

Model compile_model(nb::handle scene, nb::handle script, const std::vector<std::string>& overrides,
                    const Folders& folders) {
  ScriptSpec script_spec = script_of(script, overrides, folders);
  SceneSpec scene_spec = scene_of(scene, folders);
  nb::gil_scoped_release release;
  return compile(std::move(scene_spec), std::move(script_spec));
}

nb::object warnings(const Model& model) {
  std::vector<Issue> all = model.scene().warnings;
  const auto add = [&](const std::vector<Issue>& issues) { all.insert(all.end(), issues.begin(), issues.end()); };
  add(model.script().warnings);
  add(effects::idle(model.script().effects, model.scene(), model.script().sensing));
  add(idle_sensor_keys(model.scene(), model.script().sensing));
  add(doubts_of_positions(model.scene(), model.script()));
  return to_python(all);
}

template <typename Spec>
nb::tuple ids_of(const std::vector<Spec>& specs) {
  return nb::tuple(listed(specs, [](const Spec& spec) { return to_python(spec.id); }));
}

/// Names, places (n x 3) and directions of view (n x 3).
template <typename Spec>
nb::tuple poses(const std::vector<Spec>& specs, Frame Spec::*frame) {
  std::vector<double> positions, directions;
  for (const Spec& spec : specs) {
    for (const auto& [vector, numbers] :
         {std::pair{(spec.*frame).origin, &positions}, std::pair{(spec.*frame).forward(), &directions}}) {
      numbers->insert(numbers->end(), {vector.x, vector.y, vector.z});
    }
  }
  const std::size_t n = specs.size();
  return nb::make_tuple(ids_of(specs), to_numpy(std::move(positions), {n, 3}), to_numpy(std::move(directions), {n, 3}));
}

/// Origins and directions (n_rays x 3), ranges, and of each ray its zone and its sensor.
nb::tuple rays(const Model& model) {
  const RayBundle& bundle = model.rays();
  std::vector<float> origins, directions, ranges = bundle.range;
  std::vector<std::uint32_t> zones, sensors;
  for (std::size_t s = 0; s < bundle.n_sensors(); ++s) {
    const auto first = bundle.cluster_zones_begin[bundle.sensor_clusters_begin[s]];
    const auto last = bundle.cluster_zones_begin[bundle.sensor_clusters_begin[s + 1]];
    for (auto zone = first; zone < last; ++zone) {
      for (auto ray = bundle.zone_rays_begin[zone]; ray < bundle.zone_rays_begin[zone + 1]; ++ray) {
        const auto& [origin, direction] = bundle.rays[ray];
        origins.insert(origins.end(), {origin.x, origin.y, origin.z});
        directions.insert(directions.end(), {direction.x, direction.y, direction.z});
        zones.push_back(zone);
        sensors.push_back(static_cast<std::uint32_t>(s));
      }
    }
  }
  const std::size_t n = ranges.size();
  return nb::make_tuple(to_numpy(std::move(origins), {n, 3}), to_numpy(std::move(directions), {n, 3}),
                        to_numpy(std::move(ranges), {n}), to_numpy(std::move(zones), {n}),
                        to_numpy(std::move(sensors), {n}));
}

/// None: all of the study's.
using Runs = std::optional<std::vector<std::uint32_t>>;

std::vector<std::uint32_t> all_runs(const Model& model) {
  std::vector<std::uint32_t> runs(model.n_runs());
  std::iota(runs.begin(), runs.end(), 0U);
  return runs;
}

std::size_t count_of(const Runs& runs, const Model& model) { return runs ? runs->size() : model.n_runs(); }

nb::dict run(const Model& model, Runs runs, unsigned threads, bool zones, bool signals, bool occupants, bool frames,
             nb::handle progress) {
  RunArrays arrays(model.scene().sensors.size(), model.areas().size(), model.scene().doors.size(),
                   frames ? model.scene().arrays : std::vector<SensorSpec>{});
  StudyOptions options;
  options.threads = threads;
  options.record = zones ? Record::samples_and_zones : Record::samples;
  options.trace = signals ? Trace::signals : Trace::none;
  options.occupants = occupants ? Occupants::told : Occupants::counted;
  options.frames = frames ? Frames::taken : Frames::none;
  const std::size_t n_runs = count_of(runs, model);
  options.chosen = std::move(runs);
  attend(progress, [&](Job& job) {
    job.n_all = n_runs;
    options.goes_on = [&] { return !job.stop; };
    run_study(model, options, [&](const RunResult& result) {
      arrays.add(result);
      ++job.n_done;
    });
  });
  return std::move(arrays).to_dict();
}

Recording record_runs(const Model& model, const Runs& runs, unsigned threads, nb::handle progress) {
  Recording recording;
  attend(progress, [&](Job& job) {
    job.n_all = count_of(runs, model);
    recording = record(model, runs ? *runs : all_runs(model), threads, [&] { job.step_or_stop(); });
  });
  return recording;
}

nb::dict emit_runs(const Model& model, const Recording& recording, nb::handle effects,
                   std::optional<std::uint64_t> seed, nb::handle progress) {
  RunArrays arrays(recording.n_sensors, model.areas().size(), model.scene().doors.size());
  EmitOptions options{.effects = {}, .seed = seed};
  if (!effects.is_none()) options.effects = from_python<std::vector<EffectSpec>>(effects, "effects");
  attend(progress, [&](Job& job) {
    job.n_all = recording.runs.size();
    emit(model, recording, options, [&](const RunResult& result) {
      arrays.add(result);
      job.step_or_stop();
    });
  });
  return std::move(arrays).to_dict();
}

}  // namespace

void add_study(nb::module_& module) {
  nb::class_<Model>(module, "Model", "What pirsim.Model holds.")
      .def_prop_ro("n_runs", &Model::n_runs)
      .def_prop_ro("tick_s", &Model::tick_s)
      .def_prop_ro("seed", [](const Model& model) { return model.script().seed; })
      .def_prop_ro("doors", [](const Model& model) { return ids_of(model.scene().doors); })
      .def_prop_ro("areas", [](const Model& model) { return nb::tuple(to_python(model.areas())); })
      .def_prop_ro("trials", [](const Model& model) { return ids_of(model.script().trials); })
      .def_prop_ro("warnings", &warnings)
      .def_prop_ro("sensors",
                   [](const Model& model) { return poses(model.scene().sensors, &SensorSpec::world_from_sensor); })
      .def_prop_ro("seats", [](const Model& model) { return poses(model.scene().seats, &SeatSpec::world_from_seat); })
      .def_prop_ro("rays", &rays)
      .def("scene", [](const Model& model) { return to_python(model.scene()); })
      .def("script", [](const Model& model) { return to_python(model.script()); });
  nb::class_<Recording>(module, "Recording", "What pirsim.Trace holds.")
      .def_prop_ro("n_runs", [](const Recording& recording) { return recording.runs.size(); });
  module.def("compile", &compile_model, "scene"_a, "script"_a, "overrides"_a, "folders"_a,
             "From files (texts) or objects of pirsim.specs.");
  module.def("run", &run, "model"_a, "runs"_a.none(), "threads"_a, "zones"_a, "signals"_a, "occupants"_a, "frames"_a,
             "progress"_a.none(), "Arrays of pirsim.Result, by name.");
  module.def("record", &record_runs, "model"_a, "runs"_a.none(), "threads"_a, "progress"_a.none(),
             "What the optics showed in these runs.");
  module.def("emit", &emit_runs, "model"_a, "recording"_a, "effects"_a.none(), "seed"_a.none(), "progress"_a.none(),
             "Arrays of pirsim.Result, by name.");
}

}  // namespace pirsim::python
