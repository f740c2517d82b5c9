#include "app/options.hpp"

#include <fnmatch.h>
#include <sys/stat.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "files/disk/file.hpp"
#include "model/core/text.hpp"
#include "model/schema/words.hpp"
#include "pirsim/error.hpp"

namespace pirsim::app {
namespace {

constexpr const char* said_of_inputs = ", - for standard input";

bool is_input(const CLI::Option& option) { return option.get_description().ends_with(said_of_inputs); }

/// CLI11's transformation of a file's name.
std::string take_standard_input(std::string& file) {
  if (file == "-") file = io::standard_input;
  return {};
}

/// Also of an option that isn't in the help, which CLI11 gives no name.
std::string name_of(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

/// As it is mostly typed: "-o".
std::string told_name(const CLI::Option& option) {
  if (option.get_positional()) return "the input";
  return option.get_snames().empty() ? option.get_name() : '-' + option.get_snames().front();
}

Files& files_of(CLI::App& command) { return dynamic_cast<Command&>(command).files; }

/// Throws Error(usage) if two inputs are standard input.
void require_one_standard_input(const CLI::App& command) {
  const CLI::Option* first = nullptr;
  for (const CLI::Option* option : command.get_options(nullptr)) {
    const auto n = is_input(*option) ? std::ranges::count(option->results(), io::standard_input) : 0;
    if (n > 1) throw Error(ErrorCode::usage, option->get_name() + ": standard input can be read once");
    if (n == 0) continue;
    if (first != nullptr) {
      throw Error(ErrorCode::usage, first->get_name() + " and " + option->get_name() + " can't both be standard input");
    }
    first = option;
  }
}

/// Functions that offer an option to several commands give it one description. Others mean something of their own.
bool mean_the_same(const CLI::Option& one, const CLI::Option& other) {
  return one.get_description() == other.get_description();
}

/// CLI11 answers these itself, wherever they stand.
bool is_about_pirsim(const CLI::App& app, const CLI::Option* option) {
  return option == app.get_help_ptr() || option == app.get_version_ptr();
}

void take_from_parent(CLI::App& command) {
  CLI::App& parent = *command.get_parent();
  for (CLI::Option* option : parent.get_options(nullptr)) {
    if (option->count() == 0 || is_about_pirsim(parent, option)) continue;
    const std::string name = name_of(*option);
    CLI::Option* own = command.get_option_no_throw(name);
    if (own == nullptr) throw Error(ErrorCode::usage, name + " is not an option of '" + spoken_name(command) + "'");
    if (!mean_the_same(*option, *own)) {
      throw Error(ErrorCode::usage,
                  name + " must stand after '" + spoken_name(command) + "'; before it, it means something else");
    }
    own->add_result(option->results());
    option->clear();
  }
}

/// What a file that stands alone was probably meant for; empty for any other word.
std::string meant_as(const std::string& word) {
  const std::string ending = std::filesystem::path(word).extension().string();
  if (ending == ".gltf" || ending == ".glb") return "; a room is given as --scene " + word;
  if (ending == ".yaml" || ending == ".yml") return "; a study is given as --script " + word;
  return {};
}

/// What is wrong with a word of the command line that nothing takes.
std::string explain_word(const CLI::App& app, const std::string& word) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  const bool is_option = word.size() > 1 && word.front() == '-';
  std::vector<std::string> known;
  if (is_option) {
    for (const CLI::Option* option : command->get_options(nullptr)) {
      if (!option->get_group().empty()) known.push_back(option->get_name());
    }
  } else {
    known = offered_commands(*command);
  }
  const std::string spoken = spoken_name(*command);
  const std::string hint = command->get_option_no_throw("--scene") == nullptr ? std::string() : meant_as(word);
  const std::string what = is_option ? "an option" : known.empty() ? "an argument" : "a command";
  return "error: '" + word + "' isn't " + what + " of 'pirsim" + (spoken.empty() ? "" : " " + spoken) + "'" +
         (hint.empty() ? did_you_mean(word, known) : hint) + "\n";
}

/// CLI11's complaint, "Could not convert: --time = 10s", in pirsim's words; empty if it is another one.
std::string explain_conversion(const CLI::App& app, const std::string& complaint) {
  constexpr std::string_view before = "Could not convert: ", between = " = ";
  const std::size_t end = complaint.find(between);
  if (!complaint.starts_with(before) || end == std::string::npos) return {};
  const std::string name = complaint.substr(before.size(), end - before.size());
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  const CLI::Option* option = command->get_option_no_throw(name);
  if (option == nullptr) return {};
  const std::string type = option->get_type_name();
  std::string wanted = type.starts_with("UINT") ? "a whole number from 0" : "a whole number";
  if (type.starts_with("FLOAT")) wanted = "a number";
  if (option->get_items_expected_max() > 1) wanted = "a list of numbers";
  return "error: " + name + ": '" + complaint.substr(end + between.size()) + "' is not " + wanted + "\n";
}

/// The option that the user gave more often than it can be taken, or null.
const CLI::Option* repeated_option(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options(nullptr)) {
    const bool is_single = option->get_multi_option_policy() == CLI::MultiOptionPolicy::Throw;
    if (is_single && static_cast<int>(option->count()) > option->get_items_expected_max()) return option;
  }
  for (const CLI::App* command : app.get_subcommands()) {
    if (const CLI::Option* option = repeated_option(*command)) return option;
  }
  return nullptr;
}

// Values are checked here, so that the message names the option and not a value of the script that nobody typed.

std::int64_t from(std::int64_t least, std::int64_t n, const std::string& option) {
  if (n < least) {
    throw CLI::ValidationError(option, "'" + std::to_string(n) + "' is less than " + std::to_string(least));
  }
  return n;
}

const std::string& response(const std::string& word) {
  std::vector<std::string> words;
  for (const auto& [known, value] : Words<Response>::all) words.emplace_back(known);
  if (std::ranges::find(words, word) != words.end()) return word;
  throw CLI::ValidationError("--response", "'" + word + "' isn't a response" + near_or_all(word, words));
}

void offer_scene_file(CLI::App& command, Inputs& inputs) {
  offer_input_file(command, "--scene", inputs.scene, "room: a glTF 2.0 file (.gltf or .glb)");
  offer_input_file(command, "--marks", inputs.marks, "marks for a scene without: a YAML file");
}

}  // namespace

