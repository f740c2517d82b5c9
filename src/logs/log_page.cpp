#include "logs/log_page.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "logs/times.hpp"
#include "model/core/text.hpp"
#include "pirsim/log.hpp"
#include "show/charts.hpp"

namespace pirsim::io {
namespace {

// ----------------------------------------------------------------------------------------------------- days as lines

/// Local time cut into bins of equal length: those of a day that the chart shows, day after day.
struct DayGrid {
  std::int64_t first_midnight_us = 0;  ///< local
  std::int64_t from_us = 0;            ///< of each day, the left end
  std::int64_t bin_us = 0;
  std::size_t n_days = 1, n_bins = 1;
};

DayGrid grid_of(const Log& log) {
  const std::int64_t begin = log.moment(log.begin_us).local_us(), end = log.moment(log.end_us).local_us();
  DayGrid grid;
  constexpr std::array<std::int64_t, 10> lengths_s{1, 2, 5, 10, 20, 30, 60, 120, 300, 600};
  constexpr std::int64_t most_bins = 720;
  const bool is_one_day = log.clock == LogClock::elapsed ||
                          rounded_down(begin, us_per_day) == rounded_down(std::max(begin, end - 1), us_per_day);
  if (is_one_day) {
    const auto fits =
        std::ranges::find_if(lengths_s, [&](std::int64_t s) { return (end - begin) / (us_per_s * s) < most_bins; });
    grid.bin_us = fits == lengths_s.end() ? (end - begin) / most_bins : us_per_s * *fits;
    grid.first_midnight_us = log.clock == LogClock::elapsed ? 0 : rounded_down(begin, us_per_day);
    grid.from_us = rounded_down(begin - grid.first_midnight_us, 10 * grid.bin_us);
    const std::int64_t shown = end - grid.first_midnight_us - grid.from_us;
    grid.n_bins = static_cast<std::size_t>((shown + grid.bin_us - 1) / grid.bin_us);
    return grid;
  }
  grid.first_midnight_us = rounded_down(begin, us_per_day);
  grid.n_days = static_cast<std::size_t>((end - 1 - grid.first_midnight_us) / us_per_day + 1);
  constexpr std::size_t a_month = 31, a_season = 100;
  const std::int64_t bin_s = grid.n_days <= a_month ? 120 : grid.n_days <= a_season ? 300 : 600;
  grid.bin_us = us_per_s * bin_s;
  grid.n_bins = static_cast<std::size_t>(us_per_day / grid.bin_us);
  return grid;
}

/// Calls put(day, bin, microseconds) for what a stretch of local time has of each bin.
template <typename Put>
void each_bin(const Log& log, const DayGrid& grid, const LogRun& run, Put put) {
  for (std::int64_t at = run.from_us; at < run.to_us;) {
    const std::int64_t local = log.moment(at).local_us() - grid.first_midnight_us;
    const bool is_one = grid.n_days == 1;
    const std::int64_t day = is_one ? 0 : rounded_down(local, us_per_day) / us_per_day;
    const std::int64_t of_day = local - day * us_per_day - grid.from_us;
    const std::int64_t bin = rounded_down(of_day, grid.bin_us) / grid.bin_us;
    const std::int64_t to = std::min(run.to_us, at + grid.bin_us - (of_day - bin * grid.bin_us));
    const bool is_in = day >= 0 && std::cmp_less(day, grid.n_days) && bin >= 0 && std::cmp_less(bin, grid.n_bins);
    if (is_in) put(static_cast<std::size_t>(day) * grid.n_bins + static_cast<std::size_t>(bin), to - at);
    at = to;
  }
}

using Levels = std::vector<std::int32_t>;  ///< (n_days x n_bins)

Levels motion_levels(const Log& log, const DayGrid& grid, const LogTrack& track) {
  std::vector<float> known(grid.n_days * grid.n_bins), motion(known.size());
  each_stretch(log, track, [&](const LogRun& run) {
    if (run.value == log_state::unknown) return;
    each_bin(log, grid, run, [&](std::size_t bin, std::int64_t us) {
      known[bin] += static_cast<float>(us);
      if (run.value == log_state::on) motion[bin] += static_cast<float>(us);
    });
  });
  Levels levels(known.size(), DaysChart::unknown);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (known[i] > 0.0F) levels[i] = DaysChart::level_of(motion[i] / known[i]);
  }
  return levels;
}

/// The most in each bin.
Levels people_levels(const Log& log, const DayGrid& grid) {
  Levels levels(grid.n_days * grid.n_bins, DaysChart::unknown);
  each_stretch(log, *log.people, [&](const LogRun& run) {
    each_bin(log, grid, run, [&](std::size_t bin, std::int64_t) { levels[bin] = std::max(levels[bin], run.value); });
  });
  return levels;
}

std::string name_of_day(const DayGrid& grid, std::size_t day) {
  constexpr std::array names{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  const std::int64_t number = grid.first_midnight_us / us_per_day + static_cast<std::int64_t>(day);
  const std::chrono::weekday weekday{std::chrono::sys_days(std::chrono::days(number))};
  const LogMoment midnight{number * us_per_day, 0};
  return names[weekday.c_encoding()] + (" " + pirsim::to_text(midnight, LogClock::local).substr(0, 10));
}

struct NamedLevels {
  std::string name;
  Levels levels;
  DaysChart::Shows shows = DaysChart::Shows::motion;
};

/// A line a sensor, or, of very many days and sensors, the most of all.
std::vector<NamedLevels> lines_of(const Log& log, const DayGrid& grid) {
  std::vector<NamedLevels> lines;
  constexpr std::size_t most_lines = 400;  // that anybody scrolls through
  if (log.people) lines.push_back({"people", people_levels(log, grid), DaysChart::Shows::people});
  const bool is_each = grid.n_days * (log.sensors.size() + lines.size()) <= most_lines;
  for (const LogTrack& track : log.sensors) {
    Levels levels = motion_levels(log, grid, track);
    if (is_each || &track == &log.sensors.front()) {
      lines.push_back({is_each ? track.name : "any sensor", std::move(levels)});
      continue;
    }
    Levels& most = lines.back().levels;
    for (std::size_t i = 0; i < most.size(); ++i) most[i] = std::max(most[i], levels[i]);
  }
  return lines;
}

DaysChart days_of(const Log& log) {
  const DayGrid grid = grid_of(log);
  DaysChart chart;
  chart.title = "When there was motion";
  chart.from_s = static_cast<double>(grid.from_us) / us_per_s;
  chart.bin_s = static_cast<double>(grid.bin_us) / us_per_s;
  chart.n_bins = static_cast<int>(grid.n_bins);
  chart.ticks = log.clock == LogClock::elapsed ? DaysChart::Ticks::seconds : DaysChart::Ticks::clock;
  const std::vector<NamedLevels> lines = lines_of(log, grid);
  for (std::size_t day = 0; day < grid.n_days; ++day) {
    DaysChart::Day& shown = chart.days.emplace_back();
    shown.name = log.clock == LogClock::elapsed ? "" : name_of_day(grid, day);
    for (const NamedLevels& line : lines)
      shown.lines.push_back(
          {line.name, DaysChart::runs_of(std::span(line.levels).subspan(day * grid.n_bins, grid.n_bins)), line.shows});
  }
  return chart;
}

// ------------------------------------------------------------------------------------------------------------- words

/// To a millisecond, at which the last event ends.
std::string moment_in_words(const Log& log, std::int64_t us) {
  constexpr std::int64_t ms = 1'000;
  return pirsim::to_text(log.moment((us + ms / 2) / ms * ms), log.clock);
}

/// "1.1 s", "45 min", "7.5 h", "12 d"
std::string time_in_words(double s) {
  constexpr double a_minute = 60.0, an_hour = 3600.0, a_day = 86'400.0;
  const auto short_number = [](double value) { return shortest_number(std::round(10.0 * value) / 10.0); };
  if (s < 10.0) return shortest_number(std::round(100.0 * s) / 100.0) + " s";
  if (s < 3.0 * a_minute) return short_number(s) + " s";
  if (s < 3.0 * an_hour) return short_number(s / a_minute) + " min";
  if (s < 3.0 * a_day) return short_number(s / an_hour) + " h";
  return short_number(s / a_day) + " d";
}

std::string rare_or_not(double share) { return percent(share, share < 0.1 ? 2 : 1); }

/// "1.1 s (38 %)"
std::string floor_in_words(const LogLengths& lengths) {
  if (lengths.n == 0) return {};
  return time_in_words(lengths.floor_s) + " (" + percent(lengths.floor_share) + ")";
}

std::string quantile_in_words(const LogLengths& lengths, double value) {
  return lengths.n == 0 ? std::string() : time_in_words(value);
}

std::string rate_in_words(const std::optional<LogFalseTriggers>& found) {
  if (!found) return {};
  return std::to_string(found->n) + " in " + fixed(found->hours, found->hours < 10.0 ? 1 : 0) + " h";
}

std::string people_in_words(const Log& log) {
  if (!log.people) return ", no counts";
  std::int32_t most = 0;
  for (const LogChange& change : log.people->changes) most = std::max(most, change.value);
  const bool is_count = log.map.people_mean == LogMap::People::count;
  return ", people: " + log.people->in_log + (is_count ? ", up to " + std::to_string(most) : ", present or not");
}

std::string names_in_words(const Log& log, const std::vector<std::size_t>& sensors) {
  if (sensors.size() == log.sensors.size() && sensors.size() > 1) return "all";
  std::vector<std::string> names;
  constexpr std::size_t most = 4;
  for (std::size_t i = 0; i < std::min(most, sensors.size()); ++i) names.push_back(log.sensors[sensors[i]].name);
  if (sensors.size() > most) names.push_back("and " + std::to_string(sensors.size() - most) + " more");
  return joined(names, ", ");
}

/// "readings every 30 s, 2 sensors, people: Room_Occupancy_Count, up to 3; 2017-12-22T10:49:11 to ..., 10129 rows"
std::string log_in_words(const Log& log) {
  return form_in_words(log) + "; " + moment_in_words(log, log.begin_us) + " to " + moment_in_words(log, log.end_us) +
         " (" + time_in_words(static_cast<double>(log.end_us - log.begin_us) / 1e6) + "), " +
         counted(log.n_rows, "row");
}

/// A row a sensor: share of motion, pulses, pauses, false triggers.
Table sensor_table(const Log& log, const LogFacts& facts) {
  Table table{{"sensor", "motion", "unknown", "pulses", "shortest", "hold", "median", "95 %", "shortest pause",
               "median pause", "false triggers"},
              {}};
  const double whole_s = static_cast<double>(log.end_us - log.begin_us) / 1e6;
  for (const LogSensorFacts& sensor : facts.sensors) {
    const auto share = sensor.motion_share();
    table.rows.push_back({sensor.name, share ? rare_or_not(*share) : "",
                          rare_or_not(std::max(0.0, sensor.unknown_s) / whole_s), std::to_string(sensor.pulses.n),
                          floor_in_words(sensor.pulses), sensor.hold_s ? time_in_words(*sensor.hold_s) : "not told",
                          quantile_in_words(sensor.pulses, sensor.pulses.median_s),
                          quantile_in_words(sensor.pulses, sensor.pulses.q95_s), floor_in_words(sensor.pauses),
                          quantile_in_words(sensor.pauses, sensor.pauses.median_s),
                          rate_in_words(sensor.false_triggers)});
  }
  return table;
}

/// A row a pair, of those most alike.
Table pair_table(const LogFacts& facts, std::size_t most) {
  Table table{{"sensors", "alike (phi)", "who leads", "begin together"}, {}};
  for (std::size_t i = 0; i < std::min(most, facts.pairs.size()); ++i) {
    const LogPair& pair = facts.pairs[i];
    const std::string &a = facts.sensors[pair.a].name, &b = facts.sensors[pair.b].name;
    std::string lead;
    if (pair.b_after_a_s) {
      const double after = *pair.b_after_a_s;
      lead = pair.has_leader() ? (after > 0.0 ? a : b) + " by " + time_in_words(std::abs(after)) : "neither";
    }
    table.rows.push_back({a + ", " + b, pair.phi ? fixed(*pair.phi, 2) : "", lead,
                          pair.n_together > 0 ? std::to_string(pair.n_together) : ""});
  }
  return table;
}

Table gap_table(const Log& log, const LogFacts& facts) {
  Table table{{"unknown from", "to", "for", "sensors"}, {}};
  for (const LogGap& gap : facts.gaps) {
    table.rows.push_back({moment_in_words(log, gap.from.us), moment_in_words(log, gap.to.us),
                          time_in_words(static_cast<double>(gap.to.us - gap.from.us) / 1e6),
                          names_in_words(log, gap.sensors)});
  }
  return table;
}

std::string first_of(std::span<const std::string> names) {
  constexpr std::size_t most = 12;
  const auto first = names.first(std::min(most, names.size()));
  return joined({first.begin(), first.end()}, ", ") +
         (names.size() > most ? " and " + std::to_string(names.size() - most) + " more" : "");
}

/// What the tables' columns mean, and what isn't in them.
std::vector<std::string> log_notes(const Log& log, const LogFacts& facts) {
  std::vector<std::string> notes;
  notes.push_back(
      "Shortest: what one in a hundred doesn't reach, and how many of all are at most a tenth longer. If that are "
      "three "
      "in ten of twenty pulses of events, it is the sensor's hold; if they are many of the pauses, its dead time" +
      std::string(log.has_readings() ? "; readings can't tell what is shorter than their interval." : "."));
  const auto told =
      std::ranges::find_if(facts.sensors, [](const auto& sensor) { return sensor.false_triggers.has_value(); });
  if (told != facts.sensors.end()) {
    notes.push_back(
        told->false_triggers->from == LogFalseTriggers::From::nobody
            ? "False triggers: motion that begins while the count is 0, five minutes from any other count."
            : "False triggers: motion that begins from midnight to five in the quietest third of the nights; "
              "the others have more.");
  }
  if (!log.others.empty()) {
    notes.push_back("Not read: " + first_of(log.others) +
                    (log.n_other_rows > 0 ? " (" + counted(log.n_other_rows, "row") + ")" : "") + ".");
  }
  if (log.n_other_lines > 0)
    notes.push_back(counted(log.n_other_lines, "line") + " of " + log.source + " tell of something else.");
  if (!log.has_readings() && log.map.form != LogMap::Form::intervals && !log.map.longest_gap_s) {
    notes.push_back("The longest time without any change is " + time_in_words(facts.longest_silence_s) +
                    ": it counts as known, unless a map says longest_gap_s.");
  }
  if (facts.n_gaps > facts.gaps.size())
    notes.push_back("There are " + std::to_string(facts.n_gaps) + " gaps; the longest are listed.");
  return notes;
}

/// Columns one below the other; the first one's texts begin, those of the others end at the same place.
std::string aligned(const Table& table) {
  std::vector<std::vector<std::string>> rows{table.headings};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  std::vector<std::size_t> widths(table.headings.size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - row[i].size(), ' ');
      line += i == 0 ? row[i] + space : "  " + space + row[i];
    }
    while (line.ends_with(' ')) line.pop_back();
    text += line + '\n';
  }
  return text;
}

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

