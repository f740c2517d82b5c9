#include "app/session.hpp"

#include <poll.h>
#include <unistd.h>
#include <algorithm>
#include <iostream>

#include "app/long_work.hpp"
#include "engine/rt/tracer.hpp"
#include "engine/sim/compiled_study.hpp"
#include "files/read/csv_reader.hpp"
#include "model/core/text.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "pirsim/model.hpp"
#include "pirsim/response.hpp"
#include "pirsim/version.hpp"
#include "surveys/coverage.hpp"

namespace pirsim::app {
namespace {

TracerKind tracer_kind(const std::string& name) {
  if (name == "auto") return fastest_tracer;
  std::vector<std::string> names{"auto"};
  for (const auto kind : {TracerKind::direct, TracerKind::embree, TracerKind::reference}) {
    if (rt::name(kind) == name) return kind;
    names.emplace_back(rt::name(kind));
  }
  throw Error(ErrorCode::usage, "--tracer: '" + name + "' isn't a tracer" + near_or_all(name, names));
}

}  // namespace

void tell(const std::vector<Issue>& issues, Verbosity verbosity) {
  if (verbosity == Verbosity::quiet) return;
  for (const Issue& issue : issues) std::cerr << to_string(issue) << '\n';
}

void tell_what_is_left_out(const studies::CoverageStudy& study, Verbosity verbosity) {
  constexpr std::size_t most_named = 6;
  const std::vector<TriMesh>& meshes = study.taken_out();
  if (meshes.empty() || verbosity == Verbosity::quiet) return;
  std::cerr << "left out of the room, as the study's 'without' says:";
  for (std::size_t i = 0; i < std::min(meshes.size(), most_named); ++i)
    std::cerr << (i == 0 ? " " : ", ") << meshes[i].name;
  if (meshes.size() > most_named) std::cerr << " and " << meshes.size() - most_named << " more";
  std::cerr << '\n';
}

io::SceneOptions scene_options(const Inputs& inputs) {
  std::error_code unknown;
  for (const std::filesystem::path& folder : inputs.sensor_directories) {
    if (!std::filesystem::is_directory(folder, unknown))
      throw Error(ErrorCode::io, Where{folder.string()}, "--sensors: there is no such folder");
  }
  return {inputs.sensor_directories, data_directories(), inputs.marks};
}

std::vector<std::filesystem::path> data_directories() {
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
  // Installed (bin beside share), or in a build folder or the Python package (beside data).
  return {(program / ".." / "share" / "pirsim").lexically_normal(), program / "data"};
}

std::filesystem::path found(io::DataKind kind, const std::filesystem::path& file) {
  return io::find_file(file, kind, data_directories());
}

SceneSpec read_scene(const Inputs& inputs) {
  const std::filesystem::path file = found(io::DataKind::rooms, inputs.scene);
  SceneSpec scene = io::read_scene(file, scene_options(inputs));
  keep_inputs(inputs, files_read({}, scene));
  return scene;
}

ScriptSpec read_script(const Inputs& inputs) {
  ScriptSpec script =
      io::read_script(found(io::DataKind::studies, inputs.script), inputs.overrides, data_directories());
  keep_inputs(inputs, files_read(script, {}));
  return script;
}

namespace {

Model compiled(const Inputs& inputs, Verbosity of_progress, ScriptSpec script) {
  const TracerKind tracer = tracer_kind(inputs.tracer);
  const Progress progress({.what = "reading and compiling " + inputs.scene.filename().string()}, of_progress);
  SceneSpec scene = read_scene(inputs);
  tell(scene.warnings, inputs.verbosity);
  tell(script.warnings, inputs.verbosity);
  Model model = compile(std::move(scene), std::move(script), {tracer});
  const sim::CompiledStudy& study = model.compiled();
  tell(effects::idle(study.script_given().effects, study.scene(), study.sensing()), inputs.verbosity);
  tell(idle_sensor_keys(study.scene_given(), study.sensing()), inputs.verbosity);
  tell(doubts_of_positions(study.scene_given(), study.script_given()), inputs.verbosity);
  return model;
}

}  // namespace

Model load(const Inputs& inputs) { return load(inputs, inputs.verbosity); }

Model load(const Inputs& inputs, Verbosity of_progress) {
  static_cast<void>(tracer_kind(inputs.tracer));  // before any file
  // Of commands that look at a scene alone.
  constexpr const char* nobody = "pirsim_script: 1\nname: no script\nduration_s: 1\n";
  if (inputs.script.empty()) return compiled(inputs, of_progress, io::parse_script(nobody, "", inputs.overrides));
  ScriptSpec script = [&] {
    const Progress progress({.what = "reading " + inputs.script.filename().string()}, of_progress);
    return read_script(inputs);
  }();
  return compiled(inputs, of_progress, std::move(script));
}

Model load(const Inputs& inputs, ScriptSpec script) { return compiled(inputs, inputs.verbosity, std::move(script)); }

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
              "--trial: '" + choice.trial + "' is not in the script" + near_or_all(choice.trial, names));
}