std::vector<std::string> offered_commands(const CLI::App& parent) {
  std::vector<std::string> names;
  for (const CLI::App* command : parent.get_subcommands(nullptr)) {
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  return names;
}

CLI::Option* as_input(CLI::Option* option) {
  return option->description(option->get_description() + said_of_inputs)
      ->transform(CLI::Validator(take_standard_input, ""));
}

CLI::Option* declare_inputs(CLI::App& command, CLI::Option* option, const std::vector<std::filesystem::path>& files,
                            const std::vector<std::string>& contents) {
  files_of(command).add_inputs([option, &files, contents] {
    std::vector<NamedFile> inputs;
    std::error_code unknown;
    for (const std::filesystem::path& file : files) {
      const bool is_folder = std::filesystem::is_directory(file, unknown);
      inputs.push_back({told_name(*option), file, {}, is_folder ? contents : std::vector<std::string>{}});
    }
    return inputs;
  });
  return option->group("Inputs");
}

CLI::Option* offer_input_file(CLI::App& command, const std::string& name, std::filesystem::path& file,
                              const std::string& what) {
  CLI::Option* option = as_input(command.add_option(name, file, what));
  files_of(command).add_inputs([option, &file] { return std::vector<NamedFile>{{told_name(*option), file}}; });
  return (option->get_positional() ? option : option->option_text("FILE"))->group("Inputs");
}

CLI::Option* declare_outputs(CLI::App& command, CLI::Option* option, const Files::List& outputs) {
  files_of(command).add_outputs(outputs);
  return option->group("Outputs");
}

CLI::Option* offer_output(CLI::App& command, const std::string& names, std::filesystem::path& file,
                          const std::string& what, const std::vector<std::string>& endings) {
  CLI::Option* option = command.add_option(names, file, what)->option_text("FILE");
  return declare_outputs(command, option, [option, &file, endings] {
    return std::vector<NamedFile>{{told_name(*option), file, endings}};
  });
}

CLI::Option* offer_output_folder(CLI::App& command, const std::string& names, std::filesystem::path& folder,
                                 const std::string& what, const std::vector<std::string>& contents) {
  CLI::Option* option = command.add_option(names, folder, what)->option_text("DIR");
  return declare_outputs(command, option, [option, &folder, contents] {
    return std::vector<NamedFile>{{told_name(*option), folder, {}, contents}};
  });
}

void offer_sensors(CLI::App& command, Inputs& inputs) {
  inputs.files = &files_of(command);
  command.add_option("--sensors", inputs.sensor_directories, "folder with sensor models, searched first")
      ->option_text("DIR")
      ->allow_extra_args(false)
      ->group("Inputs");  // which of their files are read is told once they are
}

void offer_changes(CLI::App& command, Inputs& inputs, const std::string& what) {
  offer_sensors(command, inputs);
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&inputs](const std::vector<std::string>& given) {
            inputs.overrides.insert(inputs.overrides.end(), given.begin(), given.end());
          },
          "override a value of the " + what + ": sensing.rays_per_zone=9")
      ->option_text("KEY=VALUE")
      ->allow_extra_args(false);
  command
      .add_option_function<std::string>(
          "--response",
          [&inputs](const std::string& word) { inputs.overrides.push_back("sensing.response=" + response(word)); },
          "how all sensors answer: zones or analog (default: as the " + what + " says, or else the sensor)")
      ->option_text("WORD");
  offer_quiet(command, inputs.verbosity);
}

