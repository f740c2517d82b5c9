// Logs of motion sensors as people have them, windows made from them, and what they tell by themselves. The forms:
// docs/formats/log.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pirsim/dates.hpp"
#include "pirsim/error.hpp"
#include "pirsim/input_file.hpp"
#include "pirsim/sample.hpp"

namespace pirsim {

// What a log's columns and times mean. All of it may be left to the reader, which takes what it finds.

struct LogMap {
  enum class Form {
    found,     ///< as the log looks
    wide,      ///< a row a reading, a column a sensor
    events,    ///< a row a change of one sensor
    intervals  ///< a row a stretch of motion of one sensor, from its begin to its end
  };
  enum class Rows {
    found,
    readings,  ///< of a wide log: a row every interval, whose values hold for that interval
    changes    ///< a row whenever something changed, whose values hold until the next row
  };
  using Dates = pirsim::Dates;
  enum class Stamps { end, begin };  ///< which end of a reading its time stamp tells
  enum class Empty {
    found,
    unknown,   ///< an empty cell tells that the state isn't known
    unchanged  ///< of rows of changes: it didn't change, as in series that were joined by time
  };
  enum class Order { found, oldest_first, newest_first };  ///< of rows
  enum class Files {
    found,
    parts,   ///< of one log
    sensors  ///< each is one sensor's, which is called as the file is
  };
  /// What tells motion, besides the words that are known.
  struct States {
    std::vector<std::string> on, off;
    std::optional<double> above;  ///< a number above it is motion, any other one none
    bool operator==(const States&) const = default;
  };
  enum class People {
    count,     ///< how many are there
    presence,  ///< 1 if anybody is
    none       ///< the log doesn't tell
  };
  /// Of all sensors, or else of some, by their names in the scene or in the log.
  struct Seconds {
    std::optional<double> all;
    std::vector<std::pair<std::string, double>> each;
    bool operator==(const Seconds&) const = default;
  };
  struct Sensor {
    std::string name;    ///< of the sensor in the scene
    std::string in_log;  ///< its column or entity; a sensor that was renamed has several entries of one name
    bool operator==(const Sensor&) const = default;
  };

  Form form = Form::found;
  Rows rows = Rows::found;
  Empty empty = Empty::found;     ///< of a wide log: what an empty cell means
  std::vector<std::string> time;  ///< a column, or those of date, time, and AM or PM or an offset; empty: found. Of
                                  ///< intervals their begin
  std::vector<std::string> end;   ///< of intervals, as `time`
  std::vector<std::string> sensor_column;  ///< of events and intervals: a column, or several that name it together
  std::string state_column;                ///< of events; intervals may have one
  States states;
  Order order = Order::found;
  Files files = Files::found;
  std::string time_format;  ///< strptime's pattern, "%d.%m.%y %H.%M"; or of numbers seconds, excel_days, matlab_days
  /// IANA name: "Europe/Berlin". Stamps without an offset are local times there, others are told so. Empty: local times
  /// are taken as they are, and every day has 24 hours.
  std::string time_zone;
  Dates dates = Dates::found;
  Stamps stamps = Stamps::end;
  std::vector<Sensor> sensors;  ///< empty: all that the log has, under its own names
  std::string people;           ///< column or entity of the count; empty: found in wide logs
  People people_mean = People::count;
  std::optional<double> interval_s;     ///< between readings; none: found
  std::optional<double> longest_gap_s;  ///< what is longer isn't known. None: 1.5 intervals; of events: any is known
  Seconds hold_s;                       ///< of events: how long motion lasts whose end isn't told
  Seconds longest_motion_s;  ///< of events: motion of which nothing was told for longer is unknown from there
  double shift_s = 0.0;      ///< added to every time: the log's clock is so much late
  std::string from, to;      ///< local times, "2026-03-02T08:30"; empty: all
  bool operator==(const LogMap&) const = default;
};

/// A moment of a log.
struct LogMoment {
  /// Microseconds since 1970-01-01T00:00 UTC; of a log that tells neither zone nor offset, of its own clock; of one
  /// that tells elapsed seconds, since their zero. Never jumps.
  std::int64_t us = 0;
  std::int32_t offset_s = 0;  ///< local time is so much ahead of UTC

