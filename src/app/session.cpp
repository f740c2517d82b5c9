#include "app/session.hpp"

#include <iostream>

#include "pirsim/effects.hpp"
#include "pirsim/io.hpp"
#include "rt/tracer.hpp"

namespace pirsim::app {
namespace {

TracerKind tracer_kind(const std::string& name) {
  if (name == "auto") return fastest_tracer;
  std::vector<std::string> names{"auto"};
  for (const auto kind : {TracerKind::direct, TracerKind::embree, TracerKind::reference}) {
    if (rt::name(kind) == name) return kind;
    names.emplace_back(rt::name(kind));
  }
  throw Error(ErrorCode::usage, "--tracer: '" + name + "' isn't a tracer" + did_you_mean(name, names));
}

}  // namespace

NuisanceSpec nuisance_of(const std::string& asked) {
  if (asked == "none") return {0.0, 0.0, 0.0, 0.0, 0.0};
  return asked.empty() ? NuisanceSpec{} : io::read_nuisance(asked);
}

void tell(const std::vector<Issue>& issues, Verbosity verbosity) {
  if (verbosity == Verbosity::quiet) return;
  for (const Issue& issue : issues) std::cerr << to_string(issue) << '\n';
}

io::SceneOptions scene_options(const Inputs& inputs) {
  std::error_code unknown;
  for (const std::filesystem::path& folder : inputs.sensor_directories) {
    if (!std::filesystem::is_directory(folder, unknown))
      throw Error(ErrorCode::io, Where{folder.string()}, "--sensors: there is no such folder");
  }
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
  // Installed (bin beside share), or in a build folder of the source tree (build/<preset>).
  return {inputs.sensor_directories, {program / ".." / "share" / "pirsim", program / ".." / ".." / "data"}};
}

Model load(const Inputs& inputs) {
  static_cast<void>(tracer_kind(inputs.tracer));  // before any file
  return load(inputs, io::read_script(inputs.script, inputs.overrides));
}

Model load(const Inputs& inputs, ScriptSpec script) {
  const TracerKind tracer = tracer_kind(inputs.tracer);
  SceneSpec scene = io::read_scene(inputs.scene, scene_options(inputs));
  tell(scene.warnings, inputs.verbosity);
  tell(script.warnings, inputs.verbosity);
  Model model = compile(std::move(scene), std::move(script), {tracer});
  tell(effects::idle(model.script().effects, model.scene(), model.script().sensing), inputs.verbosity);
  return model;
}

std::uint32_t find_run(const Model& model, const RunChoice& choice) {
  if (choice.replicate < 1 || choice.replicate > model.script().replicates) {
    throw Error(ErrorCode::usage, "--replicate: the script has 1 to " + std::to_string(model.script().replicates));
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.script().trials.size(); ++i) {
    names.push_back(model.script().trials[i].id);
    if (choice.trial.empty() || choice.trial == names.back()) {
      return static_cast<std::uint32_t>(static_cast<std::size_t>(choice.replicate - 1) * model.script().trials.size() +
                                        i);
    }
  }
  throw Error(ErrorCode::usage,
              "--trial: '" + choice.trial + "' is not in the script" + did_you_mean(choice.trial, names));
}

std::vector<std::size_t> find_sensors(const Model& model, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const SensorSpec& sensor : model.scene().sensors) known.push_back(sensor.id);
  std::vector<std::size_t> indices;
  for (const std::string& name : names) {
    if (name == "none") continue;
    bool found = name == "all";
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (name != "all" && name != known[i]) continue;
      indices.push_back(i);
      found = true;
    }
    if (!found)
      throw Error(ErrorCode::usage, "--beams: sensor '" + name + "' is not in the scene" + did_you_mean(name, known));
  }
  return indices;
}

}  // namespace pirsim::app
