#include "surveys/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <glm/geometric.hpp>
#include <nlopt.hpp>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/rt/room.hpp"
#include "model/core/error.hpp"
#include "model/schema/check_scene.hpp"
#include "model/schema/words.hpp"
#include "pirsim/look.hpp"
#include "pirsim/model.hpp"
#include "pirsim/response.hpp"
#include "pirsim/study.hpp"
#include "surveys/coverage.hpp"
#include "surveys/sight.hpp"

namespace pirsim::studies {
namespace {

constexpr std::size_t word_bits = 64;

void set_bit(RowBits& bits, std::size_t row) { bits[row / word_bits] |= std::uint64_t{1} << (row % word_bits); }

/// Without areas all people are in the only one.
LightRun run_of(const RunResult& result, const std::vector<std::string>& areas, std::size_t n_sensors) {
  LightRun run;
  run.n_rows = result.samples.size();
  const RowBits nothing((run.n_rows + word_bits - 1) / word_bits, 0);
  run.occupied.assign(areas.size(), nothing);
  run.moved.assign(n_sensors, nothing);
  for (std::size_t row = 0; row < run.n_rows; ++row) {
    const Sample& sample = result.samples[row];
    for (std::size_t area = 0; area < areas.size(); ++area) {
      const int people = sample.people_of_areas.empty() ? sample.people : sample.people_of_areas[area];
      if (people > 0 && !sleep_all(sample.phase, areas[area])) set_bit(run.occupied[area], row);
    }
    for (std::size_t sensor = 0; sensor < n_sensors; ++sensor) {
      if (sample.bits[sensor] == 1) set_bit(run.moved[sensor], row);
    }
  }
  return run;
}

/// What people do about the dark belongs to the aim, not to a rule of its own.
control::SwitchRule rule_of(const PlacementLightSpec& light, double window_s) {
  control::LightSpec spec;
  spec.wave_s = light.wave_s;
  return {spec, window_s};
}

/// Row by row through the switch; words in which nothing happens in the dark are passed over.
void switch_run(const RowBits& occupied, const RowBits& moved, std::size_t n_rows, const control::SwitchRule& rule,
                std::int64_t delay_rows, LightSums& sums) {
  control::LightSwitch light;
  for (std::size_t word = 0; word < occupied.size(); ++word) {
    const std::size_t first = word * word_bits, n = std::min(word_bits, n_rows - first);
    if (!light.is_lit() && occupied[word] == 0 && moved[word] == 0) {
      light.rest(static_cast<std::int64_t>(n));
      continue;
    }
    for (std::size_t bit = 0; bit < n; ++bit) {
      const control::Cue cue{(moved[word] >> bit & 1U) != 0, (occupied[word] >> bit & 1U) != 0, false};
      const bool was_lit = light.is_lit();
      light.advance(rule, cue, delay_rows);
      sums.occupied += cue.occupied ? 1 : 0;
      if (light.is_lit()) {
        sums.lit_empty += cue.occupied ? 0 : 1;
      } else if (cue.occupied) {
        ++sums.dark;
        sums.false_offs += was_lit ? 1 : 0;
      }
    }
  }
}

PlacementLight told(const LightSums& sums, double window_s) {
  const double row_h = window_s / 3600.0;
  PlacementLight light;
  light.occupied_h = static_cast<double>(sums.occupied) * row_h;
  light.false_offs = sums.false_offs;
  light.dark_h = static_cast<double>(sums.dark) * row_h;
  light.lit_empty_h = static_cast<double>(sums.lit_empty) * row_h;
  return light;
}

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

/// (n_things)
std::vector<bool> covered_by(const Cover& cover, const Chosen& chosen) {
  std::vector<bool> is_covered(cover.worth.size());
  for (const std::size_t candidate : chosen) {
    for (const std::uint32_t thing : cover.covered[candidate]) is_covered[thing] = true;
  }
  return is_covered;
}

/// The search as NLopt calls it.
struct Objective {
  const SceneSpec& scene;
  const CoverageSpec& coverage;
  const PlacementSearchSpec& search;
  unsigned threads;
  const Tried& tried;
  int evaluations = 0;
  double best_area = -1.0;
  std::vector<double> best;
  std::exception_ptr fault{};  ///< which NLopt would replace by its own

