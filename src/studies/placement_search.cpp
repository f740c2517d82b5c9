#include "studies/placement_search.hpp"

#include <algorithm>
#include <exception>
#include <glm/geometric.hpp>
#include <nlopt.hpp>
#include <numeric>
#include <utility>

#include "studies/coverage.hpp"
#include "studies/light_search.hpp"
#include "studies/placement.hpp"
#include "studies/sitters.hpp"

namespace pirsim::studies {
namespace {

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

std::vector<double> found_by_seats(const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search,
                                   const std::vector<double>& even, unsigned threads, const Tried& tried) {
  std::vector<double> shares = even;
  const std::vector<double> places = even_shares(search.evaluations);
  shares.insert(shares.end(), places.begin(), places.end());
  std::vector<std::size_t> start(even.size());
  std::iota(start.begin(), start.end(), std::size_t{0});
  std::vector<double> found;
  for (const std::size_t i : best_cover(cover_of(scene, spec, search, shares, threads, tried), start)) {
    found.push_back(shares[i]);
  }
  std::ranges::sort(found);
  return found;
}

PlacementSearch search_by_area(const SceneSpec& scene, const CoverageSpec& coverage, const PlacementSearchSpec& search,
                               unsigned threads, const Tried& tried) {
  const std::vector<double> even = even_shares(search.n_sensors);
  Objective objective{scene, coverage, search, threads, tried, 0, -1.0, {}};
  static_cast<void>(objective.area(even));
  maximise(nlopt::GN_DIRECT_L, objective, search.evaluations * 2 / 3);
  maximise(nlopt::LN_SBPLX, objective, search.evaluations - objective.evaluations);
  return {score(scene, coverage, sensors_along(search, even, "even spacing"), threads),
          score(scene, coverage, sensors_along(search, objective.best, "found"), threads), objective.evaluations};
}

PlacementSearch search_by_seats(const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search,
                                unsigned threads, const Tried& tried) {
  const std::vector<double> even = even_shares(search.n_sensors);
  const std::vector<double> found = found_by_seats(scene, spec, search, even, threads, tried);
  return {score(scene, spec.coverage, sensors_along(search, even, "even spacing"), threads),
          score(scene, spec.coverage, sensors_along(search, found, "found"), threads), search.evaluations};
}

/// All places hang in one room at once: the people are simulated once, and each place has its own column of motion.
std::vector<double> found_by_light(const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search,
                                   const std::vector<double>& even, unsigned threads, const Tried& tried) {
  std::vector<double> shares = even;
  const std::vector<double> places = even_shares(search.evaluations);
  shares.insert(shares.end(), places.begin(), places.end());
  std::size_t n_told = 0;
  const auto tell = [&](std::size_t n_done, std::size_t n_runs) {
    for (; n_told < places.size() * n_done / n_runs; ++n_told) tried();
  };
  const LightRows rows =
      light_rows(with_set(scene, sensors_along(search, shares, "")), *spec.light, spec.coverage.sensing, threads, tell);
  std::vector<std::size_t> start(even.size());
  std::iota(start.begin(), start.end(), std::size_t{0});
  std::vector<double> found;
  for (const std::size_t i : LightSearch(rows, *spec.light).best(start)) found.push_back(shares[i]);
  std::ranges::sort(found);
  return found;
}

PlacementSearch search_by_light(const SceneSpec& scene, const PlacementSpec& spec, const PlacementSearchSpec& search,
                                unsigned threads, const Tried& tried) {
  const std::vector<double> even = even_shares(search.n_sensors);
  const std::vector<double> found = found_by_light(scene, spec, search, even, threads, tried);
  return {score(scene, spec.coverage, sensors_along(search, even, "even spacing"), threads),
          score(scene, spec.coverage, sensors_along(search, found, "found"), threads), search.evaluations};
}

}  // namespace

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
  switch (spec.by) {
    case PlacementAim::area:
      return search_by_area(scene, spec.coverage, search, threads, tried);
    case PlacementAim::seats:
      return search_by_seats(scene, spec, search, threads, tried);
    case PlacementAim::false_off:
      return search_by_light(scene, spec, search, threads, tried);
  }
  throw Error(ErrorCode::internal, "unknown aim of a placement search");
}

}  // namespace pirsim::studies
