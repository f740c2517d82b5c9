#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "logs/times.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/log.hpp"

namespace pirsim {
namespace {

using io::each_stretch, io::LogRun, io::rounded_down, io::us_per_day, io::us_per_ms, io::us_per_s;

double in_seconds(std::int64_t us) { return static_cast<double>(us) / us_per_s; }

// ----------------------------------------------------------------------------------------- how much alike sensors are

/// Windows of one sensor, a bit each.
struct Bits {
  std::vector<std::uint64_t> known, on;
};

/// How often two sensors were on, of the windows in which both are known.
struct Counts {
  std::uint64_t both = 0, a = 0, b = 0, known = 0;
};

std::uint64_t n_common(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  std::uint64_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n += static_cast<std::uint64_t>(std::popcount(a[i] & b[i]));
  return n;
}

std::vector<Bits> bits_of(const LogRows& rows) {
  constexpr std::size_t bits = 64;
  const std::size_t n_words = (rows.n_windows() + bits - 1) / bits;
  std::vector<Bits> result(rows.sensors.size(),
                           {std::vector<std::uint64_t>(n_words), std::vector<std::uint64_t>(n_words)});
  for (std::size_t window = 0; window < rows.n_windows(); ++window) {
    const std::uint64_t bit = std::uint64_t{1} << window % bits;
    for (std::size_t sensor = 0; sensor < result.size(); ++sensor) {
      const std::uint8_t state = rows.at(window, sensor);
      if (state != log_state::unknown) result[sensor].known[window / bits] |= bit;
      if (state == log_state::on) result[sensor].on[window / bits] |= bit;
    }
  }
  return result;
}

std::optional<double> phi_of(const Counts& counts) {
  const auto n = static_cast<double>(counts.known), a = static_cast<double>(counts.a),
             b = static_cast<double>(counts.b);
  const double spread = a * (n - a) * b * (n - b);
  if (!(spread > 0.0)) return std::nullopt;
  return (n * static_cast<double>(counts.both) - a * b) / std::sqrt(spread);
}

std::vector<std::int64_t> onsets_of(const LogTrack& track) {
  std::vector<std::int64_t> onsets;
  for (std::size_t i = 1; i < track.changes.size(); ++i) {
    if (track.changes[i].value == log_state::on && track.changes[i - 1].value == log_state::off)
      onsets.push_back(track.changes[i].us);
  }
  return onsets;
}

/// From each onset of a to the nearest of b, if that is at most ten seconds away.
void set_lead(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b, LogPair& pair) {
  constexpr std::int64_t farthest_us = 10 * us_per_s;  // assumed: a walk through a room
  constexpr std::size_t fewest = 10;
  std::vector<std::int64_t> after;
  auto next = b.begin();
  for (const std::int64_t onset : a) {
    while (next != b.end() && *next < onset) ++next;
    std::int64_t nearest = farthest_us + 1;
    if (next != b.end()) nearest = *next - onset;
    if (next != b.begin() && onset - *(next - 1) < nearest) nearest = *(next - 1) - onset;
    if (std::abs(nearest) <= farthest_us) after.push_back(nearest);
  }
  pair.n_together = after.size();
  if (after.size() < fewest) return;
  const auto n_first = std::ranges::count_if(after, [](std::int64_t us) { return us > 0; });
  const auto n_same = std::ranges::count(after, 0);
  pair.a_first_share =
      (static_cast<double>(n_first) + 0.5 * static_cast<double>(n_same)) / static_cast<double>(after.size());
  const auto middle = after.begin() + static_cast<std::ptrdiff_t>(after.size() / 2);
  std::nth_element(after.begin(), middle, after.end());
  pair.b_after_a_s = in_seconds(*middle);
}

/// Sets the pairs of facts and the length of their windows.
void add_pairs(const Log& log, LogFacts& facts) {
  constexpr std::size_t most_sensors = 100;
  constexpr double usual_window_s = 10.0;  // assumed: holds of seconds fall into one window, two visits don't
  const std::size_t n = log.sensors.size();
  if (n > most_sensors) return;
  facts.pair_window_s = std::max(usual_window_s, std::ceil(facts.interval_s));
  const LogWindows windows(log, std::min(facts.pair_window_s, 86'400.0));
  std::vector<Counts> counts(n * n);
  constexpr std::size_t at_once = 1U << 14U;
  for (std::size_t first = 0; first < windows.size(); first += at_once) {
    const std::vector<Bits> bits = bits_of(windows.rows(first, at_once));
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = a + 1; b < n; ++b) {
        Counts& pair = counts[a * n + b];
        pair.both += n_common(bits[a].on, bits[b].on);
        pair.a += n_common(bits[a].on, bits[b].known);
        pair.b += n_common(bits[a].known, bits[b].on);
        pair.known += n_common(bits[a].known, bits[b].known);
      }
    }
  }
  std::vector<std::vector<std::int64_t>> onsets;
  for (const LogTrack& track : log.sensors) onsets.push_back(onsets_of(track));
  constexpr double most_interval_s = 2.0;
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      LogPair& pair = facts.pairs.emplace_back(LogPair{a, b, phi_of(counts[a * n + b]), {}, 0});
      if (facts.interval_s <= most_interval_s) set_lead(onsets[a], onsets[b], pair);
    }
  }
  std::ranges::stable_sort(facts.pairs, std::greater{}, [](const LogPair& pair) { return pair.phi.value_or(-2.0); });
}

