#include "studies/placement.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/grouped_warnings.hpp"
#include "pirsim/look.hpp"
#include "pirsim/response.hpp"
#include "studies/light_rows.hpp"
#include "studies/placement_search.hpp"
#include "studies/sight.hpp"

namespace pirsim::studies {
namespace {

/// Share of the squares with motion in which two sensors or more see it.
double overlap_of(const CoverageMap& map) {
  std::size_t seen = 0, shared = 0;
  const std::size_t n_sensors = map.sensors.size();
  for (std::size_t at = 0; at < map.counts.size(); at += n_sensors) {
    const auto counts = map.counts.begin() + static_cast<std::ptrdiff_t>(at);
    const auto by =
        std::count_if(counts, counts + static_cast<std::ptrdiff_t>(n_sensors), [](auto n) { return n > 0; });
    seen += by > 0 ? 1 : 0;
    shared += by > 1 ? 1 : 0;
  }
  return seen == 0 ? 0.0 : static_cast<double>(shared) / static_cast<double>(seen);
}

/// Sensors of a map and of the counts at seats that see nothing.
std::vector<std::size_t> idle_of(const CoverageMap& map, const std::vector<std::vector<MotionCount>>& at_seats) {
  const std::size_t n_sensors = map.sensors.size();
  std::vector<std::size_t> idle;
  for (std::size_t sensor = 0; sensor < n_sensors; ++sensor) {
    bool sees = std::ranges::any_of(at_seats, [&](const auto& counts) { return counts[sensor] > 0; });
    for (std::size_t at = sensor; at < map.counts.size() && !sees; at += n_sensors) sees = map.counts[at] > 0;
    if (!sees) idle.push_back(sensor);
  }
  return idle;
}

}  // namespace

SceneSpec with_set(SceneSpec scene, const SensorSetSpec& set) {
  if (!set.sensors.empty()) scene.sensors = set.sensors;
  return scene;
}

CoverageStudy study_of(const SceneSpec& scene, const CoverageSpec& coverage, const SensorSetSpec& set) {
  return {with_set(scene, set), coverage};
}

std::vector<std::vector<MotionCount>> counts_at_seats(const CoverageStudy& study) {
  std::vector<std::vector<MotionCount>> counts;
  for (const SeatSpec& seat : study.scene().seats)
    counts.push_back(study.counts_at(floor_point(seat.world_from_seat.origin)));
  return counts;
}

std::vector<std::string> seats_without_target(const SceneSpec& scene,
                                              const std::vector<std::vector<MotionCount>>& counts) {
  std::vector<std::string> seats;
  for (std::size_t i = 0; i < scene.seats.size(); ++i) {
    if (std::ranges::all_of(counts[i], [](MotionCount n) { return n == 0; })) seats.push_back(scene.seats[i].id);
  }
  return seats;
}

PlacementScore score(const SceneSpec& scene, const CoverageSpec& coverage, SensorSetSpec set, unsigned threads) {
  const CoverageStudy study = study_of(scene, coverage, set);
  const CoverageMap map = run_coverage(study, threads);
  const MapFigures figures = figures_of(map).all;
  PlacementScore result{std::move(set), figures.seen_area_m2, figures.blind_fraction, overlap_of(map), {}, {}, {}};
  const auto at_seats = counts_at_seats(study);
  result.blind_seats = seats_without_target(scene, at_seats);
  result.idle = idle_of(map, at_seats);
  return result;
}

WorkReport watch_workers(const CoverageStudy& study, SeatsTried tried, unsigned threads) {
  const SurveyBase& survey = study.survey();
  return watch_sitters({survey.scene(), survey.sensing(), survey.array(), fastest_tracer, survey.seed()},
                       usual_worker(), threads, tried);
}

SeatsAtWork seats_at_work(const SceneSpec& scene, const PlacementSpec& spec, const SensorSetSpec& set,
                          unsigned threads) {
  const SeatsTried tried = spec.by == PlacementAim::seats ? SeatsTried::all : SeatsTried::some;
  return watch_workers(study_of(scene, spec.coverage, set), tried, threads).by_any();
}

std::vector<Issue> warnings(std::span<const PlacementScore> scores, const FloorArea& floor) {
  GroupedWarnings blind;
  for (const PlacementScore& score : scores) {
    for (const std::size_t i : score.idle) {
      if (i >= score.set.sensors.size()) continue;  // of the scene, which `check` judges
      const SensorSpec& sensor = score.set.sensors[i];
      const std::string outside = hangs_outside(floor, sensor.world_from_sensor.origin);
      const std::string name = "set '" + score.set.id + "': sensor '" + sensor.id + "'";
      blind.add(outside.empty() ? "astray" : "outside", i < score.set.where.size() ? score.set.where[i] : Where{}, name,
                name + " sees the target nowhere" + (outside.empty() ? " (does it look at a wall?)" : ": " + outside));
    }
  }
  Diagnostics remarks;
  blind.tell(remarks);
  return remarks.issues();
}

std::vector<PlacementScore> ranked(std::vector<PlacementScore> scores, PlacementAim by) {
  std::ranges::stable_sort(scores, [by](const PlacementScore& a, const PlacementScore& b) {
    if (by == PlacementAim::false_off) {
      const auto cost = [](const PlacementLight& light) {
        return std::tie(light.false_offs, light.dark_h, light.lit_empty_h);
      };
      if (cost(a.light) != cost(b.light)) return cost(a.light) < cost(b.light);
    }
    const SeatsAtWork &at_a = a.at_work, &at_b = b.at_work;
    if (by == PlacementAim::seats) {
      if (at_a.noticed.size() != at_b.noticed.size()) return at_a.noticed.size() > at_b.noticed.size();
      if (at_a.surely.size() != at_b.surely.size()) return at_a.surely.size() > at_b.surely.size();
    }
    if (a.seen_area_m2 != b.seen_area_m2) return a.seen_area_m2 > b.seen_area_m2;
    return a.blind_seats.size() < b.blind_seats.size();
  });
  return scores;
}

}  // namespace pirsim::studies

