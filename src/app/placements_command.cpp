#include <iostream>
#include <optional>
#include <utility>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "io/files/atomic_file.hpp"
#include "pirsim/io.hpp"
#include "pirsim/look.hpp"
#include "studies/placement_page.hpp"

namespace pirsim::app {
namespace {

struct PlacementsOptions {
  std::filesystem::path scene;   ///< .gltf, .glb
  std::filesystem::path report;  ///< .html
  unsigned threads = 0;
};

PlacementReport compare(const SceneSpec& scene, const PlacementSpec& spec, const Inputs& inputs, unsigned threads,
                        const StopRequest& stop) {
  auto n_tried = static_cast<std::uint64_t>(spec.search ? spec.search->evaluations : 0);
  if (spec.search && spec.by == PlacementAim::seats) n_tried += static_cast<std::uint64_t>(spec.search->n_sensors);
  // All places of a search by false-offs are done at once: how many sets are done says nothing of how long it takes.
  const std::uint64_t total = spec.by == PlacementAim::false_off ? 0 : spec.sets.size() + n_tried;
  Progress progress({"scoring sets of sensors", total, "sets"}, inputs.verbosity);
  PlacementOptions options{threads, found(io::DataKind::rooms, inputs.scene), scene_options(inputs)};
  options.set_done = [&] {
    progress.finished();
    stop.throw_if_made();
  };
  return run_placements(scene, spec, options);
}

void placements(const Inputs& inputs, const PlacementsOptions& options) {
  const PlacementSpec spec =
      io::read_placements(found(io::DataKind::studies, inputs.script), inputs.overrides, data_directories());
  const SceneSpec scene = read_scene(inputs);
  if (spec.light) keep_inputs(inputs, files_read(spec.light->people, scene));
  tell(scene.warnings, inputs.verbosity);
  std::optional<io::AtomicFile> report_file;
  if (!options.report.empty()) report_file.emplace(options.report);
  const StopRequest stop;
  const PlacementReport report = compare(scene, spec, inputs, options.threads, stop);
  tell(report.warnings, inputs.verbosity);
  if (!options.scene.empty()) io::write_scene(options.scene, report.best);
  if (report_file) {
    const studies::PlacementViews views = studies::views_of(scene, spec, report, options.threads);
    stop.throw_if_made();
    write_page(*report_file, studies::placement_report(scene, spec, report, views), inputs);
  }
  std::cout << report.text;
  require_written();
  tell_written({{options.scene}, {options.report}}, inputs.verbosity);
}

}  // namespace

void add_placements_command(CLI::App& app) {
  CLI::App& command = add_command(app, "placements", "rank sets of sensors, and look for a better one", R"(
  pirsim placements --scene room.gltf --script placements.yaml
  pirsim placements --scene room.gltf --script placements.yaml --set by=seats -o better.gltf --report sets.html
  pirsim placements --scene room.gltf --script placements.yaml --set search.evaluations=2000
  pirsim placements --scene room.gltf --script light.yaml --set light.delay_min=5 --report sets.html
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<PlacementsOptions>();
  offer_study(command, *inputs);
  offer_seed(command, *inputs);
  offer_output(command, output_names, options->scene, "the scene with the best set's sensors, .gltf or .glb",
               {".gltf", ".glb"});
  offer_map_report(command, options->report);
  offer_threads(command, options->threads);
  on_call(command, inputs, [options](const Inputs& given) { placements(given, *options); });
}

}  // namespace pirsim::app
