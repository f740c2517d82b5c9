#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "logs/calibrate.hpp"
#include "pirsim/calibrate.hpp"
#include "pirsim/csv.hpp"
#include "stats/intervals.hpp"

// What people ask of a log counted, and how far off that is.

namespace pirsim::calibrate {
namespace {

using counting::Estimates;

constexpr std::size_t to_date = 10, to_time = 11, hms = 8;

/// What is so, as what is told.
Estimates certain(const std::vector<int>& people, int n_counts) {
  Estimates sure{n_counts, std::vector<double>(people.size() * static_cast<std::size_t>(n_counts), 0.0)};
  for (std::size_t i = 0; i < people.size(); ++i) {
    const std::size_t at = i * static_cast<std::size_t>(n_counts);
    if (people[i] == counting::unknown_count)
      sure.probabilities[at] = std::nan("");
    else
      sure.probabilities[at + static_cast<std::size_t>(std::min(people[i], n_counts - 1))] = 1.0;
  }
  return sure;
}

/// Figures of an hour, summed up over days.
struct HourSums {
  int days = 0;
  double nobody = 0.0, mean = 0.0, most = 0.0;
  void add(const Figures& figures) {
    if (!(figures.told_h > 0.0)) return;
    ++days;
    nobody += figures.nobody;
    mean += figures.mean;
    most += figures.most;
  }
};

/// (hours) of days that all begin at the same time of day.
std::vector<HourSums> hours_of(std::span<const Estimates> days, double step_s) {
  std::vector<HourSums> hours;
  const auto n = static_cast<std::size_t>(std::max(1.0, std::round(hour_s / step_s)));
  for (const Estimates& day : days) {
    const std::size_t n_readings = day.probabilities.size() / static_cast<std::size_t>(day.n_counts);
    hours.resize(std::max(hours.size(), (n_readings + n - 1) / n));
    for (std::size_t h = 0; h * n < n_readings; ++h)
      hours[h].add(figures_of(day, h * n, std::min(n_readings, (h + 1) * n), step_s));
  }
  return hours;
}

/// When a reading begins.
std::string moment(const LogRows& rows, std::size_t reading) { return to_text(rows.begin[reading], rows.clock); }

std::string time_of_day(LogMoment at, LogClock clock) { return to_text(at, clock).substr(to_time, hms); }

/// When a reading ends: midnight is the end of its day.
std::string end_of(const LogRows& rows, std::size_t reading) {
  LogMoment at = rows.begin[reading];
  at.us += std::llround(rows.window_s * 1e6);
  const std::string time = time_of_day(at, rows.clock);
  return time == "00:00:00" ? "24:00:00" : time;
}

int hour_of(const LogRows& rows, std::size_t reading) {
  if (rows.clock == LogClock::elapsed) return static_cast<int>(rows.begin[reading].seconds() / hour_s);
  return std::stoi(moment(rows, reading).substr(to_time, 2));
}

Cell number(double value) { return std::isnan(value) ? Cell() : Cell(value); }

template <typename Row, counting::Off counting::FiguresOff::*off>
Cell most_off(const Row& row) {
  return row.off ? Cell(((*row.off).*off).most) : Cell();
}

constexpr int decimals = 3;
constexpr ColumnInfo info(std::string_view name, std::string_view meaning, std::string_view unit) {
  return {name, Holds::number, meaning, unit, When::always, {}, decimals};
}
constexpr std::string_view
    off = "in nine of ten such days of rooms that were left out it is off by no more",
    hour_off = "in nine of ten such hours of rooms that were left out it is off by no more; empty: nobody came";

using Day = CountedDay;
using Hour = CountedHour;
using Off = counting::FiguresOff;
constexpr Column<Day> day_columns[]{
    {{"date", Holds::text, "empty: the log has no dates"}, [](const Day& day) -> Cell { return day.date; }},
    {info("told_h", "for how long something is known", "h"), [](const Day& day) -> Cell { return day.figures.told_h; }},
    {info("occupied_h", "with somebody, to be expected", "h"),
     [](const Day& day) -> Cell { return day.figures.occupied_h; }},
    {info("occupied_off_h", off, "h"), most_off<Day, &Off::occupied_h>},
    {{"arrival", Holds::text, "when the first reading with somebody begins"},
     [](const Day& day) -> Cell { return day.arrival; }},
    {info("arrival_off_min", off, "min"), most_off<Day, &Off::arrival_min>},
    {{"departure", Holds::text, "when the last reading with somebody ends"},
     [](const Day& day) -> Cell { return day.departure; }},
    {info("departure_off_min", off, "min"), most_off<Day, &Off::departure_min>},
    {{"most", Holds::count, "people"},
     [](const Day& day) -> Cell { return static_cast<std::int64_t>(day.figures.most); }},
    {info("most_off", off, ""), most_off<Day, &Off::most>},
};
constexpr Column<Hour> hour_columns[]{
    {{"hour", Holds::count, "of the day, or since the log began if it has no dates"},
     [](const Hour& hour) -> Cell { return static_cast<std::int64_t>(hour.hour); }},
    {{"days", Holds::count, "on which it is told"},
     [](const Hour& hour) -> Cell { return static_cast<std::int64_t>(hour.days); }},
    {info("nobody", "probability that nobody is there, on average", ""),
     [](const Hour& hour) { return number(hour.nobody); }},
    {info("nobody_off", hour_off, ""), most_off<Hour, &Off::hour_nobody>},
    {info("mean", "people, on average", ""), [](const Hour& hour) { return number(hour.mean); }},
    {info("mean_off", hour_off, ""), most_off<Hour, &Off::hour_mean>},
    {info("most", "the most people at once, on average over the days", ""),
     [](const Hour& hour) { return number(hour.most); }},
    {info("most_off", hour_off, ""), most_off<Hour, &Off::hour_most>},
};

template <typename Row>
std::string table_of(std::span<const Row> rows) {
  std::ostringstream text;
  io::TableWriter<Row> csv(text);
  for (const Row& row : rows) csv.write(row);
  return text.str();
}

}  // namespace

Figures figures_of(const Estimates& estimates, std::size_t begin, std::size_t end, double step_s) {
  Figures figures;
  double told = 0.0, nobody = 0.0, people = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    if (!estimates.is_told(i)) continue;
    const std::size_t at = i * static_cast<std::size_t>(estimates.n_counts);
    told += 1.0;
    nobody += estimates.probabilities[at];
    for (int n = 1; n < estimates.n_counts; ++n)
      people += n * estimates.probabilities[at + static_cast<std::size_t>(n)];
    const int count = estimates.count(i);
    figures.most = std::max(figures.most, count);
    if (count == 0) continue;
    if (!figures.first) figures.first = i;
    figures.last = i;
  }
  figures.told_h = told * step_s / hour_s;
  figures.occupied_h = (told - nobody) * step_s / hour_s;
  figures.nobody = nobody / told;
  figures.mean = people / told;
  return figures;
}

