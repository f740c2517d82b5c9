#include "studies/coverage_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace pirsim::studies {
namespace {

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

/// Rectangles around what was taken out, one for each name.
std::vector<std::vector<Vec2>> places_of(const CoverageStudy& study) {
  std::vector<std::vector<Vec2>> rectangles;
  for (const std::string& name : study.spec().without) {
    Vec2 lower(1e9), upper(-1e9);
    for (const TriMesh& mesh : study.taken_out()) {
      if (!mesh.name.starts_with(name)) continue;
      for (const Vec3& p : mesh.positions) {
        lower = glm::min(lower, floor_point(p));
        upper = glm::max(upper, floor_point(p));
      }
    }
    if (lower.x <= upper.x) rectangles.push_back({lower, {upper.x, lower.y}, upper, {lower.x, upper.y}});
  }
  return rectangles;
}

/// A page can't draw a million squares: blocks of them are shown by their mean.
std::size_t squares_per_block_side(const FloorGrid& grid) {
  constexpr double most_drawn = 60000;
  return static_cast<std::size_t>(
      std::ceil(std::sqrt(static_cast<double>(grid.n_columns() * grid.n_rows()) / most_drawn)));
}

std::optional<double> block_mean(const CoverageMap& map, std::size_t sensor, std::size_t column, std::size_t row,
                                 std::size_t side) {
  double sum = 0.0;
  int squares = 0;
  for (std::size_t r = row; r < std::min(row + side, map.grid.n_rows()); ++r) {
    for (std::size_t c = column; c < std::min(column + side, map.grid.n_columns()); ++c) {
      if (!map.grid.on_floor(c, r)) continue;
      sum += map.count(c, r, sensor);
      ++squares;
    }
  }
  if (squares == 0) return std::nullopt;
  return sum / squares;
}

std::vector<std::string> row_of(const std::string& name, const MapFigures& f) {
  return {name, fixed(f.mean_step, 1), std::to_string(f.greatest_step), fixed(100.0 * f.blind_fraction, 1) + " %",
          fixed(f.seen_area_m2, 2)};
}

}  // namespace

io::MapChart map_chart(const CoverageStudy& study, const CoverageMap& map, std::size_t sensor) {
  const FloorGrid& grid = map.grid;
  const std::size_t side = squares_per_block_side(grid);
  const SensorSpec& spec = study.scene().sensors[sensor];
  io::MapChart chart;
  chart.title = spec.id;
  chart.label = "motion, s";
  const double window_s =
      static_cast<double>(study.spec().sensing.ticks_per_window) / study.spec().sensing.tick_rate_hz;
  if (window_s != 1.0) chart.label = "windows";
  chart.unit = (window_s == 1.0 ? "s of " : "windows of ") + std::to_string(map.n_windows) + " with motion";
  chart.lower = grid.centre(0, 0) - 0.5 * Vec2(grid.spacing_m());
  chart.spacing_m = grid.spacing_m() * static_cast<double>(side);
  chart.columns = static_cast<int>((grid.n_columns() + side - 1) / side);
  chart.rows = static_cast<int>((grid.n_rows() + side - 1) / side);
  for (std::size_t row = 0; row < grid.n_rows(); row += side) {
    for (std::size_t column = 0; column < grid.n_columns(); column += side) {
      chart.values.push_back(block_mean(map, sensor, column, row, side));
    }
  }
  chart.max = map.n_windows;
  chart.outline = study.scene().floor.loops();
  chart.dashed = places_of(study);
  chart.markers = {{spec.id, floor_point(spec.world_from_sensor.origin), heading_of(spec.world_from_sensor)}};
  return chart;
}

io::Report coverage_report(const CoverageStudy& study, const CoverageMap& map, const CoverageFigures& figures) {
  io::Report report;
  report.title = study.spec().name + ": where each sensor sees motion";
  report.paragraphs = {"A moving target stood for " + fixed(study.spec().duration_s, 0) + " s in every square of " +
                           fixed(100.0 * map.grid.spacing_m(), 0) + " cm of the floor of " + study.scene().name + " (" +
                           std::to_string(map.grid.n_squares()) +
                           " squares). The maps, seen from above, tell for each sensor in how many "
                           "of these windows it reported motion: 0 means blind there. Point at a square for its value.",
                       "The target is " + std::to_string(study.target().crosses().size()) +
                           " crosses of two bars, turning on the spot. "
                           "The triangle is the sensor, the solid line the floor's edge, the dashed line what was "
                           "taken out of the room."};

  io::Table table{{"sensor", "mean step", "greatest step", "blind", "area seen, m²"}, {}};
  for (std::size_t i = 0; i < map.sensors.size(); ++i) table.rows.push_back(row_of(map.sensors[i], figures.sensors[i]));
  table.rows.push_back(row_of("all together", figures.all));
  report.sections.push_back(
      {"In numbers",
       {"Mean step: average difference between two neighbouring squares (sharing a side) that both have motion. "
        "Greatest step: between any two neighbours. Blind: share of the squares without any motion. The last row takes "
        "the steps of all sensors, and the area seen by at least one."},
       {std::move(table)},
       {}});
  io::ReportSection maps{"Maps", {}, {}, {}};
  for (std::size_t i = 0; i < map.sensors.size(); ++i) {
    io::MapChart chart = map_chart(study, map, i);
    chart.note = "blind in " + fixed(100.0 * figures.sensors[i].blind_fraction, 0) + " % of the squares";
    maps.charts.emplace_back(std::move(chart));
  }
  report.sections.push_back(std::move(maps));
  return report;
}

}  // namespace pirsim::studies
