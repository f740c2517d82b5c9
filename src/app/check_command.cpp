#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/input.hpp"
#include "io/read/model_parts.hpp"
#include "pirsim/look.hpp"
#include "studies/suggestion.hpp"

namespace pirsim::app {
namespace {

struct CheckOptions {
  bool suggests = false;
  studies::SuggestionHints hints;
  std::filesystem::path output;  ///< empty: standard output
};

/// Marks that somebody edited are worth more than new ones.
void refuse_to_overwrite(const std::filesystem::path& file) {
  std::error_code unknown;
  if (!file.empty() && !io::is_written_directly(file) && std::filesystem::exists(file, unknown))
    throw Error(ErrorCode::usage, "-o: '" + file.string() + "' is there already and isn't overwritten");
}

void suggest(const Inputs& inputs, const CheckOptions& options) {
  if (!inputs.marks.empty()) throw Error(ErrorCode::usage, "--suggest makes marks; it doesn't go with --marks");
  refuse_to_overwrite(options.output);
  const std::string name = io::name_of_input(inputs.scene);
  const std::string text = [&] {
    const Progress progress({.what = "looking for floors and rooms in " + name}, inputs.verbosity);
    io::ModelParts model = io::read_model_parts(found(io::DataKind::rooms, inputs.scene));
    tell(model.warnings, inputs.verbosity);
    return studies::to_yaml(studies::suggest(std::move(model), options.hints, name), name);
  }();
  if (options.output.empty()) {
    std::cout << text;
    return require_written();
  }
  io::write_text_file(options.output, text);
  tell_written({{options.output}}, inputs.verbosity);
}

void check(const Inputs& inputs, const CheckOptions& options) {
  if (options.suggests) return suggest(inputs, options);
  if (options.hints.floor_m || !options.hints.ignored.empty() || !options.output.empty()) {
    throw Error(ErrorCode::usage, std::string(options.hints.floor_m           ? "--floor"
                                              : options.hints.ignored.empty() ? "-o"
                                                                              : "--ignore") +
                                      " goes with --suggest");
  }
  // Warnings are what a check is made for: --quiet leaves out only the report.
  Inputs with_warnings = inputs;
  with_warnings.verbosity = Verbosity::normal;
  const Model model = load(with_warnings, inputs.verbosity);
  const CheckReport report = [&] {
    const Progress progress({.what = "looking at what sensors see"}, inputs.verbosity);
    return check_study(model);
  }();
  if (inputs.verbosity != Verbosity::quiet) std::cout << report.text;
  require_written();
  tell(report.warnings, Verbosity::normal);  // last, where a terminal shows them
}

}  // namespace

void add_check_command(CLI::App& app) {
  CLI::App& command = add_command(app, "check", "validate scene and script without running them", R"(
  pirsim check --scene room.gltf --script study.yaml               validate, and report what each sensor can see
  pirsim check --scene room.gltf                                   the same of a room alone
  pirsim check --scene room.gltf --script study.yaml -q            only faults and warnings
  pirsim check --scene flat.glb --suggest -o marks.yaml            propose marks for a model that has none
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<CheckOptions>();
  offer_study(command, *inputs);
  offer_tracer(command, *inputs);
  offer_replicates(command, *inputs);
  command.add_flag("--suggest", options->suggests,
                   "propose a file of marks for the scene, to be edited; no script is needed");
  command
      .add_option("--floor", options->hints.floor_m,
                  "of --suggest: the floor's height (default: the lowest large one's)")
      ->option_text("M");
  command
      .add_option("--ignore", options->hints.ignored,
                  "of --suggest: a node to leave out with all below it, as `ignore` of marks; repeatable")
      ->option_text("NODE")
      ->allow_extra_args(false);
  offer_output(command, output_names, options->output, "of --suggest: marks, .yaml (default: standard output)",
               {".yaml", ".yml"});
  on_call(
      command, inputs, [options](const Inputs& given) { check(given, *options); }, Needs::scene);
}

}  // namespace pirsim::app