FigureErrors figure_errors(std::span<const Estimates> told, std::span<const counting::Stretch> days, double step_s) {
  FigureErrors errors;
  const auto note = [&](counting::Off counting::FiguresOff::*figure, double error) {
    const auto* at = std::ranges::find(counting::figure_names, figure, &counting::FigureName::off);
    errors[static_cast<std::size_t>(at - std::begin(counting::figure_names))].push_back(std::abs(error));
  };
  std::vector<Estimates> so;
  for (std::size_t d = 0; d < days.size(); ++d) {
    so.push_back(certain(days[d].people, told[d].n_counts));
    const Figures real = figures_of(so[d], 0, days[d].n_readings(), step_s);
    const Figures figures = figures_of(told[d], 0, days[d].n_readings(), step_s);
    note(&Off::occupied_h, figures.occupied_h - real.occupied_h);
    note(&Off::most, figures.most - real.most);
    if (!real.first || !figures.first) continue;
    const auto minutes = [&](std::size_t a, std::size_t b) {
      return (static_cast<double>(a) - static_cast<double>(b)) * step_s / minute_s;
    };
    note(&Off::arrival_min, minutes(*figures.first, *real.first));
    note(&Off::departure_min, minutes(*figures.last, *real.last));
  }
  const std::vector<HourSums> of_told = hours_of(told, step_s), of_real = hours_of(so, step_s);
  for (std::size_t h = 0; h < of_real.size(); ++h) {
    if (of_real[h].days == 0 || of_told[h].days == 0) continue;
    const auto mean_off = [&](double HourSums::*sum) {
      return of_told[h].*sum / of_told[h].days - of_real[h].*sum / of_real[h].days;
    };
    note(&Off::hour_nobody, mean_off(&HourSums::nobody));
    note(&Off::hour_mean, mean_off(&HourSums::mean));
    note(&Off::hour_most, mean_off(&HourSums::most));
  }
  return errors;
}

