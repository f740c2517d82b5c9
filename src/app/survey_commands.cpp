#include <iostream>
#include <optional>
#include <string>
#include <utility>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "files/disk/file.hpp"
#include "pirsim/io.hpp"
#include "pirsim/look.hpp"
#include "pirsim/response.hpp"
#include "surveys/coverage.hpp"
#include "surveys/placement_page.hpp"
#include "surveys/study_report.hpp"
#include "surveys/walk_test.hpp"

namespace pirsim::app {
namespace {

struct CoverageOptions {
  std::filesystem::path output = "coverage";  ///< folder
  std::filesystem::path report;               ///< .html
  unsigned threads = 0;
};

studies::CoverageStudy load_coverage(const Inputs& inputs) {
  CoverageSpec spec = io::read_coverage(found(io::DataKind::studies, inputs.script), inputs.overrides);
  SceneSpec scene = read_scene(inputs);
  tell(scene.warnings, inputs.verbosity);
  tell(idle_sensor_keys(scene, spec.sensing), inputs.verbosity);
  studies::CoverageStudy study(std::move(scene), std::move(spec));
  tell(study.warnings(), inputs.verbosity);
  tell_what_is_left_out(study, inputs.verbosity);
  return study;
}

CoverageMap compute(const studies::CoverageStudy& study, const Inputs& inputs, unsigned threads,
                    const StopRequest& stop) {
  Progress progress({"moving a target over the floor", study.grid().n_rows(), "rows of squares"}, inputs.verbosity);
  return studies::run_coverage(study, threads, [&](std::size_t, std::size_t) {
    progress.finished();
    stop.throw_if_made();
  });
}

void coverage(const Inputs& inputs, const CoverageOptions& options) {
  const studies::CoverageStudy study = load_coverage(inputs);
  std::optional<io::AtomicFile> report_file;
  if (!options.report.empty()) report_file.emplace(options.report);
  const StopRequest stop;
  make_folder(options.output);
  const CoverageMap map = compute(study, inputs, options.threads, stop);
  const studies::CoverageFigures figures = studies::figures_of(map);
  io::write_text_file(options.output / "coverage.csv", studies::to_csv(map));
  if (report_file) write_page(*report_file, studies::coverage_report(study, map, figures), inputs);
  if (inputs.verbosity == Verbosity::quiet) return;
  std::cout << studies::to_text(map, figures, studies::area_figures_of(map, study.scene()));
  require_written();
  tell_written({{options.output / "coverage.csv"}, {options.report}}, inputs.verbosity);
}

}  // namespace

void add_coverage_command(CLI::App& app) {
  CLI::App& command = add_command(app, "coverage", "map where each sensor sees a moving target", R"(
  pirsim coverage --scene room.gltf --script studyB.yaml --report maps.html   figures, a map of every sensor
  pirsim coverage --scene room.gltf --script studyB.yaml --set spacing_m=0.1 -o fine
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<CoverageOptions>();
  offer_study(command, *inputs);
  offer_seed(command, *inputs);
  offer_output_folder(command, output_names, options->output, "folder for coverage.csv (default: coverage)",
                      {"coverage.csv"});
  offer_map_report(command, options->report);
  offer_threads(command, options->threads);
  on_call(command, inputs, [options](const Inputs& given) { coverage(given, *options); });
}

namespace {

struct WalkTestOptions {
  std::filesystem::path output = "walk_test.csv";
  std::filesystem::path report;  ///< .html
  unsigned threads = 0;
};

void walk_test(const Inputs& inputs, const WalkTestOptions& options) {
  WalkTestSpec spec = io::read_walk_test(found(io::DataKind::studies, inputs.script), inputs.overrides);
  SceneSpec scene = read_scene(inputs);
  tell(scene.warnings, inputs.verbosity);
  tell(idle_sensor_keys(scene, spec.sensing), inputs.verbosity);
  const studies::WalkTest test(std::move(scene), std::move(spec));
  tell(test.warnings(), inputs.verbosity);
  const bool is_stream = io::is_written_directly(options.output);
  io::AtomicFile file(options.output);
  std::optional<io::AtomicFile> report_file;
  if (!options.report.empty()) report_file.emplace(options.report);
  const StopRequest stop;
  const WalkTestResult result = [&] {
    Progress progress({"walking and sitting", test.grid().n_rows(), "rows of points"}, inputs.verbosity);
    return studies::run_walk_test(test, options.threads, [&](std::size_t, std::size_t) {
      progress.finished();
      stop.throw_if_made();
    });
  }();
  file.stream() << to_csv(test, result);
  file.commit();
  if (report_file) write_page(*report_file, studies::walk_test_report(test, result), inputs);
  if (inputs.verbosity == Verbosity::quiet) return;
  (is_stream ? std::cerr : std::cout) << to_text(test, result);
  require_written();
  tell_written({{options.output}, {options.report}}, inputs.verbosity);
}

}  // namespace

void add_walktest_command(CLI::App& app) {
  CLI::App& command = add_command(app, "walktest", "how surely walkers and sitters are noticed in time", R"(
  pirsim walktest --scene room.gltf --script walk_test.yaml -o points.csv
  pirsim walktest --scene room.gltf --script walk_test.yaml --set spacing_m=1 --report maps.html
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<WalkTestOptions>();
  offer_study(command, *inputs);
  offer_seed(command, *inputs);
  offer_output(command, output_names, options->output,
               "points with tries and verdicts, as CSV (default: walk_test.csv)", {".csv"});
  offer_map_report(command, options->report);
  offer_threads(command, options->threads);
  on_call(command, inputs, [options](const Inputs& given) { walk_test(given, *options); });
}

namespace {

struct PlacementsOptions {
  std::filesystem::path scene;         ///< .gltf, .glb
  std::filesystem::path report;        ///< .html
  std::vector<std::string> each_area;  ///< models
  unsigned threads = 0;
};

PlacementReport compare(const SceneSpec& scene, const PlacementSpec& spec, const Inputs& inputs,
                        const PlacementsOptions& asked, const StopRequest& stop) {
  auto n_tried = static_cast<std::uint64_t>(spec.search ? spec.search->evaluations : 0);
  if (spec.search && spec.by == PlacementAim::seats) n_tried += static_cast<std::uint64_t>(spec.search->n_sensors);
  // All places of a search by false-offs are done at once: how many sets are done says nothing of how long it takes.
  const bool is_open = spec.by == PlacementAim::false_off || !asked.each_area.empty();
  const std::uint64_t total = is_open ? 0 : spec.sets.size() + n_tried;
  Progress progress({"scoring sets of sensors", total, "sets"}, inputs.verbosity);
  PlacementOptions options{asked.threads, found(io::DataKind::rooms, inputs.scene), scene_options(inputs)};
  options.each_area = asked.each_area;
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
  const PlacementReport report = compare(scene, spec, inputs, options, stop);
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
  pirsim placements --scene flat.gltf --script home_placements.yaml --each-area SML001 RTCGQ11LM -o better.gltf
  pirsim placements --scene room.gltf --script light.yaml --set light.delay_min=5 --report sets.html
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<PlacementsOptions>();
  offer_study(command, *inputs);
  offer_seed(command, *inputs);
  command
      .add_option("--each-area", options->each_area,
                  "look for one sensor in each area, of these models: in its corners and below its ceiling")
      ->option_text("MODEL ...");
  offer_output(command, output_names, options->scene, "the scene with the best set's sensors, .gltf or .glb",
               {".gltf", ".glb"});
  offer_map_report(command, options->report);
  offer_threads(command, options->threads);
  on_call(command, inputs, [options](const Inputs& given) { placements(given, *options); });
}

}  // namespace pirsim::app
