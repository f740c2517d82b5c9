#include "studies/study_report.hpp"

#include <algorithm>
#include <cmath>

#include "core/text.hpp"
#include "pirsim/response.hpp"
#include "studies/room_plan.hpp"

namespace pirsim::studies {
namespace {

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

/// count(column, row): of a square on the floor.
template <typename Count>
std::optional<double> block_mean(const FloorGrid& grid, Count count, std::size_t column, std::size_t row,
                                 std::size_t side) {
  double sum = 0.0;
  int squares = 0;
  for (std::size_t r = row; r < std::min(row + side, grid.n_rows()); ++r) {
    for (std::size_t c = column; c < std::min(column + side, grid.n_columns()); ++c) {
      if (!grid.on_floor(c, r)) continue;
      sum += count(c, r);
      ++squares;
    }
  }
  if (squares == 0) return std::nullopt;
  return sum / squares;
}

std::vector<std::string> row_of(const std::string& name, const MapFigures& f) {
  return {name, fixed(f.mean_step, 1), std::to_string(f.greatest_step), percent(f.blind_fraction, 1),
          fixed(f.seen_area_m2, 2)};
}

io::ReportSection areas_section(const std::vector<AreaCoverage>& areas) {
  io::Table table{{"area (its sensors)", "squares", "not seen by any sensor", "not seen by its own"}, {}};
  for (const AreaCoverage& area : areas) {
    table.rows.push_back({area.area, std::to_string(area.squares), percent(area.blind_fraction, 1),
                          area.blind_to_its_own ? percent(*area.blind_to_its_own, 1) : "no sensor"});
  }
  return {"By area", {}, {std::move(table)}, {}};
}

/// A map without title and sensors.
template <typename Count>
io::MapChart map_with(const CoverageStudy& study, const CoverageMap& map, Count count) {
  const FloorGrid& grid = map.grid;
  const std::size_t side = squares_per_block_side(grid);
  io::MapChart chart;
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
      chart.values.push_back(block_mean(grid, count, column, row, side));
    }
  }
  chart.max = map.n_windows;
  chart.plan = plan_of(study.scene());
  chart.dashed = places_of(study);
  return chart;
}

/// One sensor's map with the walls, the sensor and, dashed, what was taken out of the room.
io::MapChart map_chart(const CoverageStudy& study, const CoverageMap& map, std::size_t sensor) {
  io::MapChart chart =
      map_with(study, map, [&](std::size_t column, std::size_t row) { return map.count(column, row, sensor); });
  chart.title = map.sensors[sensor];
  chart.markers = {marker_of(study.scene().sensors[sensor])};
  return chart;
}

}  // namespace

io::MapChart map_of_all(const CoverageStudy& study, const CoverageMap& map) {
  io::MapChart chart = map_with(study, map, [&](std::size_t column, std::size_t row) {
    MotionCount most = 0;
    for (std::size_t i = 0; i < map.sensors.size(); ++i) most = std::max<MotionCount>(most, map.count(column, row, i));
    return most;
  });
  chart.title = "all sensors";
  for (const SensorSpec& sensor : study.scene().sensors) chart.markers.push_back(marker_of(sensor));
  return chart;
}

io::Report coverage_report(const CoverageStudy& study, const CoverageMap& map, const CoverageFigures& figures) {
  io::Report report;
  report.title = study.spec().name + ": where each sensor sees motion";
  report.paragraphs = {
      "A moving target stood for " + fixed(study.spec().duration_s, 0) + " s in every square of " +
          fixed(100.0 * map.grid.spacing_m(), 0) + " cm of the floor of " + study.scene().name + " (" +
          std::to_string(map.grid.n_squares()) +
          " squares). The maps, seen from above, tell for each sensor in how many "
          "of these windows it reported motion: 0 means not seen there. Point at a square for its value.",
      "The target is " + std::to_string(study.target().crosses().size()) +
          " crosses of two bars, turning on the spot. The sensors' response is " +
          responses_in_words(study.scene(), study.spec().sensing) + ".",
      signs_of_maps(study.scene()) +
          (study.taken_out().empty() ? "" : " Dashed lines are what was taken out of the room.")};

  io::Table table{{"sensor", "mean step", "greatest step", "not seen", "area seen, m²"}, {}};
  for (std::size_t i = 0; i < map.sensors.size(); ++i) table.rows.push_back(row_of(map.sensors[i], figures.sensors[i]));
  table.rows.push_back(row_of("all together", figures.all));
  report.sections.push_back(
      {"In numbers",
       {"Mean step: average difference between two neighbouring squares (sharing a side) that both have motion. "
        "Greatest step: between any two neighbours. Not seen: share of the squares without any motion. The last row "
        "takes "
        "the steps of all sensors, and the area seen by at least one."},
       {std::move(table)},
       {}});
  const std::vector<AreaCoverage> areas = area_figures_of(map, study.scene());
  if (!areas.empty()) report.sections.push_back(areas_section(areas));
  io::ReportSection maps{"Maps", {}, {}, {}};
  if (map.sensors.size() > 1) {
    io::MapChart chart = map_of_all(study, map);
    chart.note = "in each square the sensor that reported motion most often there; " +
                 percent(figures.all.blind_fraction) + " of the squares are seen by none";
    maps.charts.emplace_back(std::move(chart));
  }
  for (std::size_t i = 0; i < map.sensors.size(); ++i) {
    io::MapChart chart = map_chart(study, map, i);
    chart.note = "not seen: " + percent(figures.sensors[i].blind_fraction) + " of the squares";
    maps.charts.emplace_back(std::move(chart));
  }
  report.sections.push_back(std::move(maps));
  return report;
}

