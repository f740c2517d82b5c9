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

reconcile::Settings settings_of(const AnalysisOptions& options, const std::filesystem::path& output,
                                const ScriptSpec& script) {
  reconcile::Settings settings = reconcile::settings_of(script, options.alpha, options.budget, options.effects);
  settings.nuisance = reconcile::nuisance_of(options.nuisance);
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

/// Of a plan or a self-test.
struct ExperimentWords {
  std::filesystem::path output;
  std::string folder, data, runs;     ///< what they are
  std::vector<std::string> contents;  ///< of the folder
};

/// What a plan and a self-test share. run(scene, script, settings, context) gives the result, tell(result) what goes to
/// standard output, write(folder, result, made_by) the files.
template <typename Settings, typename OfferMore, typename Run, typename Tell, typename Write>
void make_experiment(CLI::App& command, const ExperimentWords& words, const OfferMore& offer_more, const Run& run,
                     const Tell& tell, const Write& write) {
  using Kind = reconcile::Measured::Kind;
  const auto inputs = std::make_shared<Inputs>();
  const auto analysis = std::make_shared<AnalysisOptions>();
  const auto output = std::make_shared<std::filesystem::path>(words.output);
  const auto asked = std::make_shared<Settings>();
  offer_study(command, *inputs);
  offer_output_folder(command, folder_names, *output, words.folder + " (default: " + words.output.string() + ")",
                      words.contents);
  command.add_option("--data", asked->kind, words.data + ": series or sums (default: series)")
      ->option_text("KIND")
      ->transform(one_of<Kind>({{"series", Kind::series}, {"sums", Kind::sums}}));
  command.add_option("--runs", asked->n_replicates, words.runs + " of every trial (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 100));
  offer_more(*asked);
  offer_analysis(command, *analysis);
  on_call(command, inputs, [=](const Inputs& given) {
    const ScriptSpec script = read_script(given);
    const SceneSpec scene = read_scene(given);
    Settings settings = *asked;
    settings.analysis = settings_of(*analysis, *output, script);
    require_writable(*output);
    AnalysisTeller teller(given.verbosity);
    const auto result = run(scene, script, settings, context_of(*analysis, teller));
    teller.finish();
    std::cout << tell(result);
    require_written();
    write(*output, result, made_by(given));
    tell_written({{*output}}, given.verbosity);
  });
}

void add_selftest_command(CLI::App& reconcile_command) {
  CLI::App& command =
      add_command(reconcile_command, "selftest", "hide effects in simulated data and see which are found", R"(
  pirsim reconcile selftest --scene room.gltf --script study.yaml --budget 0.2
  pirsim reconcile selftest --scene room.gltf --script study.yaml --effects dead_time,sensor_yaw --injected 40
)");
  using reconcile::LeaveOut, reconcile::SelftestSettings;
  const auto offer_more = [&](SelftestSettings& settings) {
    command.add_option("--nulls", settings.n_nulls, "datasets with nothing hidden (default: 60)")->option_text("N");
    command.add_option("--injected", settings.n_injected, "datasets of every effect and strength (default: 10)")
        ->option_text("N");
    command.add_option("--pairs", settings.n_pairs, "datasets with two effects (default: 0)")->option_text("N");
    command
        .add_option("--leave-out", settings.leave_out,
                    "effects: judge by catalogues that lack the effect, too (default: none)")
        ->option_text("HOW")
        ->transform(one_of<LeaveOut>({{"none", LeaveOut::none}, {"effects", LeaveOut::effects}}));
  };
  const auto run = [](const SceneSpec& scene, const ScriptSpec& script, SelftestSettings& settings,
                      const reconcile::Context& context) {
    settings.injected_folder = settings.analysis.table_folder / "injected";
    return reconcile::selftest(scene, script, settings, context);
  };
  make_experiment<SelftestSettings>(command,
                                    {"reconcile_selftest",
                                     "folder for rates and pictures",
                                     "what faults are injected into",
                                     "runs",
                                     {"selftest.csv", "selftest.md", "selftest.html", "table"}},
                                    offer_more, run, reconcile::to_markdown, reconcile::write_selftest);
}

void add_plan_command(CLI::App& reconcile_command) {
  CLI::App& command =
      add_command(reconcile_command, "plan", "before measuring: what could be told apart, and what to measure next", R"(
  pirsim reconcile plan --scene room.gltf --script study.yaml -o plan
  pirsim reconcile plan --scene room.gltf --script study.yaml --data sums --runs 3
)");
  make_experiment<reconcile::PlanSettings>(
      command,
      {"reconcile_plan",
       "folder for page and tables",
       "what is to be measured",
       "planned runs",
       {"plan.csv", "plan.html", "plan.json", "table"}},
      [](const auto&) {}, reconcile::plan,
      [](const reconcile::PlanResult& result) { return reconcile::sentence(result) + '\n'; }, reconcile::write_plan);
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
