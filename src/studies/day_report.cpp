#include "studies/study_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/text.hpp"
#include "pirsim/geometry.hpp"
#include "schema/clock.hpp"
#include "sim/compiled_study.hpp"
#include "studies/room_plan.hpp"

namespace pirsim::studies {
namespace {

constexpr double bin_s = 600.0, hour_s = 3600.0, square_m = 0.25;

/// "2026-03-02T08:30:15" in hours of its day.
double hours_of(const std::string& clock) {
  const auto two = [&](std::size_t at) { return std::stod(clock.substr(at, 2)); };
  return two(11) + two(14) / 60.0 + two(17) / hour_s;
}

std::string count_of(int n, const std::string& what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }

std::string percents(double share) { return fixed(100.0 * share, share < 0.0995 ? 1 : 0); }

}  // namespace

DayReport::DayReport(const Model& model)
    : model_(&model),
      window_s_(model.tick_s() * model.compiled().sensing().ticks_per_window),
      areas_(model),
      watched_(Areas(model.scene()).of_sensors()) {
  const Vec2 size = model.compiled().scene().floor.upper() - model.compiled().scene().floor.lower();
  columns_ = static_cast<std::size_t>(std::ceil(size.x / square_m));
  squares_.assign(columns_ * static_cast<std::size_t>(std::ceil(size.y / square_m)), 0.0);
}

double DayReport::hour_of(std::size_t bin) const { return from_h_ + (static_cast<double>(bin) + 0.5) * bin_s / hour_s; }

double DayReport::to_h() const { return from_h_ + longest_s_ / hour_s; }

std::string DayReport::time_of(double hours) const { return has_clock_ ? hours_text(hours) : fixed(hours, 2) + " h"; }

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

void DayReport::set_time_axis(io::LineChart& chart) const {
  chart.x_label = has_clock_ ? "time of day" : "hours since the run began";
  if (has_clock_) chart.x_ticks = io::LineChart::Ticks::clock;
  chart.x_low = from_h_;
  chart.x_high = to_h();
}

io::LineChart DayReport::people_chart() const {
  io::LineChart chart;
  chart.title = "People in the room";
  chart.note = "mean of every ten minutes" + over_runs() + ", with the least and the most that there were at once";
  set_time_axis(chart);
  chart.y_label = "people";
  io::LineChart::Line line;
  double most = 1.0;
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    const Bin& bin = bins_[k];
    if (bin.windows == 0.0) continue;
    const double mean = bin.people / bin.windows;
    most = std::max<double>(most, bin.most);
    line.points.push_back(
        {hour_of(k), mean, bin.fewest, bin.most, time_of(hour_of(k)) + ": " + fixed(mean, 2) + " people"});
  }
  chart.y_high = most;
  chart.lines.push_back(std::move(line));
  return chart;
}

io::LineChart DayReport::area_chart() const {
  io::LineChart chart;
  chart.title = "People in each area";
  chart.note = "mean of every ten minutes" + over_runs();
  set_time_axis(chart);
  chart.y_label = "people";
  chart.y_high = 0.1;
  for (std::size_t area = 0; area < model_->areas().size(); ++area) {
    io::LineChart::Line& line = chart.lines.emplace_back();
    line.name = model_->areas()[area];
    for (std::size_t k = 0; k < bins_.size(); ++k) {
      if (bins_[k].windows == 0.0) continue;
      const double mean = bins_[k].people_of_areas[area] / bins_[k].windows;
      chart.y_high = std::max(chart.y_high, mean);
      line.points.push_back({hour_of(k), mean, {}, {}, time_of(hour_of(k)) + ", " + line.name + ": " + fixed(mean, 2)});
    }
  }
  return chart;
}

io::LineChart DayReport::sensor_chart(std::size_t sensor) const {
  io::LineChart chart;
  chart.title = model_->scene().sensors[sensor].id;
  chart.note = "share of rows with motion in every ten minutes" + over_runs();
  set_time_axis(chart);
  chart.y_label = "share";
  io::LineChart::Line line;
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    if (bins_[k].windows == 0.0) continue;
    const double share = bins_[k].motion[sensor] / bins_[k].windows;
    line.points.push_back({hour_of(k), share, {}, {}, time_of(hour_of(k)) + ": " + percents(share) + " %"});
  }
  chart.lines.push_back(std::move(line));
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
  section.paragraphs.push_back(
      (has_clock_ ? count_of(days_, "day") + " with somebody there. The first chart tells how many people were in the "
                                             "room at each time of day, "
                  : count_of(days_, "run") + " with somebody there. The first chart tells how many people were in the "
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