// ------------------------------------------------------------------------------------------------------------- lengths

LogLengths lengths_of(std::vector<double> lengths) {
  LogLengths facts;
  facts.n = lengths.size();
  if (lengths.empty()) return facts;
  std::ranges::sort(lengths);
  const auto quantile = [&](double share) {
    return lengths[static_cast<std::size_t>(std::lround(share * static_cast<double>(lengths.size() - 1)))];
  };
  facts.shortest_s = lengths.front();
  facts.q05_s = quantile(0.05);
  facts.q25_s = quantile(0.25);
  facts.median_s = quantile(0.5);
  facts.q75_s = quantile(0.75);
  facts.q95_s = quantile(0.95);
  facts.longest_s = lengths.back();
  constexpr double a_hundredth = 0.01, a_tenth_more = 1.1;  // assumed: fewer are faults of a clock or of a radio
  facts.floor_s = quantile(a_hundredth);
  const auto until = [&](double length) { return std::ranges::upper_bound(lengths, length) - lengths.begin(); };
  const auto below = std::ranges::lower_bound(lengths, facts.floor_s) - lengths.begin();
  facts.floor_share = static_cast<double>(until(a_tenth_more * facts.floor_s) - below) / static_cast<double>(facts.n);
  return facts;
}

/// Of the runs of `state` between two of the other one.
LogLengths lengths_of(const std::vector<LogRun>& runs, std::int32_t state) {
  std::vector<double> lengths;
  for (std::size_t i = 1; i + 1 < runs.size(); ++i) {
    const bool is_whole = runs[i - 1].value != log_state::unknown && runs[i + 1].value != log_state::unknown;
    if (runs[i].value == state && is_whole) lengths.push_back(in_seconds(runs[i].to_us - runs[i].from_us));
  }
  return lengths_of(std::move(lengths));
}

std::optional<double> hold_told_by(const LogLengths& pulses) {
  constexpr double least_share = 0.3;  // that is as long as the shortest; assumed (0.2-0.5)
  constexpr double shortest_s = 0.5;   // assumed: detectors' own pulses are shorter (0.3-1)
  constexpr double per_s = 10.0;       // no log tells more
  if (pulses.n < fewest_pulses_of_hold || pulses.floor_share < least_share || pulses.floor_s < shortest_s)
    return std::nullopt;
  return std::round(per_s * pulses.floor_s) / per_s;
}

// ---------------------------------------------------------------------------------------------------------------- time

/// Seconds of each hour of the day.
struct HoursOfDay {
  std::array<double, 24> known{}, motion{};
};

void add_to_day(const Log& log, const LogRun& run, HoursOfDay& day) {
  constexpr std::int64_t us_per_hour = 3600 * us_per_s;
  for (std::int64_t from = run.from_us; from < run.to_us;) {
    const std::int64_t local = log.moment(from).local_us();
    const std::int64_t of_day = local - rounded_down(local, us_per_day);
    const std::int64_t to = std::min(run.to_us, from + us_per_hour - of_day % us_per_hour);
    const auto hour = static_cast<std::size_t>(of_day / us_per_hour);
    day.known[hour] += in_seconds(to - from);
    if (run.value == log_state::on) day.motion[hour] += in_seconds(to - from);
    from = to;
  }
}

