#include "calibrate/motion_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace pirsim::calibrate {
namespace {

using counting::Stretch;

constexpr double minute_s = 60.0, hour_s = 3600.0;
constexpr double window_min = 5.0, pause_min = 10.0, busy_share = 0.7;
constexpr int least_readings_with_motion = 20;

std::uint8_t bit(const Stretch& stretch, std::size_t reading, int sensor) {
  return stretch.motion[reading * static_cast<std::size_t>(stretch.n_sensors) + static_cast<std::size_t>(sensor)];
}

/// Readings from the first to the last with motion; an unknown bit counts as none.
struct Active {
  std::size_t begin = 0, end = 0, with_motion = 0;
  std::vector<char> any;  ///< (end - begin)
};

Active active_part(const Stretch& stretch) {
  Active active;
  std::vector<char> any(stretch.n_readings(), 0);
  for (std::size_t i = 0; i < any.size(); ++i) {
    for (int k = 0; k < stretch.n_sensors; ++k) any[i] = any[i] != 0 || bit(stretch, i, k) == 1 ? 1 : 0;
    if (any[i] == 0) continue;
    if (active.with_motion++ == 0) active.begin = i;
    active.end = i + 1;
  }
  active.any.assign(any.begin() + static_cast<std::ptrdiff_t>(active.begin),
                    any.begin() + static_cast<std::ptrdiff_t>(active.end));
  return active;
}

/// Share of a sensor's known readings with motion.
double share(const Stretch& stretch, int sensor, std::size_t begin, std::size_t end) {
  std::size_t known = 0, motion = 0;
  for (std::size_t i = begin; i < end; ++i) {
    known += bit(stretch, i, sensor) == counting::unknown_bit ? 0 : 1;
    motion += bit(stretch, i, sensor) == 1 ? 1 : 0;
  }
  return known == 0 ? 0.0 : static_cast<double>(motion) / static_cast<double>(known);
}

/// Phi coefficient of the first and the last sensor; 0 where one of them never changes.
double likeness(const Stretch& stretch, const Active& active) {
  double n = 0, a = 0, b = 0, both = 0;
  for (std::size_t i = active.begin; i < active.end; ++i) {
    const std::uint8_t x = bit(stretch, i, 0), y = bit(stretch, i, stretch.n_sensors - 1);
    if (x == counting::unknown_bit || y == counting::unknown_bit) continue;
    n += 1;
    a += x;
    b += y;
    both += x * y;
  }
  const double spread = a * (n - a) * b * (n - b);
  return spread > 0.0 ? (n * both - a * b) / std::sqrt(spread) : 0.0;
}

/// Lengths of runs without and with motion, in readings.
struct Runs {
  std::vector<std::size_t> without, with;
};

Runs runs_of(const Active& active) {
  Runs runs;
  for (std::size_t i = 0; i < active.any.size();) {
    std::size_t end = i;
    while (end < active.any.size() && active.any[end] == active.any[i]) ++end;
    (active.any[i] != 0 ? runs.with : runs.without).push_back(end - i);
    i = end;
  }
  return runs;
}

double log_mean(const std::vector<std::size_t>& lengths) {
  double sum = 0.0;
  for (const std::size_t length : lengths) sum += static_cast<double>(length);
  return lengths.empty() ? 0.0 : std::log(sum / static_cast<double>(lengths.size()));
}

/// Shares of readings before which 5 min were quiet, and busy, for the busiest sensor.
std::pair<double, double> quiet_and_busy(const Stretch& stretch, const Active& active, double step_s) {
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(window_min * minute_s / step_s)));
  std::size_t quiet = 0, busy = 0;
  for (std::size_t i = active.begin; i < active.end; ++i) {
    double most = 0.0;
    for (int k = 0; k < stretch.n_sensors; ++k)
      most = std::max(most, share(stretch, k, i + 1 < window ? 0 : i + 1 - window, i + 1));
    quiet += most == 0.0 ? 1 : 0;
    busy += most > busy_share ? 1 : 0;
  }
  const auto n = static_cast<double>(active.any.size());
  return {static_cast<double>(quiet) / n, static_cast<double>(busy) / n};
}

std::vector<double> of_stretch(const Stretch& stretch, const Active& active, double step_s) {
  std::vector<double> shares;
  for (int k = 0; k < stretch.n_sensors; ++k) shares.push_back(share(stretch, k, active.begin, active.end));
  const auto [least, most] = std::ranges::minmax(shares);
  const double n = static_cast<double>(active.any.size()), hours = n * step_s / hour_s;
  const Runs runs = runs_of(active);
  const auto [quiet, busy] = quiet_and_busy(stretch, active, step_s);
  const auto pauses = std::ranges::count_if(
      runs.without, [&](std::size_t length) { return static_cast<double>(length) * step_s > pause_min * minute_s; });
  std::vector<double> values{most,
                             static_cast<double>(active.with_motion) / n,
                             log_mean(runs.with),
                             log_mean(runs.without),
                             quiet,
                             busy,
                             hours,
                             static_cast<double>(pauses) / hours,
                             static_cast<double>(active.begin) * step_s / hour_s};
  if (stretch.n_sensors > 1) {
    values.push_back(least);
    values.push_back(likeness(stretch, active));
  }
  return values;
}

}  // namespace

double told(const StatisticInfo& info, double value, double step_s) {
  return info.scale == StatisticInfo::Scale::plain ? value : std::exp(value) * step_s / minute_s;
}

std::vector<StatisticInfo> statistics_of(int n_sensors) {
  using Scale = StatisticInfo::Scale;
  std::vector<StatisticInfo> all{{"readings with motion, busiest sensor", "share"},
                                 {"readings with motion, any sensor", "share"},
                                 {"mean run with motion", "min", Scale::logarithm},
                                 {"mean run without", "min", Scale::logarithm},
                                 {"5 min without motion", "share"},
                                 {"5 min with motion in more than 70 %", "share"},
                                 {"from first to last motion", "h"},
                                 {"pauses longer than 10 min", "1/h"},
                                 {"first motion after the hours begin", "h"}};
  if (n_sensors > 1) {
    all.push_back({"readings with motion, quietest sensor", "share"});
    all.push_back({"likeness of first and last sensor", "phi"});
  }
  return all;
}

std::vector<std::vector<double>> motion_statistics(std::span<const Stretch> stretches, double step_s) {
  std::vector<std::vector<double>> all;
  for (const Stretch& stretch : stretches) {
    const Active active = active_part(stretch);
    if (active.with_motion >= least_readings_with_motion) all.push_back(of_stretch(stretch, active, step_s));
  }
  return all;
}

}  // namespace pirsim::calibrate
