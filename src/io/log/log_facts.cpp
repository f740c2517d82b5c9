#include "pirsim/log_facts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "io/log/log_pairs.hpp"
#include "io/log/log_runs.hpp"
#include "io/log/log_units.hpp"

namespace pirsim {
namespace {

using io::each_stretch, io::LogRun, io::us_per_day, io::us_per_ms, io::us_per_s;

double in_seconds(std::int64_t us) { return static_cast<double>(us) / us_per_s; }

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
struct Day {
  std::array<double, 24> known{}, motion{};
};

void add_to_day(const Log& log, const LogRun& run, Day& day) {
  constexpr std::int64_t us_per_hour = 3600 * us_per_s;
  for (std::int64_t from = run.from_us; from < run.to_us;) {
    const std::int64_t local = log.moment(from).local_us();
    const std::int64_t of_day = ((local % us_per_day) + us_per_day) % us_per_day;
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
  Day day;
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

struct Stretch {
  std::int64_t from_us, to_us;
};

/// When the count says that nobody is there, but not near to other counts, which may be late.
std::vector<Stretch> empty_times(const Log& log) {
  constexpr std::int64_t apart_us = 300 * us_per_s;  // assumed: a count every 30 s, people who linger, a sensor's hold
  std::vector<Stretch> found;
  if (!log.people) return found;
  each_stretch(log, *log.people, [&](const LogRun& run) {
    if (run.value == 0 && run.to_us - run.from_us > 2 * apart_us)
      found.push_back({run.from_us + apart_us, run.to_us - apart_us});
  });
  return found;
}

/// What a sensor did in each of these stretches, which are in order of time.
struct InStretch {
  std::size_t n_onsets = 0;
  double known_h = 0.0;
};

std::vector<InStretch> done_in(const Log& log, const LogTrack& track, const std::vector<Stretch>& stretches) {
  std::vector<InStretch> done(stretches.size());
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
std::vector<Stretch> nights_of(const Log& log) {
  constexpr std::int64_t night_us = 5 * 3600 * us_per_s;
  std::vector<Stretch> nights;
  if (log.clock == LogClock::elapsed) return nights;
  const std::int64_t first_local = log.moment(log.begin_us).local_us();
  for (std::int64_t midnight = first_local - first_local % us_per_day;; midnight += us_per_day) {
    const std::int64_t from = midnight - us_per_s * log.moment(midnight).offset_s;
    if (from + night_us > log.end_us) return nights;
    if (from >= log.begin_us) nights.push_back({from, from + night_us});
  }
}

/// The third of all nights that are known in which motion begins least often; none of less than three.
std::vector<Stretch> quiet_nights(const Log& log) {
  const std::vector<Stretch> nights = nights_of(log);
  std::vector<InStretch> done(nights.size());
  for (const LogTrack& track : log.sensors) {
    const std::vector<InStretch> more = done_in(log, track, nights);
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
  std::vector<Stretch> chosen;
  for (const std::size_t i : known) chosen.push_back(nights[i]);
  return chosen;
}

void add_false_triggers(const Log& log, LogFacts& facts) {
  std::vector<Stretch> times = empty_times(log);
  const auto from = times.empty() ? LogFalseTriggers::From::nights : LogFalseTriggers::From::nobody;
  if (times.empty()) times = quiet_nights(log);
  for (std::size_t i = 0; i < log.sensors.size(); ++i) {
    LogFalseTriggers found{from, 0.0, 0};
    for (const InStretch& done : done_in(log, log.sensors[i], times)) {
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

}  // namespace

LogFacts facts_of(const Log& log) {
  LogFacts facts;
  facts.interval_s = in_seconds(log.interval_us);
  facts.resolution_s = resolution_of(log);
  for (const LogTrack& track : log.sensors) facts.sensors.push_back(sensor_facts(log, track));
  add_false_triggers(log, facts);
  add_gaps(log, facts);
  io::add_pairs(log, facts);
  if (!log.has_readings()) facts.longest_silence_s = longest_silence(log);
  return facts;
}

}  // namespace pirsim
