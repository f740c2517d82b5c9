// What is summed up of a light, and figures over days.
#pragma once

#include <cstdint>
#include <vector>

#include "pirsim/control.hpp"

namespace pirsim::control {

/// Of one day and delay, in rows.
struct DelaySums {
  std::int32_t lit = 0, lit_empty = 0, dark = 0, false_offs = 0, switched_on = 0;
};

/// Of a run nothing is left out; of a date there may be rows of a part alone.
enum class DayKind { run, date };

/// Of one day.
struct DaySums {
  DayKind kind = DayKind::run;
  std::int32_t all = 0, rows = 0, unknown = 0, occupied = 0;  ///< all: by daylight too; rows: that count
  std::int32_t first_occupied = -1, last_occupied = -1;       ///< of the rows that count; -1: nobody came
  std::vector<DelaySums> by_delay;
  [[nodiscard]] std::int32_t span() const { return first_occupied < 0 ? 0 : last_occupied - first_occupied + 1; }
};

/// Days drawn with replacement: how often each is drawn, (draws x days); the same for every figure.
class DrawnDays {
 public:
  explicit DrawnDays(std::size_t n_days);
  /// The sum of `above` over that of `below`, NaN without any of that. (n_days) each. No interval if all of `above` is
  /// 0: draws of it are 0, too.
  [[nodiscard]] Figure ratio(const std::vector<double>& above, const std::vector<double>& below) const;
  /// Events an hour, as ratio(). Without events its interval ends where a chance of 5 % remains to see none, if they
  /// come independently of each other: at 3 in all hours [Hanley1983].
  [[nodiscard]] Figure rate(const std::vector<double>& events, const std::vector<double>& hours) const;

 private:
  std::size_t n_days_;
  std::vector<std::uint16_t> times_;
};

}  // namespace pirsim::control
