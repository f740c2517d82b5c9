// What no effect of the catalogue explains: which bits differ from what the model expects, and when.
#pragma once

#include <span>

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

/// What the model with these effects leaves over and hardly any effect makes: what changes in the course of the
/// session, from a trial on or from trial to trial, of all sensors or one; and whether all sensors are silent at the
/// same moments, oftener than in datasets of that model. plain: the study without the effects. measured: series only.
/// Throws Error(infeasible) if people can hardly get about with the effects.
[[nodiscard]] Residuals explain_rest(const ReferenceStudy& plain, std::span<const FittedEffect> applied,
                                     const Measured& measured, double alpha, const Context& context);

}  // namespace pirsim::reconcile
