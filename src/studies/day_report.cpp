#include "studies/study_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/fixed.hpp"
#include "pirsim/geometry.hpp"
#include "sim/compiled_study.hpp"
#include "studies/room_plan.hpp"

namespace pirsim::studies {
namespace {

constexpr double bin_s = 600.0, square_m = 0.25;

std::string percent(double share) { return fixed(100.0 * share, share < 0.0995 ? 1 : 0); }

}  // namespace

DayReport::DayReport(const Model& model, const ScheduleSpec& schedule)
    : model_(&model),
      window_s_(model.tick_s() * model.compiled().sensing().ticks_per_window),
      from_h_(schedule.from_h),
      to_h_(schedule.to_h) {
  const std::size_t n_sensors = model.scene().sensors.size();
  const auto n = static_cast<std::size_t>(std::ceil((to_h_ - from_h_) * 3600.0 / bin_s - 1e-9));
  bins_.assign(n, {0.0, 0.0, 0, 0, std::vector<double>(n_sensors, 0.0)});
  const Vec2 size = model.compiled().scene().floor.upper() - model.compiled().scene().floor.lower();
  columns_ = static_cast<std::size_t>(std::ceil(size.x / square_m));
  squares_.assign(columns_ * static_cast<std::size_t>(std::ceil(size.y / square_m)), 0.0);
}

double DayReport::hour_of(std::size_t bin) const { return from_h_ + (static_cast<double>(bin) + 0.5) * bin_s / 3600.0; }

void DayReport::add_run(const RunResult& result) {
  const auto empty = [](const Sample& sample) { return sample.people == 0; };
  if (std::ranges::all_of(result.samples, empty)) return;
  ++days_;
  std::vector<double> people(bins_.size(), 0.0), windows(bins_.size(), 0.0);
  for (const Sample& sample : result.samples) {
    const std::size_t k =
        std::min(bins_.size() - 1, static_cast<std::size_t>(std::max(0.0, sample.time_s - 1e-6) / bin_s));
    const auto n = static_cast<std::size_t>(sample.people);
    if (by_people_.size() <= n) by_people_.resize(n + 1, {0.0, std::vector<double>(sample.bits.size(), 0.0)});
    people[k] += sample.people;
    windows[k] += 1.0;
    by_people_[n].windows += 1.0;
    for (std::size_t i = 0; i < sample.bits.size(); ++i) {
      bins_[k].motion[i] += sample.bits[i];
      by_people_[n].motion[i] += sample.bits[i];
    }
    Bin& bin = bins_[k];
    bin.fewest = bin.windows == 0.0 ? sample.people : std::min(bin.fewest, sample.people);
    bin.most = std::max(bin.most, sample.people);
    bin.windows += 1.0;
    bin.people += sample.people;
  }
  const Vec2 lower = model_->compiled().scene().floor.lower();
  for (const OccupantRow& row : result.occupants) {
    const Vec2 at = (row.place_m - lower) / square_m;
    if (row.where == OccupantRow::Where::outside || at.x < 0.0 || at.y < 0.0) continue;
    const std::size_t i =
        static_cast<std::size_t>(at.y) * columns_ + std::min(columns_ - 1, static_cast<std::size_t>(at.x));
    if (i < squares_.size()) squares_[i] += window_s_;
  }
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
      busiest_.clock = first->clock;
      busiest_.people.clear();
      std::copy_if(first, last, std::back_inserter(busiest_.people), inside);
    }
    first = last;
  }
}

io::LineChart DayReport::people_chart() const {
  io::LineChart chart;
  chart.title = "People in the room";
  chart.note = "mean of every ten minutes over the days, with the least and the most that there were at once";
  chart.x_label = "time of day, h";
  chart.y_label = "people";
  chart.x_low = from_h_;
  chart.x_high = to_h_;
  io::LineChart::Line line;
  double most = 1.0;
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    const Bin& bin = bins_[k];
    if (bin.windows == 0.0) continue;
    const double mean = bin.people / bin.windows;
    most = std::max<double>(most, bin.most);
    line.points.push_back(
        {hour_of(k), mean, bin.fewest, bin.most, fixed(hour_of(k), 2) + " h: " + fixed(mean, 2) + " people"});
  }
  chart.y_high = most;
  chart.lines.push_back(std::move(line));
  return chart;
}

