#include "studies/placement.hpp"

#include <algorithm>
#include <exception>
#include <glm/geometric.hpp>
#include <iomanip>
#include <nlopt.hpp>
#include <sstream>
#include <utility>

#include "core/grouped_warnings.hpp"
#include "core/text.hpp"
#include "pirsim/look.hpp"
#include "pirsim/response.hpp"
#include "studies/coverage.hpp"
#include "studies/sight.hpp"
#include "studies/sitters.hpp"

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

/// The search as NLopt calls it.
struct Objective {
  const SceneSpec& scene;
  const CoverageSpec& coverage;
  const PlacementSearchSpec& search;
  unsigned threads;
  const std::function<void()>& set_done;
  int evaluations = 0;
  double best_area = -1.0;
  std::vector<double> best;
  std::exception_ptr fault{};  ///< which NLopt would replace by its own

  double area(const std::vector<double>& shares) {
    ++evaluations;
    set_done();
    const double seen = score(scene, coverage, sensors_along(search, shares, ""), threads).seen_area_m2;
    if (seen > best_area) {
      best_area = seen;
      best = shares;
    }
    return seen;
  }
};

void maximise(nlopt::algorithm algorithm, Objective& objective, int evaluations) {
  if (evaluations < 1) return;
  nlopt::opt optimiser(algorithm, static_cast<unsigned>(objective.search.n_sensors));
  optimiser.set_lower_bounds(0.0);
  optimiser.set_upper_bounds(1.0);
  optimiser.set_maxeval(evaluations);
  optimiser.set_xtol_abs(1e-3);
  optimiser.set_initial_step(0.1);
  optimiser.set_max_objective(
      [](const std::vector<double>& shares, std::vector<double>&, void* data) {
        auto& called = *static_cast<Objective*>(data);
        try {
          return called.area(shares);
        } catch (...) {
          called.fault = std::current_exception();
          throw nlopt::forced_stop();
        }
      },
      &objective);
  std::vector<double> shares = objective.best;
  double area = 0.0;
  try {
    optimiser.optimize(shares, area);
  } catch (const nlopt::roundoff_limited&) {
    // The best so far is kept: no further progress is possible.
  } catch (const nlopt::forced_stop&) {
    std::rethrow_exception(objective.fault);
  }
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

std::string listed(const std::vector<std::string>& names) { return names.empty() ? "none" : joined(names, " "); }

}  // namespace

namespace {

CoverageStudy study_of(SceneSpec scene, const CoverageSpec& coverage, const SensorSetSpec& set) {
  if (!set.sensors.empty()) scene.sensors = set.sensors;
  return {std::move(scene), coverage};
}

}  // namespace

PlacementScore score(const SceneSpec& scene, const CoverageSpec& coverage, SensorSetSpec set, unsigned threads) {
  const CoverageStudy study = study_of(scene, coverage, set);
  const CoverageMap map = run_coverage(study, threads);
  const MapFigures figures = figures_of(map).all;
  PlacementScore result{std::move(set), figures.seen_area_m2, figures.blind_fraction, overlap_of(map), {}, {}, {}};
  std::vector<std::vector<MotionCount>> at_seats;
  for (const SeatSpec& seat : scene.seats) {
    const auto& counts = at_seats.emplace_back(study.counts_at(floor_point(seat.world_from_seat.origin)));
    if (std::ranges::all_of(counts, [](MotionCount n) { return n == 0; })) result.blind_seats.push_back(seat.id);
  }
  result.idle = idle_of(map, at_seats);
  return result;
}

