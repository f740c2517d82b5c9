#include "app/log_command.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/dataset_command.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "files/disk/file.hpp"
#include "logs/log_page.hpp"
#include "logs/log_rows.hpp"
#include "model/core/text.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/version.hpp"

namespace pirsim::app {

void offer_log(CLI::App& command, LogInputs& log) {
  CLI::Option* files = as_input(command.add_option("--log", log.files, "the log; several files are parts of one"))
                           ->option_text("FILE")
                           ->required();
  declare_inputs(command, files, log.files);
  offer_input_file(command, "--map", log.map, "what the log's columns mean (pirsim log --print-map)");
  command.add_option("--time-zone", log.time_zone, "where the room is, as Europe/Berlin: for times of day")
      ->option_text("ZONE");
}

std::vector<std::string> words_of(const LogInputs& log) {
  std::vector<std::string> words{"--log"};
  for (const std::filesystem::path& file : log.files) words.push_back(typed(file));
  if (!log.map.empty()) words.insert(words.end(), {"--map", typed(log.map)});
  if (!log.time_zone.empty()) words.insert(words.end(), {"--time-zone", log.time_zone});
  return words;
}

namespace {

LogMap map_of(const LogInputs& inputs) {
  LogMap map = inputs.map.empty() ? LogMap{} : io::read_log_map(inputs.map);
  if (!inputs.time_zone.empty()) map.time_zone = inputs.time_zone;
  return map;
}

Log read(const LogInputs& inputs, const LogMap& map, Verbosity verbosity) {
  const Progress progress({.what = "reading the log"}, verbosity);
  const StopRequest stop;
  return io::read_log(inputs.files, map, {[&](std::uint64_t) { stop.throw_if_made(); }});
}

}  // namespace

Log read_log(const LogInputs& inputs, Verbosity verbosity) {
  const LogMap map = map_of(inputs);
  Log log = read(inputs, map, verbosity);
  if (log.clock == LogClock::zoned && map.time_zone.empty()) {
    log.remarks.push_back({Severity::warning, Where{inputs.files.front().string()},
                           "its times tell an offset, and no zone is named: hours of the day are taken as they are "
                           "written; name the room's zone (--time-zone Europe/Berlin)"});
  }
  if (verbosity != Verbosity::quiet)
    std::cerr << io::name_of_input(inputs.files.front()) << " is read as " << io::form_in_words(log) << ": "
              << tellable(io::sensors_in_words(log)) << '\n';
  tell(log.remarks, verbosity);
  return log;
}

namespace {

struct LogOptions {
  LogInputs log;
  std::filesystem::path output, report;
  std::string from, to;
  std::optional<double> window_s;
  bool prints_map = false;
  Verbosity verbosity = Verbosity::normal;
};

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
  const std::vector<std::filesystem::path>& files = options.log.files;
  const std::string name = io::stem_of_input(files.front());
  return files.size() == 1 ? name : name + " and " + std::to_string(files.size() - 1) + " more";
}

void write_report(const Log& log, const LogFacts& facts, const LogOptions& options) {
  io::Report report = io::log_report(log, facts, title_of(options));
  std::vector<std::filesystem::path> files;
  for (const InputFile& file : log.files) files.emplace_back(file.path);
  report.footer = made_from(files);
  io::write_report(options.report, report);
}

void run_log(const LogOptions& options) {
  LogMap map = map_of(options.log);
  if (!options.from.empty()) map.from = options.from;
  if (!options.to.empty()) map.to = options.to;
  const Log log = read(options.log, map, options.verbosity);
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
  CLI::Option* files = as_input(command.add_option("files", options->log.files,
                                                   "the log: CSV, or events as Home Assistant and CASAS write them"));
  declare_inputs(command, files->option_text("FILE..."), options->log.files);
  offer_input_file(command, "--map", options->log.map, "what its columns mean, YAML");
  command.add_option("--time-zone", options->log.time_zone, "in which local time it is told, as Europe/Berlin")
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
    if (options->log.files.empty()) throw Error(ErrorCode::usage, "FILE is missing; see pirsim log --help");
    run_log(*options);
  });
}

