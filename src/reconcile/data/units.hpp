// Days that nobody scripted, in the parts that are compared: what a trial is where people do the same thing on purpose.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/script.hpp"
#include "schema/clock.hpp"

namespace pirsim::reconcile {

/// Which rows of a study's runs are compared together: those of one stretch of the data in which so many people are
/// there, or in which somebody may come or go. Presence is what data and simulation have in common there, so that
/// nobody who came unexpectedly is taken for a fault of a sensor.
struct Units {
  static constexpr std::uint16_t none = 0xFFFF;
  static constexpr std::int32_t not_sure = -1;

  std::string trial;                     ///< of the script: the only one
  std::size_t n_days = 0;                ///< runs that make one dataset; 0: runs are compared as a whole
  std::size_t n_rows = 0;                ///< of a run
  std::vector<std::uint16_t> of_row;     ///< (n_days x n_rows) a unit, or none
  std::vector<std::int32_t> people;      ///< (n_days x n_rows) there all the time, or not_sure
  std::vector<std::string> names;        ///< (n_units)
  std::vector<std::int64_t> begins_s{};  ///< (n_days) of the clock, since 1970; empty without a clock

  [[nodiscard]] bool empty() const noexcept { return n_days == 0; }
  /// A row with its neighbour before it, in the same unit: they follow each other.
  [[nodiscard]] std::uint16_t unit_of(std::size_t day, std::size_t row) const noexcept {
    return of_row[day * n_rows + row];
  }
  bool operator==(const Units&) const = default;
};

/// Of a study whose only trial has an occupancy; empty for any other.
[[nodiscard]] Units units_of(const ScriptSpec& script);

/// Throws Error(input) for a script that draws who is there, as a schedule does: no data tell its days from others.
void require_known_presence(const ScriptSpec& script);

}  // namespace pirsim::reconcile
