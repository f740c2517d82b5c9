#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "io/files/atomic_file.hpp"
#include "pirsim/io.hpp"
#include "pirsim/response.hpp"
#include "studies/coverage.hpp"
#include "studies/study_report.hpp"

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

}  // namespace pirsim::app