void offer_scene(CLI::App& command, Inputs& inputs) {
  offer_scene_file(command, inputs);
  offer_changes(command, inputs, "script");
}

void offer_study(CLI::App& command, Inputs& inputs) {
  offer_scene_file(command, inputs);
  offer_input_file(command, "--script", inputs.script, "study: a YAML file");
  offer_changes(command, inputs, "script");
}

std::string typed(const std::filesystem::path& input) { return input == io::standard_input ? "-" : input.string(); }

std::vector<std::string> model_options(const Inputs& inputs) {
  std::vector<std::string> words{"--scene", typed(inputs.scene)};
  if (!inputs.marks.empty()) words.insert(words.end(), {"--marks", typed(inputs.marks)});
  words.insert(words.end(), {"--script", typed(inputs.script)});
  for (const std::string& change : inputs.overrides) words.insert(words.end(), {"--set", change});
  for (const std::filesystem::path& folder : inputs.sensor_directories)
    words.insert(words.end(), {"--sensors", folder.string()});
  return words;
}

void offer_tracer(CLI::App& command, Inputs& inputs) {
  command.add_option("--tracer", inputs.tracer, "auto, direct, embree or reference")->group("");
}

void offer_seed(CLI::App& command, Inputs& inputs) {
  command
      .add_option_function<std::int64_t>(
          "--seed",
          [&inputs](std::int64_t n) { inputs.overrides.push_back("seed=" + std::to_string(from(0, n, "--seed"))); },
          "seed of all random streams")
      ->option_text("N");
}

CLI::Validator is_seed() {
  return {[](std::string& text) {
            return io::parse_number<std::uint64_t>(text) ? std::string()
                                                         : "'" + text + "' is not a whole number from 0 to 2^64 - 1";
          },
          "", "seed"};
}

void offer_replicates(CLI::App& command, Inputs& inputs) {
  command
      .add_option_function<int>(
          "--replicates",
          [&inputs](int n) { inputs.overrides.push_back("replicates=" + std::to_string(from(1, n, "--replicates"))); },
          "how often every trial is run")
      ->option_text("N");
}

void offer_quiet(CLI::App& command, Verbosity& verbosity) {
  command.add_flag_callback(
      "-q,--quiet", [&verbosity] { verbosity = Verbosity::quiet; }, "errors only; of check, warnings as well");
}

void offer_verbose(CLI::App& command, Verbosity& verbosity) {
  // CLI11 calls back in the order in which options were offered, so --quiet has had its effect by now.
  const auto set = [&verbosity] {
    if (verbosity == Verbosity::quiet) throw Error(ErrorCode::usage, "--quiet and --verbose exclude each other");
    verbosity = Verbosity::verbose;
  };
  command.add_flag_callback("-v,--verbose", set, "more about the work's progress");
}

void offer_threads(CLI::App& command, unsigned& threads) {
  command.add_option("--threads", threads, "0: all cores; changes no byte of any result")->option_text("N");
}