const std::vector<std::string>& summary_endings() {
  static const std::vector<std::string> endings{".csv", ".md"};
  return endings;
}

void keep_inputs(const Inputs& inputs, const std::vector<std::filesystem::path>& read) {
  if (inputs.files == nullptr)
    throw Error(ErrorCode::internal, "a command reads files that it didn't declare (offer_sensors)");
  inputs.files->keep(read);
}

namespace {

/// What the script's summary refers to; an empty path if it doesn't.
io::NamedFile reference_of(const ScriptSpec& script) {
  const std::string& file = script.summary.reference_file;
  if (file.empty()) return {};
  return io::find_beside(script.directory, file, io::DataKind::measured, data_directories());
}

}  // namespace

std::vector<std::filesystem::path> files_read(const ScriptSpec& script, const SceneSpec& scene) {
  std::vector<std::filesystem::path> files;
  for (const std::vector<InputFile>* read : {&script.files, &scene.files}) {
    for (const InputFile& file : *read) files.emplace_back(file.path);
  }
  const io::NamedFile reference = reference_of(script);
  if (!reference.path.empty()) files.push_back(reference.path);
  return files;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault) throw Error(ErrorCode::io, Where{folder.string()}, "can't make the folder: " + fault.message());
}

std::vector<MeasuredCell> measured_cells(const ScriptSpec& script) {
  const io::NamedFile reference = reference_of(script);
  if (reference.path.empty()) return {};
  if (!reference.fault.empty())
    throw Error(ErrorCode::io, script.summary.where, "summary: reference: " + reference.fault);
  return io::read_measured_cells(reference.path);
}

void write_summary(const studies::Summary& summary, io::AtomicFile& file, const std::filesystem::path& path,
                   const std::string& title, const std::string& remarks, Verbosity verbosity) {
  const bool is_document = path.extension() == ".md";
  if (is_document) file.stream() << "# " << markdown_text(title) << ": seconds with motion\n\n";
  file.stream() << (is_document ? studies::to_markdown(summary) : studies::to_csv(summary));
  if (is_document && !remarks.empty()) file.stream() << '\n' << remarks << '\n';
  file.commit();
  if (verbosity != Verbosity::quiet) std::cerr << studies::to_text(summary);
}

std::string made_by(const Inputs& inputs) { return made_from({inputs.scene, inputs.marks, inputs.script}); }

std::string made_from(const std::vector<std::filesystem::path>& files) {
  std::string text = program();
  for (const std::filesystem::path& file : files)
    if (!file.empty()) text += ", " + io::name_of_input(file);
  return text;
}

void write_page(io::AtomicFile& file, io::Report report, const Inputs& inputs) {
  report.footer = made_by(inputs);
  file.stream() << io::to_html(report);
  file.commit();
}

void tell_written(const std::vector<WrittenFile>& files, Verbosity verbosity) {
  if (verbosity == Verbosity::quiet) return;
  std::string text;
  for (const auto& [file, about] : files) {
    if (file.empty() || io::is_written_directly(file)) continue;
    text += (text.empty() ? "wrote " : ", ") + file.string() + (about.empty() ? "" : ": " + about);
  }
  if (!text.empty()) std::cerr << text << '\n';
}

void require_written() {
  if (std::cout.flush()) return;
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  if (poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0) throw ClosedPipe{};
  throw Error(ErrorCode::io, "standard output can't be written: is the disk full?");
}

}  // namespace pirsim::app
