// What lights do, row by row and as schedules of days.
#pragma once

#include <cstdint>
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
/// them. Over the rows that are known of this step, of one run or of several. Steps of which nothing is known are dark
/// and empty, which a remark tells.
class Schedule {
 public:
  /// step_min: a divisor of 60. people: if they aren't known, it has no shares of them.
  Schedule(const RuleSpec& rule, double window_s, int step_min, People people);
  /// Throws Error(input) for a row without a clock.
  void add(const LitRow& lit);
  /// Throws Error(input) for a light of which nothing is known.
  void write(std::ostream& out) const;
  [[nodiscard]] std::size_t n_days() const noexcept { return days_.size(); }
  /// What a reader of whole years doesn't expect.
  [[nodiscard]] std::vector<Issue> remarks() const;

 private:
  struct Sums {
    double lit = 0.0, known = 0.0, present = 0.0, counted = 0.0;  ///< seconds; known, counted: of the lamp, of people
  };
  double window_s_, step_s_;
  People people_;
  std::vector<std::string> names_;
  std::map<std::int64_t, std::vector<Sums>> days_;  ///< since 1970; (n_steps x n_lights)
};

}  // namespace pirsim::control
