// Few contrasts that see what many drivers of single bits don't: what changes in the course of the session. Private to
// reconcile.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pirsim/reconcile.hpp"
#include "reconcile/data/alignment.hpp"

namespace pirsim::reconcile {

/// What contrasts are made from.
struct ContrastData {
  std::vector<std::vector<Gaps>> gaps;  ///< (n_runs x (1 + n_sensors)) of all sensors, of each
  std::vector<double> shortest;         ///< (n_runs) rows of the shortest stretch of motion that isn't cut off; 0: none
};
/// runs: of a dataset; made blind where the shape is.
[[nodiscard]] ContrastData contrast_data(const StudyFrame& frame, const DataShape& shape, std::span<const Series> runs);

/// Contrasts of measured data that datasets of the model hardly ever have, strongest first. p: that the strongest
/// contrast of its kind (session of all sensors, session of one) is so strong in such a dataset, times two; at most
/// alpha. The session has the order of the script, one repetition after the other; it needs four runs.
[[nodiscard]] std::vector<ResidualDriver> telling_contrasts(const StudyFrame& frame, const DataShape& shape,
                                                            const ContrastData& measured,
                                                            const std::vector<ContrastData>& simulated, double alpha);

// What no effect of the catalogue explains: which bits differ from what the model expects, and when.

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
/// session, from a trial on or from trial to trial, of all sensors or one. plain: the study without the effects.
/// measured: series only.
/// Throws Error(infeasible) if people can hardly get about with the effects.
[[nodiscard]] Residuals explain_rest(const ReferenceStudy& plain, std::span<const FittedEffect> applied,
                                     const Measured& measured, double alpha, const Context& context);

}  // namespace pirsim::reconcile