counting::FiguresOff figures_off(const FigureErrors& errors, double times, double step_s) {
  constexpr double nine_in_ten = 0.9;
  counting::FiguresOff all;
  for (std::size_t f = 0; f < errors.size(); ++f) {
    if (errors[f].empty()) continue;
    const std::vector<double> alike(errors[f].size(), 1.0);
    all.*counting::figure_names[f].off = {times * weighted_mean(errors[f], alike),
                                          times * stats::quantile(errors[f], nine_in_ten)};
  }
  for (counting::Off Off::*time : {&Off::arrival_min, &Off::departure_min})
    (all.*time).most = std::max((all.*time).most, step_s / minute_s);  // nobody knows when in a reading
  return all;
}

std::vector<CountedDay> counted_days(const LogCounts& counts) {
  const LogRows& rows = counts.rows;
  const bool has_dates = rows.clock != LogClock::elapsed;
  std::vector<CountedDay> days;
  for (std::size_t i = 0; i < rows.n_windows(); ++i) {
    const std::string date = has_dates ? moment(rows, i).substr(0, to_date) : "";
    if (days.empty() || days.back().date != date) days.push_back({.date = date, .begin = i, .off = counts.figures_off});
    days.back().end = i + 1;
  }
  // The one short reading that ends at a log's first midnight, or begins at its last, is no day.
  const auto is_edge = [&](const CountedDay& day) { return day.end - day.begin == 1 && rows.window_s <= minute_s; };
  if (has_dates && days.size() > 1 && is_edge(days.front())) days.erase(days.begin());
  if (has_dates && days.size() > 1 && is_edge(days.back())) days.pop_back();
  for (CountedDay& day : days) {
    day.figures = figures_of(counts.estimates, day.begin, day.end, rows.window_s);
    if (!has_dates || !day.figures.first) continue;
    day.arrival = time_of_day(rows.begin[*day.figures.first], rows.clock);
    day.departure = end_of(rows, *day.figures.last);
  }
  return days;
}

std::vector<CountedHour> counted_hours(const LogCounts& counts) {
  const LogRows& rows = counts.rows;
  std::map<int, HourSums> sums;
  for (std::size_t begin = 0; begin < rows.n_windows();) {
    const int hour = hour_of(rows, begin);
    std::size_t end = begin;
    while (end < rows.n_windows() && hour_of(rows, end) == hour) ++end;
    sums[hour].add(figures_of(counts.estimates, begin, end, rows.window_s));
    begin = end;
  }
  constexpr double empty = 0.99;  // the rooms' errors are those of hours in which people come and go
  std::vector<CountedHour> hours;
  for (const auto& [hour, sum] : sums) {
    CountedHour& one = hours.emplace_back(
        CountedHour{hour, sum.days, sum.nobody / sum.days, sum.mean / sum.days, sum.most / sum.days});
    if (one.nobody < empty) one.off = counts.figures_off;
  }
  return hours;
}

std::string to_csv(std::span<const CountedDay> days) { return table_of(days); }
std::string to_csv(std::span<const CountedHour> hours) { return table_of(hours); }

}  // namespace pirsim::calibrate

template <>
std::span<const pirsim::Column<pirsim::calibrate::CountedDay>> pirsim::columns_of() {
  return calibrate::day_columns;
}
template <>
std::span<const pirsim::Column<pirsim::calibrate::CountedHour>> pirsim::columns_of() {
  return calibrate::hour_columns;
}