namespace {

struct CountOptions {
  std::filesystem::path counter, output, report, days, hours;
  LogInputs log;
  counting::Pass pass = counting::Pass::smoothed;
  Verbosity verbosity = Verbosity::normal;
};

void write(const CountOptions& options, const calibrate::LogCounts& counts) {
  if (options.output.empty()) {
    if (options.report.empty() && options.days.empty() && options.hours.empty())
      calibrate::write_counts(std::cout, counts);
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
  if (!options.days.empty()) io::write_text_file(options.days, calibrate::to_csv(calibrate::counted_days(counts)));
  if (!options.hours.empty()) io::write_text_file(options.hours, calibrate::to_csv(calibrate::counted_hours(counts)));
  tell_written({{options.output}, {options.days}, {options.hours}, {options.report}}, options.verbosity);
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
  offer_output(command, output_names, options->output, "counts, .csv (default: standard output)", {".csv"});
  offer_output(command, "--by-day", options->days, "a row a day: hours with somebody, arrival, departure, .csv",
               {".csv"});
  offer_output(command, "--by-hour", options->hours, "a row an hour of the day: P(nobody), people, .csv", {".csv"});
  offer_output(command, "--report", options->report, "a page with all of it, and the counts as time lines, .html",
               {".html"});
  command.add_flag_callback(
      "--forward", [options] { options->pass = counting::Pass::forward; },
      "each reading by those before it alone (default: by those after it as well)");
  offer_quiet(command, options->verbosity);
  command.callback([options] { count(*options); });
}

namespace {

struct CalibrateOptions {
  std::filesystem::path recipe, folder;
  LogInputs log;
  std::optional<double> step_s, hold_s;
  std::shared_ptr<DatasetWork> pool = std::make_shared<DatasetWork>();
};

void tell_finding(const calibrate::Calibration& calibration, const CalibrateOptions& options) {
  if (options.pool->inputs.verbosity == Verbosity::quiet) return;
  std::cout << calibrate::finding(calibration) << '\n'
            << calibrate::how_much_it_told(calibration) << " See " << (options.folder / "calibration.html").string()
            << '\n';
  if (calibration.verdict != calibrate::Verdict::none_like_it) {
    std::cout << "count with: pirsim count " << (options.folder / "counter.json").string();
    for (const std::string& word : words_of(options.log)) std::cout << ' ' << word;
    std::cout << " -o counts.csv\n";
  }
  require_written();
}

void run(const CalibrateOptions& options) {
  if (options.folder.empty()) throw Error(ErrorCode::usage, "-o DIR is missing");
  DatasetWork pool = *options.pool;
  const bool is_quiet = pool.inputs.verbosity == Verbosity::quiet;
  const calibrate::WeighingLog log =
      calibrate::weighing_log(read_log(options.log, pool.inputs.verbosity), options.step_s, options.hold_s);
  if (log.hold_s && !options.hold_s && !is_quiet)
    std::cerr << "the log's sensors hold motion for " << fixed(*log.hold_s, 1) << " s, and so do the rooms' (--hold)\n";
  const dataset::RecipeSpec given = read_recipe(options.recipe, pool);
  const dataset::RecipeSpec recipe =
      dataset::with_overrides(given, calibrate::pool_overrides(given, log.rows.window_s, log.hold_s));
  const Interval hours = calibrate::hours_of(recipe);
  const calibrate::LogDays days = calibrate::days_of(log.rows, hours);
  const calibrate::About about{options.recipe.filename().string(),
                               options.log.files.front().filename().string(),
                               program(),
                               hours,
                               days.whole.size(),
                               days.partial,
                               log.rows.n_counted()};
  if (!days.partial.empty() && !is_quiet)
    std::cerr << "of the log are compared " << calibrate::days_compared(about) << '\n';
  calibrate::require_rooms(recipe, static_cast<int>(log.rows.sensors.size()));
  pool.folder = options.folder / "pool";
  make_folder(options.folder);
  const StopRequest stop;
  if (make_dataset(recipe, pool, stop) == Whole::no) return;
  const Progress progress({.what = "weighing rooms"}, pool.inputs.verbosity);
  counting::Settings settings;
  settings.step_s = log.rows.window_s;
  const calibrate::Calibration made = calibrate::weigh_rooms(pool.folder, log, days, settings, pool.threads);
  calibrate::write_calibration(options.folder, made, about);
  io::write_text_file(options.folder / "recipe.yaml", calibrate::weighted_recipe(recipe, made, options.folder));
  tell_finding(made, options);
  tell_written({{options.folder}}, pool.inputs.verbosity);
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  CLI::App& command =
      add_command(app, "calibrate", "find simulated rooms that are like the one of a log, and count there", R"(
  pirsim calibrate recipe.yaml --log week.csv -o DIR      a counter for that room, the error to expect, a verdict
  pirsim calibrate recipe.yaml --log month.csv --hold 12 -o DIR          the same rooms, as they are there, and another log
  pirsim calibrate recipe.yaml --log week.csv -o DIR --shard 3/100       a part of the rooms, in a job array ...
  pirsim calibrate recipe.yaml --log week.csv -o DIR --finish            ... and when all are through
  pirsim dataset DIR/recipe.yaml -o data                  a dataset of rooms drawn by their weight
)");
  const auto options = std::make_shared<CalibrateOptions>();
  options->pool->start = dataset::DatasetOptions::Start::resume;  // rooms are the same, whatever the log
  offer_input_file(command, "RECIPE", options->recipe, "what is known of the room: a recipe, as of pirsim dataset")
      ->required();
  offer_log(command, options->log);
  offer_output_folder(command, output_names, options->folder, "folder of what is made",
                      {"recipe.yaml", "weights.csv", "counter.json", "calibration.json", "calibration.html", "pool"});
  command
      .add_option("--step", options->step_s, "seconds between readings (default: 30, or the log's interval if longer)")
      ->option_text("SECONDS")
      ->check(CLI::Range(1.0, 3600.0));
  command
      .add_option("--hold", options->hold_s,
                  "seconds for which the sensors hold motion (default: what an event log tells)")
      ->option_text("SECONDS")
      ->check(CLI::Range(0.0, 600.0));
  command.add_flag_callback(
      "--finish", [pool = options->pool.get()] { pool->part = DatasetWork::Part::finish; },
      "only weigh the rooms that are there");
  offer_dataset_work(command, options->pool);
  command.callback([options] { run(*options); });
}

}  // namespace pirsim::app