  double area(const std::vector<double>& shares) {
    ++evaluations;
    tried();
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

std::vector<double> even_shares(int n) {
  std::vector<double> shares;
  for (int i = 0; i < n; ++i) shares.push_back((i + 0.5) / n);
  return shares;
}

/// No number of squares is worth a seat that is surely noticed, and no number of these a seat that is noticed.
std::vector<std::uint64_t> worth(std::size_t n_seats, std::size_t n_squares) {
  const std::uint64_t surely = n_squares + 1, noticed = (n_seats + 1) * surely;
  std::vector<std::uint64_t> worth(n_seats, noticed);
  worth.resize(2 * n_seats, surely);
  worth.resize(2 * n_seats + n_squares, 1);
  return worth;
}

/// Adds what the sensors from `first` on notice.
void add_noticed(Cover& cover, std::size_t first, const WorkReport& work, const CoverageMap& map) {
  const std::size_t n_sensors = map.sensors.size();
  for (std::size_t sensor = 0; sensor < n_sensors; ++sensor) {
    std::vector<std::uint32_t>& covered = cover.covered[first + sensor];
    std::uint32_t thing = 0;
    for (std::size_t seat = 0; seat < work.seats.size(); ++seat, ++thing) {
      if (work.notice(seat, sensor).seconds > 0) covered.push_back(thing);
    }
    for (std::size_t seat = 0; seat < work.seats.size(); ++seat, ++thing) {
      if (work.notice(seat, sensor).is_sure()) covered.push_back(thing);
    }
    for (std::size_t at = sensor; at < map.counts.size(); at += n_sensors, ++thing) {
      if (map.counts[at] > 0) covered.push_back(thing);
    }
  }
  cover.worth = worth(work.seats.size(), map.counts.size() / n_sensors);
}

/// Even spacing and what was found, judged.
PlacementSearch judged(const SceneSpec& scene, const CoverageSpec& coverage, const PlacementSearchSpec& search,
                       const std::vector<double>& found, int evaluations, unsigned threads) {
  const std::vector<double> even = even_shares(search.n_sensors);
  return {score(scene, coverage, sensors_along(search, even, "even spacing"), threads),
          score(scene, coverage, sensors_along(search, found, "found"), threads), evaluations};
}

PlacementSearch search_by_area(const SceneSpec& scene, const CoverageSpec& coverage, const PlacementSearchSpec& search,
                               unsigned threads, const Tried& tried) {
  Objective objective{scene, coverage, search, threads, tried, 0, -1.0, {}};
  static_cast<void>(objective.area(even_shares(search.n_sensors)));
  maximise(nlopt::GN_DIRECT_L, objective, search.evaluations * 2 / 3);
  maximise(nlopt::LN_SBPLX, objective, search.evaluations - objective.evaluations);
  return judged(scene, coverage, search, objective.best, objective.evaluations, threads);
}

/// All places hang in one room at once: the people are simulated once, and each place has its own column of motion.
Chosen best_by_light(const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search,
                     const std::vector<double>& shares, const Chosen& start, unsigned threads, const Tried& tried) {
  std::size_t n_told = 0;
  const auto tell = [&](std::size_t n_done, std::size_t n_runs) {
    for (; n_told < (shares.size() - start.size()) * n_done / n_runs; ++n_told) tried();
  };
  const LightRows rows =
      light_rows(with_set(scene, sensors_along(search, shares, "")), *spec.light, spec.coverage.sensing, threads, tell);
  LightSearch by_light(rows, *spec.light);
  return best_of(by_light, start);
}

/// Chooses among single places, of which the first are those of even spacing.
PlacementSearch search_among_places(const SceneSpec& scene, const PlacementSpec& spec,
                                    const PlacementSearchSpec& search, unsigned threads, const Tried& tried) {
  std::vector<double> shares = even_shares(search.n_sensors);
  Chosen chosen(shares.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  const std::vector<double> places = even_shares(search.evaluations);
  shares.insert(shares.end(), places.begin(), places.end());
  if (spec.by == PlacementAim::seats) {
    const Cover cover = cover_of(scene, spec, search, shares, threads, tried);
    chosen = best_of(cover, chosen);
  } else {
    chosen = best_by_light(scene, spec, search, shares, chosen, threads, tried);
  }
  std::vector<double> found;
  for (const std::size_t i : chosen) found.push_back(shares[i]);
  std::ranges::sort(found);
  return judged(scene, spec.coverage, search, found, search.evaluations, threads);
}

}  // namespace

LightRows light_rows(const SceneSpec& scene, const PlacementLightSpec& light, const SensingSpec& sensing,
                     unsigned threads, const RunsDone& done) {
  ScriptSpec script = light.people;
  if (sensing.response) script.sensing.response = sensing.response;
  const Model model = compile(scene, std::move(script));
  const Areas areas(scene);
  LightRows rows;
  rows.window_s = static_cast<double>(model.script().sensing.ticks_per_window) / model.script().sensing.tick_rate_hz;
  rows.areas = areas.empty() ? std::vector<std::string>{""} : areas.names();
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    rows.sensors.push_back(scene.sensors[i].id);
    rows.area_of.push_back(areas.empty() ? std::optional<std::size_t>(0) : areas.of_sensors()[i]);
  }
  std::size_t n_done = 0;
  run_study(model, {.threads = threads}, [&](const RunResult& result) {
    if (result.fault) {
      rows.warnings.push_back({Severity::warning,
                               {scene.name},
                               "the light's people: run " + std::to_string(result.replicate) + " of trial '" +
                                   result.trial + "' can't go on, and is left out: " + result.fault->message});
    } else {
      rows.runs.push_back(run_of(result, rows.areas, rows.sensors.size()));
    }
    done(++n_done, model.n_runs());
  });
  return rows;
}

LightSums& LightSums::operator+=(const LightSums& other) noexcept {
  occupied += other.occupied;
  false_offs += other.false_offs;
  dark += other.dark;
  lit_empty += other.lit_empty;
  return *this;
}

bool LightSums::better_than(const LightSums& other) const noexcept {
  return std::tie(false_offs, dark, lit_empty) < std::tie(other.false_offs, other.dark, other.lit_empty);
}

LightSums switch_light(const LightRows& rows, std::size_t area, std::span<const std::size_t> sensors,
                       const PlacementLightSpec& light) {
  const control::SwitchRule rule = rule_of(light, rows.window_s);
  const std::int64_t delay_rows = std::llround(60.0 * light.delay_min / rows.window_s);
  LightSums sums;
  RowBits moved;
  for (const LightRun& run : rows.runs) {
    moved.assign(run.occupied[area].size(), 0);
    for (const std::size_t sensor : sensors) {
      for (std::size_t word = 0; word < moved.size(); ++word) moved[word] |= run.moved[sensor][word];
    }
    switch_run(run.occupied[area], moved, run.n_rows, rule, delay_rows, sums);
  }
  return sums;
}

LightScore score_light(const LightRows& rows, const PlacementLightSpec& light) {
  LightScore score;
  LightSums all;
  for (std::size_t area = 0; area < rows.areas.size(); ++area) {
    std::vector<std::size_t> sensors;
    for (std::size_t i = 0; i < rows.sensors.size(); ++i) {
      if (rows.area_of[i] == area) sensors.push_back(i);
    }
    const LightSums sums = switch_light(rows, area, sensors, light);
    all += sums;
    PlacementLight of_area = told(sums, rows.window_s);
    of_area.area = rows.areas[area];
    for (const std::size_t sensor : sensors) of_area.sensors.push_back(rows.sensors[sensor]);
    if (sums.occupied > 0 || !sensors.empty()) score.areas.push_back(std::move(of_area));
  }
  score.all = told(all, rows.window_s);
  score.all.sensors = rows.sensors;
  return score;
}

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
  return watch_sitters({survey.scene(), survey.sensing(), survey.array(), fastest_tracer}, usual_worker(), threads,
                       tried);
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

std::uint64_t Cover::worth_of(const Chosen& chosen) const {
  const std::vector<bool> is_covered = covered_by(*this, chosen);
  return std::inner_product(is_covered.begin(), is_covered.end(), worth.begin(), std::uint64_t{0});
}

std::size_t Cover::best_addition(const Chosen& chosen) const {
  const std::vector<bool> is_covered = covered_by(*this, chosen);
  std::vector<std::uint64_t> gains;  // 0: is chosen; else by 1 more
  for (std::size_t candidate = 0; candidate < covered.size(); ++candidate) {
    const bool is_chosen = std::ranges::find(chosen, candidate) != chosen.end();
    std::uint64_t& gain = gains.emplace_back(is_chosen ? 0 : 1);
    for (std::size_t i = 0; i < covered[candidate].size() && !is_chosen; ++i) {
      const std::uint32_t thing = covered[candidate][i];
      gain += is_covered[thing] ? 0 : worth[thing];
    }
  }
  return static_cast<std::size_t>(std::ranges::max_element(gains) - gains.begin());
}

const LightSums& LightSearch::of_area(std::size_t area, const Chosen& chosen) {
  Chosen own;
  std::ranges::copy_if(chosen, std::back_inserter(own), [&](std::size_t i) { return rows_.area_of[i] == area; });
  std::ranges::sort(own);
  const auto known = known_[area].find(own);
  if (known != known_[area].end()) return known->second;
  const LightSums sums = switch_light(rows_, area, own, light_);
  return known_[area].emplace(std::move(own), sums).first->second;
}

LightSums LightSearch::of(const Chosen& chosen) {
  LightSums sums;
  for (std::size_t area = 0; area < rows_.areas.size(); ++area) sums += of_area(area, chosen);
  return sums;
}

std::size_t LightSearch::best_addition(const Chosen& chosen) {
  std::size_t best = rows_.sensors.size();
  LightSums least;
  Chosen with_one = chosen;
  with_one.push_back(0);
  for (std::size_t i = 0; i < rows_.sensors.size(); ++i) {
    if (std::ranges::find(chosen, i) != chosen.end()) continue;
    with_one.back() = i;
    const LightSums sums = of(with_one);
    if (best < rows_.sensors.size() && !sums.better_than(least)) continue;
    best = i;
    least = sums;
  }
  return best;
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

namespace {

struct PlaceInArea {
  std::size_t area;
  SensorSpec sensor;
};

/// Corners that point outwards, a hand off their walls, and the ceiling's middle.
std::vector<PlaceInArea> places_in_areas(const SceneSpec& scene, const std::vector<std::string>& models) {
  constexpr double off_corner_m = 0.1;  // assumed (0.06-0.15): outlines reach to the middle of walls
  constexpr double corner_height_m = 2.2, tilt_deg = 20.0, below_ceiling_m = 0.02, highest_ceiling_m = 20.0;
  const rt::Room room(scene.meshes);
  const double floor_y = scene.floor.height_m();
  std::vector<PlaceInArea> places;
  const auto add = [&](std::size_t area, const Vec3& at, double yaw_deg, double tilt) {
    for (const std::string& model : models)
      places.push_back(
          {area, {"PIR_" + scene.areas[area].id, model, mounted(at, yaw_deg, tilt), 1.0, scene.areas[area].id}});
  };
  for (std::size_t area = 0; area < scene.areas.size(); ++area) {
    const FloorArea& outline = scene.areas[area].outline;
    for (const std::vector<Vec2>& loop : outline.loops()) {
      const Vec2 middle = std::accumulate(loop.begin(), loop.end(), Vec2(0.0)) / static_cast<double>(loop.size());
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec2 &before = loop[(i + loop.size() - 1) % loop.size()], &after = loop[(i + 1) % loop.size()];
        const Vec2 at = loop[i] + off_corner_m * (glm::normalize(before - loop[i]) + glm::normalize(after - loop[i]));
        if (outline.contains(at))
          add(area, Vec3(at.x, floor_y + corner_height_m, at.y), degrees(heading_of(middle - at)), tilt_deg);
      }
      const Vec3f low(static_cast<float>(middle.x), static_cast<float>(floor_y + corner_height_m),
                      static_cast<float>(middle.y));
      const auto ceiling = room.first_hit({low, Vec3f(0, 1, 0)}, static_cast<float>(highest_ceiling_m));
      if (!ceiling || !outline.contains(middle)) continue;
      const double height = floor_y + corner_height_m + static_cast<double>(ceiling->distance) - below_ceiling_m;
      add(area, Vec3(middle.x, height, middle.y), 0.0, 90.0);
    }
  }
  return places;
}

/// Of seats and places, and of the floor's squares, those in an area that a sensor notices. The first of them count
/// most.
using NoticedInArea = std::array<std::size_t, 3>;

}  // namespace

SensorSetSpec best_in_each_area(const SceneSpec& scene, const PlacementSpec& spec,
                                const std::vector<std::string>& models, unsigned threads, const Tried& tried) {
  constexpr std::size_t at_once = 16;
  if (scene.areas.empty()) throw Error(ErrorCode::input, Where{scene.name}, "one sensor in each area: it has no areas");
  const Areas areas(scene);
  std::map<std::string, std::size_t> area_of;
  for (const SeatSpec& seat : scene.seats) area_of[seat.id] = areas.at(floor_point(seat.world_from_seat.origin));
  for (const PlaceSpec& place : scene.places) area_of[place.id] = areas.at(floor_point(place.world_from_place.origin));
  const std::vector<PlaceInArea> places = places_in_areas(scene, models);
  std::vector<std::pair<NoticedInArea, std::optional<std::size_t>>> best(scene.areas.size());
  for (std::size_t first = 0; first < places.size(); first += at_once) {
    SensorSetSpec set;
    for (std::size_t i = first; i < std::min(first + at_once, places.size()); ++i)
      set.sensors.push_back(places[i].sensor);
    for (std::size_t i = 0; i < set.sensors.size(); ++i) set.sensors[i].id += '_' + std::to_string(i);
    const CoverageStudy study = study_of(scene, spec.coverage, set);
    const CoverageMap map = run_coverage(study, threads);
    const WorkReport work =
        spec.by == PlacementAim::seats ? watch_workers(study, SeatsTried::all, threads) : WorkReport{};
    for (std::size_t i = 0; i < set.sensors.size(); ++i) {
      const std::size_t area = places[first + i].area;
      NoticedInArea noticed{};
      for (std::size_t seat = 0; seat < work.seats.size(); ++seat) {
        if (area_of.at(work.seats[seat]) != area) continue;
        noticed[0] += work.notice(seat, i).seconds > 0 ? 1 : 0;
        noticed[1] += work.notice(seat, i).is_sure() ? 1 : 0;
      }
      for (std::size_t row = 0; row < map.grid.n_rows(); ++row) {
        for (std::size_t column = 0; column < map.grid.n_columns(); ++column)
          if (map.count(column, row, i) > 0 && areas.at(map.grid.centre(column, row)) == area) ++noticed[2];
      }
      if (!best[area].second || noticed > best[area].first) best[area] = {noticed, first + i};
      tried();
    }
  }
  SensorSetSpec set{"one in each area", {}};
  for (const auto& [noticed, which] : best)
    if (which) set.sensors.push_back(places[*which].sensor);
  return set;
}

Cover cover_of(const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search,
               const std::vector<double>& shares, unsigned threads, const Tried& tried) {
  constexpr std::size_t at_once = 16;  // sensors: they share the sitter's movements, and memory stays small
  const std::vector<SensorSpec> places = sensors_along(search, shares, "").sensors;
  Cover cover;
  cover.covered.resize(places.size());
  for (std::size_t first = 0; first < places.size(); first += at_once) {
    const std::size_t end = std::min(first + at_once, places.size());
    SensorSetSpec set{
        "", {places.begin() + static_cast<std::ptrdiff_t>(first), places.begin() + static_cast<std::ptrdiff_t>(end)}};
    const CoverageStudy study = study_of(scene, spec.coverage, set);
    add_noticed(cover, first, watch_workers(study, SeatsTried::all, threads), run_coverage(study, threads));
    for (std::size_t i = first; i < end; ++i) tried();
  }
  return cover;
}

PlacementSearch search_placement(const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search,
                                 unsigned threads, const Tried& tried) {
  if (spec.by == PlacementAim::area) return search_by_area(scene, spec.coverage, search, threads, tried);
  return search_among_places(scene, spec, search, threads, tried);
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
  if (!scene.seats.empty() || !scene.places.empty()) return;
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
  refuse_arrays(scene, "placements");
  add_models(scene, spec, options);
  for (const std::string& model : options.each_area) {
    if (!scene.sensor_models.contains(model))
      scene.sensor_models[model] = io::find_sensor_model(model, options.scene_file, options.scenes, {});
  }
  for (const auto& [name, model] : scene.sensor_models) {
    if (model.array)
      throw Error(ErrorCode::input, Where{scene.name},
                  "placements works on rows of motion, which a thermal array ('" + name + "') doesn't give");
  }
  PlacementReport report;
  const auto set_done = options.set_done ? options.set_done : [] {};
  const auto watch_people = [&](PlacementScore& score) {
    score.at_work = studies::seats_at_work(scene, spec, score.set, options.threads);
    if (spec.light) watch_light(scene, spec, options.threads, score, report.warnings);
  };
  std::vector<SensorSetSpec> sets = spec.sets;
  if (!options.each_area.empty())
    sets.push_back(studies::best_in_each_area(scene, spec, options.each_area, options.threads, set_done));
  for (const SensorSetSpec& set : sets) {
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
  if (!options.each_area.empty()) report.text += studies::to_text(sets.back());
  report.best = report.ranked.empty() ? std::move(scene) : studies::with_set(std::move(scene), report.ranked[0].set);
  return report;
}

}  // namespace pirsim
