#include <iostream>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "pirsim/error.hpp"
#include "pirsim/io.hpp"
#include "studies/placement.hpp"

namespace pirsim::app {
namespace {

/// Models that the study names and the scene doesn't.
void add_models(SceneSpec& scene, const PlacementSpec& spec, const Inputs& inputs) {
  for (const auto& [name, where] : spec.models) {
    if (scene.sensor_models.contains(name)) continue;
    try {
      scene.sensor_models[name] = io::find_sensor_model(name, inputs.scene, scene_options(inputs));
    } catch (const Error& fault) {
      const Issue& first = fault.issues().front();
      if (!first.where.file.empty()) throw;  // of the model's own file
      throw Error(fault.code(), where, first.message);
    }
  }
}

void placements(const Inputs& inputs, unsigned threads) {
  const PlacementSpec spec = io::read_placements(inputs.script, inputs.overrides);
  SceneSpec scene = io::read_scene(inputs.scene, scene_options(inputs));
  tell(scene.warnings, inputs.verbosity);
  add_models(scene, spec, inputs);
  std::vector<studies::PlacementScore> scores;
  for (const SensorSetSpec& set : spec.sets) scores.push_back(studies::score(scene, spec.coverage, set, threads));
  tell(studies::warnings(scores, scene.floor), inputs.verbosity);
  std::optional<studies::PlacementSearch> search;
  if (spec.search) {
    Progress progress(static_cast<std::uint32_t>(spec.search->evaluations), inputs.verbosity, "sets");
    search = studies::search_placement(scene, spec.coverage, *spec.search, threads, [&] { progress.run_finished(); });
    scores.push_back(search->even);
    scores.push_back(search->found);
  }
  std::cout << to_text(studies::ranked(std::move(scores)));
  if (search) std::cout << to_text(*search);
  require_written();
}

}  // namespace

void add_placements_command(CLI::App& app) {
  CLI::App& command = add_command(app, "placements", "rank sets of sensors, and look for a better one", R"(
  pirsim placements --scene room.gltf --script placements.yaml
  pirsim placements --scene room.gltf --script placements.yaml --set search.evaluations=2000
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto threads = std::make_shared<unsigned>(0);
  offer_study(command, *inputs);
  offer_seed(command, *inputs);
  offer_threads(command, *threads);
  on_call(command, inputs, [threads](const Inputs& given) { placements(given, *threads); });
}

}  // namespace pirsim::app
