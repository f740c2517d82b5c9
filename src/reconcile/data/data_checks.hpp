// The parts of the look at the file. Private to reconcile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {

/// Runs of one dataset, measured or simulated: they outlive it.
struct DatasetRows {
  std::span<const Series> runs;
  std::size_t n_sensors = 0;

  [[nodiscard]] std::size_t n_rows() const noexcept {
    std::size_t n = 0;
    for (const Series& run : runs) n += run.n_rows(n_sensors);
    return n;
  }
};
[[nodiscard]] inline std::uint8_t bit_of(const Series& run, std::size_t row, std::size_t sensor,
                                         std::size_t n_sensors) noexcept {
  return run.bits[row * n_sensors + sensor];
}

// By chance: by how much less likely than this level something must be to be told. Rows that follow one another aren't
// independent, so that a chance that is computed as if they were is too small: hence a level so low (assumed).
inline constexpr double log_level = -20.7;  ///< natural logarithm of 1e-9

inline constexpr std::size_t fewest_edges = 20;  ///< by which columns are compared, and a logger's clock is read
inline constexpr double may_differ = 0.02;       ///< share of edges by which nearly equal columns may differ (assumed)
inline constexpr std::size_t longest_period = 60;  ///< rows: gateways report once a minute at least (assumed)
inline constexpr double model_has_it = 0.9;  ///< of a share that is 1 in the data: the model's own runs come near it

/// How far the model's own datasets go; 0 without any.
[[nodiscard]] double greatest_of(std::span<const DatasetRows> pilot,
                                 const std::function<double(const DatasetRows&)>& of);

/// Rows that stand in two places, from `row` and `other_row` on.
struct Repeat {
  std::size_t run = 0, row = 0;
  std::size_t other_run = 0, other_row = 0;
  std::size_t n_rows = 0;
  /// Bits in these rows after Lempel and Ziv: what follows from rows before it, as a steady beat does, adds nothing.
  double information = 0.0;
};
/// Those with most information first, one of a pair of runs and a shift. Rows that go on as their own repeat don't
/// count, as a fan's to and fro, nor do two runs of one trial, whose choreography comes again, nor parts that stand at
/// the same time in both runs: what goes by the clock does that. A whole run that stands in another trial counts.
struct Repeats {
  static constexpr std::size_t most = 3;
  std::vector<Repeat> between_runs, in_a_run;  ///< at most so many
};
[[nodiscard]] Repeats greatest_repeats(const DatasetRows& data);

/// Adds what it finds. pilot: datasets of the model, whose runs have one replicate.
using DataCheck = void(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                       std::vector<DataFinding>& findings);

DataCheck compare_columns;  ///< two that are equal, nearly, or opposite
DataCheck find_constant;    ///< a column of ones
DataCheck find_silent;      ///< a column without any
DataCheck find_beats;       ///< a column with ones on a grid
DataCheck find_polls;       ///< columns that change on a grid only
DataCheck find_repeat;      ///< rows that stand twice
DataCheck find_silence;     ///< rows without any motion

}  // namespace pirsim::reconcile