  [[nodiscard]] double seconds() const noexcept { return static_cast<double>(us) / 1e6; }
  [[nodiscard]] std::int64_t local_us() const noexcept { return us + std::int64_t{offset_s} * 1'000'000; }
  bool operator==(const LogMoment&) const = default;
};

enum class LogClock {
  elapsed,  ///< seconds since something began
  local,    ///< local times of an unknown zone, days of 24 hours
  zoned     ///< local times whose offset from UTC is known
};

/// Local time, "2026-03-02T08:30:00", with as many decimals as it has; of elapsed time "30600 s".
[[nodiscard]] std::string to_text(const LogMoment& moment, LogClock clock);

// What was read: of each sensor when it changed.

namespace log_state {
inline constexpr std::int32_t off = 0, on = 1, unknown = unknown_bit;
inline constexpr std::int32_t unknown_count = unknown_people;
}  // namespace log_state

/// From this moment on. Of readings: from the one with this stamp, the one before being so much earlier.
struct LogChange {
  std::int64_t us = 0;
  std::int64_t since_last_us = 0;  ///< of readings; 0 of events
  std::int32_t value = 0;          ///< log_state, or a number of people
  bool operator==(const LogChange&) const = default;
};

struct LogTrack {
  std::string name;                ///< of the map, else of the log
  std::string in_log;              ///< column or entity
  std::vector<LogChange> changes;  ///< in order of time; neighbours differ. Before the first nothing is known
  std::uint64_t n_read = 0;        ///< readings or events
};

/// From this moment on, local time is so much ahead of UTC.
struct LogOffset {
  std::int64_t from_us = 0;
  std::int32_t offset_s = 0;
};

struct Log {
  std::vector<InputFile> files;
  LogMap map;  ///< as given, completed by what was found
  LogClock clock = LogClock::local;
  std::vector<LogOffset> offsets;  ///< in order of time; the first holds before it, too
  std::vector<LogTrack> sensors;
  std::optional<LogTrack> people;
  std::int64_t begin_us = 0, end_us = 0;  ///< what it tells of: readings in (begin, end], or events in [begin, end)
  std::int64_t interval_us = 0;           ///< between readings; 0: events
  std::uint64_t n_rows = 0;               ///< that were read
  std::string source;                     ///< "openHAB's log", "Home Assistant's database"; empty: a table
  std::uint64_t n_other_lines = 0;        ///< of such a log: those that tell of something else
  std::vector<std::string> others;        ///< columns or entities that are no motion sensors
  std::uint64_t n_other_rows = 0;         ///< events of those
  std::vector<Issue> remarks;             ///< what is odd, a kind once

  [[nodiscard]] bool has_readings() const noexcept { return interval_us > 0; }
  [[nodiscard]] LogMoment moment(std::int64_t us) const;
};

namespace io {

// Reading. A file may be a pipe, UTF-16, or compressed by gzip or Zstandard; it may be Home Assistant's database, which
// is only read. It is read once, from begin to end, and memory grows with the number of changes in it: 24 bytes each.

struct LogObserver {
  std::function<void(std::uint64_t rows)> read;  ///< now and then: so many rows so far; may throw to end the reading
  std::optional<std::int64_t> now_us{};  ///< since 1970, UTC; no row is from later than a day after it. None: now
};

/// One log: several files are parts of it, in any order. Throws Error: io; input with all faults that could be told
/// apart, each kind once with its first place and how often it appears.
[[nodiscard]] Log read_log(std::span<const std::filesystem::path> files, const LogMap& map = {},
                           const LogObserver& observer = {});

/// Throws Error (io, input, usage).
[[nodiscard]] LogMap read_log_map(const std::filesystem::path& file, std::span<const std::string> overrides = {});
/// From memory; `name` stands in messages.
[[nodiscard]] LogMap parse_log_map(std::string_view text, const std::string& name);
/// As YAML that read_log_map() reads back.
[[nodiscard]] std::string to_yaml(const LogMap& map);

}  // namespace io

// Windows.

/// Windows of equal length, in order of time, also those in which nothing is known.
struct LogRows {
  std::vector<std::string> sensors;
  double window_s = 0.0;
  LogClock clock = LogClock::local;
  std::vector<LogMoment> begin;  ///< (n_windows)
  /// (n_windows x n_sensors): 1 if any motion is in the window, 0 if it is known throughout and none is, otherwise 2.
  std::vector<std::uint8_t> motion;
  std::vector<std::int32_t> people;  ///< (n_windows) at the window's end, -1: unknown; empty if the log has no count
  LogMap::People people_mean = LogMap::People::count;

  [[nodiscard]] std::size_t n_windows() const noexcept { return begin.size(); }
  /// Windows whose people are known.
  [[nodiscard]] std::size_t n_counted() const {
    return people.size() - static_cast<std::size_t>(std::ranges::count(people, log_state::unknown_count));
  }
  [[nodiscard]] std::uint8_t at(std::size_t window, std::size_t sensor) const {
    return motion[window * sensors.size() + sensor];
  }
};

/// The windows of a log: of one length, and aligned to the first day's midnight. Readings belong to the window (begin,
/// end] in which their stamp is, and to all that lie between their stamp and the one before; events to [begin, end).
class LogWindows {
 public:
  /// The log outlives it. Throws Error(usage) for a length that isn't a whole number of milliseconds, or so short that
  /// there would be more than a billion windows.
  LogWindows(const Log& log, double window_s);
  /// Aligned to a moment instead, before or after which they lie.
  LogWindows(const Log& log, double window_s, std::int64_t aligned_to_us);