io::LineChart DayReport::sensor_chart(std::size_t sensor) const {
  io::LineChart chart;
  chart.title = model_->scene().sensors[sensor].id;
  chart.note = "share of rows with motion in every ten minutes, over the days";
  chart.x_label = "time of day, h";
  chart.y_label = "share";
  chart.x_low = from_h_;
  chart.x_high = to_h_;
  io::LineChart::Line line;
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    if (bins_[k].windows == 0.0) continue;
    const double share = bins_[k].motion[sensor] / bins_[k].windows;
    line.points.push_back({hour_of(k), share, {}, {}, fixed(hour_of(k), 2) + " h: " + percent(share) + " %"});
  }
  chart.lines.push_back(std::move(line));
  return chart;
}

io::GridChart DayReport::count_chart() const {
  io::GridChart chart;
  chart.title = "Motion by number of people";
  chart.note = "percent of rows with motion; empty where there were never so many";
  chart.label = "share, %";
  chart.row_label = "sensor";
  chart.column_label = "people";
  chart.max = 100.0;
  for (std::size_t n = 0; n < by_people_.size(); ++n) chart.columns.push_back(std::to_string(n));
  for (std::size_t i = 0; i < model_->scene().sensors.size(); ++i) {
    chart.rows.push_back(model_->scene().sensors[i].id);
    for (const Count& count : by_people_) {
      if (count.windows == 0.0) {
        chart.cells.emplace_back();
        continue;
      }
      const double share = count.motion[i] / count.windows;
      chart.cells.push_back({100.0 * share, percent(share), "of " + fixed(count.windows, 0) + " rows"});
    }
  }
  return chart;
}

io::MapChart DayReport::floor_chart() const {
  io::MapChart chart;
  chart.title = "Where people were";
  chart.note =
      "minutes a day in each square of 25 cm, seats many more than five; triangles: who was there at " + busiest_.clock;
  chart.label = "min a day";
  chart.unit = "min a day (5: or more)";
  chart.lower = model_->compiled().scene().floor.lower();
  chart.spacing_m = square_m;
  chart.columns = static_cast<int>(columns_);
  chart.rows = static_cast<int>(squares_.size() / columns_);
  chart.max = 5.0;
  for (std::size_t i = 0; i < squares_.size(); ++i) {
    const Vec2 centre =
        chart.lower + square_m * Vec2(static_cast<double>(i % columns_) + 0.5, static_cast<double>(i / columns_) + 0.5);
    const double minutes = squares_[i] / 60.0 / std::max(1, days_);
    const bool shown = squares_[i] > 0.0 || model_->compiled().scene().floor.contains(centre);
    chart.values.push_back(shown ? std::optional(std::round(100.0 * std::min(minutes, chart.max)) / 100.0)
                                 : std::nullopt);
  }
  chart.plan = plan_of(model_->compiled().scene());
  for (const OccupantRow& row : busiest_.people) {
    chart.markers.push_back({row.person, row.place_m, 0.0});
  }
  return chart;
}

io::ReportSection DayReport::section(const std::string& heading) const {
  io::ReportSection section{heading, {}, {}, {}};
  if (days_ == 0) {
    section.paragraphs.push_back("Nobody came.");
    return section;
  }
  section.paragraphs.push_back((days_ == 1 ? "One day" : std::to_string(days_) + " days") +
                               " on which somebody came. First how many people were in the room, by the time of day, "
                               "then how much motion each sensor reported at that time.");
  section.charts.emplace_back(people_chart());
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
  return section;
}

io::ReportSection DayReport::moment_section(const std::string& heading) const {
  io::ReportSection section{heading, {}, {}, {}};
  section.paragraphs.push_back("Most people were in the room at " + busiest_.clock +
                               "; of all such moments it is the first at which the most of them were on their feet. "
                               "This is what each of them did. Triangles in the map above show where.");
  io::Table table{{"who", "does", "seat"}, {}};
  for (const OccupantRow& row : busiest_.people) table.rows.push_back({row.person, row.activity, row.seat});
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace pirsim::studies
