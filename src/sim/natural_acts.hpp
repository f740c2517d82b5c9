// What people of natural style do with their bodies, as data: acts with amplitude, duration, frequency and source.
#pragma once

#include <optional>
#include <span>

#include "body/motion.hpp"
#include "pirsim/script.hpp"

namespace pirsim::sim {

/// What an act is to those who count them. Shifts and fidgets have rates of their own; tasks fill what is left.
enum class ActKind { shift, fidget, task };

/// One movement of one channel, to a target drawn between the bounds: relative to where the channel rests, or, of an
/// act that stays, to where it is at home.
struct Stroke {
  enum class Side { as_drawn, either };  ///< either: as often mirrored
  body::Channel channel;
  double low, high;  ///< metres, radians or shares
  Side side = Side::as_drawn;
};

/// Strokes that begin together, repeated so many times with targets of their own.
struct Act {
  enum class After { returns, stays };
  const char* name;
  double weight;  ///< how often, relative to the others of its kind
  std::span<const Stroke> strokes;
  double stroke_s;
  int fewest, most;  ///< repeats
  After after;
  const char* source;

  /// From the first stroke to the end of the way back.
  [[nodiscard]] constexpr double mean_s() const noexcept {
    return stroke_s * (0.5 * (fewest + most) + (after == After::returns ? 1.0 : 0.0));
  }
};

/// Where a channel is while nothing moves, if not at 0.
struct Hold {
  body::Channel channel;
  double value;
};

/// Still periods: a power law between two ends.
struct StillPeriods {
  double exponent;  ///< of the share of periods that are longer
  double shortest_s, longest_s;

  [[nodiscard]] double mean_s() const noexcept;
  /// u: uniform in [0, 1).
  [[nodiscard]] double length_s(double u) const noexcept;
  /// What is left of the period that one meets at a random moment of stillness.
  [[nodiscard]] double rest_s(double u, double v) const noexcept;
};

/// Posture shifts and fidgets of seated office workers, a second. Ref: [ApplErgon2024]: 9 and 13 in 15 minutes.
inline constexpr double shift_rate_per_s = 9.0 / 900.0;
inline constexpr double fidget_rate_per_s = 13.0 / 900.0;

/// All that somebody does in one situation. Shifts and fidgets may be empty, tasks not.
struct Repertoire {
  std::span<const Act> shifts, fidgets, tasks;
  std::span<const Hold> holds;
  StillPeriods still;
  double shifts_per_s = shift_rate_per_s, fidgets_per_s = fidget_rate_per_s;  ///< of the mean person

  [[nodiscard]] std::span<const Act> acts(ActKind kind) const noexcept {
    return kind == ActKind::shift ? shifts : kind == ActKind::fidget ? fidgets : tasks;
  }
};

enum class Bearing { seated, standing, walking, lying };
enum class Talk { none, listens, speaks };
[[nodiscard]] const Repertoire& repertoire(Bearing bearing, std::optional<Activity> activity, Talk talk) noexcept;

}  // namespace pirsim::sim
