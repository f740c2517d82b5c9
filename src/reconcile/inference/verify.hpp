// Does the patched model predict trials that it was not fitted on better than the plain one?
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/script.hpp"
#include "reconcile/data/measured.hpp"
#include "reconcile/inference/fit.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {

struct ReferenceStudy;

struct VerifySettings {
  double alpha = 0.05;
  std::uint32_t n_realizations = 60;  ///< simulated with each patched model; more if these couldn't refuse it at alpha
  std::size_t trees = 100;
};

/// One effect applied to the model: where it was found, and by which data.
struct AppliedEffect {
  const ReferenceStudy* reference = nullptr;  ///< of the model with all effects before this one
  std::span<const float> observed;            ///< statistics of the measured data in that reference study
  std::string effect;
  SeenRows seen;  ///< of the table, with all trials
};

/// What is said to be missing, about one measured dataset.
struct Claim {
  std::vector<AppliedEffect> steps;  ///< effects applied one after the other
  std::vector<std::string> rivals;   ///< effects that explain the data as well: none of their families is a placebo
};

/// Trials (indices, ascending) that are held out together; those of no fold are never judged.
using Folds = std::vector<std::vector<std::size_t>>;

/// One a claim. Naming and fitting are repeated in every fold without its trials, step by step, and all effects
/// together are judged on them against the plain model, that of the first step. What is not repeated is the simulation
/// of the later steps' tables: they hold the earlier effects as all trials gave them. A fold that finds another effect
/// than was applied stops there.
[[nodiscard]] std::vector<Verification> verify(std::span<const Claim> claims, const Folds& folds,
                                               const VerifySettings& settings, const Context& context);

/// Whether the gap shrunk, and closed, by what was found on the held-out trials.
void decide(Verification& result, Measured::Kind kind, double alpha);

/// Every trial is held out once: in five folds, or by itself if the data are sums, which say little a trial.
[[nodiscard]] Folds usual_folds(std::string_view digest, std::vector<std::size_t> trials, Measured::Kind kind);
/// Folds of about the same size over the given trials, from the data's digest alone: fixed before anything is named.
[[nodiscard]] Folds folds_of(std::string_view digest, std::vector<std::size_t> trials, std::size_t n_folds);

/// Which measured trials (ascending) `asked` means: a share of them, "0.3", drawn by the data's digest, or names,
/// "S3,S8"; empty: none. Throws Error(usage): a trial that is unknown or wasn't measured, or fewer than two held out or
/// left.
[[nodiscard]] std::vector<std::size_t> holdout_of(const std::string& asked, const StudyFrame& frame,
                                                  const Measured& measured);

}  // namespace pirsim::reconcile