LogSensorFacts sensor_facts(const Log& log, const LogTrack& track) {
  LogSensorFacts facts;
  facts.name = track.name;
  std::vector<LogRun> runs;
  each_stretch(log, track, [&](const LogRun& run) { runs.push_back(run); });
  HoursOfDay day;
  bool was_on = false, was_off = false;
  for (const LogRun& run : runs) {
    const double s = in_seconds(run.to_us - run.from_us);
    was_on = was_on || run.value == log_state::on;
    was_off = was_off || run.value == log_state::off;
    if (run.value == log_state::unknown) continue;
    facts.known_s += s;
    if (run.value == log_state::on) facts.motion_s += s;
    add_to_day(log, run, day);
  }
  facts.unknown_s = in_seconds(log.end_us - log.begin_us) - facts.known_s;
  facts.never_changes = !was_on || !was_off;
  facts.pulses = lengths_of(runs, log_state::on);
  facts.pauses = lengths_of(runs, log_state::off);
  if (!log.has_readings()) facts.hold_s = hold_told_by(facts.pulses);
  if (log.clock == LogClock::elapsed) return facts;
  for (std::size_t hour = 0; hour < day.known.size(); ++hour) {
    if (day.known[hour] > 0.0) facts.motion_by_hour[hour] = day.motion[hour] / day.known[hour];
  }
  return facts;
}

// ------------------------------------------------------------------------------------------------------ false triggers

struct TimeSpan {
  std::int64_t from_us, to_us;
};

/// When the count says that nobody is there, but not near to other counts, which may be late.
std::vector<TimeSpan> empty_times(const Log& log) {
  constexpr std::int64_t apart_us = 300 * us_per_s;  // assumed: a count every 30 s, people who linger, a sensor's hold
  std::vector<TimeSpan> found;
  if (!log.people) return found;
  each_stretch(log, *log.people, [&](const LogRun& run) {
    if (run.value == 0 && run.to_us - run.from_us > 2 * apart_us)
      found.push_back({run.from_us + apart_us, run.to_us - apart_us});
  });
  return found;
}

/// What a sensor did in each of these stretches, which are in order of time.
struct InTimeSpan {
  std::size_t n_onsets = 0;
  double known_h = 0.0;
};

std::vector<InTimeSpan> done_in(const Log& log, const LogTrack& track, const std::vector<TimeSpan>& stretches) {
  std::vector<InTimeSpan> done(stretches.size());
  std::size_t first = 0;
  std::int32_t before = log_state::unknown;
  each_stretch(log, track, [&](const LogRun& run) {
    while (first < stretches.size() && stretches[first].to_us <= run.from_us) ++first;
    const bool is_onset = run.value == log_state::on && before == log_state::off;
    before = run.value;
    if (first < stretches.size() && is_onset && stretches[first].from_us <= run.from_us) ++done[first].n_onsets;
    if (run.value == log_state::unknown) return;
    for (std::size_t i = first; i < stretches.size() && stretches[i].from_us < run.to_us; ++i) {
      const std::int64_t from = std::max(run.from_us, stretches[i].from_us),
                         to = std::min(run.to_us, stretches[i].to_us);
      done[i].known_h += in_seconds(to - from) / 3600.0;
    }
  });
  return done;
}

/// Midnight to five, of each day that the log has.
std::vector<TimeSpan> nights_of(const Log& log) {
  constexpr std::int64_t night_us = 5 * 3600 * us_per_s;
  std::vector<TimeSpan> nights;
  if (log.clock == LogClock::elapsed) return nights;
  const std::int64_t first_local = log.moment(log.begin_us).local_us();
  for (std::int64_t midnight = first_local - first_local % us_per_day;; midnight += us_per_day) {
    const std::int64_t from = midnight - us_per_s * log.moment(midnight).offset_s;
    if (from + night_us > log.end_us) return nights;
    if (from >= log.begin_us) nights.push_back({from, from + night_us});
  }
}

/// The third of all nights that are known in which motion begins least often; none of less than three.
std::vector<TimeSpan> quiet_nights(const Log& log) {
  const std::vector<TimeSpan> nights = nights_of(log);
  std::vector<InTimeSpan> done(nights.size());
  for (const LogTrack& track : log.sensors) {
    const std::vector<InTimeSpan> more = done_in(log, track, nights);
    for (std::size_t i = 0; i < nights.size(); ++i) {
      done[i].n_onsets += more[i].n_onsets;
      done[i].known_h += more[i].known_h;
    }
  }
  std::vector<std::size_t> known;
  const double enough_h = 0.9 * 5.0 * static_cast<double>(log.sensors.size());
  for (std::size_t i = 0; i < nights.size(); ++i) {
    if (done[i].known_h >= enough_h) known.push_back(i);
  }
  constexpr std::size_t fewest = 3;
  if (known.size() < fewest) return {};
  std::ranges::stable_sort(known, {}, [&](std::size_t i) { return done[i].n_onsets; });
  known.resize(known.size() / 3);
  std::ranges::sort(known);
  std::vector<TimeSpan> chosen;
  for (const std::size_t i : known) chosen.push_back(nights[i]);
  return chosen;
}

