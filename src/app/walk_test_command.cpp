#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/output_checks.hpp"
#include "app/progress.hpp"
#include "app/session.hpp"
#include "app/stop_request.hpp"
#include "io/atomic_file.hpp"
#include "pirsim/io.hpp"
#include "studies/walk_test.hpp"

namespace pirsim::app {

void walk_test(const Inputs& inputs, const WalkTestOptions& options) {
  check_outputs({{"-o", options.output, {".csv"}}, {"--report", options.report, {".html"}}}, inputs);
  WalkTestSpec spec = io::read_walk_test(inputs.script, inputs.overrides);
  SceneSpec scene = io::read_scene(inputs.scene, scene_options(inputs));
  tell(scene.warnings, inputs.verbosity);
  const studies::WalkTest test(std::move(scene), std::move(spec));
  tell(test.warnings(), inputs.verbosity);
  io::AtomicFile file(options.output);
  std::optional<io::AtomicFile> report_file;
  if (!options.report.empty()) report_file.emplace(options.report);
  const StopRequest stop;
  const WalkTestResult result = [&] {
    Progress progress(static_cast<std::uint32_t>(test.grid().n_rows()), inputs.verbosity, "rows of points");
    return studies::run_walk_test(test, options.threads, [&] {
      progress.run_finished();
      stop.throw_if_made();
    });
  }();
  file.stream() << to_csv(test, result);
  file.commit();
  if (report_file) write_page(*report_file, studies::walk_test_report(test, result), inputs);
  if (inputs.verbosity != Verbosity::quiet) std::cout << to_text(test, result);
}

}  // namespace pirsim::app
