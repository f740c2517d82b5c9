// The page that plays a run.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "geom/floor_distance.hpp"
#include "io/pages/run_page.hpp"
#include "pirsim/coverage.hpp"
#include "pirsim/look.hpp"
#include "pirsim/response.hpp"
#include "pirsim/study.hpp"
#include "pirsim/version.hpp"
#include "sim/compiled_study.hpp"
#include "studies/look.hpp"
#include "studies/run_film.hpp"

namespace pirsim {
namespace studies {
namespace {

/// Of a longer run a page shows a part, unless its user asks for more: it would be large and take long to load.
constexpr double longest_unasked_s = 1200.0;

struct Stretch {
  double from_s = 0.0, to_s = 0.0;
  double run_s = 0.0;  ///< of the whole run
};

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

bool wants_busiest(const PageRequest& request, double end_s) {
  return !request.from_s && !request.to_s && end_s > longest_unasked_s;
}

/// When the run ends, where that is known before it is simulated: at the end of a window.
std::optional<double> known_end_s(const Model& model, std::uint32_t run) {
  const auto& duration_s = model.compiled().trial_of(run).duration_s;
  if (!duration_s) return std::nullopt;
  const SensingInForce& sensing = model.compiled().sensing();
  const auto end_of = [&](std::int64_t window) {
    return static_cast<double>(window * sensing.ticks_per_window) / sensing.tick_rate_hz;
  };
  auto window = std::max<std::int64_t>(1, std::llround(std::floor(*duration_s / end_of(1))) - 1);
  while (end_of(window) < *duration_s) ++window;
  return end_of(window);
}

Stretch chosen_stretch(const PageRequest& request, const std::optional<RunClock>& clock, double end_s,
                       double window_s) {
  Stretch stretch{request.from_s.value_or(0.0), end_s};
  if (request.to_s) {
    stretch.to_s = std::min(end_s, *request.to_s);
    if (!request.from_s) stretch.from_s = std::max(0.0, stretch.to_s - longest_unasked_s);
  } else {
    stretch.to_s = std::min(end_s, stretch.from_s + longest_unasked_s);
  }
  if (!(stretch.from_s >= 0.0 && stretch.from_s < end_s))
    throw Error(ErrorCode::usage, "from: the run lasts from " + span_text(clock, 0.0, end_s));
  if (!(stretch.to_s > stretch.from_s)) {
    throw Error(ErrorCode::usage, "to: the page would begin at " + moment_text(clock, stretch.from_s) + " and end at " +
                                      moment_text(clock, stretch.to_s));
  }
  // Whole windows, so that rows and pictures begin together.
  stretch.from_s = std::floor(stretch.from_s / window_s + 1e-9) * window_s;
  stretch.to_s = std::min(end_s, std::ceil(stretch.to_s / window_s - 1e-9) * window_s);
  return stretch;
}

std::vector<io::PageSensor> page_sensors(const Model& model, Film& film) {
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
io::PageMap page_map(const SceneSpec& scene, const CoverageSpec& spec) {
  const CoverageMap map = run_coverage(scene, spec);
  const FloorGrid& grid = map.grid;
  io::PageMap page{spec.name,
                   grid.centre(0, 0) - 0.5 * Vec2(grid.spacing_m()),
                   scene.floor.height_m(),
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

io::RunPage run_page(const Model& model, const PageRequest& request, const Stretch& stretch) {
  std::vector<std::size_t> all_sensors(model.scene().sensors.size());
  std::iota(all_sensors.begin(), all_sensors.end(), 0);
  Film film =
      studies::film(model, request.run,
                    {stretch.from_s, stretch.to_s, request.keys_per_s, std::move(all_sensors), request.simulated});
  const auto or_else = [](const std::string& given, const std::string& own) { return given.empty() ? own : given; };
  io::RunPage page;
  page.title = model.script().name + ", " + model.trial_of(request.run);
  page.about = "trial " + model.trial_of(request.run) + ", replicate " +
               std::to_string(model.replicate_of(request.run)) + ", " + or_else(request.scene, model.scene().name) +
               ", " + or_else(request.script, model.script().name) +
               ", response of the sensors: " + responses_in_words(model.scene(), model.script().sensing);
  const TrialSpec& trial = model.script().trials[request.run % model.script().trials.size()];
  if (!trial.schedule && !trial.occupancy && !trial.people.empty()) page.first_person = trial.people.front().id;
  page.made_by = program();
  page.sensors = page_sensors(model, film);
  page.run = std::move(film.run);
  page.rows = std::move(film.rows);
  drop_absent_people(page.run);
  page.active_zones = std::move(film.active_zones);
  for (const SeatSpec& seat : model.compiled().scene().seats)
    page.seats.push_back({seat.id, seat.world_from_seat.origin});
  for (const EntranceSpec& door : model.compiled().scene().entrances)
    page.doors.push_back({door.id, door.world_from_entrance.origin});
  for (const AreaSpec& area : model.compiled().scene().areas) {
    const Vec2 middle = roomiest_point(area.outline);
    const double floor_y = model.compiled().scene().floor.height_m();
    page.areas.push_back({area.id, Vec3(middle.x, floor_y, middle.y), area.outline.loops()});
  }
  page.counted = model.areas();
  return page;
}

std::vector<Sample> rows_of(const Model& model, const PageRequest& request) {
  const double window_s = model.tick_s() * model.compiled().sensing().ticks_per_window;
  StudyOptions study;
  study.threads = 1;
  study.runs = RunRange{request.run, request.run + 1};
  if (request.simulated) study.window_done = [&] { request.simulated(window_s); };
  std::vector<Sample> rows;
  run_study(model, study, [&](const RunResult& result) {
    if (result.fault) throw Error(ErrorCode::infeasible, result.fault->message);
    rows = result.samples;
  });
  return rows;
}

/// A whole run is simulated beforehand only where that tells what to show.
Stretch find_stretch(const Model& model, const PageRequest& request, double window_s) {
  const std::optional<double> known_s = known_end_s(model, request.run);
  std::vector<Sample> rows;
  if (!known_s || wants_busiest(request, *known_s)) rows = rows_of(model, request);
  const double end_s = known_s ? *known_s : rows.back().time_s;
  Stretch stretch = wants_busiest(request, end_s)
                        ? busiest(rows, window_s)
                        : chosen_stretch(request, model.compiled().clock_of(request.run), end_s, window_s);
  stretch.run_s = end_s;
  return stretch;
}

}  // namespace
}  // namespace studies

Page page_of(const Model& model, const PageRequest& request) {
  using namespace studies;
  require_run(model, request.run);
  require("keys_per_s", request.keys_per_s, {.min = 0.1, .max = 100.0});
  const double window_s = model.tick_s() * model.compiled().sensing().ticks_per_window;
  const Stretch stretch = find_stretch(model, request, window_s);
  io::RunPage page = run_page(model, request, stretch);
  page.run_s = stretch.run_s;
  page.window_s = window_s;
  if (request.coverage) page.map = page_map(model.compiled().scene(), *request.coverage);
  std::ostringstream text;
  io::write_run_page(text, page);
  const auto& keys = page.run.key_times_s;
  const bool is_busiest_part = page.run_s > longest_unasked_s && !request.from_s && !request.to_s;
  return {std::move(text).str(), page.about, keys.front(), keys.back(), page.run_s, is_busiest_part};
}

}  // namespace pirsim