void add_false_triggers(const Log& log, LogFacts& facts) {
  std::vector<TimeSpan> times = empty_times(log);
  const auto from = times.empty() ? LogFalseTriggers::From::nights : LogFalseTriggers::From::nobody;
  if (times.empty()) times = quiet_nights(log);
  for (std::size_t i = 0; i < log.sensors.size(); ++i) {
    LogFalseTriggers found{from, 0.0, 0};
    for (const InTimeSpan& done : done_in(log, log.sensors[i], times)) {
      found.hours += done.known_h;
      found.n += done.n_onsets;
    }
    if (found.hours > 0.0) facts.sensors[i].false_triggers = found;
  }
}

// ---------------------------------------------------------------------------------------------------------------- gaps

void add_gaps(const Log& log, LogFacts& facts) {
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::size_t>> gaps;
  for (std::size_t i = 0; i < log.sensors.size(); ++i) {
    const LogTrack& track = log.sensors[i];
    const auto add = [&](std::int64_t from, std::int64_t to) {
      if (to > from) gaps[{from, to}].push_back(i);
    };
    const LogChange first = track.changes.empty() ? LogChange{log.end_us, 0, 0} : track.changes.front();
    add(log.begin_us, first.us - first.since_last_us);
    each_stretch(log, track, [&](const LogRun& run) {
      if (run.value == log_state::unknown) add(run.from_us, run.to_us);
    });
  }
  facts.n_gaps = gaps.size();
  for (auto& [times, sensors] : gaps)
    facts.gaps.push_back({log.moment(times.first), log.moment(times.second), std::move(sensors)});
  std::ranges::stable_sort(facts.gaps, std::greater{}, [](const LogGap& gap) { return gap.to.us - gap.from.us; });
  constexpr std::size_t most = 20;
  if (facts.gaps.size() > most) facts.gaps.resize(most);
}

double resolution_of(const Log& log) {
  for (const std::int64_t unit : {60 * us_per_s, us_per_s, us_per_ms}) {
    const bool is_multiple = std::ranges::all_of(log.sensors, [&](const LogTrack& track) {
      return std::ranges::all_of(track.changes, [&](const LogChange& change) { return change.us % unit == 0; });
    });
    if (is_multiple) return in_seconds(unit);
  }
  return 1e-6;
}

double longest_silence(const Log& log) {
  std::vector<std::int64_t> times{log.begin_us, log.end_us};
  for (const LogTrack& track : log.sensors) {
    for (const LogChange& change : track.changes) times.push_back(change.us);
  }
  std::ranges::sort(times);
  std::int64_t longest = 0;
  for (std::size_t i = 1; i < times.size(); ++i) longest = std::max(longest, times[i] - times[i - 1]);
  return in_seconds(longest);
}

// Windows of a log.

std::int64_t divided_down(std::int64_t a, std::int64_t b) { return rounded_down(a, b) / b; }
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
  return log.clock == LogClock::elapsed ? 0 : rounded_down(begin.local_us(), us_per_day) - us_per_s * begin.offset_s;
}

}  // namespace

bool LogPair::has_leader() const noexcept {
  constexpr double two_sided_99 = 2.576;
  return b_after_a_s && std::abs(a_first_share - 0.5) > 0.5 * two_sided_99 / std::sqrt(static_cast<double>(n_together));
}

LogFacts facts_of(const Log& log) {
  LogFacts facts;
  facts.interval_s = in_seconds(log.interval_us);
  facts.resolution_s = resolution_of(log);
  for (const LogTrack& track : log.sensors) facts.sensors.push_back(sensor_facts(log, track));
  add_false_triggers(log, facts);
  add_gaps(log, facts);
  add_pairs(log, facts);
  if (!log.has_readings()) facts.longest_silence_s = longest_silence(log);
  return facts;
}

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
  // The first run that may reach into these windows: of several changes at their very begin, all touch the first one.
  const std::int64_t begin_us = origin_us_ + lower * window_us_;
  auto at = std::ranges::lower_bound(changes, begin_us, {}, &LogChange::us);
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