namespace pirsim {
namespace {

/// Models that the study names and the scene doesn't.
void add_models(SceneSpec& scene, const PlacementSpec& spec, const PlacementOptions& options) {
  for (const auto& [name, where] : spec.models) {
    if (!scene.sensor_models.contains(name))
      scene.sensor_models[name] = io::find_sensor_model(name, options.scene_file, options.scenes, where);
  }
}

/// Of the sensors of any set.
std::vector<Issue> idle_keys(const SceneSpec& scene, const PlacementSpec& spec) {
  SceneSpec hung;
  hung.sensors = scene.sensors;
  for (const SensorSetSpec& set : spec.sets) {
    hung.sensors.insert(hung.sensors.end(), set.sensors.begin(), set.sensors.end());
  }
  hung.sensor_models = scene.sensor_models;
  hung.files = scene.files;
  return idle_sensor_keys(hung, spec.coverage.sensing);
}

void require_seats(const SceneSpec& scene, const PlacementSpec& spec) {
  if (!scene.seats.empty()) return;
  Diagnostics faults;
  faults.error(spec.by_where, "by: seats: " + scene.name + " has no seat (by: area ranks by the floor that is seen)");
  faults.throw_if_errors();
}

/// In a run of the set's own, so that a run of the scene with these sensors gives the same rows.
void watch_light(const SceneSpec& scene, const PlacementSpec& spec, unsigned threads, PlacementScore& score,
                 std::vector<Issue>& warnings) {
  const studies::LightRows rows =
      studies::light_rows(studies::with_set(scene, score.set), *spec.light, spec.coverage.sensing, threads);
  studies::LightScore light = studies::score_light(rows, *spec.light);
  score.light = std::move(light.all);
  score.areas = std::move(light.areas);
  if (warnings.empty()) warnings = rows.warnings;  // of people, so the same for every set
}

/// What sensors notice together may differ from what they notice one by one: effects draw anew for each of a set.
void keep_the_better(PlacementSearch& search, PlacementAim by) {
  search.gained = studies::ranked({search.even, search.found}, by).front().set.id == search.found.set.id;
  if (search.gained) return;
  const std::string id = search.found.set.id;
  search.found = search.even;
  search.found.set.id = id;
}

}  // namespace

PlacementReport run_placements(SceneSpec scene, const PlacementSpec& spec, const PlacementOptions& options) {
  if (spec.by == PlacementAim::seats) require_seats(scene, spec);
  add_models(scene, spec, options);
  PlacementReport report;
  const auto set_done = options.set_done ? options.set_done : [] {};
  const auto watch_people = [&](PlacementScore& score) {
    score.at_work = studies::seats_at_work(scene, spec, score.set, options.threads);
    if (spec.light) watch_light(scene, spec, options.threads, score, report.warnings);
  };
  for (const SensorSetSpec& set : spec.sets) {
    report.ranked.push_back(studies::score(scene, spec.coverage, set, options.threads));
    watch_people(report.ranked.back());
    set_done();
  }
  const std::vector<Issue> blind = studies::warnings(report.ranked, scene.floor);
  report.warnings.insert(report.warnings.end(), blind.begin(), blind.end());
  const std::vector<Issue> idle = idle_keys(scene, spec);
  report.warnings.insert(report.warnings.end(), idle.begin(), idle.end());
  if (spec.search) {
    report.search = studies::search_placement(scene, spec, *spec.search, options.threads, set_done);
    PlacementSearch& search = *report.search;
    watch_people(search.even);
    watch_people(search.found);
    keep_the_better(search, spec.by);
    report.ranked.push_back(search.even);
    report.ranked.push_back(search.found);
  }
  report.ranked = studies::ranked(std::move(report.ranked), spec.by);
  report.text =
      studies::to_text(report.ranked, spec) + (report.search ? studies::to_text(*report.search, spec.by) : "");
  report.best = report.ranked.empty() ? std::move(scene) : studies::with_set(std::move(scene), report.ranked[0].set);
  return report;
}

}  // namespace pirsim
