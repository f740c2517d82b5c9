#include <algorithm>
#include <iostream>

#include "app/commands.hpp"
#include "app/dataset_work.hpp"
#include "app/log_inputs.hpp"
#include "app/session.hpp"
#include "core/text.hpp"
#include "io/files/atomic_file.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/log_facts.hpp"
#include "pirsim/version.hpp"

namespace pirsim::app {
namespace {

struct CalibrateOptions {
  std::filesystem::path recipe, folder;
  LogInputs log;
  std::optional<double> step_s, hold_s;
  std::shared_ptr<DatasetWork> pool = std::make_shared<DatasetWork>();
};

/// Between the readings that rooms and log are compared by: no shorter than the log's own.
double step_of(const CalibrateOptions& options, const Log& log) {
  const double interval_s = static_cast<double>(log.interval_us) * 1e-6;
  const double step_s = options.step_s.value_or(usual_window_s(log));
  if (step_s < interval_s) {
    throw Error(ErrorCode::usage, "--step: the log has a reading every " + shortest_number(interval_s) +
                                      " s, so that nothing shorter can be told apart");
  }
  return step_s;
}

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

/// Before hours of work on rooms that can't be weighed.
void require_rooms(const dataset::RecipeSpec& recipe, int n_sensors) {
  if (recipe.n_rooms() < calibrate::fewest_rooms) {
    throw Error(ErrorCode::input, Where{recipe.file.string()},
                "a calibration needs " + std::to_string(calibrate::fewest_rooms) +
                    " rooms at least, better 60; it has " + std::to_string(recipe.n_rooms()));
  }
  if (!calibrate::may_have(recipe, n_sensors)) {
    throw Error(ErrorCode::input, Where{recipe.file.string()},
                "the log has " + counted(static_cast<std::size_t>(n_sensors), "sensor") +
                    ", and no room has as many: change its sensors, or name those of the room in a map (--map)");
  }
}

std::size_t counted_readings(const LogRows& rows) {
  return static_cast<std::size_t>(
      std::ranges::count_if(rows.people, [](int n) { return n != log_state::unknown_count; }));
}

void run(const CalibrateOptions& options) {
  if (options.folder.empty()) throw Error(ErrorCode::usage, "-o DIR is missing");
  const Log log = read_log(options.log, options.pool->inputs.verbosity);
  const double step_s = step_of(options, log);
  const LogFacts facts = facts_of(log);
  const std::optional<double> hold_s = options.hold_s ? options.hold_s : calibrate::common_hold(facts);
  if (hold_s && !options.hold_s && options.pool->inputs.verbosity != Verbosity::quiet)
    std::cerr << "the log's sensors hold motion for " << fixed(*hold_s, 1) << " s, and so do the rooms' (--hold)\n";
  const dataset::RecipeSpec given = read_recipe(options.recipe, *options.pool);
  const std::vector<std::string> overrides = calibrate::pool_overrides(given, step_s, hold_s);
  const dataset::RecipeSpec recipe = dataset::with_overrides(given, overrides);
  const LogRows rows = LogWindows(log, step_s).rows();
  const Interval hours = calibrate::hours_of(recipe);
  const calibrate::LogDays days = calibrate::days_of(rows, hours);
  const calibrate::About about{options.recipe.filename().string(),
                               options.log.files.front().filename().string(),
                               program(),
                               hours,
                               days.whole.size(),
                               days.partial,
                               counted_readings(rows)};
  if (!days.partial.empty() && options.pool->inputs.verbosity != Verbosity::quiet)
    std::cerr << "of the log are compared " << calibrate::days_compared(about) << '\n';
  require_rooms(recipe, static_cast<int>(rows.sensors.size()));
  DatasetWork pool = *options.pool;
  pool.folder = options.folder / "pool";
  make_folder(options.folder);
  const StopRequest stop;
  if (make_dataset(recipe, pool, stop) == Whole::no) return;
  const Progress progress({.what = "weighing rooms"}, pool.inputs.verbosity);
  auto rooms = calibrate::read_pool(pool.folder, static_cast<int>(rows.sensors.size()), step_s, pool.threads);
  counting::Settings settings;
  settings.step_s = step_s;
  calibrate::Calibration made = calibrate::Pool(std::move(rooms), settings, pool.threads)
                                    .calibrate(std::vector{calibrate::whole_log(rows)}, days.whole);
  calibrate::LogTraits traits = calibrate::traits_of(facts);
  if (options.hold_s) std::ranges::fill(traits.holds_s, options.hold_s);
  calibrate::remember(traits, made.counter);
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
