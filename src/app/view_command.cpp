#include <algorithm>
#include <cstdio>
#include <iostream>
#include <numeric>
#include <sstream>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "io/run_page.hpp"
#include "pirsim/study.hpp"
#include "pirsim/version.hpp"
#include "schema/schedule_people.hpp"
#include "sim/compiled_study.hpp"
#include "studies/coverage.hpp"
#include "studies/run_film.hpp"

namespace pirsim::app {
namespace {

/// Of a longer run a page shows a part, unless its user asks for more: it would be large and take long to load.
constexpr double longest_unasked_s = 1200.0;

struct ViewOptions {
  std::filesystem::path output = "run.html";
  RunChoice run;
  std::string from, to;            ///< empty: not given
  std::filesystem::path coverage;  ///< a coverage study; empty: no map
  double keys_per_s = 10.0;
};

struct Stretch {
  double from_s = 0.0, to_s = 0.0;
  [[nodiscard]] bool holds(double time_s) const { return time_s >= from_s && time_s <= to_s; }
};

/// Of run seconds or, in a run of a schedule, of a time of day.
double run_seconds(const std::string& option, const std::string& text, const sim::TrialModel& trial) {
  if (const auto hour = trial.schedule ? clock_hours(text) : std::nullopt)
    return 3600.0 * (*hour - trial.schedule->from_h);
  const auto seconds = io::parse_number<double>(text);
  if (!seconds || !(*seconds >= 0.0)) {
    throw Error(ErrorCode::usage, option + ": expected seconds since the run began" +
                                      (trial.schedule ? ", or a time of day such as 09:30" : "") + ", not '" + text +
                                      "'");
  }
  return *seconds;
}

int bits_set(const Sample& row) { return std::accumulate(row.bits.begin(), row.bits.end(), 0); }

/// That in which sensors see motion most often, the earliest of equals.
Stretch busiest(const std::vector<Sample>& rows, double window_s) {
  const auto length = std::clamp<std::size_t>(static_cast<std::size_t>(longest_unasked_s / window_s), 1, rows.size());
  int motion = 0, most = -1;
  std::size_t best_end = length;
  for (std::size_t end = 1; end <= rows.size(); ++end) {
    motion += bits_set(rows[end - 1]);
    if (end > length) motion -= bits_set(rows[end - 1 - length]);
    if (end >= length && motion > most) {
      most = motion;
      best_end = end;
    }
  }
  return {rows[best_end - length].time_s - window_s, rows[best_end - 1].time_s};
}

Stretch chosen_stretch(const ViewOptions& options, const sim::TrialModel& trial, const std::vector<Sample>& rows,
                       double window_s) {
  const double end_s = rows.back().time_s;
  if (options.from.empty() && options.to.empty() && end_s > longest_unasked_s) return busiest(rows, window_s);
  Stretch stretch{0.0, end_s};
  if (!options.from.empty()) stretch.from_s = run_seconds("--from", options.from, trial);
  if (!options.to.empty()) {
    stretch.to_s = std::min(end_s, run_seconds("--to", options.to, trial));
    if (options.from.empty()) stretch.from_s = std::max(0.0, stretch.to_s - longest_unasked_s);
  } else {
    stretch.to_s = std::min(end_s, stretch.from_s + longest_unasked_s);
  }
  std::ostringstream lasts;
  lasts << ": the run lasts from 0 to " << end_s << " s";
  if (stretch.from_s >= end_s || stretch.from_s < 0.0) throw Error(ErrorCode::usage, "--from" + lasts.str());
  if (stretch.to_s <= stretch.from_s) throw Error(ErrorCode::usage, "--to must be later than --from");
  // Whole windows, so that rows and pictures begin together.
  stretch.from_s = std::floor(stretch.from_s / window_s + 1e-9) * window_s;
  stretch.to_s = std::min(end_s, std::ceil(stretch.to_s / window_s - 1e-9) * window_s);
  return stretch;
}

std::vector<io::PageSensor> page_sensors(const Model& model, studies::Film& film) {
  const sim::CompiledStudy& study = model.compiled();
  const RayBundle& rays = model.rays();
  std::vector<io::PageSensor> result;
  for (std::size_t i = 0; i < rays.n_sensors(); ++i) {
    const SensorSpec& spec = study.scene().sensors[i];
    io::PageSensor& sensor = result.emplace_back();
    sensor.id = spec.id;
    sensor.model = spec.model;
    sensor.world_from_sensor = spec.world_from_sensor;
    sensor.first_zone = rays.cluster_zones_begin[rays.sensor_clusters_begin[i]];
    for (auto zone = sensor.first_zone; zone < rays.cluster_zones_begin[rays.sensor_clusters_begin[i + 1]]; ++zone)
      sensor.zone_rays.push_back(rays.zone_rays_begin[zone + 1] - rays.zone_rays_begin[zone]);
    sensor.signal_v = std::move(film.signals_v[i]);
    if (sensor.signal_v.empty()) continue;
    const ComparatorSpec& comparator = study.scene().sensor_models.at(spec.model).detector.comparator;
    sensor.positive_v = comparator.positive_v;
    sensor.negative_v = comparator.negative_v;
  }
  return result;
}

void drop_absent_people(io::ExportedRun& run) {
  std::erase_if(run.people, [](const io::ExportedPerson& person) {
    return std::ranges::none_of(person.present, [](std::uint8_t present) { return present != 0; });
  });
}

/// Where each of the room's sensors sees the study's target.
io::PageMap page_map(const Model& model, const std::filesystem::path& file, Verbosity verbosity) {
  CoverageSpec spec = io::read_coverage(file);
  const studies::CoverageStudy study(model.compiled().scene(), std::move(spec));
  tell(study.warnings(), verbosity);
  tell_what_is_left_out(study, verbosity);
  const CoverageMap map = studies::run_coverage(study);
  const FloorGrid& grid = map.grid;
  io::PageMap page{study.spec().name,
                   grid.centre(0, 0) - 0.5 * Vec2(grid.spacing_m()),
                   study.scene().floor.height_m(),
                   grid.spacing_m(),
                   grid.n_columns(),
                   grid.n_rows(),
                   {}};
  for (std::size_t sensor = 0; sensor < map.sensors.size(); ++sensor) {
    std::vector<double>& shares = page.shares.emplace_back();
    for (std::size_t row = 0; row < grid.n_rows(); ++row) {
      for (std::size_t column = 0; column < grid.n_columns(); ++column) {
        const double share = static_cast<double>(map.count(column, row, sensor)) / map.n_windows;
        shares.push_back(grid.on_floor(column, row) ? share : -1.0);
      }
    }
  }
  return page;
}

io::RunPage run_page(const Model& model, std::uint32_t run, const Stretch& stretch, const ViewOptions& options) {
  std::vector<std::size_t> all_sensors(model.scene().sensors.size());
  std::iota(all_sensors.begin(), all_sensors.end(), 0);
  studies::Film film =
      studies::film(model, run, {stretch.from_s, stretch.to_s, options.keys_per_s, std::move(all_sensors)});
  io::RunPage page;
  page.title = model.script().name + ", " + model.trial_of(run);
  page.about = "trial " + model.trial_of(run) + ", replicate " + std::to_string(model.replicate_of(run));
  const TrialSpec& trial = model.script().trials[run % model.script().trials.size()];
  if (!trial.schedule && !trial.people.empty()) page.first_person = trial.people.front().id;
  page.made_by = "pirsim " + version() + " (" + git_revision() + ")";
  page.sensors = page_sensors(model, film);
  page.run = std::move(film.run);
  drop_absent_people(page.run);
  page.active_zones = std::move(film.active_zones);
  for (const SeatSpec& seat : model.compiled().scene().seats)
    page.seats.push_back({seat.id, seat.world_from_seat.origin});
  for (const EntranceSpec& door : model.compiled().scene().entrances)
    page.doors.push_back({door.id, door.world_from_entrance.origin});
  return page;
}

std::vector<Sample> rows_of(const Model& model, std::uint32_t run) {
  RunResult result = run_once(model, run);
  if (result.fault) throw Error(ErrorCode::infeasible, result.fault->message);
  return std::move(result.samples);
}

void tell_what_is_shown(const io::RunPage& page, const ViewOptions& options, std::size_t bytes) {
  const auto& keys = page.run.key_times_s;
  std::cerr << "wrote " << options.output.string() << ": " << page.about << ", " << keys.front() << " to "
            << keys.back() << " s of " << page.run_s << " s, " << std::ceil(static_cast<double>(bytes) / 1e5) / 10.0
            << " MB\n";
  if (page.run_s > longest_unasked_s && options.from.empty() && options.to.empty()) {
    std::cerr << "the run is longer than " << longest_unasked_s
              << " s: these are the seconds with most motion; --from and "
              << "--to choose others\n";
  }
}

void view(const Inputs& inputs, const ViewOptions& options) {
  check_outputs({{"-o", options.output, {".html"}}}, inputs);
  const Model model = load(inputs);
  keep_inputs({{"-o", options.output}}, files_read(model.script(), model.scene()));
  const std::uint32_t run = find_run(model, options.run);
  std::vector<Sample> rows = rows_of(model, run);
  const double window_s = model.tick_s() * model.compiled().sensing().ticks_per_window;
  const Stretch stretch = chosen_stretch(options, model.compiled().trial_of(run), rows, window_s);
  io::RunPage page = run_page(model, run, stretch, options);
  page.about += ", " + inputs.scene.filename().string() + ", " + inputs.script.filename().string();
  page.run_s = rows.back().time_s;
  page.window_s = window_s;
  std::erase_if(
      rows, [&](const Sample& row) { return row.time_s <= stretch.from_s + 1e-6 || row.time_s > stretch.to_s + 1e-6; });
  page.rows = std::move(rows);
  if (!options.coverage.empty()) page.map = page_map(model, options.coverage, inputs.verbosity);
  std::ostringstream text;
  io::write_run_page(text, page);
  io::write_text_file(options.output, text.view());
  if (inputs.verbosity != Verbosity::quiet) tell_what_is_shown(page, options, text.view().size());
}

}  // namespace

void add_view_command(CLI::App& app) {
  CLI::App& command = add_command(app, "view", "write a page that plays one run, in any browser", R"(
  pirsim view --scene room.gltf --script study.yaml -o run.html                     the first trial
  pirsim view --scene room.gltf --script study.yaml --trial S8 --replicate 3 -o S8.html
  pirsim view --scene office.gltf --script week.yaml --from 09:00 --to 09:20        part of a day
  pirsim view --scene room.gltf --script study.yaml --coverage studyB.yaml          a coverage map on the floor
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<ViewOptions>();
  offer_study(command, *inputs);
  offer_tracer(command, *inputs);
  offer_seed(command, *inputs);
  offer_output(command, options->output, "FILE", "page, .html (default: run.html)");
  offer_run_choice(command, options->run);
  command
      .add_option("--from", options->from,
                  "where the page begins: seconds of the run, or a time of day such as 09:30 if it has a schedule "
                  "(default: the beginning; of runs over 1200 s the 1200 s with most motion)")
      ->option_text("TIME");
  command.add_option("--to", options->to, "where it ends (default: the end, 1200 s later at most)")
      ->option_text("TIME");
  command.add_option("--coverage", options->coverage, "a coverage study, YAML, whose map is laid on the floor")
      ->option_text("FILE");
  command
      .add_option("--keys-per-s", options->keys_per_s, "pictures a second, between which it interpolates (default: 10)")
      ->option_text("N")
      ->check(CLI::Range(0.1, 100.0));
  on_call(command, inputs, [options](const Inputs& given) { view(given, *options); });
}

}  // namespace pirsim::app