SeatsAtWork seats_at_work(const SceneSpec& scene, const CoverageSpec& coverage, const SensorSetSpec& set,
                          unsigned threads) {
  const CoverageStudy study = study_of(scene, coverage, set);
  const SurveyBase& survey = study.survey();
  return watch_sitters({survey.scene(), survey.sensing(), survey.array(), fastest_tracer, survey.seed()},
                       usual_worker(), threads)
      .by_any();
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

std::vector<PlacementScore> ranked(std::vector<PlacementScore> scores) {
  std::ranges::stable_sort(scores, [](const PlacementScore& a, const PlacementScore& b) {
    if (a.seen_area_m2 != b.seen_area_m2) return a.seen_area_m2 > b.seen_area_m2;
    return a.blind_seats.size() < b.blind_seats.size();
  });
  return scores;
}

SensorSetSpec sensors_along(const PlacementSearchSpec& search, const std::vector<double>& shares, std::string id) {
  double total = 0.0;
  for (const MountingLineSpec& line : search.lines) total += glm::distance(line.from, line.to);
  SensorSetSpec set{std::move(id), {}};
  for (const double share : shares) {
    double along = share * total;
    std::size_t i = 0;
    while (i + 1 < search.lines.size() && along > glm::distance(search.lines[i].from, search.lines[i].to)) {
      along -= glm::distance(search.lines[i].from, search.lines[i].to);
      ++i;
    }
    const MountingLineSpec& line = search.lines[i];
    const double length = glm::distance(line.from, line.to);
    const double part = length > 0.0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
    set.sensors.push_back({"PIR" + std::to_string(set.sensors.size() + 1), search.model,
                           mounted(line.from + part * (line.to - line.from), line.yaw_deg, line.tilt_deg)});
  }
  return set;
}

PlacementSearch search_placement(const SceneSpec& scene, const CoverageSpec& coverage,
                                 const PlacementSearchSpec& search, unsigned threads,
                                 const std::function<void()>& set_done) {
  std::vector<double> even;
  for (int i = 0; i < search.n_sensors; ++i) even.push_back((i + 0.5) / search.n_sensors);
  Objective objective{scene, coverage, search, threads, set_done, 0, -1.0, {}};
  static_cast<void>(objective.area(even));
  maximise(nlopt::GN_DIRECT_L, objective, search.evaluations * 2 / 3);
  maximise(nlopt::LN_SBPLX, objective, search.evaluations - objective.evaluations);
  return {score(scene, coverage, sensors_along(search, even, "even spacing"), threads),
          score(scene, coverage, sensors_along(search, objective.best, "found"), threads), objective.evaluations};
}

std::string to_text(const std::vector<PlacementScore>& scores) {
  std::ostringstream out;
  out << "                                       seats at work\n"
         "  rank  seen, m2  blind, %  overlap, %  noticed  deaf  unseen  set (blind seats; deaf to work in)\n"
      << std::fixed;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const PlacementScore& s = scores[i];
    out << std::setw(6) << i + 1 << std::setprecision(2) << std::setw(10) << s.seen_area_m2 << std::setprecision(1)
        << std::setw(10) << 100.0 * s.blind_fraction << std::setw(12) << 100.0 * s.overlap << std::setw(9)
        << s.at_work.noticed.size() << std::setw(6) << s.at_work.deaf.size() << std::setw(8) << s.at_work.unseen.size()
        << "  " << s.set.id << " (" << listed(s.blind_seats) << "; " << listed(s.at_work.deaf) << ")\n";
  }
  return out.str();
}

std::string to_text(const PlacementSearch& search) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << search.evaluations << " sets tried: " << search.found.seen_area_m2
      << " m2 found, " << search.found.seen_area_m2 - search.even.seen_area_m2 << " m2 more than even spacing ("
      << search.even.seen_area_m2 << " m2). Sensors at:\n";
  for (const SensorSpec& sensor : search.found.set.sensors) {
    const Vec3 p = sensor.world_from_sensor.origin;
    out << "  " << sensor.id << "  " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  }
  return out.str();
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

}  // namespace

PlacementReport run_placements(SceneSpec scene, const PlacementSpec& spec, const PlacementOptions& options) {
  add_models(scene, spec, options);
  PlacementReport report;
  const auto set_done = options.set_done ? options.set_done : [] {};
  for (const SensorSetSpec& set : spec.sets) {
    report.ranked.push_back(studies::score(scene, spec.coverage, set, options.threads));
    set_done();
  }
  report.warnings = studies::warnings(report.ranked, scene.floor);
  const std::vector<Issue> idle = idle_keys(scene, spec);
  report.warnings.insert(report.warnings.end(), idle.begin(), idle.end());
  if (spec.search) {
    report.search = studies::search_placement(scene, spec.coverage, *spec.search, options.threads, set_done);
    report.ranked.push_back(report.search->even);
    report.ranked.push_back(report.search->found);
  }
  report.ranked = studies::ranked(std::move(report.ranked));
  for (PlacementScore& score : report.ranked) {
    score.at_work = studies::seats_at_work(scene, spec.coverage, score.set, options.threads);
  }
  report.text = studies::to_text(report.ranked) + (report.search ? studies::to_text(*report.search) : "");
  return report;
}

}  // namespace pirsim