void offer_run_choice(CLI::App& command, RunChoice& choice) {
  command.add_option("--trial", choice.trial, "which trial (default: the first)")->option_text("ID");
  command.add_option("--replicate", choice.replicate, "which replicate (default: 1)")->option_text("N");
}

void offer_map_report(CLI::App& command, std::filesystem::path& report) {
  offer_output(command, "--report", report, "the maps as one self-contained page, .html", {".html"});
}

namespace {

/// CLI11 lets numbers pass that nothing can hold.
void require_numbers(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string type = option->get_type_name();  // with what is said of its range
    const bool is_whole = type.starts_with("INT") || type.starts_with("UINT"), is_number = type.starts_with("FLOAT");
    const auto holds = [&](const std::string& value) {
      if (is_whole) return io::parse_number<std::int64_t>(value) || io::parse_number<std::uint64_t>(value);
      return !is_number || std::isfinite(io::parse_number<double>(value).value_or(NAN));
    };
    for (const std::string& value : option->results()) {
      if (!holds(value))
        throw Error(ErrorCode::usage, told_name(*option) + ": expected a " + (is_whole ? "whole number" : "number") +
                                          ", got '" + value + "'");
    }
  }
}

}  // namespace

void Command::pre_callback() {
  if (!get_subcommands().empty()) return;
  require_numbers(*this);
  require_one_standard_input(*this);
  files.check();
}

Command& add_command(CLI::App& parent, const std::string& name, const std::string& what, const std::string& examples) {
  const auto command = std::make_shared<Command>(name, what, parent);
  parent.add_subcommand(command);
  command->footer("Examples:" + examples);
  return *command;
}

Command& add_old_command(CLI::App& parent, const std::string& name, const std::string& what,
                         const std::string& examples) {
  Command& command = add_command(parent, name, what, examples);
  command.group("");
  return command;
}

std::shared_ptr<CLI::FormatterBase> help_formatter() {
  class Formatter : public CLI::Formatter {
    [[nodiscard]] std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
      std::string names = CLI::Formatter::make_option_name(option, is_positional) + ',';
      for (const std::string old : {"--out", "--print-script", "--window"}) {
        if (const auto at = names.find(',' + old + ','); at != std::string::npos) names.erase(at, old.size() + 1);
      }
      names.pop_back();
      return names;
    }
    /// What goes without what, a message says to whom it concerns.
    [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override {
      return option->get_expected_max() == 0 ? "" : CLI::Formatter::make_option_opts(option);
    }
  };
  return std::make_shared<Formatter>();
}

void require_inputs(const CLI::App& command, const Inputs& inputs, Needs needs) {
  if (!inputs.scene.empty() && (needs == Needs::scene || !inputs.script.empty())) return;
  const std::string spoken = spoken_name(command);
  throw Error(ErrorCode::usage, std::string(inputs.scene.empty() ? "--scene" : "--script") +
                                    " FILE is missing; see pirsim " + (spoken.empty() ? "" : spoken + ' ') + "--help");
}

void on_call(CLI::App& command, std::shared_ptr<const Inputs> inputs, std::function<void(const Inputs&)> work,
             Needs needs) {
  command.callback([&command, inputs = std::move(inputs), work = std::move(work), needs] {
    if (!command.get_subcommands().empty()) return;
    require_inputs(command, *inputs, needs);
    work(*inputs);
  });
}

void pass_options_on(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands(nullptr)) {
    command->preparse_callback([command](std::size_t) { take_from_parent(*command); });
    pass_options_on(*command);
  }
}

std::string explain(const CLI::App* app, const CLI::Error& error) {
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    if (const CLI::Option* option = repeated_option(*app)) return "error: " + name_of(*option) + " is given twice\n";
  }
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    if (std::string text = explain_conversion(*app, error.what()); !text.empty()) return text;
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    if (const std::vector<std::string> rest = app->remaining(true); !rest.empty())
      return explain_word(*app, rest.front());
  }
  return "error: " + CLI::FailureMessage::simple(app, error);
}

std::string spoken_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  if (parent == nullptr) return {};
  const std::string before = spoken_name(*parent);
  return before.empty() ? command.get_name() : before + ' ' + command.get_name();
}

