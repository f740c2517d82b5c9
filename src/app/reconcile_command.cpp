#include <algorithm>
#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/gnuplot_runner.hpp"
#include "app/progress.hpp"
#include "app/row_output.hpp"
#include "app/session.hpp"
#include "io/atomic_file.hpp"
#include "io/gnuplot.hpp"
#include "effects/catalogue.hpp"
#include "pirsim/io.hpp"
#include "pirsim/version.hpp"
#include "reconcile/measured.hpp"
#include "reconcile/outputs.hpp"
#include "reconcile/plan.hpp"
#include "reconcile/reconcile.hpp"
#include "reconcile/selftest_page.hpp"

namespace pirsim::app {
namespace {

reconcile::Settings settings_of(const AnalysisOptions& options, const std::filesystem::path& output,
                                const ScriptSpec& script) {
  reconcile::Settings settings;
  settings.nuisance = nuisance_of(options.nuisance);
  settings.alpha = options.alpha;
  settings.seed = options.seed;
  settings.threads = options.threads;
  const auto scaled = [&](std::uint32_t n) {
    return std::max(reconcile::fewest_datasets_to_refuse(options.alpha),
                    static_cast<std::uint32_t>(static_cast<double>(n) * options.budget));
  };
  for (const std::string& effect : options.effects) {
    const std::string& name = effects::find(effect).info.name;
    if (std::ranges::find(settings.table.entries, name) != settings.table.entries.end())
      throw Error(ErrorCode::usage, "--effects: " + name + " twice");
    if (std::ranges::find(script.effects, name, &EffectSpec::name) != script.effects.end())
      throw Error(ErrorCode::usage, "--effects: the script has " + name + " already, it isn't looked for again");
    settings.table.entries.push_back(name);
  }
  settings.table.threads = options.threads;
  settings.table.n_worlds = scaled(settings.table.n_worlds);
  settings.table.n_remembered = scaled(settings.table.n_remembered);
  settings.table.n_traced = scaled(settings.table.n_traced);
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

/// Tells stages and progress on standard error.
class Teller {
 public:
  explicit Teller(Verbosity verbosity) : verbosity_(verbosity) {}
  [[nodiscard]] reconcile::Observer observer() {
    reconcile::Observer observer;
    observer.stage = [this](const std::string& stage) {
      progress_.reset();
      told_ = 0;
      if (verbosity_ != Verbosity::quiet) std::cerr << stage << " ...\n";
    };
    observer.progress = [this](std::uint32_t done, std::uint32_t total) {
      if (!progress_) progress_.emplace(total, verbosity_, "worlds");
      for (; told_ < done; ++told_) progress_->run_finished();
    };
    return observer;
  }
  void finish() { progress_.reset(); }

 private:
  Verbosity verbosity_;
  std::optional<Progress> progress_;
  std::uint32_t told_ = 0;
};

std::string made_by(const Inputs& inputs) {
  return "pirsim " + version() + " " + git_revision() + ", " + inputs.scene.filename().string() + ", " +
         inputs.script.filename().string();
}

void draw_selftest(const std::filesystem::path& folder, const reconcile::SelftestResult& result, Verbosity verbosity) {
  draw({io::gnuplot_program(reconcile::confusion_chart(result), folder / "confusion.png"),
        io::gnuplot_program(reconcile::power_grid(result), folder / "power.png"),
        io::gnuplot_program(reconcile::reliability_chart(result), folder / "reliability.png"),
        io::gnuplot_program(reconcile::coverage_chart(result), folder / "coverage.png")},
       verbosity);
}

}  // namespace

void reconcile_selftest(const Inputs& inputs, const AnalysisOptions& analysis, const SelftestOptions& options) {
  const ScriptSpec script = io::read_script(inputs.script, inputs.overrides);
  const SceneSpec scene = io::read_scene(inputs.scene, scene_options(inputs));
  reconcile::SelftestSettings settings{settings_of(analysis, options.output, script),
                                       options.kind,
                                       options.runs,
                                       options.nulls,
                                       options.planted,
                                       options.beyond,
                                       options.pairs,
                                       options.aliens,
                                       options.leave_out,
                                       options.verified};
  require_writable(options.output);
  settings.planted_folder = settings.analysis.table_folder / "planted";
  Teller teller(inputs.verbosity);
  const reconcile::SelftestResult result = reconcile::selftest(scene, script, settings, teller.observer());
  teller.finish();
  std::cout << reconcile::to_markdown(result);
  require_written();
  const reconcile::Geometry geometry =
      analysis.nuisance == "none" ? reconcile::Geometry::known : reconcile::Geometry::uncertain;
  reconcile::write_selftest(options.output, result, geometry, made_by(inputs));
  draw_selftest(options.output, result, inputs.verbosity);
}

void reconcile_plan(const Inputs& inputs, const AnalysisOptions& analysis, const PlanOptions& options) {
  const ScriptSpec script = io::read_script(inputs.script, inputs.overrides);
  const SceneSpec scene = io::read_scene(inputs.scene, scene_options(inputs));
  reconcile::PlanSettings settings{settings_of(analysis, options.output, script), options.kind, options.runs};
  require_writable(options.output);
  Teller teller(inputs.verbosity);
  const reconcile::PlanResult result = reconcile::plan(scene, script, settings, teller.observer());
  teller.finish();
  std::cout << result.sentence << '\n';
  require_written();
  reconcile::write_plan(options.output, result, made_by(inputs));
}

void reconcile_data(const Inputs& inputs, const AnalysisOptions& analysis, const ReconcileOptions& options) {
  if (options.measured.empty())
    throw Error(ErrorCode::usage, "--measured FILE is missing; see pirsim reconcile --help");
  const ScriptSpec script = io::read_script(inputs.script, inputs.overrides);
  const SceneSpec scene = io::read_scene(inputs.scene, scene_options(inputs));
  tell(scene.warnings, inputs.verbosity);
  tell(script.warnings, inputs.verbosity);
  const reconcile::StudyFrame frame = reconcile::frame_of(scene, script);
  const reconcile::Measured measured = reconcile::read_measured(options.measured, frame);
  tell_notes(measured.notes, inputs.verbosity);
  require_writable(options.output);
  reconcile::Settings settings = settings_of(analysis, options.output, script);
  settings.max_effects = options.max_effects;
  settings.holdout = reconcile::holdout_of(options.holdout, frame, measured);

  Teller teller(inputs.verbosity);
  const reconcile::Outcome outcome = reconcile::reconcile(scene, script, measured, settings, teller.observer());
  teller.finish();
  tell_notes(outcome.notes, inputs.verbosity);
  std::cout << outcome.sentence << '\n';
  require_written();
  reconcile::write_outputs(options.output, outcome, measured, script, settings,
                           {"pirsim " + version() + " " + git_revision(), inputs.scene.filename().string(),
                            inputs.script.filename().string(), options.measured.filename().string()});
}

}  // namespace pirsim::app