namespace {

/// Stretches of rows in one of the counted phases.
std::vector<io::SeriesChart::Phase> counted_phases(const std::vector<Sample>& samples, const SummarySpec& spec,
                                                   double window_s) {
  std::vector<io::SeriesChart::Phase> phases;
  std::string current;
  for (const Sample& sample : samples) {
    const bool counted = std::ranges::find(spec.phases, sample.phase) != spec.phases.end();
    if (!counted) {
      current.clear();
    } else if (sample.phase == current) {
      phases.back().to_s = sample.time_s;
    } else {
      current = sample.phase;
      phases.push_back({current, sample.time_s - window_s, sample.time_s});
    }
  }
  return phases;
}

io::Table overall_table(const OverallSummary& overall) {
  io::Table table{{"over all cells", ""}, {}};
  table.rows = {{"cells with a measured count", std::to_string(overall.cells)},
                {"measured count within the simulated range", std::to_string(overall.inside)},
                {"expected if the measured counts were dealt at random", fixed(overall.shuffled_inside, 1)},
                {"simulated mean minus measured, average", fixed(overall.bias, 1)},
                {"average absolute error of the simulated means", fixed(overall.mean_absolute_error, 1)}};
  return table;
}

std::string note_of(const CellSummary& cell) {
  std::string note =
      "mean " + fixed(cell.mean, 1) + ", " + std::to_string(cell.min) + " to " + std::to_string(cell.max);
  if (cell.measured) {
    note += "; measured " + std::to_string(cell.measured->real) + (*cell.inside ? ", inside" : ", outside");
  }
  return note;
}

std::string watchers(const Model& model, const std::vector<std::string>& sensors) {
  return joined(sensors, ", ") + ", whose response is " + responses_in_words(model.scene(), model.script().sensing);
}

/// What was run, and what a count is.
std::string introduction(const Model& model, const std::vector<std::string>& sensors) {
  const ScriptSpec& script = model.script();
  return std::to_string(script.trials.size()) + (script.trials.size() == 1 ? " trial in " : " trials in ") +
         model.scene().name + ", " +
         (script.replicates == 1 ? "run once" : "each run " + std::to_string(script.replicates) + " times") +
         ", watched by " + watchers(model, sensors) +
         ". A count is the number of windows in which a sensor reported motion" +
         (script.summary.phases.empty() ? "." : " while the phase was " + joined(script.summary.phases, ", ") + ".");
}

/// Second by second nobody can read it. How long runs without a set duration are isn't known before they end.
bool lasts_hours(const TrialSpec& trial) {
  constexpr double long_run_s = 7200.0;
  return trial.schedule || trial.occupancy || (trial.duration_s && *trial.duration_s >= long_run_s);
}

}  // namespace

StudyReport::StudyReport(const Model& model) : model_(&model) {
  for (const SensorSpec& sensor : model.scene().sensors) sensors_.push_back(sensor.id);
  for (const TrialSpec& trial : model.script().trials) {
    trials_.push_back({trial.id, {}, AreaTally(model), {}});
    if (lasts_hours(trial)) trials_.back().days.emplace(model);
  }
}

bool StudyReport::needs_occupants() const noexcept {
  return std::ranges::any_of(trials_, [](const Trial& trial) { return trial.days.has_value(); });
}

