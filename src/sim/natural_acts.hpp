// What people of natural style do with their bodies, as data: acts with amplitude, duration, frequency and source.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "body/motion.hpp"
#include "pirsim/script.hpp"

namespace pirsim::sim {

/// What an act is to those who count them. All but tasks have rates of their own; tasks fill what is left.
enum class ActKind { shift, fidget, touch, look, task };
inline constexpr std::size_t n_habits = 4;  ///< kinds before tasks

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

/// Still periods are log-normal.
struct StillPeriods {
  double mean_s;

  /// z: standard normal.
  [[nodiscard]] double length_s(double z) const noexcept;
  /// What is left of the period that one meets at a random moment of stillness. v: uniform in [0, 1).
  [[nodiscard]] double rest_s(double z, double v) const noexcept;
};

/// Acts of a kind, and how often the mean person carries out one of them.
struct Habit {
  std::span<const Act> acts;
  double per_s = 0.0;
};

/// All that somebody does in one situation. Habits may be empty, tasks not.
struct Repertoire {
  std::array<Habit, n_habits> habits;  ///< in the order of ActKind
  std::span<const Act> tasks;
  std::span<const Hold> holds;
  StillPeriods still;

  [[nodiscard]] std::span<const Act> acts(ActKind kind) const noexcept {
    return kind == ActKind::task ? tasks : habits[static_cast<std::size_t>(kind)].acts;
  }
};

enum class Bearing { seated, standing, walking, lying };
enum class Talk { none, listens, speaks };
[[nodiscard]] const Repertoire& repertoire(Bearing bearing, std::optional<Activity> activity, Talk talk) noexcept;

}  // namespace pirsim::sim
