// The two passes over a hidden Markov model.
#pragma once

#include <array>
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

/// Models that go through the same readings side by side, a lane each. No lane's numbers depend on the others', so that
/// a room's are the same bits whatever stands beside it.
template <std::size_t n_lanes>
class Lanes {
 public:
  using Values = std::array<double, n_lanes>;

  /// rooms: at most n_lanes; the last one fills the lanes that are left. The counter outlives it.
  Lanes(const Counter& counter, std::span<const RoomModel* const> rooms);

  struct Passed {
    std::vector<Values> beliefs;  ///< (readings x states)
    Values log_likelihoods{};
  };
  [[nodiscard]] Passed forward(std::span<const Reading> readings) const;
  /// Forward beliefs become those that know what came after. moved, if not empty: (states x states), to which the
  /// expected number of each move is added.
  void smooth(std::span<const Reading> readings, std::span<Values> beliefs, std::span<Values> moved = {}) const;
  /// One step: beliefs (states) before a reading, of which these states were possible, to those after it, of which the
  /// likelihoods are returned. before: empty at the first.
  Values step(std::span<const Values> before, StateRange range_before, const Reading& reading,
              std::span<Values> after) const;

 private:
  /// Likelihood of a reading in a state. Where some sensors are unknown: each choice of sensors is as likely to be the
  /// known one.
  [[nodiscard]] Values likelihood(std::size_t state, const Reading& reading) const;

  const Counter* counter_;
  std::vector<Values> first_;      ///< (states)
  std::vector<Values> moves_;      ///< (states x states)
  std::vector<Values> emissions_;  ///< (states x symbols)
};
extern template class Lanes<1>;  // rooms that are learned from, each with readings of its own
inline constexpr std::size_t side_by_side = 4;
extern template class Lanes<side_by_side>;

/// Rows that add up to 1.
void divide_rows(std::span<double> table, std::size_t n_columns);

}  // namespace pirsim::counting
