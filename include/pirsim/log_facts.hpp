// What a log of motion sensors tells by itself: docs/formats/log.md.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/log.hpp"

namespace pirsim {

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
