// Few contrasts that see what many drivers of single bits don't: what changes in the course of the session, and what
// strikes all sensors at once. Private to reconcile.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "reconcile/data/alignment.hpp"
#include "reconcile/data/gaps.hpp"

namespace pirsim::reconcile {

inline constexpr double n_contrast_kinds = 3.0;

/// What contrasts are made from.
struct ContrastData {
  std::vector<std::vector<Gaps>> gaps;  ///< (n_runs x (1 + n_sensors)) of all sensors, of each
  double joint_silence = 0.0;           ///< JointSilence::log_ratio()
};
/// runs: of a dataset; made blind where the shape is.
[[nodiscard]] ContrastData contrast_data(const StudyFrame& frame, const DataShape& shape, std::span<const Series> runs);

/// Contrasts of measured data that datasets of the model hardly ever have, strongest first. p: that the strongest
/// contrast of its kind (session of all sensors, session of one, all at once) is so strong in such a dataset, times
/// n_contrast_kinds; at most alpha. The
/// session has the order of the script, one repetition after the other; it needs four runs.
[[nodiscard]] std::vector<ResidualDriver> telling_contrasts(const StudyFrame& frame, const DataShape& shape,
                                                            const ContrastData& measured,
                                                            const std::vector<ContrastData>& simulated, double alpha);

}  // namespace pirsim::reconcile
