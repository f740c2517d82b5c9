#include <iostream>

#include "app/commands.hpp"
#include "app/gnuplot_runner.hpp"
#include "app/progress.hpp"
#include "app/session.hpp"
#include "pirsim/core/version.hpp"
#include "pirsim/io/atomic_file.hpp"
#include "pirsim/io/coverage_reader.hpp"
#include "pirsim/io/gnuplot.hpp"
#include "pirsim/io/scene_reader.hpp"
#include "pirsim/studies/coverage_figures.hpp"
#include "pirsim/studies/coverage_report.hpp"

namespace pirsim::app {
namespace {

studies::CoverageStudy load_coverage(const Inputs& inputs) {
  CoverageSpec spec = io::read_coverage(inputs.script, inputs.overrides);
  SceneSpec scene = io::read_scene(inputs.scene, {inputs.sensor_directories});
  tell(scene.warnings, inputs.verbosity);
  return {std::move(scene), std::move(spec)};
}

void write(const std::filesystem::path& path, const std::string& text) {
  io::AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

/// What made a page or a file of maps.
std::string provenance(const Inputs& inputs) {
  return "pirsim " + version() + " (" + git_revision() + "), " + inputs.scene.filename().string() + ", " +
         inputs.script.filename().string();
}

void draw_maps(const studies::CoverageStudy& study, const studies::CoverageMap& map, const Inputs& inputs,
               const std::filesystem::path& folder) {
  for (std::size_t i = 0; i < map.sensors.size(); ++i) {
    io::MapChart chart = studies::map_chart(study, map, i);
    chart.title = study.spec().name + ", " + chart.title;
    if (run_gnuplot(io::gnuplot_program(chart, folder / (map.sensors[i] + ".png")))) continue;
    return tell({{Severity::warning, {}, "no pictures of the maps: gnuplot (package gnuplot-nox) isn't there or failed"}},
                inputs.verbosity);
  }
}

}  // namespace

void coverage(const Inputs& inputs, const CoverageOptions& options) {
  const studies::CoverageStudy study = load_coverage(inputs);
  std::filesystem::create_directories(options.output);
  studies::CoverageMap map = studies::empty_map(study);
  {
    Progress progress(static_cast<std::uint32_t>(study.grid().n_rows()), inputs.verbosity, "rows of squares");
    studies::run_rows(study, 0, options.threads, [&](std::size_t, const std::vector<studies::MotionCount>& counts) {
      map.counts.insert(map.counts.end(), counts.begin(), counts.end());
      progress.run_finished();
    });
  }
  const studies::CoverageFigures figures = studies::figures_of(map);
  write(options.output / "coverage.csv", to_csv(map));
  draw_maps(study, map, inputs, options.output);
  if (!options.report.empty()) {
    io::Report report = studies::coverage_report(study, map, figures);
    report.footer = provenance(inputs);
    io::write_report(options.report, report);
  }
  if (inputs.verbosity != Verbosity::quiet) std::cout << to_text(map, figures);
}

}  // namespace pirsim::app
