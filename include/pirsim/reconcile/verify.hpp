// Does the patched model foretell trials that it was not fitted on better than the plain one?
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/reconcile/feature_map.hpp"
#include "pirsim/reconcile/reference_table.hpp"
#include "pirsim/reconcile/simulated_world.hpp"
#include "pirsim/reconcile/statistics.hpp"
#include "pirsim/stats/intervals.hpp"

namespace pirsim::reconcile {

/// How far a model lies from data, summed up over held-out trials.
struct Gap {
  double energy_score = 0.0;      ///< of the cells' scaled seconds, mean over trials
  double area_s = 0.0;            ///< mean absolute difference of measured and simulated seconds, mean over cells
  std::size_t cells_outside = 0;  ///< of the model's 95 % band
  std::size_t n_cells = 0;
  double p = 1.0;  ///< of the global test on the held-out trials
};

struct Verification {
  std::size_t n_folds = 0;
  Gap before, after;
  double noise_floor = 0.0;        ///< energy score of the patched model's own datasets
  stats::Interval gain;            ///< 95 % of the mean drop in energy score per trial, over trials
  double share_closed = 0.0;       ///< (before - after) / (before - noise floor)
  double placebo = 0.0;            ///< energy score after the best effect of another family, or 0 without one
  std::string placebo_effect;      ///< its name
  std::vector<std::string> names;  ///< what each fold found, or "nothing"
  bool shrunk = false;             ///< the interval excludes 0 and the placebo does less
  bool closed = false;             ///< and the patched model passes the global test on the held-out trials
};

struct VerifySettings {
  std::string digest;  ///< of the data: fixes the folds before anything is named
  double alpha = 0.05;
  std::uint64_t seed = 0;
  unsigned threads = 0;
  std::uint32_t n_worlds = 100;  ///< simulated with each patched model
  std::size_t n_folds = 5;
  std::size_t trees = 100;
};

struct Outcome;

/// Naming and fitting are repeated in every fold without its trials, and judged on them.
[[nodiscard]] Verification verify(const WorldSource& source, const StudyFrame& frame,
                                  const std::vector<CellKnowledge>& knowledge, const DataShape& shape,
                                  const ReferenceTable& table, std::span<const float> measured, const Outcome& outcome,
                                  const VerifySettings& settings);

/// Which fold each trial is held out in (n_trials), from the digest alone.
[[nodiscard]] std::vector<std::size_t> folds_of(std::string_view digest, std::size_t n_trials, std::size_t n_folds);

}  // namespace pirsim::reconcile