CLI::Validator one_of_words(std::map<std::string, int> values) {
  return {[values = std::move(values)](std::string& text) -> std::string {
            if (const auto known = values.find(text); known != values.end()) {
              text = std::to_string(known->second);
              return {};
            }
            std::vector<std::string> words;
            for (const auto& [word, value] : values) words.push_back(word);
            return "expected one of " + joined(words, ", ") + ", not '" + text + "'" + did_you_mean(text, words);
          },
          "", "one of"};
}

namespace {

namespace fs = std::filesystem;

/// Where it is or will be: without links, also without one to what isn't there yet.
fs::path whole(const fs::path& file) {
  std::error_code fault, none;
  fs::path path = fs::weakly_canonical(fs::absolute(file, fault), fault);
  constexpr int most_links = 40;  // as the system follows
  for (int n = 0; n < most_links && fs::is_symlink(fs::symlink_status(path, none)); ++n)
    path = fs::weakly_canonical(path.parent_path() / fs::read_symlink(path, none), fault);
  return fault ? file.lexically_normal() : path;
}

/// Do they name one file? Links, hard ones too, are names of it.
bool is_one_file(const fs::path& one, const fs::path& other) {
  struct stat a {
  }, b{};
  const bool is_there = ::stat(one.c_str(), &a) == 0;
  if (is_there != (::stat(other.c_str(), &b) == 0)) return false;
  return is_there ? a.st_dev == b.st_dev && a.st_ino == b.st_ino : whole(one) == whole(other);
}

bool fits(const std::string& pattern, const std::string& name) {
  return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

/// Is or will this be one of the folder's files? By its place, or since a link there, or another name, is it.
bool holds(const NamedFile& folder, const fs::path& file) {
  const std::string place = whole(file).lexically_relative(whole(folder.file)).string();
  return std::ranges::any_of(folder.contents, [&](const std::string& pattern) {
    if (fits(pattern, place) || fits(pattern + "/*", place)) return true;
    const fs::path names = fs::path(pattern).parent_path();
    std::error_code fault;
    for (fs::directory_iterator entry(folder.file / names, fault), end; !fault && entry != end;
         entry.increment(fault)) {
      if (fits(pattern, (names / entry->path().filename()).string()) && is_one_file(entry->path(), file)) return true;
    }
    return false;
  });
}

/// Is it the file, or one of the folder's?
bool takes(const NamedFile& one, const fs::path& file) {
  return one.contents.empty() ? is_one_file(one.file, file) : holds(one, file);
}

bool collide(const NamedFile& one, const NamedFile& other) {
  if (one.contents.empty()) return takes(other, one.file);
  if (other.contents.empty()) return takes(one, other.file);
  return whole(one.file) == whole(other.file) && std::ranges::any_of(one.contents, [&](const std::string& pattern) {
           return std::ranges::find(other.contents, pattern) != other.contents.end();
         });
}

std::string in_quotes(const fs::path& file) { return "'" + file.string() + "'"; }

void check_ending(const NamedFile& output) {
  const std::string name = output.file.filename().string();
  const auto is_end = [&](const std::string& ending) { return name.size() > ending.size() && name.ends_with(ending); };
  if (output.endings.empty() || std::ranges::any_of(output.endings, is_end)) return;
  if (io::is_written_directly(output.file)) return;
  throw Error(ErrorCode::usage,
              output.option + ": '" + output.file.string() + "' must end in " + in_words(output.endings));
}

/// Before hours of work: a file needs its folder, and a folder is made, unless a file is in the way.
void check_place(const NamedFile& output) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::io, Where{output.file.string()}, "can't write: " + why);
  };
  std::error_code unknown;
  const bool is_folder = !output.contents.empty();
  if (!is_folder && fs::is_directory(output.file, unknown)) refuse("it is a folder, and " + output.option + " a file");
  fs::path folder = is_folder ? output.file : output.file.parent_path();
  while (is_folder && folder.has_relative_path() && fs::status(folder, unknown).type() == fs::file_type::not_found)
    folder = folder.parent_path();
  const fs::file_status status = fs::status(folder, unknown);
  if (folder.empty() || fs::is_directory(status) || status.type() == fs::file_type::none) return;
  refuse(fs::exists(status) ? in_quotes(folder) + " isn't a folder" : "there is no folder " + in_quotes(folder));
}