void StudyReport::add_run(const RunResult& result) {
  Trial& trial = trials_[result.run % trials_.size()];
  if (trial.days) return trial.days->add_run(result);
  trial.areas.add_run(result);
  if (result.replicate == 1) trial.samples = result.samples;
}

io::SeriesChart StudyReport::series_of(const Trial& trial) const {
  const SensingSpec& sensing = model_->script().sensing;
  io::SeriesChart chart;
  chart.title = "trial " + trial.id;
  if (!trial.samples.empty()) chart.first_clock = trial.samples.front().clock;
  chart.window_s = static_cast<double>(sensing.ticks_per_window) / sensing.tick_rate_hz;
  if (!trial.samples.empty()) chart.end_s = trial.samples.back().time_s;
  chart.phases = counted_phases(trial.samples, model_->script().summary, chart.window_s);
  for (const Sample& sample : trial.samples) {
    const int people = sample.people;
    if (chart.people.empty() || chart.people.back().people != people)
      chart.people.push_back({sample.time_s - chart.window_s, people});
  }
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    auto& row = chart.rows.emplace_back();
    row.name = sensors_[i];
    for (const Sample& sample : trial.samples) {
      if (sample.bits[i] != 0) row.times_s.push_back(sample.time_s);
    }
  }
  return chart;
}

io::Report StudyReport::finish(const Summary& summary) const {
  const ScriptSpec& script = model_->script();
  const std::vector<CellSummary> cells = summary.cells();  // trials in order, sensors within each
  const auto is_measured = [&](std::size_t trial) {
    const auto first = cells.begin() + static_cast<std::ptrdiff_t>(trial * sensors_.size());
    return std::any_of(first, first + static_cast<std::ptrdiff_t>(sensors_.size()),
                       [](const CellSummary& cell) { return cell.measured.has_value(); });
  };
  io::Report report;
  report.title = script.name;
  const bool has_counts = summary.overall().cells > 0 ||
                          std::ranges::any_of(trials_, [](const Trial& trial) { return !trial.days.has_value(); });
  if (has_counts) {
    report.paragraphs = {introduction(*model_, sensors_)};
    if (summary.overall().cells > 0)
      report.sections.push_back({"In numbers", {}, {overall_table(summary.overall())}, {}});
  } else {
    const std::string unit = script.trials.front().schedule ? "day" : "run";
    report.paragraphs = {std::to_string(model_->n_runs()) + " " + unit + (model_->n_runs() == 1 ? " in " : "s in ") +
                         model_->scene().name + ", watched by " + watchers(*model_, sensors_) + "."};
  }

  for (std::size_t t = 0; t < trials_.size(); ++t) {
    if (trials_[t].days) {
      const std::string whose = trials_.size() == 1 ? "" : " of trial " + trials_[t].id;
      const std::string what = script.trials[t].schedule ? "Days" : "The whole run";
      report.sections.push_back(trials_[t].days->section(what + whose));
      if (trials_[t].days->has_moment())
        report.sections.push_back(trials_[t].days->moment_section("The fullest moment" + whose));
      if (!is_measured(t)) continue;
    }
    io::ReportSection section{"Trial " + trials_[t].id, {}, {}, {}};
    if (t == 0) {
      section.paragraphs = {
          "How often each count came out over the runs." +
          std::string(summary.overall().cells > 0 ? " The coloured line is the measured count." : "") +
          (trials_[t].samples.empty()
               ? ""
               : " Below: the first run, window by window, with the number of people above the sensors" +
                     std::string(counted_phases(trials_[t].samples, script.summary, 1.0).empty()
                                     ? "."
                                     : "; counted windows are shaded."))};
    }
    for (std::size_t s = 0; s < sensors_.size(); ++s) {
      const CellSummary& cell = cells[t * sensors_.size() + s];
      if (cell.runs == 0) continue;
      std::optional<int> real;
      if (cell.measured) real = cell.measured->real;
      section.charts.emplace_back(io::HistogramChart{"trial " + trials_[t].id + ", " + sensors_[s], note_of(cell),
                                                     "windows with motion", "windows", cell.counts, real});
    }
    if (!trials_[t].areas.empty() && !trials_[t].days) section.tables.push_back(trials_[t].areas.table());
    io::SeriesChart series = series_of(trials_[t]);
    series.title += ", first run";
    if (!trials_[t].samples.empty()) section.charts.emplace_back(std::move(series));
    report.sections.push_back(std::move(section));
  }
  return report;
}

}  // namespace pirsim::studies
