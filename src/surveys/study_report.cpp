#include "surveys/study_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "engine/sim/compiled_study.hpp"
#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/response.hpp"
#include "surveys/picture.hpp"

namespace pirsim::studies {
namespace {

std::string names_of(const SceneSpec& scene, const std::vector<std::size_t>& sensors) {
  std::vector<std::string> names;
  for (const std::size_t sensor : sensors) names.push_back(scene.sensors[sensor].id);
  return joined(names, ", ");
}

std::string percent_of(std::int64_t part, std::int64_t whole) {
  return fixed(whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
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
  const std::size_t n_sensors = study.scene().sensors.size();
  chart.markers = {
      marker_of(sensor < n_sensors ? study.scene().sensors[sensor] : study.scene().arrays[sensor - n_sensors])};
  return chart;
}

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

constexpr double bin_s = 600.0, hour_s = 3600.0, square_m = 0.25;

/// "2026-03-02T08:30:15" in hours of its day.
double hours_of(const std::string& clock) {
  const auto two = [&](std::size_t at) { return std::stod(clock.substr(at, 2)); };
  return two(11) + two(14) / 60.0 + two(17) / hour_s;
}

std::string percents(double share) { return fixed(100.0 * share, share < 0.0995 ? 1 : 0); }

}  // namespace

AreaTally::AreaTally(const Model& model)
    : model_(&model),
      areas_(model.scene()),
      window_s_(model.tick_s() * model.compiled().sensing().ticks_per_window),
      with_motion_(model.areas().size(), 0) {
  for (std::size_t area = 0; area < model.areas().size(); ++area) {
    sums_.push_back({.area = model.areas()[area]});
    sensors_.push_back(areas_.sensors_of(area));
  }
}

void AreaTally::add_run(const RunResult& result) {
  ++runs_;
  for (const Sample& row : result.samples) {
    for (std::size_t area = 0; area < sums_.size(); ++area) {
      sums_[area].add(row.people_of_areas[area]);
      const auto saw_motion = [&](std::size_t sensor) { return row.bits[sensor] != 0; };
      with_motion_[area] += std::ranges::any_of(sensors_[area], saw_motion) ? 1 : 0;
    }
  }
}

io::Table AreaTally::table() const {
  io::Table table{{"area", "floor, m²", "minutes a run, of all people", "rows with people", "most people", "sensors",
                   "rows with motion"},
                  {}};
  for (std::size_t area = 0; area < sums_.size(); ++area) {
    const AreaSums& sums = sums_[area];
    const double minutes = static_cast<double>(sums.person_rows) * window_s_ / 60.0 / std::max(1, runs_);
    const bool is_watched = !sensors_[area].empty();
    table.rows.push_back({sums.area, fixed(areas_.areas_m2()[area], 2), fixed(minutes, 1),
                          percent_of(sums.occupied, sums.rows), std::to_string(sums.most),
                          is_watched ? names_of(model_->scene(), sensors_[area]) : "none",
                          is_watched ? percent_of(with_motion_[area], sums.rows) : ""});
  }
  return table;
}

std::string with_sensors(const SceneSpec& scene, const Areas& areas, std::size_t area) {
  const std::string sensors = names_of(scene, areas.sensors_of(area));
  return areas.names()[area] + (sensors.empty() ? "" : " (" + sensors + ")");
}

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

DayReport::DayReport(const Model& model)
    : model_(&model),
      window_s_(model.tick_s() * model.compiled().sensing().ticks_per_window),
      areas_(model),
      watched_(Areas(model.scene()).of_sensors()) {
  const Vec2 size = model.compiled().scene().floor.upper() - model.compiled().scene().floor.lower();
  columns_ = static_cast<std::size_t>(std::ceil(size.x / square_m));
  squares_.assign(columns_ * static_cast<std::size_t>(std::ceil(size.y / square_m)), 0.0);
}

template <typename PointOf>
io::LineChart::Line DayReport::line_over_time(PointOf point_of) const {
  io::LineChart::Line line;
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    if (bins_[k].windows == 0.0) continue;
    io::LineChart::Point& point = line.points.emplace_back(point_of(bins_[k]));
    point.x = from_h_ + (static_cast<double>(k) + 0.5) * bin_s / hour_s;
    point.hint = (has_clock_ ? hours_text(point.x) : fixed(point.x, 2) + " h") + point.hint;
  }
  return line;
}

DayReport::Bin& DayReport::bin_at(double time_s) {
  const auto k = static_cast<std::size_t>(std::max(0.0, time_s - 1e-6) / bin_s);
  if (bins_.size() <= k)
    bins_.resize(k + 1, {0.0, 0.0, 0, 0, std::vector<double>(model_->scene().sensors.size(), 0.0),
                         std::vector<double>(model_->areas().size(), 0.0)});
  return bins_[k];
}

void DayReport::add_run(const RunResult& result) {
  const auto empty = [](const Sample& sample) { return sample.people == 0; };
  if (std::ranges::all_of(result.samples, empty)) return;
  const Sample& first = result.samples.front();
  has_clock_ = !first.clock.empty();
  if (has_clock_) from_h_ = hours_of(first.clock) - first.time_s / hour_s;
  longest_s_ = std::max(longest_s_, result.samples.back().time_s);
  ++days_;
  const std::vector<double> none(model_->scene().sensors.size(), 0.0);
  for (const Sample& sample : result.samples) {
    Bin& bin = bin_at(sample.time_s);
    for (std::size_t i = 0; i < sample.bits.size(); ++i) {
      bin.motion[i] += sample.bits[i];
      const std::optional<std::size_t> area = watched_[i];
      const auto n = static_cast<std::size_t>(area ? sample.people_of_areas[*area] : sample.people);
      if (by_people_.size() <= n) by_people_.resize(n + 1, {none, none});
      by_people_[n].windows[i] += 1.0;
      by_people_[n].motion[i] += sample.bits[i];
    }
    bin.fewest = bin.windows == 0.0 ? sample.people : std::min(bin.fewest, sample.people);
    bin.most = std::max(bin.most, sample.people);
    bin.windows += 1.0;
    bin.people += sample.people;
    for (std::size_t i = 0; i < sample.people_of_areas.size(); ++i) bin.people_of_areas[i] += sample.people_of_areas[i];
  }
  const Vec2 lower = model_->compiled().scene().floor.lower();
  for (const OccupantRow& row : result.occupants) {
    const Vec2 at = (row.place_m - lower) / square_m;
    if (row.where == OccupantRow::Where::outside || at.x < 0.0 || at.y < 0.0) continue;
    const std::size_t i =
        static_cast<std::size_t>(at.y) * columns_ + std::min(columns_ - 1, static_cast<std::size_t>(at.x));
    if (i < squares_.size()) squares_[i] += window_s_;
  }
  areas_.add_run(result);
  note_moment(result);
}

/// The first with the most people on their feet, among those with the most people; occupants are in order of time.
void DayReport::note_moment(const RunResult& result) {
  const auto rank = [](std::size_t people, std::size_t seated) { return 1000 * people - seated; };
  const auto inside = [](const OccupantRow& row) { return row.where == OccupantRow::Where::inside; };
  const auto seated_of = [&](auto first, auto last) {
    return static_cast<std::size_t>(std::count_if(
        first, last, [&](const OccupantRow& row) { return row.activity == "working" || row.activity == "seated"; }));
  };
  const auto& rows = result.occupants;
  for (auto first = rows.begin(); first != rows.end();) {
    const auto last =
        std::find_if(first, rows.end(), [&](const OccupantRow& row) { return row.time_s != first->time_s; });
    const auto n = static_cast<std::size_t>(std::count_if(first, last, inside));
    const std::size_t known = rank(busiest_.people.size(), seated_of(busiest_.people.begin(), busiest_.people.end()));
    if (n > 0 && (busiest_.people.empty() || rank(n, seated_of(first, last)) > known)) {
      busiest_.time = first->clock.empty() ? "second " + fixed(first->time_s, 0)
                                           : first->clock.substr(0, 10) + ' ' + first->clock.substr(11);
      busiest_.people.clear();
      std::copy_if(first, last, std::back_inserter(busiest_.people), inside);
    }
    first = last;
  }
}

std::string DayReport::over_runs() const { return days_ == 1 ? "" : has_clock_ ? " over the days" : " over the runs"; }

io::LineChart DayReport::chart_over_time(const std::string& title, const std::string& note,
                                         const std::string& y_label) const {
  io::LineChart chart;
  chart.title = title;
  chart.note = note;
  chart.y_label = y_label;
  chart.x_label = has_clock_ ? "time of day" : "hours since the run began";
  if (has_clock_) chart.x_ticks = io::LineChart::Ticks::clock;
  chart.x_low = from_h_;
  chart.x_high = from_h_ + longest_s_ / hour_s;
  return chart;
}

io::LineChart DayReport::people_chart() const {
  io::LineChart chart = chart_over_time(
      "People in the room",
      "mean of every ten minutes" + over_runs() + ", with the least and the most that there were at once", "people");
  chart.lines.push_back(line_over_time([&](const Bin& bin) {
    const double mean = bin.people / bin.windows;
    chart.y_high = std::max<double>(chart.y_high, bin.most);
    return io::LineChart::Point{0.0, mean, bin.fewest, bin.most, ": " + fixed(mean, 2) + " people"};
  }));
  return chart;
}

io::LineChart DayReport::area_chart() const {
  io::LineChart chart = chart_over_time("People in each area", "mean of every ten minutes" + over_runs(), "people");
  chart.y_high = 0.1;
  for (std::size_t area = 0; area < model_->areas().size(); ++area) {
    const std::string& name = model_->areas()[area];
    chart.lines.push_back(line_over_time([&](const Bin& bin) {
      const double mean = bin.people_of_areas[area] / bin.windows;
      chart.y_high = std::max(chart.y_high, mean);
      return io::LineChart::Point{0.0, mean, {}, {}, ", " + name + ": " + fixed(mean, 2)};
    }));
    chart.lines.back().name = name;
  }
  return chart;
}

io::LineChart DayReport::sensor_chart(std::size_t sensor) const {
  io::LineChart chart = chart_over_time(model_->scene().sensors[sensor].id,
                                        "share of rows with motion in every ten minutes" + over_runs(), "share");
  chart.lines.push_back(line_over_time([&](const Bin& bin) {
    const double share = bin.motion[sensor] / bin.windows;
    return io::LineChart::Point{0.0, share, {}, {}, ": " + percents(share) + " %"};
  }));
  return chart;
}

io::GridChart DayReport::count_chart() const {
  io::GridChart chart;
  chart.title = "Motion by number of people" + std::string(model_->areas().empty() ? "" : " in the sensor's area");
  chart.note = "percent of rows with motion; empty where there were never so many" +
               std::string(model_->areas().empty() ? "" : ". A sensor over no area has the people of the whole floor");
  chart.label = "share, %";
  chart.row_label = "sensor";
  chart.column_label = "people";
  chart.max = 100.0;
  for (std::size_t n = 0; n < by_people_.size(); ++n) chart.columns.push_back(std::to_string(n));
  for (std::size_t i = 0; i < model_->scene().sensors.size(); ++i) {
    chart.rows.push_back(model_->scene().sensors[i].id);
    for (const Count& count : by_people_) {
      if (count.windows[i] == 0.0) {
        chart.cells.emplace_back();
        continue;
      }
      const double share = count.motion[i] / count.windows[i];
      chart.cells.push_back({100.0 * share, percents(share), "of " + fixed(count.windows[i], 0) + " rows"});
    }
  }
  return chart;
}

io::MapChart DayReport::floor_chart() const {
  io::MapChart chart;
  chart.title = "Where people were";
  chart.note =
      "The floor in squares of 25 cm, seen from above: how long somebody was in each, the times of all people " +
      std::string(days_ == 1   ? "added up. "
                  : has_clock_ ? "added up, on an average day. "
                               : "added up, in an average run. ") +
      "Blue dots: who was there at " + busiest_.time + ".";
  chart.label = "somebody was here";
  chart.unit = days_ == 1 ? "min" : has_clock_ ? "min a day" : "min a run";
  // Seats are taken for hours and ways for seconds: an even scale would show either the one or the other.
  chart.classes = {{-1.0, "never"},      {0.0, "up to 1 min"},    {1.0, "1 to 5 min"},
                   {5.0, "5 to 30 min"}, {30.0, "30 min to 2 h"}, {120.0, "over 2 h"}};
  chart.lower = model_->compiled().scene().floor.lower();
  chart.spacing_m = square_m;
  chart.columns = static_cast<int>(columns_);
  chart.rows = static_cast<int>(squares_.size() / columns_);
  for (std::size_t i = 0; i < squares_.size(); ++i) {
    const Vec2 centre =
        chart.lower + square_m * Vec2(static_cast<double>(i % columns_) + 0.5, static_cast<double>(i / columns_) + 0.5);
    const double minutes = squares_[i] / 60.0 / std::max(1, days_);
    const bool shown = squares_[i] > 0.0 || model_->compiled().scene().floor.contains(centre);
    chart.max = std::max(chart.max, minutes);
    // Rounded up, so that what is more than nothing stays more.
    chart.values.push_back(shown ? std::optional(std::ceil(100.0 * minutes) / 100.0) : std::nullopt);
  }
  chart.plan = plan_of(model_->compiled().scene());
  for (const SensorSpec& sensor : model_->compiled().scene().sensors) chart.markers.push_back(marker_of(sensor));
  for (const OccupantRow& row : busiest_.people) chart.people.push_back({row.person, row.place_m, 0.0});
  return chart;
}

io::ReportSection DayReport::section(const std::string& heading) const {
  io::ReportSection section{heading, {}, {}, {}};
  if (days_ == 0) {
    section.paragraphs.push_back("Nobody was there.");
    return section;
  }
  constexpr std::size_t most_lines = 8;  // more can't be told apart
  const bool charts_areas = !areas_.empty() && model_->areas().size() <= most_lines;
  section.paragraphs.push_back((has_clock_
                                    ? counted(static_cast<std::size_t>(days_), "day") +
                                          " with somebody there. The first chart tells how many people were in the "
                                          "room at each time of day, "
                                    : counted(static_cast<std::size_t>(days_), "run") +
                                          " with somebody there. The first chart tells how many people were in the "
                                          "room as time went on, ") +
                               (charts_areas ? "the second one how many of them were in each area, " : "") +
                               "the next ones how much motion each sensor reported then.");
  section.charts.emplace_back(people_chart());
  if (charts_areas) section.charts.emplace_back(area_chart());
  if (!areas_.empty()) section.tables.push_back(areas_.table());
  std::vector<io::LineChart> sensors;
  double most = 0.05;
  for (std::size_t i = 0; i < model_->scene().sensors.size(); ++i) {
    sensors.push_back(sensor_chart(i));
    for (const auto& point : sensors.back().lines.front().points) most = std::max(most, point.y);
  }
  for (io::LineChart& chart : sensors) {
    chart.y_high = std::ceil(20.0 * most) / 20.0;
    section.charts.emplace_back(std::move(chart));
  }
  section.charts.emplace_back(count_chart());
  section.charts.emplace_back(floor_chart());
  section.paragraphs.push_back(
      "In the map of the floor red triangles are sensors and white ones seats, pointing the way that the sensor, or "
      "who "
      "sits there, faces; a green line is a door, "
      "dotted lines are furniture, black areas are walls" +
      std::string(areas_.empty() ? "" : ", violet dashes the borders of named areas") +
      ". Point at anything for its name or value.");
  return section;
}

io::ReportSection DayReport::moment_section(const std::string& heading) const {
  io::ReportSection section{heading, {}, {}, {}};
  section.paragraphs.push_back("Most people were in the room at " + busiest_.time +
                               "; of all such moments it is the first at which the most of them were on their feet. "
                               "This is what each of them did. Blue dots in the map above show where.");
  io::Table table{{"who", "does", "seat"}, {}};
  for (const OccupantRow& row : busiest_.people) table.rows.push_back({row.person, row.activity, row.seat});
  if (!areas_.empty()) {
    table.headings.emplace_back("area");
    for (std::size_t i = 0; i < busiest_.people.size(); ++i) table.rows[i].push_back(busiest_.people[i].area);
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace pirsim::studies
