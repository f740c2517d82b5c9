// When no effect of the catalogue fits: which bits differ from what the model expects, and when.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reconcile/data/measured.hpp"
#include "reconcile/inference/classifier.hpp"

namespace pirsim::reconcile {

struct ReferenceStudy;

/// One thing that the bits do and the model doesn't.
struct ResidualDriver {
  std::string who;        ///< "PIR3", "all sensors", "sensors near the seat", "S4"
  std::string when;       ///< "in the middle third of each run"; empty: always
  std::string what;       ///< "more motion than expected", "motion whenever PIR4 sees some"
  double log_odds = 0.0;  ///< of a logistic regression of the bits on this driver and those before it
  double standard_error = 0.0;
  double z = 0.0;  ///< the score against that of simulated datasets, in their standard deviations
  double p = 1.0;  ///< that the strongest of all drivers tried is so strong in a dataset of the model
};

struct Residuals {
  std::vector<ResidualDriver> drivers;  ///< strongest first; none: the residuals follow nothing that was tried
  std::string sentence;                 ///< all this for a reader
};

struct ResidualSettings {
  double alpha = 0.05;
  unsigned threads = 0;
  std::uint32_t n_simulated = 100;  ///< datasets that scores are compared with; more if alpha needs them
  std::size_t most_drivers = 3;
};

/// Logistic regression of every measured bit on the log-odds that the plain model gives it, and on one driver after the
/// other: who (a sensor, a seat, near or far sensors, sensors faced or not), when (parts of the run, of each minute, of
/// the time between changes of posture, of the arm's cycle, waves), and how (more or less motion, only where little or
/// much is expected, the opposite, together with another sensor). Scores are compared with those of simulated datasets
/// with nuisance, the strongest with the strongest, so that neither dependent seconds nor the number of drivers tried
/// makes one up. measured: series only; family: the likeliest.
[[nodiscard]] Residuals explain_residuals(const ReferenceStudy& reference, const Measured& measured,
                                          const FamilyScore& family, const ResidualSettings& settings);

}  // namespace pirsim::reconcile
