#include "io/pages/log_days.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "io/log/log_runs.hpp"
#include "io/log/log_units.hpp"

namespace pirsim::io {
namespace {

/// Local time cut into bins of equal length: those of a day that the chart shows, day after day.
struct DayGrid {
  std::int64_t first_midnight_us = 0;  ///< local
  std::int64_t from_us = 0;            ///< of each day, the left end
  std::int64_t bin_us = 0;
  std::size_t n_days = 1, n_bins = 1;
};

std::int64_t rounded_down(std::int64_t a, std::int64_t b) { return a - ((a % b) + b) % b; }

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

}  // namespace

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

}  // namespace pirsim::io
