#include <iostream>

#include "app/commands.hpp"
#include "app/log_inputs.hpp"
#include "app/session.hpp"
#include "core/text.hpp"
#include "io/files/atomic_file.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/version.hpp"

namespace pirsim::app {
namespace {

struct CountOptions {
  std::filesystem::path counter, output, report;
  LogInputs log;
  counting::Pass pass = counting::Pass::smoothed;
  Verbosity verbosity = Verbosity::normal;
};

void write(const CountOptions& options, const calibrate::LogCounts& counts) {
  if (options.output.empty()) {
    if (options.report.empty()) calibrate::write_counts(std::cout, counts);
    return require_written();
  }
  io::AtomicFile file(options.output);
  calibrate::write_counts(file.stream(), counts);
  file.commit();
}

void count(const CountOptions& options) {
  const counting::Counter counter = counting::read_counter(options.counter);
  const Log log = read_log(options.log, options.verbosity);
  const calibrate::LogCounts counts = calibrate::count_log(counter, LogWindows(log, counter.settings.step_s).rows(),
                                                           calibrate::traits_of(facts_of(log)), options.pass);
  write(options, counts);
  if (!options.report.empty())
    calibrate::write_counts_page(options.report, counts, options.log.files.front().filename().string(), program());
  tell_written({{options.output}, {options.report}}, options.verbosity);
  std::vector<Issue> warnings;
  if (!counts.warning.empty()) warnings.push_back({Severity::warning, Where{options.counter.string()}, counts.warning});
  for (const std::string& remark : counts.remarks)
    warnings.push_back({Severity::warning, Where{options.counter.string()}, remark});
  tell(warnings, options.verbosity);
  if (options.verbosity == Verbosity::quiet) return;
  if (const std::string sure = calibrate::how_sure(counts); !sure.empty()) std::cerr << sure << '\n';
  if (const auto error = calibrate::error_of(counts))
    std::cerr << "beside the log's own counts: " << calibrate::in_words(*error) << '\n';
}

}  // namespace

void add_count_command(CLI::App& app) {
  CLI::App& command = add_command(app, "count", "count the people of a log, by a counter of pirsim calibrate", R"(
  pirsim count DIR/counter.json --log week.csv -o counts.csv --report counts.html
  pirsim count DIR/counter.json --log week.csv --forward      as it could have been told at each moment
)");
  const auto options = std::make_shared<CountOptions>();
  offer_input_file(command, "COUNTER", options->counter, "counter.json of pirsim calibrate")->required();
  offer_log(command, options->log);
  offer_output(command, output_names, options->output, "counts as CSV (default: standard output)");
  offer_output(command, "--report", options->report, "a page with the log and the counts as time lines");
  command.add_flag_callback(
      "--forward", [options] { options->pass = counting::Pass::forward; },
      "each reading by those before it alone (default: by those after it as well)");
  offer_quiet(command, options->verbosity);
  command.callback([options] { count(*options); });
}

}  // namespace pirsim::app
