// Windows of a log.
#include <algorithm>
#include <cmath>
#include <string>

#include "io/log/log_units.hpp"
#include "pirsim/log.hpp"
#include "schema/limits.hpp"

namespace pirsim {

using io::us_per_day, io::us_per_ms, io::us_per_s;
namespace {

std::int64_t divided_down(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
std::int64_t divided_up(std::int64_t a, std::int64_t b) { return -divided_down(-a, b); }

std::int64_t microseconds(double window_s) {
  const double ms = window_s * 1e3;
  constexpr double longest_ms = 86'400e3;
  if (!(ms >= 1.0) || ms > longest_ms || std::abs(ms - std::round(ms)) > 1e-6)
    throw Error(ErrorCode::usage, "a window lasts from 0.001 s to 86400 s, in whole milliseconds");
  return us_per_ms * std::llround(ms);
}

/// The first day's midnight, or second 0.
std::int64_t midnight_of(const Log& log) {
  const LogMoment begin = log.moment(log.begin_us);
  return log.clock == LogClock::elapsed
             ? 0
             : us_per_day * divided_down(begin.local_us(), us_per_day) - us_per_s * begin.offset_s;
}

}  // namespace

/// From one change to the next.
struct LogWindows::Run {
  std::int64_t first_us;   ///< a stamp, or when it begins
  std::int64_t before_us;  ///< of readings: the stamp before the first
  std::int64_t last_us;    ///< of readings: the last stamp. Of events: the end, which belongs to the next run
  std::int32_t value;
};

double usual_window_s(const Log& log) {
  constexpr double usual_s = 30.0;
  return std::max(usual_s, std::ceil(static_cast<double>(log.interval_us) / static_cast<double>(us_per_s)));
}

LogWindows::LogWindows(const Log& log, double window_s) : LogWindows(log, window_s, midnight_of(log)) {}

LogWindows::LogWindows(const Log& log, double window_s, std::int64_t aligned_to_us)
    : log_(&log), window_us_(microseconds(window_s)), origin_us_(aligned_to_us) {
  // The first reading's own window, not that in which the time begins for which it holds.
  first_ = holding(log.has_readings() ? log.begin_us + log.interval_us : log.begin_us);
  const std::int64_t last = holding(log.has_readings() ? log.end_us : std::max(log.end_us - 1, log.begin_us));
  if (last - first_ >= static_cast<std::int64_t>(limits::log_windows)) {
    throw Error(ErrorCode::usage, "windows of " + std::to_string(window_s) + " s would be more than " +
                                      std::to_string(limits::log_windows));
  }
  n_ = static_cast<std::size_t>(last - first_ + 1);
}

/// The window in which a stamp or a moment is.
std::int64_t LogWindows::holding(std::int64_t us) const {
  if (log_->has_readings()) return divided_up(us - origin_us_, window_us_) - 1;
  return divided_down(us - origin_us_, window_us_);
}

LogWindows::Span LogWindows::span_of(const Run& run) const {
  if (!log_->has_readings()) return {holding(run.first_us), holding(std::max(run.last_us - 1, run.first_us))};
  // And those that lie wholly between the stamp before and the first.
  const std::int64_t between = divided_up(run.before_us - origin_us_, window_us_);
  return {std::min(holding(run.first_us), between), holding(run.last_us)};
}

/// Calls put(run, window from, window to), counted from `first`, for all runs of a track that concern these windows.
/// Before and after what the log tells of, nothing is known.
template <typename Put>
void LogWindows::each_run(const LogTrack& track, std::size_t first, std::size_t n, Put put) const {
  const std::int64_t lower = first_ + static_cast<std::int64_t>(first), upper = lower + static_cast<std::int64_t>(n);
  const std::vector<LogChange>& changes = track.changes;
  const std::int64_t interval = log_->interval_us;
  constexpr std::int32_t nothing = -2;
  const auto tell = [&](const Run& run) {
    const Span span = span_of(run);
    const std::int64_t from = std::max(span.first, lower), to = std::min(span.last + 1, upper);
    if (from < to) put(run.value, static_cast<std::size_t>(from - lower), static_cast<std::size_t>(to - lower));
  };
  const std::int64_t grid_begin = origin_us_ + first_ * window_us_;
  const std::int64_t grid_end = grid_begin + static_cast<std::int64_t>(n_) * window_us_;
  const std::int64_t known_us = changes.empty() ? log_->end_us : changes.front().us;
  if (!log_->has_readings() && known_us > grid_begin) tell({grid_begin, grid_begin, known_us, nothing});
  if (log_->has_readings() && known_us - interval > grid_begin)
    tell({grid_begin + 1, grid_begin, known_us - interval, nothing});
  // The first run that may reach into these windows.
  const std::int64_t begin_us = origin_us_ + lower * window_us_;
  auto at = std::ranges::upper_bound(changes, begin_us, {}, &LogChange::us);
  if (at != changes.begin()) --at;
  for (; at != changes.end(); ++at) {
    const bool is_last = at + 1 == changes.end();
    const std::int64_t end = is_last ? log_->end_us : (at + 1)->us - (at + 1)->since_last_us;
    const Run run{at->us, at->us - at->since_last_us, std::max(end, at->us), at->value};
    if (span_of(run).first >= upper) break;
    tell(run);
  }
  if (!log_->has_readings() && log_->end_us < grid_end) tell({log_->end_us, log_->end_us, grid_end, nothing});
  if (log_->has_readings() && log_->end_us + interval <= grid_end)
    tell({log_->end_us + interval, log_->end_us + interval - 1, grid_end, nothing});
}

/// The greatest says most of a window: on, unknown, off.
void LogWindows::fill_motion(const LogTrack& track, std::size_t sensor, std::size_t first, LogRows& rows) const {
  const auto rank = [](std::int32_t state) { return state == log_state::on ? 2 : state == log_state::off ? 0 : 1; };
  const std::size_t n_sensors = rows.sensors.size();
  std::vector<std::int8_t> ranks(rows.n_windows(), 0);
  each_run(track, first, rows.n_windows(), [&](std::int32_t state, std::size_t from, std::size_t to) {
    const auto mine = static_cast<std::int8_t>(rank(state));
    for (std::size_t i = from; i < to; ++i) ranks[i] = std::max(ranks[i], mine);
  });
  constexpr std::uint8_t states[] = {log_state::off, log_state::unknown, log_state::on};
  for (std::size_t i = 0; i < ranks.size(); ++i)
    rows.motion[i * n_sensors + sensor] = states[static_cast<std::size_t>(ranks[i])];
}

void LogWindows::fill_people(std::size_t first, LogRows& rows) const {
  rows.people.assign(rows.n_windows(), log_state::unknown_count);
  each_run(*log_->people, first, rows.n_windows(), [&](std::int32_t count, std::size_t from, std::size_t to) {
    std::fill(rows.people.begin() + static_cast<std::ptrdiff_t>(from),
              rows.people.begin() + static_cast<std::ptrdiff_t>(to), std::max(count, log_state::unknown_count));
  });
}

LogMoment LogWindows::begin(std::size_t window) const {
  return log_->moment(origin_us_ + (first_ + static_cast<std::int64_t>(window)) * window_us_);
}

LogRows LogWindows::rows(std::size_t first, std::size_t n) const {
  first = std::min(first, n_);
  n = std::min(n, n_ - first);
  if (n * (log_->sensors.size() + sizeof(LogMoment)) > limits::log_cells) {
    throw Error(ErrorCode::usage, std::to_string(n) + " windows of " + std::to_string(log_->sensors.size()) +
                                      " sensors at once take more than 2 GB: ask for longer windows");
  }
  LogRows rows;
  for (const LogTrack& track : log_->sensors) rows.sensors.push_back(track.name);
  rows.window_s = static_cast<double>(window_us_) / us_per_s;
  rows.clock = log_->clock;
  rows.people_mean = log_->map.people_mean;
  rows.begin.reserve(n);
  for (std::size_t i = first; i < first + n; ++i) rows.begin.push_back(begin(i));
  rows.motion.resize(n * rows.sensors.size());
  for (std::size_t sensor = 0; sensor < rows.sensors.size(); ++sensor)
    fill_motion(log_->sensors[sensor], sensor, first, rows);
  if (log_->people) fill_people(first, rows);
  return rows;
}

}  // namespace pirsim
