// The two passes over a hidden Markov model.
#pragma once

#include <span>
#include <vector>

#include "pirsim/counting.hpp"

namespace pirsim::counting {

[[nodiscard]] inline std::size_t size(int n) { return static_cast<std::size_t>(n); }

/// What a reading tells: how many of its sensors are known, and how many of these report motion.
struct Reading {
  int known = 0, active = 0;
  int people = unknown_count;
};
[[nodiscard]] std::vector<Reading> readings_of(const Stretch& stretch);

/// States that a reading leaves possible, as a range: all, or those of a known count. Counts beyond the model's are
/// taken for its most.
struct StateRange {
  std::size_t begin = 0, end = 0;
};
[[nodiscard]] StateRange states_of(const Counter& counter, const Reading& reading);

/// (states) likelihood of a reading, 0 where it isn't possible. Where some sensors are unknown: each choice of sensors
/// is as likely to be the known one.
void likelihood(const Counter& counter, std::span<const double> emissions, const Reading& reading,
                std::vector<double>& out);

struct ForwardPass {
  std::vector<double> beliefs;  ///< (readings x states)
  double log_likelihood = 0.0;
};
[[nodiscard]] ForwardPass forward(const Counter& counter, const RoomModel& room, std::span<const Reading> readings);
/// Forward beliefs become those that know what came after. moved, if not empty: (states x states), to which the
/// expected number of each move is added.
void smooth(const Counter& counter, std::span<const Reading> readings, std::vector<double>& beliefs,
            std::span<double> moved = {});
/// One step: belief before a reading to that after it, of which the likelihood is returned. before: empty at the first.
double step(const Counter& counter, const RoomModel& room, std::span<const double> before, StateRange range_before,
            const Reading& reading, std::span<double> after);

/// Rows that add up to 1.
void divide_rows(std::span<double> table, std::size_t n_columns);

}  // namespace pirsim::counting