  [[nodiscard]] std::size_t size() const noexcept { return n_; }
  /// Windows first, first + 1, ... first + n - 1; fewer at the end. Throws Error(usage) for more than 2 GB of them.
  [[nodiscard]] LogRows rows(std::size_t first, std::size_t n) const;
  [[nodiscard]] LogRows rows() const { return rows(0, n_); }
  [[nodiscard]] LogMoment begin(std::size_t window) const;  ///< also of the one after the last

 private:
  struct Span {
    std::int64_t first, last;  ///< windows, counted from the grid's origin
  };
  struct Run;
  [[nodiscard]] std::int64_t holding(std::int64_t us) const;
  [[nodiscard]] Span span_of(const Run& run) const;
  void fill_motion(const LogTrack& track, std::size_t sensor, std::size_t first, LogRows& rows) const;
  void fill_people(std::size_t first, LogRows& rows) const;
  template <typename Put>
  void each_run(const LogTrack& track, std::size_t first, std::size_t n, Put put) const;

  const Log* log_;
  std::int64_t window_us_;
  std::int64_t origin_us_;  ///< window 0 of the grid begins here
  std::int64_t first_ = 0;  ///< of the log's windows, on the grid
  std::size_t n_ = 0;
};

/// Windows in which a log is counted and written if nobody asks for others: of 30 s, or in whole seconds no shorter
/// than the log's readings are apart.
[[nodiscard]] double usual_window_s(const Log& log);

namespace io {
/// All windows of a log. See read_log() and LogWindows.
[[nodiscard]] LogRows read_log_rows(std::span<const std::filesystem::path> files, const LogMap& map, double window_s);
}  // namespace io

// What a log tells by itself.

/// How long motion, or pauses between motion, last. Seconds; of readings whole intervals.
struct LogLengths {
  std::size_t n = 0;  ///< those whose begin and end are known
  /// The length that one in a hundred doesn't reach, and how many of all are from there to a tenth longer. If many are,
  /// it is the sensor's hold, or its dead time.
  double floor_s = 0.0, floor_share = 0.0;
  double shortest_s = 0.0, q05_s = 0.0, q25_s = 0.0, median_s = 0.0, q75_s = 0.0, q95_s = 0.0, longest_s = 0.0;
};

/// Motion where there should be none.
struct LogFalseTriggers {
  enum class From {
    nobody,  ///< while the log's count is 0, five minutes from any other count
    nights   ///< midnight to five in the quietest third of the nights: less than on others
  };
  From from = From::nobody;
  double hours = 0.0;  ///< known ones of that kind
  std::size_t n = 0;   ///< how often motion begins in them
};

inline constexpr std::size_t fewest_pulses_of_hold = 20;  ///< that tell one; assumed (10-50)

struct LogSensorFacts {
  std::string name;
  double known_s = 0.0, unknown_s = 0.0;
  double motion_s = 0.0;
  LogLengths pulses;  ///< of motion
  LogLengths pauses;
  /// How long the sensor holds motion, to a tenth of a second, if events tell it: of 20 pulses or more, three in ten
  /// are as long as the shortest.
  std::optional<double> hold_s;
  std::array<std::optional<double>, 24> motion_by_hour{};  ///< share of the known time, by local hour of the day
  std::optional<LogFalseTriggers> false_triggers;
  bool never_changes = false;

  [[nodiscard]] std::optional<double> motion_share() const {
    return known_s > 0.0 ? std::optional(motion_s / known_s) : std::nullopt;
  }
};

/// Two sensors beside each other.
struct LogPair {
  std::size_t a = 0, b = 0;
  /// Correlation of their windows, from -1 to 1; none if one of them never changes.
  std::optional<double> phi;
  /// Median time from motion that begins at a to motion that begins at b, of those at most ten seconds apart: above 0
  /// if a leads. None if the log doesn't tell it: readings more than two seconds apart, or less than ten such.
  std::optional<double> b_after_a_s;
  std::size_t n_together = 0;  ///< of how many
  double a_first_share = 0.5;  ///< of those, in how many it begins at a

  /// Chance alone would give such a share once in a hundred.
  [[nodiscard]] bool has_leader() const noexcept;
};

/// Nothing is known of these sensors.
struct LogGap {
  LogMoment from, to;
  std::vector<std::size_t> sensors;
};

struct LogFacts {
  double interval_s = 0.0;    ///< between readings; 0: events
  double resolution_s = 0.0;  ///< all times are multiples of it: 60, 1, 0.001 or 0.000001 s
  std::vector<LogSensorFacts> sensors;
  double pair_window_s = 0.0;  ///< of the correlations
  std::vector<LogPair> pairs;  ///< all of up to a hundred sensors, the most alike first
  std::vector<LogGap> gaps;    ///< the longest first, twenty at most
  std::size_t n_gaps = 0;
  double longest_silence_s = 0.0;  ///< of events: without a change of any sensor
};

[[nodiscard]] LogFacts facts_of(const Log& log);

}  // namespace pirsim
