// What a reconciliation found.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reconcile/inference/classifier.hpp"
#include "reconcile/inference/fit.hpp"
#include "reconcile/inference/locate.hpp"
#include "reconcile/inference/residuals.hpp"
#include "reconcile/inference/verify.hpp"
#include "stats/decision.hpp"

namespace pirsim::reconcile {

using stats::Verdict;
/// In the order of the enumeration.
inline constexpr std::array<std::string_view, 5> verdict_names{"no-disagreement", "named", "one-of", "several",
                                                               "none-in-catalogue"};
[[nodiscard]] std::string_view name(Verdict verdict) noexcept;

/// What became of one hypothesis of the catalogue.
struct Candidate {
  HypothesisScore score;
  std::string family;
  bool kept = false;
  std::string reason;  ///< why it was kept or dropped, as a sentence
};

/// A look at the measured data with some effects applied to the model.
struct Look {
  std::vector<std::string> applied;
  double level = 0.05;                   ///< of the global test; halved with every effect
  double p = 1.0;                        ///< of the global test
  std::vector<std::string> one_of = {};  ///< effects, one of which may be missing beside these and can't be told

  [[nodiscard]] bool passes() const noexcept { return p > level; }
};

struct Outcome {
  Verdict verdict = Verdict::no_disagreement;
  std::string sentence;  ///< the verdict for a reader
  Location location;
  std::vector<Candidate> candidates;  ///< most probable first; without `nothing` and twins
  HypothesisScore nothing;            ///< how well the plain model fits
  FamilyScore family;                 ///< whose effects are likeliest together
  std::vector<std::string> named;     ///< effects applied to the model, or those that can't be told apart; of `one_of`
                                      ///< the plain model is one more if nothing.p exceeds the level
  std::vector<FittedEffect> fits;     ///< of the effects that were applied
  std::vector<Look> looks;            ///< with the effects applied, one after the other
  std::optional<Verification> verification;
  std::optional<Residuals> residuals;  ///< if nothing fits and the data are series
  std::vector<std::string> telling_features;
  double calibration_error = 0.0;
  std::string table_key;
  std::vector<std::string> notes;  ///< sentences beside the data's own: what was done with which rows
  std::vector<std::string> trail;  ///< every decision, in order
};

/// The candidates, and after each those that change the model in the same way and were judged as one with it.
[[nodiscard]] std::vector<Candidate> with_twins(const std::vector<Candidate>& candidates);

}  // namespace pirsim::reconcile
