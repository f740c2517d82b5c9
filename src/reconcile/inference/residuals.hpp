// When no effect of the catalogue fits: which bits differ from what the model expects, and when.
#pragma once

#include "pirsim/reconcile.hpp"

namespace pirsim::reconcile {

struct ReferenceStudy;

/// Logistic regression of every measured bit on the log-odds that the plain model gives it, and on one driver after the
/// other: who (a sensor, a seat, near or far sensors, sensors faced or not), when (parts of the run, of each minute, of
/// the time between changes of posture, of the arm's cycle, waves), and how (more or less motion, only where little or
/// much is expected, the opposite, together with another sensor). Scores are compared with those of simulated datasets
/// with nuisance, the strongest with the strongest, so that neither dependent seconds nor the number of drivers tried
/// makes one up. measured: series only.
[[nodiscard]] Residuals explain_residuals(const ReferenceStudy& reference, const Measured& measured, double alpha,
                                          const Context& context);

}  // namespace pirsim::reconcile
