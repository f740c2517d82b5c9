#include <algorithm>
#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "engine/effects/catalogue.hpp"
#include "files/disk/file.hpp"
#include "pirsim/io.hpp"
#include "pirsim/response.hpp"
#include "pirsim/version.hpp"
#include "reconcile/data/measured.hpp"
#include "reconcile/inference/verify.hpp"
#include "reconcile/report/pages.hpp"
#include "reconcile/report/sentences.hpp"
#include "reconcile/selftest/plan.hpp"
#include "reconcile/selftest/selftest.hpp"

namespace pirsim::app {
namespace {

/// What a reconciliation, its plan and its self-test share.
struct AnalysisOptions {
  std::filesystem::path table;     ///< folder of the reference table; empty: in the output folder
  std::filesystem::path nuisance;  ///< file, "none", or empty: the usual
  double alpha = 0.05;
  std::vector<std::string> effects;  ///< candidates; empty: the whole catalogue
  double budget = 1.0;               ///< times the usual number of simulated datasets
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

struct ReconcileOptions {
  std::filesystem::path measured;
  std::filesystem::path output = "reconcile";  ///< folder
  std::filesystem::path map;                   ///< of a log; or empty
  std::string time_zone;                       ///< of a log; or empty
  std::string holdout;                         ///< share or names of trials to be judged on; empty: folds
  int max_effects = 3;
};

constexpr const char* folder_names = "-o,--output,--out";

struct PlanOptions {
  std::filesystem::path output = "reconcile_plan";  ///< folder
  reconcile::Measured::Kind kind = reconcile::Measured::Kind::series;
  int runs = 1;
};

struct SelftestOptions {
  std::filesystem::path output = "reconcile_selftest";  ///< folder
  reconcile::Measured::Kind kind = reconcile::Measured::Kind::series;
  int runs = 1;
  std::uint32_t nulls = 60, injected = 10, pairs = 0;
  reconcile::LeaveOut leave_out = reconcile::LeaveOut::none;
};

reconcile::Settings settings_of(const AnalysisOptions& options, const std::filesystem::path& output,
                                const ScriptSpec& script) {
  reconcile::Settings settings = reconcile::settings_of(script, options.alpha, options.budget, options.effects);
  settings.nuisance = nuisance_of(options.nuisance);
  settings.table_folder = options.table.empty() ? output / "table" : options.table;
  return settings;
}

/// That nothing can be written is told before minutes of work, not after them.
void require_writable(const std::filesystem::path& folder) {
  std::error_code told_below;
  std::filesystem::create_directories(folder, told_below);
  const io::AtomicFile never_committed(folder / "report.json");
}

void tell_notes(const std::vector<std::string>& notes, Verbosity verbosity) {
  if (verbosity == Verbosity::quiet) return;
  for (const std::string& note : notes) std::cerr << note << '\n';
}

/// Tells stages and progress on standard error, and lets a signal stop the analysis at the end of any of them: the
/// table keeps what was simulated.
class AnalysisTeller {
 public:
  explicit AnalysisTeller(Verbosity verbosity) : verbosity_(verbosity) {}
  [[nodiscard]] reconcile::Observer observer() {
    reconcile::Observer observer;
    observer.stage = [this](const std::string& stage) {
      stop_.throw_if_made();
      progress_.reset();
      told_ = 0;
      stage_ = stage;
      if (verbosity_ != Verbosity::quiet) std::cerr << stage_ << " ...\n";
      progress_.emplace(Work{.what = stage_}, verbosity_);
    };
    observer.progress = [this](std::uint32_t done, std::uint32_t total) {
      stop_.throw_if_made();
      if (done == 0) progress_.emplace(Work{stage_, total, "realizations"}, verbosity_);
      if (done == told_ + 1) {
        progress_->finished();
      } else if (done > told_) {
        progress_->found(done - told_);
      }
      told_ = done;
    };
    return observer;
  }
  void finish() { progress_.reset(); }

