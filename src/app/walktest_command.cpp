#include <iostream>
#include <optional>
#include <string>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "io/files/atomic_file.hpp"
#include "pirsim/io.hpp"
#include "pirsim/response.hpp"
#include "studies/walk_test.hpp"

namespace pirsim::app {
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
    return studies::run_walk_test(test, options.threads, [&] {
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

}  // namespace pirsim::app
