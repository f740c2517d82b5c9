#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "app/study_run.hpp"
#include "engine/effects/catalogue.hpp"
#include "files/write/campaign.hpp"
#include "model/core/text.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "surveys/check_study.hpp"

namespace pirsim::app {
namespace {

using studies::OrdinaryDays;

enum class Action { run, print_config };

void print(const std::string& script) {
  std::cout << script;
  require_written();
}

void run_script(const Inputs& inputs, const RunOptions& options, Action action) {
  if (action == Action::run) {
    check_options(options);
    return run(load(inputs), inputs, options);
  }
  const ScriptSpec script = read_script(inputs);
  Diagnostics diagnostics;
  effects::check(script.effects, diagnostics);
  diagnostics.throw_if_errors();
  print(io::to_yaml(script));
}

/// What is pasted into a script must be no more than a date or a time, or a word that stands for none.
void require_plain(const std::string& option, const std::string& text) {
  if (text.find_first_not_of("0123456789:-") != std::string::npos)
    throw Error(ErrorCode::usage, option + ": '" + text + "' is not made of digits, ':' and '-' alone");
}

constexpr const char* no_file = "";  // nobody could look up a line of it

/// The faults of a script that nobody wrote, told of the options that it was made from.
void check_made_script(const std::string& text, const std::string& first_day) {
  try {
    static_cast<void>(io::parse_script(text, no_file));
  } catch (const Error& fault) {
    const std::string& message = fault.issues().front().message;
    for (const auto& [key, option] : {std::pair("first_day: ", "--first-day: "), std::pair("from: ", "--from: "),
                                      std::pair("to: ", "--to: "), std::pair("cleaning: ", "--cleaning: ")}) {
      if (message.starts_with(key)) throw Error(ErrorCode::usage, option + message.substr(std::string(key).size()));
    }
    throw Error(ErrorCode::usage, (message.starts_with("'" + first_day + "'") ? "--first-day: " : "") + message);
  }
}

void check_days(const OrdinaryDays& days) {
  if (!days.is_office() && !days.is_home())
    throw Error(ErrorCode::usage, "say who comes: --staff N, --meetings or both; or --home N, who lives there");
  const bool has_office_times = !days.from.empty() || !days.to.empty() || !days.cleaning.empty();
  if (days.is_home() && (days.is_office() || has_office_times))
    throw Error(ErrorCode::usage, "--home goes without --staff, --meetings, --from, --to and --cleaning");
  require_plain("--first-day", days.first_day);
  require_plain("--from", days.from);
  require_plain("--to", days.to);
  if (days.cleaning != "none") require_plain("--cleaning", days.cleaning);
}

void run_days(const Inputs& inputs, const RunOptions& options, const OrdinaryDays& days, Action action) {
  check_days(days);
  const std::string text = studies::script_text(days);
  check_made_script(text, days.first_day);
  ScriptSpec script = io::parse_script(text, no_file, inputs.overrides, data_directories());
  keep_inputs(inputs, files_read(script, {}));
  if (action == Action::print_config) return print(inputs.overrides.empty() ? text : io::to_yaml(script));
  check_options(options);
  run(load(inputs, std::move(script)), inputs, options);
}

/// Of a script that is made, where none is given.
std::vector<CLI::Option*> offer_days(CLI::App& command, const std::shared_ptr<OrdinaryDays>& days) {
  std::vector<CLI::Option*> options{
      command.add_option("--staff", days->staff, "how many people have a desk in the room")
          ->option_text("N")
          ->check(CLI::Range(0, 200)),
      command.add_flag_callback(
          "--meetings", [days] { days->meetings = OrdinaryDays::Meetings::held; },
          "people from elsewhere meet in the room, on the seats that are nobody's desk"),
      command.add_option("--home", days->residents, "how many people live there; every other one goes to work")
          ->option_text("N")
          ->check(CLI::Range(1, 5)),
      command.add_option("--days", days->days, "how many days follow each other (default: 5)")
          ->option_text("N")
          ->check(CLI::Range(1, 10000000))
          ->excludes(command.get_option("--replicates")),
      command.add_option("--first-day", days->first_day, "default: 2026-03-02, a Monday")->option_text("DATE"),
      command.add_option("--from", days->from, "time of day at which each run begins (default: 00:00)")
          ->option_text("TIME"),
      command.add_option("--to", days->to, "time of day at which each run ends (default: 24:00)")->option_text("TIME"),
      command.add_option("--cleaning", days->cleaning, "about when somebody cleans, or none (default: 19:00)")
          ->option_text("TIME")};
  for (CLI::Option* option : options)
    option->group("Ordinary days, instead of --script")->excludes(command.get_option("--script"));
  return options;
}

void offer_run(CLI::App& command) {
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<RunOptions>();
  const auto days = std::make_shared<OrdinaryDays>();
  const auto action = std::make_shared<Action>(Action::run);
  offer_study(command, *inputs);
  offer_verbose(command, inputs->verbosity);
  offer_tracer(command, *inputs);
  offer_seed(command, *inputs);
  offer_replicates(command, *inputs);
  const std::vector<CLI::Option*> of_days = offer_days(command, days);
  offer_run_options(command, options);
  command.add_flag_callback(
      "--print-config,--print-script", [action] { *action = Action::print_config; },
      "print the script that is run and stop");
  on_call(
      command, inputs,
      [&command, options, days, of_days, action](const Inputs& given) {
        if (std::ranges::any_of(of_days, [](const CLI::Option* option) { return option->count() > 0; }))
          return run_days(given, *options, *days, *action);
        require_inputs(command, given, Needs::scene_and_script);
        run_script(given, *options, *action);
      },
      Needs::scene);
}

constexpr const char* run_examples = R"(
  pirsim run --scene room.gltf --script study.yaml                 rows of the whole study as CSV on stdout
  pirsim run --scene room.gltf --script study.yaml -o rows.csv --summary table.md
  pirsim run --scene room.gltf --script study.yaml --replicates 20 --set people.0.stature_m=1.7
  pirsim run --scene room.gltf --script study.yaml --shard 3/100 -o out   a block of the runs; then pirsim merge
  pirsim run --scene office.gltf --staff 8 -o week.csv --report week.html     a working week of an office
  pirsim run --scene meeting_room.gltf --meetings --days 1 -o day.csv         a day of meetings
  pirsim run --scene flat.gltf --home 2 --days 7 -o week.csv                  a week of two people at home
  pirsim run --scene office.gltf --staff 8 --print-config > week.yaml         to be edited; then --script week.yaml
)";

}  // namespace

