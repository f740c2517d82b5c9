// What a command reads and writes, as its options declare it: nothing that is read is written over.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/schema/clock.hpp"

namespace pirsim::app {

/// A file or folder of an option.
struct NamedFile {
  std::string option;                      ///< "--summary"
  std::filesystem::path file;              ///< or folder; empty: not asked for
  std::vector<std::string> endings = {};   ///< that an output's name may have; none: any
  std::vector<std::string> contents = {};  ///< of a folder: "recipe.yaml", "*.png", "pool" with all below; none: a file
};

/// Of one command. What is asked for is known once the options are.
class Files {
 public:
  using List = std::function<std::vector<NamedFile>()>;
  void add_inputs(List inputs) { inputs_.push_back(std::move(inputs)); }
  void add_outputs(List outputs) { outputs_.push_back(std::move(outputs)); }

  /// Tells what is wrong with the names of outputs before any work is done. Throws Error(usage) for an ending that
  /// isn't known, for two outputs in one place, and for an output in the place of an input, whatever their names are;
  /// Error(io) for a folder that is missing, a folder where a file is wanted, and a file where a folder is. What isn't
  /// a file, as /dev/stdout, is written over by nobody.
  void check() const;
  /// Throws Error(usage) for an output in the place of one of these files, which reading has found.
  void keep(const std::vector<std::filesystem::path>& read) const;

 private:
  std::vector<List> inputs_, outputs_;
};

/// ".csv, .csv.gz or .csv.zst"
[[nodiscard]] std::string in_words(const std::vector<std::string>& endings);
/// Would the file lie in that folder, however deep, or be the folder itself?
[[nodiscard]] bool is_below(const std::filesystem::path& file, const std::filesystem::path& folder);

// What the commands have in common: options in groups, and how a command is registered.

enum class Verbosity { quiet, normal, verbose };

/// A room, a script, and what changes how they are read. A command offers as much of it as it uses.
struct Inputs {
  std::filesystem::path scene;
  std::filesystem::path marks;  ///< beside the scene; empty: none
  std::filesystem::path script;
  std::vector<std::string> overrides;  ///< "sensing.rays_per_zone=9"
  std::vector<std::filesystem::path> sensor_directories;
  std::string tracer = "auto";
  Verbosity verbosity = Verbosity::normal;
  const Files* files = nullptr;  ///< of the command that offers this
};

/// One run of a study.
struct RunChoice {
  std::string trial;  ///< empty: the first
  int replicate = 1;
};

/// pirsim itself, or a subcommand. Before its work it refuses outputs that can't be written or are inputs, and two
/// inputs that are standard input, which is read once.
class Command : public CLI::App {
 public:
  using CLI::App::App;
  Command(const std::string& name, const std::string& what, CLI::App& parent) : CLI::App(what, name, &parent) {}
  Files files;

