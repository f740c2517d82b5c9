// Gaps in motion: how many each sensor has. Private to reconcile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pirsim/reconcile.hpp"
#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {

// A sensor is awaited in a row if it sees motion within three rows before it and within three after it. Nothing that
// the model expects is asked for: where somebody sits is known to some centimetres only, and decides how much a sensor
// sees, but hardly how many gaps that has.

struct Gaps {
  double awaited = 0.0;  ///< rows
  double silent = 0.0;   ///< of them
};
/// (n_sensors) in the main part of a run; rows in which a sensor is unknown don't count for it.
[[nodiscard]] std::vector<Gaps> gaps_of(const Series& run, std::size_t n_sensors);

// Measured and simulated data side by side: what there is of a dataset, so that both are looked at alike.

/// What there is of a dataset. Simulated data are made blind where the measured ones are.
struct DataShape {
  struct Run {
    std::size_t trial = 0;
    int replicate = 1;
    std::size_t n_main = 0;                            ///< rows of the main part
    std::vector<std::uint8_t> lead_known, tail_known;  ///< (n_sensors) 1 where all before it is known, and all after
    std::vector<std::uint8_t> unknown;                 ///< (n_main x n_sensors), or empty if all is known
    bool operator==(const Run&) const = default;
  };
  Measured::Kind kind = Measured::Kind::series;
  std::vector<Run> runs;  ///< by trial, then replicate
  int n_replicates = 1;
  std::vector<std::uint8_t> known_cells;  ///< (n_trials x n_sensors) 1 where anything was measured
  bool operator==(const DataShape&) const = default;
};
/// pilot: runs of the base model, for what sums don't tell. What comes before and after the main part is taken for
/// unknown if it is shorter than in any of them: the recording began late, or ended early. A main part is looked at as
/// far as the longest of theirs goes. Throws Error(input) for what can't be of this study: sums longer than its main
/// parts, or rows that are, if the file doesn't tell phases.
[[nodiscard]] DataShape shape_of(const StudyFrame& frame, const Measured& measured, std::span<const Series> pilot);
/// Which rows of the file are left out in this shape of it, and what others are taken for.
[[nodiscard]] std::vector<std::string> notes_on(const StudyFrame& frame, const DataShape& shape,
                                                const Measured& measured, std::span<const Series> pilot);
/// Everything is known: n_replicates runs of every trial, with the main parts of these pilot runs.
[[nodiscard]] DataShape full_shape(const StudyFrame& frame, Measured::Kind kind, int n_replicates,
                                   std::span<const Series> pilot);

/// The run that the shape is of; null if there is none.
[[nodiscard]] const Series* run_of(std::span<const Series> runs, const DataShape::Run& shape);
/// Whether anything of a sensor's main part is known.
[[nodiscard]] bool knows_main_part(const DataShape::Run& shape, std::size_t sensor, std::size_t n_sensors);

}  // namespace pirsim::reconcile
