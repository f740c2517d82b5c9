#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "core/text.hpp"
#include "io/pages/log_page.hpp"
#include "io/pages/log_text.hpp"
#include "io/write/log_rows_writer.hpp"
#include "pirsim/log_facts.hpp"
#include "pirsim/version.hpp"

namespace pirsim::app {
namespace {

struct LogOptions {
  std::vector<std::filesystem::path> files;
  std::filesystem::path map, output, report;
  std::vector<std::string> changes;
  std::string from, to, time_zone;
  std::optional<double> window_s;
  bool prints_map = false;
  Verbosity verbosity = Verbosity::normal;
};

LogMap map_of(const LogOptions& options) {
  LogMap map;
  if (!options.map.empty()) map = io::read_log_map(options.map, options.changes);
  if (!options.time_zone.empty()) map.time_zone = options.time_zone;
  if (!options.from.empty()) map.from = options.from;
  if (!options.to.empty()) map.to = options.to;
  return map;
}

Log read(const LogOptions& options) {
  const LogMap map = map_of(options);
  const Progress progress({"reading the log"}, options.verbosity);
  const StopRequest stop;
  return io::read_log(options.files, map, {[&](std::uint64_t) { stop.throw_if_made(); }});
}

void write_rows(const Log& log, const LogOptions& options) {
  const LogWindows windows(log, options.window_s.value_or(usual_window_s(log)));
  io::AtomicFile file(options.output);
  io::DataWriter data(file.stream(), io::compression_of(options.output));
  const Progress progress({"writing rows"}, options.verbosity);
  const StopRequest stop;
  io::write_log_rows(windows, [&](std::string_view text) {
    stop.throw_if_made();
    data.write(text);
  });
  data.finish();
  file.commit();
}

std::string title_of(const LogOptions& options) {
  const std::string name = io::stem_of_input(options.files.front());
  return options.files.size() == 1 ? name : name + " and " + std::to_string(options.files.size() - 1) + " more";
}

void write_report(const Log& log, const LogFacts& facts, const LogOptions& options) {
  io::Report report = io::log_report(log, facts, title_of(options));
  std::vector<std::filesystem::path> files;
  for (const InputFile& file : log.files) files.emplace_back(file.path);
  report.footer = made_from(files);
  io::write_report(options.report, report);
}

void run_log(const LogOptions& options) {
  const Log log = read(options);
  tell(log.remarks, options.verbosity);
  if (options.prints_map) {
    std::cout << io::to_yaml(log.map);
    if (!log.others.empty()) std::cout << "# not read: " << tellable(joined(log.others, ", ")) << '\n';
  } else if (options.verbosity != Verbosity::quiet || !options.report.empty()) {
    const LogFacts facts = facts_of(log);
    if (options.verbosity != Verbosity::quiet) std::cout << io::to_text(log, facts);
    if (!options.report.empty()) write_report(log, facts, options);
  }
  require_written();
  if (!options.output.empty()) write_rows(log, options);
  tell_written({{options.output}, {options.prints_map ? std::filesystem::path() : options.report}}, options.verbosity);
}

}  // namespace

void add_log_command(CLI::App& app) {
  CLI::App& command = add_command(app, "log", "read a log of real motion sensors, and say what it tells", R"(
  pirsim log week.csv                                              form, sensors, times, and what they tell
  pirsim log week.csv --print-map > map.yaml                       a map to start from: which column is which sensor
  pirsim log week.csv --map map.yaml --step 30 -o rows.csv         rows of pirsim, empty where nothing is known
  pirsim log week.csv --report week.html                           a page: the days as time lines
)");
  const auto options = std::make_shared<LogOptions>();
  CLI::Option* files = as_input(
      command.add_option("files", options->files, "the log: CSV, or events as Home Assistant and CASAS write them"));
  declare_inputs(command, files->option_text("FILE..."), options->files);
  offer_input_file(command, "--map", options->map, "what its columns mean, YAML");
  command.add_option("--time-zone", options->time_zone, "in which local time it is told, as Europe/Berlin")
      ->option_text("ZONE");
  command.add_option("--from", options->from, "local time from which it is read")->option_text("TIME");
  command.add_option("--to", options->to, "local time until which it is read")->option_text("TIME");
  command
      .add_option("--step,--window", options->window_s,
                  "length of a row (default: 30, or the log's interval if longer)")
      ->option_text("SECONDS");
  offer_output(command, output_names, options->output, "rows, .csv, .csv.gz or .csv.zst", io::table_endings());
  offer_output(command, "--report", options->report, "a page with the days as time lines, .html", {".html"});
  command.add_flag("--print-map", options->prints_map, "print the map that it was read by, and nothing else");
  offer_quiet(command, options->verbosity);
  command.callback([options] {
    if (options->files.empty()) throw Error(ErrorCode::usage, "FILE is missing; see pirsim log --help");
    run_log(*options);
  });
}

}  // namespace pirsim::app
