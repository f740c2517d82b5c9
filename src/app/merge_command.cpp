#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "app/study_run.hpp"
#include "core/text.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "studies/campaign.hpp"

namespace pirsim::app {
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
  static_cast<void>(
      offer_merge(add_command(app, "merge", "join shards into one file, identical to a single process's", merge_examples)));
  offer_merge(add_old_command(app, "status", "the same as merge --status", merge_examples))->add_result("true");
}

}  // namespace pirsim::app
