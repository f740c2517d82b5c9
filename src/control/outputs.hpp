// What lights do, row by row and as schedules of days.
#pragma once

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "pirsim/control.hpp"

namespace pirsim::control {

/// A row a row: each light, and the people of its area.
class LitTable {
 public:
  /// out: outlives it.
  LitTable(std::ostream& out, const RuleSpec& rule);
  void add(const Sample& row, const LitRow& lit);

 private:
  std::ostream& out_;
};

/// Shares of each step of whole days in which lights are lit, and somebody is there: as EnergyPlus' Schedule:File reads
/// them. What rows don't tell of a day is dark and empty.
class Schedule {
 public:
  /// step_min: a divisor of 60.
  Schedule(const RuleSpec& rule, double window_s, int step_min);
  /// Throws Error(input) for a row without a clock.
  void add(const Sample& row, const LitRow& lit);
  void write(std::ostream& out) const;
  [[nodiscard]] std::size_t n_days() const noexcept { return days_.size(); }

 private:
  struct Sums {
    double lit = 0.0, present = 0.0;  ///< seconds
  };
  int step_min_;
  double window_s_;
  std::vector<std::string> names_;
  std::map<std::string, std::vector<Sums>> days_;  ///< by date; (n_steps x n_lights)
};

}  // namespace pirsim::control