void add_run_command(CLI::App& app) {
  offer_run(app);  // the default
  offer_run(add_command(app, "run", "run a study, or ordinary days of a room (the default)", run_examples));
  offer_run(add_old_command(app, "day", "the same as run", run_examples));
}

namespace {

struct MergeOptions {
  enum class Action { merge, status } action = Action::merge;
  std::filesystem::path folder;  ///< with shards
  std::filesystem::path output;
  std::filesystem::path summary;
  std::filesystem::path script;        ///< for the summary
  std::vector<std::string> overrides;  ///< of the script
  Verbosity verbosity = Verbosity::normal;
  const Files* files = nullptr;  ///< of the command
};

/// The script of the shards, read again for what a summary wants to know of it.
ScriptSpec script_of(const MergeOptions& options) {
  if (options.script.empty()) throw Error(ErrorCode::usage, "--summary needs --script FILE, that of the shards");
  const io::Provenance made = studies::campaign_provenance(options.folder);
  ScriptSpec script =
      io::read_script(found(io::DataKind::studies, options.script), options.overrides, data_directories());
  script.seed = made.seed;
  script.replicates = static_cast<int>(made.study_runs / script.trials.size());
  if (io::to_yaml(script) != made.resolved_script) {
    throw Error(ErrorCode::input, Where{options.script.string()}, "isn't the script of these shards");
  }
  return script;
}

std::vector<std::string> trial_ids(const ScriptSpec& script) {
  std::vector<std::string> ids;
  for (const TrialSpec& trial : script.trials) ids.push_back(trial.id);
  return ids;
}

void tell_status(const MergeOptions& options) {
  const std::vector<studies::ShardReport> shards = [&] {
    const Progress progress({.what = "reading the shards of " + options.folder.string()}, options.verbosity);
    return studies::campaign_status(options.folder);
  }();
  if (options.verbosity != Verbosity::quiet) std::cerr << studies::to_text(shards);
  if (const std::string rest = studies::array_specification(shards); !rest.empty()) std::cout << rest << '\n';
  require_written();
}

void merge(const MergeOptions& options) {
  if (options.action == MergeOptions::Action::status) return tell_status(options);
  if (options.output.empty()) throw Error(ErrorCode::usage, "-o FILE is missing");
  ScriptSpec script;
  std::optional<io::AtomicFile> file;
  std::optional<studies::RowTally> tally;
  if (!options.summary.empty()) {
    script = script_of(options);
    options.files->keep(files_read(script, {}));
    file.emplace(options.summary);
    tally.emplace(trial_ids(script), script.summary, measured_cells(script));
  }
  const StopRequest stop;
  const studies::Sink sink = [&](std::string_view bytes) {
    stop.throw_if_made();
    if (tally) tally->add(bytes);
  };
  std::optional<Progress> progress;
  progress.emplace(Work{.what = "joining the shards of " + options.folder.string()}, options.verbosity);
  const io::Manifest merged = studies::merge_campaign(options.folder, options.output, sink);
  progress.reset();
  if (tally) {
    write_summary(tally->finish(), *file, options.summary, script.name, merged.notes.remarks(), options.verbosity);
  }
  if (options.verbosity != Verbosity::quiet) {
    std::cerr << "merged " << counted(merged.runs.count(), "run") << ", " << counted(merged.rows, "row") << '\n';
  }
  tell_written({{options.output}, {options.summary}}, options.verbosity);
  tell(merged.notes, options.verbosity);
}

/// Returns --status.
CLI::Option* offer_merge(Command& command) {
  const auto options = std::make_shared<MergeOptions>();
  CLI::Option* folder = command.add_option("DIR", options->folder, "folder with the shards")->required();
  command.files.add_inputs([options] {
    return std::vector<NamedFile>{{"the shards", options->folder, {}, {"shard-*"}}};
  });
  folder->group("Inputs");
  offer_quiet(command, options->verbosity);
  options->files = &command.files;
  CLI::Option* rows = offer_output(command, output_names, options->output, "rows, " + in_words(io::table_endings()),
                                   io::table_endings());
  declare_outputs(command, rows, [options] {
    if (options->output.empty()) return std::vector<NamedFile>{};
    return std::vector<NamedFile>{{"the manifest of -o", io::manifest_path(options->output)}};
  });
  CLI::Option* summary = offer_output(
      command, "--summary", options->summary,
      "table of sums per trial and sensor, " + in_words(summary_endings()) + "; needs --script", summary_endings());
  CLI::Option* script = offer_input_file(command, "--script", options->script, "the shards' script, for the summary");
  CLI::Option* set = command.add_option("--set", options->overrides, "as for the shards")
                         ->option_text("KEY=VALUE")
                         ->allow_extra_args(false);
  CLI::Option* status = command.add_flag_callback(
      "--status", [options] { options->action = MergeOptions::Action::status; },
      "only tell which shards are missing or broken, and what is left as Slurm's --array");
  for (CLI::Option* other : {rows, summary, script, set}) status->excludes(other);
  command.callback([options] { merge(*options); });
  return status;
}

constexpr const char* merge_examples = R"(
  pirsim merge out --status                                        what is there; what is left, as Slurm's --array
  pirsim merge out --status -q                                     only what is left
  pirsim merge out -o rows.csv.zst
  pirsim merge out -o rows.csv --script study.yaml --summary table.md
)";

}  // namespace

void add_merge_command(CLI::App& app) {
  static_cast<void>(offer_merge(
      add_command(app, "merge", "join shards into one file, identical to a single process's", merge_examples)));
  offer_merge(add_old_command(app, "status", "the same as merge --status", merge_examples))->add_result("true");
}

}  // namespace pirsim::app
