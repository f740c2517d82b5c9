#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/row_output.hpp"
#include "app/session.hpp"
#include "pirsim/core/version.hpp"
#include "pirsim/io/nuisance_reader.hpp"
#include "pirsim/io/script_reader.hpp"
#include "pirsim/reconcile/measured.hpp"
#include "pirsim/reconcile/outputs.hpp"
#include "pirsim/reconcile/reconcile.hpp"

namespace pirsim::app {
namespace {

reconcile::Settings settings_of(const ReconcileOptions& options) {
  reconcile::Settings settings;
  if (options.nuisance == "none") {
    settings.nuisance = {0.0, 0.0, 0.0, 0.0, 0.0};
  } else if (!options.nuisance.empty()) {
    settings.nuisance = io::read_nuisance(options.nuisance);
  }
  settings.alpha = options.alpha;
  settings.max_effects = options.max_effects;
  settings.seed = options.seed;
  settings.threads = options.threads;
  const auto scaled = [&](std::uint32_t n) {
    return std::max(60U, static_cast<std::uint32_t>(static_cast<double>(n) * options.budget));
  };
  settings.table.threads = options.threads;
  settings.table.n_worlds = scaled(settings.table.n_worlds);
  settings.table.n_remembered = scaled(settings.table.n_remembered);
  settings.table.n_traced = scaled(settings.table.n_traced);
  settings.table_folder = options.table.empty() ? options.output / "table" : options.table;
  return settings;
}

}  // namespace

void reconcile_data(const Inputs& inputs, const ReconcileOptions& options) {
  const ScriptSpec script = io::read_script(inputs.script, inputs.overrides);
  const SceneSpec scene = io::read_scene(inputs.scene, scene_options(inputs));
  tell(scene.warnings, inputs.verbosity);
  tell(script.warnings, inputs.verbosity);
  const reconcile::Measured measured = reconcile::read_measured(options.measured, reconcile::frame_of(scene, script));
  if (inputs.verbosity != Verbosity::quiet) {
    for (const std::string& note : measured.notes) std::cerr << note << '\n';
  }
  const reconcile::Settings settings = settings_of(options);

  std::optional<Progress> progress;
  std::uint32_t told = 0;
  reconcile::Observer observer;
  observer.stage = [&](const std::string& stage) {
    progress.reset();
    if (inputs.verbosity != Verbosity::quiet) std::cerr << stage << " ...\n";
  };
  observer.progress = [&](std::uint32_t done, std::uint32_t total) {
    if (!progress) progress.emplace(total, inputs.verbosity, "worlds");
    for (; told < done; ++told) progress->run_finished();
  };
  const reconcile::Outcome outcome = reconcile::reconcile(scene, script, measured, settings, observer);
  progress.reset();
  std::cout << outcome.sentence << '\n';
  require_written();
  reconcile::write_outputs(options.output, outcome, measured, script, settings,
                           {"pirsim " + version() + " " + git_revision(), inputs.scene.filename().string(),
                            inputs.script.filename().string(), options.measured.filename().string()});
}

}  // namespace pirsim::app