[[noreturn]] void refuse(const NamedFile& one, const NamedFile& output, const char* why) {
  if (one.contents.empty() == output.contents.empty()) {
    throw Error(ErrorCode::usage, one.option + " and " + output.option +
                                      (one.contents.empty() ? " are one file: " : " are one folder: ") +
                                      in_quotes(one.file) + why);
  }
  const auto& [file, folder] = one.contents.empty() ? std::tie(one, output) : std::tie(output, one);
  throw Error(ErrorCode::usage, file.option + ": " + in_quotes(file.file) + " is one of the files of " + folder.option +
                                    " in " + in_quotes(folder.file) + why);
}

constexpr const char* lost = "; it would be overwritten";

std::vector<NamedFile> asked_for(const std::vector<Files::List>& lists) {
  std::vector<NamedFile> all;
  for (const Files::List& list : lists) {
    for (NamedFile& file : list()) {
      if (!file.file.empty()) all.push_back(std::move(file));
    }
  }
  return all;
}

}  // namespace

void Files::check() const {
  const std::vector<NamedFile> inputs = asked_for(inputs_), outputs = asked_for(outputs_);
  std::vector<NamedFile> before;
  std::error_code unknown;
  for (const NamedFile& output : outputs) {
    check_ending(output);
    const bool is_in_another = std::ranges::any_of(outputs, [&](const NamedFile& folder) {
      return &folder != &output && !folder.contents.empty() && is_below(output.file, folder.file);
    });
    if (!is_in_another) check_place(output);  // else its place may not be made yet
    for (const NamedFile& input : inputs) {
      // What isn't there, as a shipped file isn't here, can't be lost.
      const bool may_be_lost = !input.contents.empty() || fs::is_regular_file(input.file, unknown);
      if (may_be_lost && collide(input, output)) refuse(input, output, lost);
    }
    if (output.file == "/dev/null") continue;
    for (const NamedFile& other : before) {
      if (collide(other, output)) refuse(other, output, "");
    }
    before.push_back(output);
  }
}

void Files::keep(const std::vector<fs::path>& read) const {
  std::error_code unknown;
  for (const NamedFile& output : asked_for(outputs_)) {
    for (const fs::path& file : read) {
      if (!fs::is_regular_file(file, unknown) || !takes(output, file)) continue;
      throw Error(ErrorCode::usage, output.option + ": '" + file.string() + "' is read as an input" + lost);
    }
  }
}

std::string in_words(const std::vector<std::string>& endings) {
  std::string text;
  for (std::size_t i = 0; i < endings.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == endings.size() ? " or " : ", ") + endings[i];
  }
  return text;
}

bool is_below(const fs::path& file, const fs::path& folder) {
  const fs::path inner = whole(file), outer = (whole(folder / "any")).parent_path();
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

namespace {

constexpr RunClock any_clock{};

/// As long as the run has a clock where it is a time of day.
std::optional<double> seconds_of(const std::string& text, const std::optional<RunClock>& clock) {
  if (const auto seconds = io::parse_number<double>(text); seconds && *seconds >= 0.0) return seconds;
  return clock ? clock->run_seconds(text) : elapsed_seconds(text);
}

std::string expected(const std::string& text) {
  return "expected seconds or H:MM:SS since the run began, or a time of day as its rows have it (19:00), not '" + text +
         "'";
}

}  // namespace

void offer_moment(CLI::App& command, const std::string& name, std::string& text, const std::string& what,
                  const std::string& otherwise) {
  const auto check = [](std::string& given) {
    return seconds_of(given, std::nullopt) || seconds_of(given, any_clock) ? std::string() : expected(given);
  };
  command
      .add_option(name, text,
                  what + ": seconds or H:MM:SS since the run began, or a time of day as its rows have it (default: " +
                      otherwise + ")")
      ->option_text("TIME")
      ->check(CLI::Validator(check, "", "moment"));
}

double moment(const std::string& option, const std::string& text, const std::optional<RunClock>& clock) {
  if (const auto seconds = seconds_of(text, clock)) return *seconds;
  if (clock || !seconds_of(text, any_clock)) throw Error(ErrorCode::usage, option + ": " + expected(text));
  throw Error(ErrorCode::usage, option + ": '" + text +
                                    "' is a time of day, and this study has no clock: add `begin: 2026-03-02T00:00` " +
                                    "to its script, or give seconds or H:MM:SS since the run began");
}

}  // namespace pirsim::app
