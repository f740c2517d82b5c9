#include "studies/coverage.hpp"

#include <algorithm>
#include <cstdlib>
#include <iomanip>
#include <numeric>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/csv.hpp"
#include "studies/area_tally.hpp"

namespace pirsim::studies {
namespace {

/// Sums of the steps between neighbours.
struct Steps {
  long long sum = 0;
  std::size_t pairs = 0;
  int greatest = 0;

  void add(int a, int b) {
    const int step = std::abs(a - b);
    greatest = std::max(greatest, step);
    if (a == 0 || b == 0) return;
    sum += step;
    ++pairs;
  }
  void add(const Steps& other) {
    sum += other.sum;
    pairs += other.pairs;
    greatest = std::max(greatest, other.greatest);
  }
};

Steps steps_of(const CoverageMap& map, std::size_t sensor) {
  const FloorGrid& grid = map.grid;
  Steps steps;
  for (std::size_t row = 0; row < grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < grid.n_columns(); ++column) {
      if (!grid.on_floor(column, row)) continue;
      const int here = map.count(column, row, sensor);
      if (column > 0 && grid.on_floor(column - 1, row)) steps.add(map.count(column - 1, row, sensor), here);
      if (row > 0 && grid.on_floor(column, row - 1)) steps.add(map.count(column, row - 1, sensor), here);
    }
  }
  return steps;
}

/// Squares on the floor for which `seen(column, row)` holds.
template <typename Seen>
std::size_t count_squares(const FloorGrid& grid, Seen seen) {
  std::size_t count = 0;
  for (std::size_t row = 0; row < grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < grid.n_columns(); ++column) {
      if (grid.on_floor(column, row) && seen(column, row)) ++count;
    }
  }
  return count;
}

MapFigures figures(const Steps& steps, std::size_t seen, const FloorGrid& grid) {
  MapFigures result;
  result.pairs = steps.pairs;
  result.greatest_step = steps.greatest;
  if (steps.pairs > 0) result.mean_step = static_cast<double>(steps.sum) / static_cast<double>(steps.pairs);
  if (grid.n_squares() > 0) {
    result.blind_fraction = 1.0 - static_cast<double>(seen) / static_cast<double>(grid.n_squares());
  }
  result.seen_area_m2 = static_cast<double>(seen) * grid.spacing_m() * grid.spacing_m();
  return result;
}

}  // namespace

CoverageFigures figures_of(const CoverageMap& map) {
  CoverageFigures result;
  Steps all;
  for (std::size_t sensor = 0; sensor < map.sensors.size(); ++sensor) {
    const Steps steps = steps_of(map, sensor);
    all.add(steps);
    const std::size_t seen = count_squares(
        map.grid, [&](std::size_t column, std::size_t row) { return map.count(column, row, sensor) > 0; });
    result.sensors.push_back(figures(steps, seen, map.grid));
  }
  const std::size_t seen_by_any = count_squares(map.grid, [&](std::size_t column, std::size_t row) {
    for (std::size_t sensor = 0; sensor < map.sensors.size(); ++sensor) {
      if (map.count(column, row, sensor) > 0) return true;
    }
    return false;
  });
  result.all = figures(all, seen_by_any, map.grid);
  return result;
}

std::vector<AreaCoverage> area_figures_of(const CoverageMap& map, const SceneSpec& scene) {
  const Areas areas(scene);
  std::vector<AreaCoverage> figures;
  for (std::size_t area = 0; area < areas.size(); ++area) {
    const auto is_here = [&](std::size_t column, std::size_t row) {
      return areas.at(map.grid.centre(column, row)) == area;
    };
    const std::vector<std::size_t> its_own = areas.sensors_of(area);
    std::vector<std::size_t> all(map.sensors.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const auto blind_to = [&](const std::vector<std::size_t>& sensors) {
      return count_squares(map.grid, [&](std::size_t column, std::size_t row) {
        const auto sees = [&](std::size_t sensor) { return map.count(column, row, sensor) > 0; };
        return is_here(column, row) && std::ranges::none_of(sensors, sees);
      });
    };
    AreaCoverage& one = figures.emplace_back(AreaCoverage{with_sensors(scene, areas, area)});
    one.squares = count_squares(map.grid, is_here);
    if (one.squares == 0) continue;
    const auto n = static_cast<double>(one.squares);
    one.blind_fraction = static_cast<double>(blind_to(all)) / n;
    if (!its_own.empty()) one.blind_to_its_own = static_cast<double>(blind_to(its_own)) / n;
  }
  return figures;
}

std::string to_csv(const CoverageMap& map) {
  std::ostringstream out;
  out << "x_m,z_m";
  for (const std::string& sensor : map.sensors) out << ',' << io::csv_field(sensor);
  out << '\n' << std::fixed;
  for (std::size_t row = 0; row < map.grid.n_rows(); ++row) {
    for (std::size_t column = 0; column < map.grid.n_columns(); ++column) {
      if (!map.grid.on_floor(column, row)) continue;
      const Vec2 centre = map.grid.centre(column, row);
      out << std::setprecision(4) << centre.x << ',' << centre.y;
      for (std::size_t sensor = 0; sensor < map.sensors.size(); ++sensor) out << ',' << map.count(column, row, sensor);
      out << '\n';
    }
  }
  return out.str();
}

std::string to_text(const CoverageMap& map, const CoverageFigures& figures, const std::vector<AreaCoverage>& areas) {
  std::ostringstream out;
  const auto line = [&](const std::string& name, const MapFigures& f) {
    out << "  " << std::left << std::setw(10) << name << std::right << std::fixed << std::setprecision(2)
        << std::setw(9) << f.mean_step << std::setw(10) << f.greatest_step << std::setprecision(1) << std::setw(13)
        << 100.0 * f.blind_fraction << std::setprecision(2) << std::setw(12) << f.seen_area_m2 << '\n';
  };
  out << map.grid.n_squares() << " squares of " << map.grid.spacing_m() << " m, " << map.n_windows
      << " windows in each\n  sensor    mean step  greatest  not seen, %   seen, m2\n";
  for (std::size_t i = 0; i < map.sensors.size(); ++i) line(map.sensors[i], figures.sensors[i]);
  line("all", figures.all);
  if (!areas.empty()) out << "  not seen of each area by all sensors, and by its own:\n";
  for (const AreaCoverage& area : areas) {
    out << "    " << area.area << ": " << percent(area.blind_fraction, 1) << ", "
        << (area.blind_to_its_own ? percent(*area.blind_to_its_own, 1) : "no sensor") << '\n';
  }
  return out.str();
}

}  // namespace pirsim::studies