std::string form_in_words(const Log& log) {
  const double interval_s = static_cast<double>(log.interval_us) / 1e6;
  const std::string form = log.map.form == LogMap::Form::events      ? "events"
                           : log.map.form == LogMap::Form::intervals ? "intervals"
                           : log.has_readings() ? "readings every " + shortest_number(interval_s) + " s"
                                                : "rows of changes";
  const std::string empty = log.map.empty == LogMap::Empty::unchanged ? " (an empty cell: unchanged)" : "";
  return form + empty + (log.source.empty() ? "" : " of " + log.source) + ", " + counted(log.sensors.size(), "sensor") +
         people_in_words(log);
}

std::string sensors_in_words(const Log& log) {
  std::vector<std::string> names;
  for (const LogTrack& track : log.sensors) names.push_back(track.in_log);
  return first_of(names) + (log.others.empty() ? "" : "; not read: " + first_of(log.others));
}

std::string to_text(const Log& log, const LogFacts& facts) {
  constexpr std::size_t most_pairs = 5, most_gaps = 5;
  std::string text = log_in_words(log) + "\n\n" + aligned(sensor_table(log, facts));
  if (!facts.pairs.empty()) text += '\n' + aligned(pair_table(facts, most_pairs));
  if (Table gaps = gap_table(log, facts); !gaps.rows.empty()) {
    if (gaps.rows.size() > most_gaps) gaps.rows.resize(most_gaps);
    text += '\n' + aligned(gaps);
  }
  text += '\n';
  for (const std::string& note : log_notes(log, facts)) text += note + '\n';
  return text;
}

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