 private:
  void pre_callback() override;
};

// Options that name files and folders. Each is declared to be read or to be written, which its group in the help tells.

/// Lets the option's file be standard input, by "-"; one of a command's files at most.
CLI::Option* as_input(CLI::Option* option);
/// An input as the user typed it: standard input is "-".
[[nodiscard]] std::string typed(const std::filesystem::path& input);
/// An option whose files are read; contents: of folders among them, as NamedFile has it.
CLI::Option* declare_inputs(CLI::App& command, CLI::Option* option, const std::vector<std::filesystem::path>& files,
                            const std::vector<std::string>& contents = {});
/// An option for a file that is read, and may be standard input.
CLI::Option* offer_input_file(CLI::App& command, const std::string& name, std::filesystem::path& file,
                              const std::string& what);
constexpr const char* output_names = "-o,--output";
/// endings: those that its name may have, which say what is written.
CLI::Option* offer_output(CLI::App& command, const std::string& names, std::filesystem::path& file,
                          const std::string& what, const std::vector<std::string>& endings);
/// contents: what is written into it, as NamedFile has it.
CLI::Option* offer_output_folder(CLI::App& command, const std::string& names, std::filesystem::path& folder,
                                 const std::string& what, const std::vector<std::string>& contents);
/// Where other options say what an output is, or where files lie beside it.
CLI::Option* declare_outputs(CLI::App& command, CLI::Option* option, const Files::List& outputs);

/// --sensors.
void offer_sensors(CLI::App& command, Inputs& inputs);
/// --set, --response, --sensors and --quiet. `what` is changed: a script or a recipe.
void offer_changes(CLI::App& command, Inputs& inputs, const std::string& what);
/// --scene, --marks and the options of offer_changes(): for commands that make the script themselves.
void offer_scene(CLI::App& command, Inputs& inputs);
/// The options of offer_scene() and --script: every other command that reads a room uses them.
void offer_study(CLI::App& command, Inputs& inputs);
/// What of it makes the model what it is, as the user typed it: a command with these words reads the same.
[[nodiscard]] std::vector<std::string> model_options(const Inputs& inputs);
/// For commands that trace rays by load(); not in the help: a switch for who works on tracers.
void offer_tracer(CLI::App& command, Inputs& inputs);
void offer_seed(CLI::App& command, Inputs& inputs);
/// Of an option whose value is 64 bits wide: CLI11 takes -1 for a large number there, and cuts what is too large.
[[nodiscard]] CLI::Validator is_seed();
void offer_replicates(CLI::App& command, Inputs& inputs);
void offer_quiet(CLI::App& command, Verbosity& verbosity);
/// After offer_quiet(): who asks for both gets Error(usage).
void offer_verbose(CLI::App& command, Verbosity& verbosity);
void offer_threads(CLI::App& command, unsigned& threads);
void offer_run_choice(CLI::App& command, RunChoice& choice);
void offer_map_report(CLI::App& command, std::filesystem::path& report);

/// A subcommand. `examples` are whole lines, and stand at the end of its help.
[[nodiscard]] Command& add_command(CLI::App& parent, const std::string& name, const std::string& what,
                                   const std::string& examples);
/// A command's word of an earlier version: accepted, but not in the help.
[[nodiscard]] Command& add_old_command(CLI::App& parent, const std::string& name, const std::string& what,
                                       const std::string& examples);
/// As CLI11's, without what excludes a flag, and without options' names of an earlier version, which are accepted.
[[nodiscard]] std::shared_ptr<CLI::FormatterBase> help_formatter();
enum class Needs { scene, scene_and_script };
/// Throws Error(usage) if one of them is missing.
void require_inputs(const CLI::App& command, const Inputs& inputs, Needs needs);
/// Does the work if the command itself is called, not one of its subcommands. It refuses to without what it needs.
void on_call(CLI::App& command, std::shared_ptr<const Inputs> inputs, std::function<void(const Inputs&)> work,
             Needs needs = Needs::scene_and_script);

/// Options before a command's name count as if they stood after it: `pirsim --scene room.gltf check`. What the command
/// doesn't take is refused by Error(usage). Holds for all subcommands that the app has, however deep.
void pass_options_on(CLI::App& app);
/// CLI11's message in one or two lines, but for what pirsim says in its own words.
[[nodiscard]] std::string explain(const CLI::App* app, const CLI::Error& error);
/// Names of the subcommands in the help.
[[nodiscard]] std::vector<std::string> offered_commands(const CLI::App& parent);
/// As a user types it, without "pirsim": "reconcile plan".
[[nodiscard]] std::string spoken_name(const CLI::App& command);

/// Turns a word into the number that stands for it, or says which words there are.
[[nodiscard]] CLI::Validator one_of_words(std::map<std::string, int> values);
/// Words for the values of an enumeration.
template <typename Value>
[[nodiscard]] CLI::Validator one_of(const std::map<std::string, Value>& values) {
  std::map<std::string, int> numbers;
  for (const auto& [word, value] : values) numbers.emplace(word, static_cast<int>(value));
  return one_of_words(std::move(numbers));
}

// A moment of a run, as options take it and as messages tell it.

/// An option that takes a moment; `otherwise` says in its help what holds without it.
void offer_moment(CLI::App& command, const std::string& name, std::string& text, const std::string& what,
                  const std::string& otherwise);

/// Seconds of the run; below 0 for a date before it. A time of day is the first such moment of the run. Throws
/// Error(usage) that names the option, for what is no moment and for a time of day in a run without a clock.
[[nodiscard]] double moment(const std::string& option, const std::string& text, const std::optional<RunClock>& clock);

}  // namespace pirsim::app
