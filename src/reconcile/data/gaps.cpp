#include "reconcile/data/gaps.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pirsim::reconcile {
namespace {

/// The arm's cycle of desk work. Of 1, 2, 3, 5 and 10 rows this one tells shared losses best from single ones, and of 2
/// and 3 a share that changes.
constexpr std::size_t reach_rows = 3;

bool moves_between(const Series& run, std::size_t begin, std::size_t end, std::size_t sensor, std::size_t n_sensors) {
  for (std::size_t row = begin; row < end; ++row) {
    if (run.bits[row * n_sensors + sensor] == 1) return true;
  }
  return false;
}

/// Calls visit(row, sensor, is_silent) for each sensor that is awaited, row by row.
template <typename Visit>
void for_each_awaited(const Series& run, std::size_t n_sensors, const Visit& visit) {
  for (std::size_t row = run.main_begin; row < run.main_end; ++row) {
    const std::size_t first = row - std::min(row - run.main_begin, reach_rows);
    const std::size_t last = std::min(run.main_end, row + 1 + reach_rows);
    for (std::size_t s = 0; s < n_sensors; ++s) {
      const std::uint8_t bit = run.bits[row * n_sensors + s];
      if (bit != unknown_bit && moves_between(run, first, row, s, n_sensors) &&
          moves_between(run, row + 1, last, s, n_sensors))
        visit(row, s, bit == 0);
    }
  }
}

}  // namespace

double JointSilence::log_ratio() const { return std::log((rows + 0.5) / (by_chance + 0.5)); }

std::vector<Gaps> gaps_of(const Series& run, std::size_t n_sensors) {
  std::vector<Gaps> gaps(n_sensors);
  for_each_awaited(run, n_sensors, [&](std::size_t, std::size_t s, bool is_silent) {
    gaps[s].awaited += 1.0;
    gaps[s].silent += is_silent ? 1.0 : 0.0;
  });
  return gaps;
}

JointSilence joint_silence(std::span<const Series> runs, std::size_t n_sensors) {
  std::vector<Gaps> all(n_sensors);
  for (const Series& run : runs) {
    const std::vector<Gaps> own = gaps_of(run, n_sensors);
    for (std::size_t s = 0; s < n_sensors; ++s) {
      all[s].awaited += own[s].awaited;
      all[s].silent += own[s].silent;
    }
  }
  struct Row {
    std::size_t n_awaited = 0;
    bool all_silent = true;
    double chance = 1.0;
  };
  JointSilence joint;
  for (const Series& run : runs) {
    std::vector<Row> rows(run.main_end);
    for_each_awaited(run, n_sensors, [&](std::size_t row, std::size_t s, bool is_silent) {
      ++rows[row].n_awaited;
      rows[row].all_silent = rows[row].all_silent && is_silent;
      rows[row].chance *= all[s].silent / all[s].awaited;
    });
    for (const Row& row : rows) {
      if (row.n_awaited < 2) continue;
      joint.rows += row.all_silent ? 1.0 : 0.0;
      joint.by_chance += row.chance;
    }
  }
  return joint;
}

}  // namespace pirsim::reconcile
