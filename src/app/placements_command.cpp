#include <iostream>
#include <optional>
#include <utility>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "pirsim/io.hpp"
#include "pirsim/look.hpp"

namespace pirsim::app {
namespace {

void placements(const Inputs& inputs, unsigned threads) {
  const PlacementSpec spec = io::read_placements(inputs.script, inputs.overrides);
  SceneSpec scene = io::read_scene(inputs.scene, scene_options(inputs));
  tell(scene.warnings, inputs.verbosity);
  PlacementOptions options{threads, inputs.scene, scene_options(inputs)};
  std::optional<Progress> progress;
  const auto n_tried = static_cast<std::uint64_t>(spec.search ? spec.search->evaluations : 0);
  progress.emplace(Work{"scoring sets of sensors", spec.sets.size() + n_tried, "sets"}, inputs.verbosity);
  const StopRequest stop;
  options.set_done = [&] {
    progress->finished();
    stop.throw_if_made();
  };
  const PlacementReport report = run_placements(std::move(scene), spec, options);
  progress.reset();
  tell(report.warnings, inputs.verbosity);
  std::cout << report.text;
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
