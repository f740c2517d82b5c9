// Columns that no sensor's output is like.
#include <algorithm>
#include <cmath>

#include "reconcile/data/data_checks.hpp"

namespace pirsim::reconcile {
namespace {

using What = DataFinding::What;

constexpr std::size_t fewest_beats = 12;  ///< in a run: what sweeps to and fro keeps to a grid of rows for a while

// Two columns: rows in which one of them changes, and those in which both do.

enum class Likeness { equal, opposite };

struct Edges {
  std::size_t n = 0, n_alike = 0;
  [[nodiscard]] double share() const noexcept {
    return (static_cast<double>(n_alike) + 1.0) / (static_cast<double>(n) + 2.0);
  }
};

Edges edges_of(const DatasetRows& data, std::size_t one, std::size_t other, Likeness likeness) {
  Edges edges;
  for (const Series& run : data.runs) {
    for (std::size_t row = 1; row < run.n_rows(data.n_sensors); ++row) {
      const auto bit = [&](std::size_t back, std::size_t sensor) {
        return bit_of(run, row - back, sensor, data.n_sensors);
      };
      const std::uint8_t a = bit(0, one), b = bit(0, other), a_before = bit(1, one), b_before = bit(1, other);
      if (std::max({a, b, a_before, b_before}) == unknown_bit || (a == a_before && b == b_before)) continue;
      ++edges.n;
      const bool both = a != a_before && b != b_before;
      edges.n_alike += both && (a == b) == (likeness == Likeness::equal) ? 1 : 0;
    }
  }
  return edges;
}

/// Logarithm of the chance that so many of them or more are alike, each with probability q: a bound.
double log_chance(const Edges& edges, double q) {
  const auto n = static_cast<double>(edges.n), k = static_cast<double>(edges.n - edges.n_alike);
  return std::log(k + 1.0) + std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
         (n - k) * std::log(q);
}

}  // namespace

void compare_columns(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                     std::vector<DataFinding>& findings) {
  for (std::size_t other = 1; other < data.n_sensors; ++other) {
    for (std::size_t one = 0; one < other; ++one) {
      for (const auto& [likeness, what] :
           {std::pair(Likeness::equal, What::equal_columns), std::pair(Likeness::opposite, What::opposite_columns)}) {
        const Edges edges = edges_of(data, one, other, likeness);
        const auto n_unlike = static_cast<double>(edges.n - edges.n_alike);
        if (edges.n < fewest_edges || n_unlike > may_differ * static_cast<double>(edges.n)) continue;
        const double usual =
            greatest_of(pilot, [&](const DatasetRows& d) { return edges_of(d, one, other, likeness).share(); });
        const double chance = log_chance(edges, usual);
        if (chance > log_level) continue;
        findings.push_back({.what = what,
                            .sensors = {frame.sensors[one], frame.sensors[other]},
                            .n_rows = data.n_rows(),
                            .n_exceptions = edges.n - edges.n_alike,
                            .chance = std::exp(chance)});
      }
    }
  }
}

namespace {

// One column.

}  // namespace

/// All known rows are 1, the first ones too, though the model's runs of these trials begin without.
void find_constant(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                   std::vector<DataFinding>& findings) {
  for (std::size_t sensor = 0; sensor < data.n_sensors; ++sensor) {
    std::size_t n_known = 0, n_ones = 0;
    double chance = 0.0;
    for (const Series& run : data.runs) {
      for (std::size_t row = 0; row < run.n_rows(data.n_sensors); ++row) {
        const std::uint8_t bit = bit_of(run, row, sensor, data.n_sensors);
        n_known += bit != unknown_bit ? 1 : 0;
        n_ones += bit == 1 ? 1 : 0;
      }
      double n = 0.0, n_begin_so = 0.0;
      for (const DatasetRows& dataset : pilot) {
        for (const Series& simulated : dataset.runs) {
          if (simulated.trial != run.trial || simulated.bits.empty()) continue;
          n += 1.0;
          n_begin_so += bit_of(simulated, 0, sensor, data.n_sensors) == 1 ? 1.0 : 0.0;
        }
      }
      if (!run.bits.empty() && run.bits[sensor] == 1) chance += std::log((n_begin_so + 1.0) / (n + 2.0));
    }
    if (n_known == 0) continue;
    if (n_ones == n_known && chance <= log_level) {
      findings.push_back({.what = What::constant_column,
                          .sensors = {frame.sensors[sensor]},
                          .n_rows = n_known,
                          .chance = std::exp(chance)});
    }
  }
}

/// No row is 1, though every realization of the model has some: a dead sensor is in the catalogue.
void find_silent(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                 std::vector<DataFinding>& findings) {
  const auto counts = [](const DatasetRows& of, std::size_t sensor) {
    std::pair<std::size_t, std::size_t> known_and_ones;
    for (const Series& run : of.runs) {
      for (std::size_t row = 0; row < run.n_rows(of.n_sensors); ++row) {
        const std::uint8_t bit = bit_of(run, row, sensor, of.n_sensors);
        known_and_ones.first += bit != unknown_bit ? 1 : 0;
        known_and_ones.second += bit == 1 ? 1 : 0;
      }
    }
    return known_and_ones;
  };
  for (std::size_t sensor = 0; sensor < data.n_sensors; ++sensor) {
    const auto [n_known, n_ones] = counts(data, sensor);
    if (n_known == 0 || n_ones > 0) continue;
    const auto moves = [&](const DatasetRows& d) { return counts(d, sensor).second > 0; };
    if (!std::ranges::all_of(pilot, moves)) continue;
    findings.push_back(
        {.what = What::silent_column, .sensors = {frame.sensors[sensor]}, .n_rows = n_known, .is_impossible = false});
  }
}

namespace {

bool is_alone(const Series& run, std::size_t row, std::size_t sensor, std::size_t n_sensors) {
  return row > 0 && row + 1 < run.n_rows(n_sensors) && bit_of(run, row, sensor, n_sensors) == 1 &&
         bit_of(run, row - 1, sensor, n_sensors) == 0 && bit_of(run, row + 1, sensor, n_sensors) == 0;
}

/// Of a run: ones on a grid of so many rows, which begins anywhere.
struct Beat {
  std::size_t n = 0, n_missing = 0;  ///< rows of the grid, those without a 1
  std::size_t n_alone = 0;           ///< those with a 1 between two zeros
};

Beat beat_of(const Series& run, std::size_t sensor, std::size_t n_sensors, std::size_t period, std::size_t first) {
  Beat beat;
  const std::size_t n_rows = run.n_rows(n_sensors);
  for (std::size_t row = first; row < n_rows; row += period) {
    const std::uint8_t bit = bit_of(run, row, sensor, n_sensors);
    if (bit == unknown_bit) continue;
    ++beat.n;
    if (bit == 0 && ++beat.n_missing > 1 + n_rows / period / 50) return {n_rows / period, n_rows / period, 0};
    beat.n_alone += is_alone(run, row, sensor, n_sensors) ? 1 : 0;
  }
  return beat;
}

struct Beats {
  double share = 0.0;   ///< of the grids' rows with a 1, in each run with the best grid
  double chance = 0.0;  ///< logarithm: that as many of the ones that stand alone are on the grid
};

Beats beats_of(const DatasetRows& data, std::size_t sensor, std::size_t period) {
  Beats beats;
  double n = 0.0, n_missing = 0.0;
  const double grids = std::log(static_cast<double>(period));
  for (const Series& run : data.runs) {
    Edges alone;
    for (std::size_t row = 0; row < run.n_rows(data.n_sensors); ++row)
      alone.n += is_alone(run, row, sensor, data.n_sensors) ? 1 : 0;
    Beat best;
    double least = 2.0;
    for (std::size_t first = 0; first < std::min(period, run.n_rows(data.n_sensors)); ++first) {
      const Beat beat = beat_of(run, sensor, data.n_sensors, period, first);
      const double missing = beat.n == 0 ? 2.0 : static_cast<double>(beat.n_missing) / static_cast<double>(beat.n);
      if (missing > least || (missing == least && beat.n_alone <= best.n_alone)) continue;
      best = beat;
      least = missing;
    }
    if (best.n < fewest_beats) continue;
    n += static_cast<double>(best.n);
    n_missing += static_cast<double>(best.n_missing);
    alone.n_alike = best.n_alone;
    beats.chance += std::min(0.0, grids + log_chance(alone, 1.0 / static_cast<double>(period)));
  }
  beats.share = n > 0.0 ? 1.0 - n_missing / n : 0.0;
  return beats;
}

}  // namespace

void find_beats(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                std::vector<DataFinding>& findings) {
  for (std::size_t sensor = 0; sensor < data.n_sensors; ++sensor) {
    for (std::size_t period = 2; period <= longest_period; ++period) {
      const Beats beats = beats_of(data, sensor, period);
      if (beats.share < 1.0 - may_differ / 2.0 || beats.chance > log_level) continue;
      const double usual = greatest_of(pilot, [&](const DatasetRows& d) { return beats_of(d, sensor, period).share; });
      if (usual > model_has_it) continue;
      findings.push_back({.what = What::beats,
                          .sensors = {frame.sensors[sensor]},
                          .n_rows = data.n_rows(),
                          .every_s = static_cast<double>(period) * frame.window_s,
                          .chance = std::exp(beats.chance)});
      break;  // its multiples beat as well
    }
  }
}

}  // namespace pirsim::reconcile