 private:
  Verbosity verbosity_;
  StopRequest stop_;
  std::string stage_;
  std::optional<Progress> progress_;
  std::uint32_t told_ = 0;
};

reconcile::Context context_of(const AnalysisOptions& options, AnalysisTeller& teller) {
  return {options.seed, options.threads, teller.observer()};
}

void reconcile_selftest(const Inputs& inputs, const AnalysisOptions& analysis, const SelftestOptions& options) {
  const ScriptSpec script = read_script(inputs);
  const SceneSpec scene = read_scene(inputs);
  reconcile::SelftestSettings settings{settings_of(analysis, options.output, script),
                                       options.kind,
                                       options.runs,
                                       options.nulls,
                                       options.injected,
                                       options.pairs,
                                       options.leave_out};
  require_writable(options.output);
  settings.injected_folder = settings.analysis.table_folder / "injected";
  AnalysisTeller teller(inputs.verbosity);
  const reconcile::SelftestResult result = reconcile::selftest(scene, script, settings, context_of(analysis, teller));
  teller.finish();
  std::cout << reconcile::to_markdown(result);
  require_written();
  reconcile::write_selftest(options.output, result, made_by(inputs));
  tell_written({{options.output}}, inputs.verbosity);
}

void reconcile_plan(const Inputs& inputs, const AnalysisOptions& analysis, const PlanOptions& options) {
  const ScriptSpec script = read_script(inputs);
  const SceneSpec scene = read_scene(inputs);
  reconcile::PlanSettings settings{settings_of(analysis, options.output, script), options.kind, options.runs};
  require_writable(options.output);
  AnalysisTeller teller(inputs.verbosity);
  const reconcile::PlanResult result = reconcile::plan(scene, script, settings, context_of(analysis, teller));
  teller.finish();
  std::cout << reconcile::sentence(result) << '\n';
  require_written();
  reconcile::write_plan(options.output, result, made_by(inputs));
  tell_written({{options.output}}, inputs.verbosity);
}

LogMap map_of(const ReconcileOptions& options) {
  LogMap map = options.map.empty() ? LogMap{} : io::read_log_map(options.map);
  if (!options.time_zone.empty()) map.time_zone = options.time_zone;
  return map;
}

void reconcile_data(const Inputs& inputs, const AnalysisOptions& analysis, const ReconcileOptions& options) {
  if (options.measured.empty())
    throw Error(ErrorCode::usage, "--measured FILE is missing; see pirsim reconcile --help");
  if (options.measured == inputs.scene || options.measured == inputs.marks || options.measured == inputs.script)
    throw Error(ErrorCode::usage, "--measured can't be the same file or stream as --scene, --marks or --script");
  const ScriptSpec given = read_script(inputs);
  const SceneSpec scene = read_scene(inputs);
  tell(scene.warnings, inputs.verbosity);
  tell(given.warnings, inputs.verbosity);
  tell(idle_sensor_keys(scene, given.sensing), inputs.verbosity);
  const reconcile::Measured measured = reconcile::read_measured(options.measured, scene, given, map_of(options));
  const ScriptSpec script = reconcile::with_holds(scene, given, measured);
  const reconcile::StudyFrame frame = reconcile::frame_of(scene, script);
  tell_notes(measured.notes, inputs.verbosity);
  require_writable(options.output);
  reconcile::Settings settings = settings_of(analysis, options.output, given);
  settings.max_effects = options.max_effects;
  settings.holdout = reconcile::holdout_of(options.holdout, frame, measured);

  AnalysisTeller teller(inputs.verbosity);
  const reconcile::Context context = context_of(analysis, teller);
  const reconcile::Outcome outcome = reconcile::reconcile(scene, script, measured, settings, context);
  teller.finish();
  tell_notes(outcome.notes, inputs.verbosity);
  std::cout << reconcile::sentence(outcome) << '\n';
  for (const std::string& detail : reconcile::details(outcome)) std::cout << detail << '\n';
  require_written();
  reconcile::write_report(options.output, outcome, measured, script, settings, context,
                          {"pirsim " + version() + " " + git_revision(), io::name_of_input(inputs.scene),
                           io::name_of_input(inputs.script), io::name_of_input(options.measured), model_options(inputs),
                           inputs.marks.empty() ? "" : io::name_of_input(inputs.marks)});
  tell_written({{options.output}}, inputs.verbosity);
}

void offer_analysis(CLI::App& command, AnalysisOptions& options) {
  offer_output_folder(command, "--table", options.table, "folder that keeps the reference table (default: DIR/table)",
                      {"table.journal", "realizations_*", "injected"});
  offer_input_file(command, "--nuisance", options.nuisance, "what is uncertain about the room, YAML; or none");
  command.add_option("--alpha", options.alpha, "level of the tests (default: 0.05)")
      ->option_text("P")
      ->check(CLI::Range(0.001, 0.5));
  command.add_option("--effects", options.effects, "candidates: a,b (default: the whole catalogue)")
      ->option_text("NAMES")
      ->delimiter(',');
  command.add_option("--budget", options.budget, "times the usual number of simulated datasets (default: 1)")
      ->option_text("X")
      ->check(CLI::Range(0.05, 20.0));
  command.add_option("--analysis-seed", options.seed, "of everything random in the analysis (default: 1)")
      ->option_text("N")
      ->check(is_seed());
  offer_threads(command, options.threads);
}

void offer_kind(CLI::App& command, reconcile::Measured::Kind& kind, const std::string& what) {
  using Kind = reconcile::Measured::Kind;
  command.add_option("--data", kind, what + ": series or sums (default: series)")
      ->option_text("KIND")
      ->transform(one_of<Kind>({{"series", Kind::series}, {"sums", Kind::sums}}));
}

void add_selftest_command(CLI::App& reconcile_command) {
  CLI::App& command =
      add_command(reconcile_command, "selftest", "hide effects in simulated data and see which are found", R"(
  pirsim reconcile selftest --scene room.gltf --script study.yaml --budget 0.2
  pirsim reconcile selftest --scene room.gltf --script study.yaml --effects dead_time,sensor_yaw --injected 40
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto analysis = std::make_shared<AnalysisOptions>();
  const auto options = std::make_shared<SelftestOptions>();
  offer_study(command, *inputs);
  using reconcile::LeaveOut;
  offer_output_folder(command, folder_names, options->output,
                      "folder for rates and pictures (default: reconcile_selftest)",
                      {"selftest.csv", "selftest.md", "selftest.html", "table"});
  offer_kind(command, options->kind, "what faults are injected into");
  command.add_option("--runs", options->runs, "runs of every trial (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 100));
  command.add_option("--nulls", options->nulls, "datasets with nothing hidden (default: 60)")->option_text("N");
  command.add_option("--injected", options->injected, "datasets of every effect and strength (default: 10)")
      ->option_text("N");
  command.add_option("--pairs", options->pairs, "datasets with two effects (default: 0)")->option_text("N");
  command
      .add_option("--leave-out", options->leave_out,
                  "effects: judge by catalogues that lack the effect, too (default: none)")
      ->option_text("HOW")
      ->transform(one_of<LeaveOut>({{"none", LeaveOut::none}, {"effects", LeaveOut::effects}}));
  offer_analysis(command, *analysis);
  on_call(command, inputs,
          [analysis, options](const Inputs& given) { reconcile_selftest(given, *analysis, *options); });
}

void add_plan_command(CLI::App& reconcile_command) {
  CLI::App& command =
      add_command(reconcile_command, "plan", "before measuring: what could be told apart, and what to measure next", R"(
  pirsim reconcile plan --scene room.gltf --script study.yaml -o plan
  pirsim reconcile plan --scene room.gltf --script study.yaml --data sums --runs 3
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto analysis = std::make_shared<AnalysisOptions>();
  const auto options = std::make_shared<PlanOptions>();
  offer_study(command, *inputs);
  offer_output_folder(command, folder_names, options->output, "folder for page and tables (default: reconcile_plan)",
                      {"plan.csv", "plan.html", "plan.json", "table"});
  offer_kind(command, options->kind, "what is to be measured");
  command.add_option("--runs", options->runs, "planned runs of every trial (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 100));
  offer_analysis(command, *analysis);
  on_call(command, inputs, [analysis, options](const Inputs& given) { reconcile_plan(given, *analysis, *options); });
}

}  // namespace

void add_reconcile_command(CLI::App& app) {
  CLI::App& command =
      add_command(app, "reconcile", "where model and measurement disagree, and which effect is missing", R"(
  pirsim reconcile --scene room.gltf --script study.yaml --measured rows.csv -o found
  pirsim reconcile --scene room.gltf --script study.yaml --measured rows.csv --holdout S3,S8
)");
  command.require_subcommand(0, 1);
  const auto inputs = std::make_shared<Inputs>();
  const auto analysis = std::make_shared<AnalysisOptions>();
  const auto options = std::make_shared<ReconcileOptions>();
  offer_study(command, *inputs);
  offer_input_file(command, "--measured", options->measured, "rows, sums or a log from the real room");
  offer_input_file(command, "--map", options->map, "what a log's columns mean (pirsim log --print-map)");
  command.add_option("--time-zone", options->time_zone, "where a log's room is, as Europe/Berlin")->option_text("ZONE");
  offer_output_folder(command, folder_names, options->output,
                      "folder for report and patched script (default: reconcile)",
                      {reconcile::report_files.begin(), reconcile::report_files.end()});
  command
      .add_option("--holdout", options->holdout,
                  "share (0.3) or names (S3,S8) of trials kept from naming and fitting, to be judged on "
                  "(default: every trial once, in folds)")
      ->option_text("TRIALS");
  command.add_option("--max-effects", options->max_effects, "most effects to apply (default: 3)")
      ->option_text("N")
      ->check(CLI::Range(1, 5));
  offer_analysis(command, *analysis);
  on_call(command, inputs, [analysis, options](const Inputs& given) { reconcile_data(given, *analysis, *options); });
  for (const auto add : {add_selftest_command, add_plan_command}) add(command);
}

}  // namespace pirsim::app
