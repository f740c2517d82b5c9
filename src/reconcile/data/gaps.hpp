// Gaps in motion: how many each sensor has, and whether all sensors have them at the same moments, as under a jammed
// radio. Private to reconcile.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pirsim/reconcile.hpp"

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

struct JointSilence {
  double rows = 0.0;       ///< in which two sensors or more are awaited and all that are, are silent
  double by_chance = 0.0;  ///< as many as there would be if each sensor kept its share of silence and knew nothing of
                           ///< the others
  /// How much oftener it happens than by chance, as a logarithm; 0 where nothing can be joint, as with one sensor.
  [[nodiscard]] double log_ratio() const;
};
/// Of the main parts of a dataset's runs.
[[nodiscard]] JointSilence joint_silence(std::span<const Series> runs, std::size_t n_sensors);

}  // namespace pirsim::reconcile
