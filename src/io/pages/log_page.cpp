#include "io/pages/log_page.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text.hpp"
#include "io/pages/log_days.hpp"
#include "io/pages/log_text.hpp"

namespace pirsim::io {
namespace {

/// Names of the sensors that have most motion: a chart has ten colours.
std::vector<std::size_t> busiest(const LogFacts& facts, std::size_t most) {
  std::vector<std::size_t> sensors(facts.sensors.size());
  for (std::size_t i = 0; i < sensors.size(); ++i) sensors[i] = i;
  std::ranges::stable_sort(sensors, std::greater{}, [&](std::size_t i) { return facts.sensors[i].motion_share(); });
  if (sensors.size() > most) sensors.resize(most);
  std::ranges::sort(sensors);
  return sensors;
}

LineChart by_hour(const LogFacts& facts) {
  constexpr std::size_t most = 10;
  LineChart chart;
  chart.title = "Share of motion by hour of the day";
  if (facts.sensors.size() > most) chart.note = "the ten sensors with most motion";
  chart.y_label = "share of the known time, %";
  chart.x_high = 24.0;
  chart.x_ticks = LineChart::Ticks::clock;
  double highest = 0.0;
  for (const std::size_t i : busiest(facts, most)) {
    const LogSensorFacts& sensor = facts.sensors[i];
    LineChart::Line line{sensor.name, {}};
    for (std::size_t hour = 0; hour < sensor.motion_by_hour.size(); ++hour) {
      if (!sensor.motion_by_hour[hour]) continue;
      const double percent = 100.0 * *sensor.motion_by_hour[hour];
      highest = std::max(highest, percent);
      line.points.push_back({static_cast<double>(hour) + 0.5, percent, {}, {}, fixed(percent, 1) + " %"});
    }
    if (!line.points.empty()) chart.lines.push_back(std::move(line));
  }
  chart.y_high = std::max(1.0, 1.05 * highest);
  return chart;
}

GridChart alike(const LogFacts& facts) {
  GridChart chart;
  chart.title = "How much alike two sensors are";
  chart.note = "correlation (phi) of windows of " + shortest_number(facts.pair_window_s) +
               " s with and without motion: 1 the same, 0 as if they had nothing to do with each other";
  chart.label = "phi";
  for (const LogSensorFacts& sensor : facts.sensors) chart.rows.push_back(sensor.name);
  chart.columns = chart.rows;
  const std::size_t n = chart.rows.size();
  chart.cells.resize(n * n);
  for (const LogPair& pair : facts.pairs) {
    if (!pair.phi) continue;
    const GridChart::Cell cell{*pair.phi, fixed(*pair.phi, 2), "phi " + fixed(*pair.phi, 3)};
    chart.cells[pair.a * n + pair.b] = chart.cells[pair.b * n + pair.a] = cell;
  }
  chart.colours = GridChart::Colours::about_zero;
  return chart;
}

ReportSection days(const Log& log) {
  ReportSection section{"Days", {}, {}, {}};
  DaysChart chart = days_of(log);
  chart.note = "a step is " + shortest_number(chart.bin_s) + " s: the darker, the longer there was motion in it" +
               (log.people ? "; people in blue" : "") + "; hatched: nothing is known";
  section.charts.emplace_back(std::move(chart));
  return section;
}

}  // namespace

Report log_report(const Log& log, const LogFacts& facts, const std::string& title) {
  Report report{title, {}, {}, {}, log_in_words(log)};
  report.sections.push_back(days(log));
  ReportSection sensors{"Sensors", log_notes(log, facts), {sensor_table(log, facts)}, {}};
  constexpr std::int64_t some_hours_us = 4LL * 3600 * 1'000'000;
  if (log.clock != LogClock::elapsed && log.end_us - log.begin_us >= some_hours_us)
    sensors.charts.emplace_back(by_hour(facts));
  report.sections.push_back(std::move(sensors));
  constexpr std::size_t most_in_grid = 30, most_pairs = 30;
  if (!facts.pairs.empty()) {
    ReportSection pairs{"Pairs of sensors", {}, {pair_table(facts, most_pairs)}, {}};
    if (facts.sensors.size() <= most_in_grid) pairs.charts.emplace_back(alike(facts));
    report.sections.push_back(std::move(pairs));
  }
  if (!facts.gaps.empty()) report.sections.push_back({"Gaps", {}, {gap_table(log, facts)}, {}});
  if (!log.remarks.empty()) {
    ReportSection odd{"What is odd", {}, {}, {}};
    for (const Issue& issue : log.remarks) odd.paragraphs.push_back(to_string(issue));
    report.sections.push_back(std::move(odd));
  }
  return report;
}

}  // namespace pirsim::io
