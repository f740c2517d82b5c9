// Models, runs and recordings.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <numeric>

#include "arrays.hpp"
#include "attend.hpp"
#include "bindings.hpp"
#include "convert.hpp"
#include "pirsim/model.hpp"
#include "pirsim/response.hpp"
#include "run_arrays.hpp"

namespace pirsim::python {
namespace {

Model compile_model(nb::handle scene, nb::handle script, const std::vector<std::string>& overrides,
                    std::vector<std::string> sensors, std::vector<std::string> data) {
  ScriptSpec script_spec = script_of(script, overrides, data);
  SceneSpec scene_spec = scene_of(scene, {std::move(sensors), std::move(data)});
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

nb::tuple trials(const Model& model) {
  std::vector<std::string> names;
  for (const TrialSpec& trial : model.script().trials) names.push_back(trial.id);
  return nb::tuple(to_python(names));
}

/// Names, places (n x 3) and directions of view (n x 3).
template <typename Spec>
nb::tuple poses(const std::vector<Spec>& specs, Frame Spec::*frame) {
  std::vector<std::string> names;
  std::vector<double> positions, directions;
  for (const Spec& spec : specs) {
    names.push_back(spec.id);
    for (const auto& [vector, numbers] :
         {std::pair{(spec.*frame).origin, &positions}, std::pair{(spec.*frame).forward(), &directions}}) {
      numbers->insert(numbers->end(), {vector.x, vector.y, vector.z});
    }
  }
  const std::size_t n = specs.size();
  return nb::make_tuple(nb::tuple(to_python(names)), to_numpy(std::move(positions), {n, 3}),
                        to_numpy(std::move(directions), {n, 3}));
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

nb::dict run(const Model& model, Runs runs, unsigned threads, bool zones, bool signals, bool occupants,
             nb::handle progress) {
  RunArrays arrays(model.scene().sensors.size(), model.areas().size(), model.scene().doors.size());
  StudyOptions options;
  options.threads = threads;
  options.record = zones ? Record::samples_and_zones : Record::samples;
  options.trace = signals ? Trace::signals : Trace::none;
  options.occupants = occupants ? Occupants::told : Occupants::counted;
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
      .def_prop_ro("columns", [](const Model& model) { return nb::tuple(to_python(model.columns())); })
      .def_prop_ro("doors",
                   [](const Model& model) {
                     std::vector<std::string> ids;
                     for (const DoorSpec& door : model.scene().doors) ids.push_back(door.id);
                     return nb::tuple(to_python(ids));
                   })
      .def_prop_ro("areas", [](const Model& model) { return nb::tuple(to_python(model.areas())); })
      .def_prop_ro("trials", &trials)
      .def_prop_ro("warnings", &warnings)
      .def_prop_ro("sensors",
                   [](const Model& model) { return poses(model.scene().sensors, &SensorSpec::world_from_sensor); })
      .def_prop_ro("seats", [](const Model& model) { return poses(model.scene().seats, &SeatSpec::world_from_seat); })
      .def_prop_ro("rays", &rays)
      .def("scene", [](const Model& model) { return to_python(model.scene()); })
      .def("script", [](const Model& model) { return to_python(model.script()); });
  nb::class_<Recording>(module, "Recording", "What pirsim.Trace holds.")
      .def_prop_ro("n_runs", [](const Recording& recording) { return recording.runs.size(); })
      .def_prop_ro("n_moments", &Recording::n_moments);
  module.def("compile", &compile_model, nb::arg("scene"), nb::arg("script"), nb::arg("overrides"), nb::arg("sensors"),
             nb::arg("data"), "From files (texts) or objects of pirsim.specs.");
  module.def("run", &run, nb::arg("model"), nb::arg("runs").none(), nb::arg("threads"), nb::arg("zones"),
             nb::arg("signals"), nb::arg("occupants"), nb::arg("progress").none(), "Arrays of pirsim.Result, by name.");
  module.def("record", &record_runs, nb::arg("model"), nb::arg("runs").none(), nb::arg("threads"),
             nb::arg("progress").none(), "What the optics showed in these runs.");
  module.def("emit", &emit_runs, nb::arg("model"), nb::arg("recording"), nb::arg("effects").none(),
             nb::arg("seed").none(), nb::arg("progress").none(), "Arrays of pirsim.Result, by name.");
}

}  // namespace pirsim::python
