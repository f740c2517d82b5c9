// Locating, naming and fitting with one reference table, ready for any number of datasets.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pirsim/reconcile.hpp"
#include "reconcile/inference/classifier.hpp"
#include "reconcile/inference/decision.hpp"
#include "reconcile/inference/fit.hpp"
#include "reconcile/inference/reference_study.hpp"

namespace pirsim::reconcile {

/// What the tests say, before anything is fitted.
struct Judgement {
  double p = 1.0;                       ///< of the global test
  std::vector<HypothesisScore> scores;  ///< (n_hypotheses) nothing first
  FamilyScore family;                   ///< the likeliest
  Decision decision;
};

/// What is said of data that the plain model may have made. Nothing is looked for, and so nothing has to be learnt.
[[nodiscard]] Outcome agreement(const TableView& view, std::span<const float> measured, double alpha,
                                const Context& context);

/// Learns from the table's datasets, as the view shows them. Immutable.
class Analyst {
 public:
  Analyst(std::shared_ptr<const TableView> view, const ClassifierSettings& settings, const Context& context);

  /// The global test's p, the hypotheses' scores, and what they decide. Without a disagreement no name is looked for.
  [[nodiscard]] Judgement judge(std::span<const float> measured) const;
  /// Verdict without verification, for statistics of the table's shape.
  [[nodiscard]] Outcome analyse(std::span<const float> measured) const;
  /// The hypothesis that fits best (at least 1), whatever the tests say, among those for which `wanted` holds; 0 if
  /// none.
  [[nodiscard]] std::size_t likeliest(std::span<const float> measured,
                                      const std::function<bool(std::size_t)>& wanted) const;
  [[nodiscard]] FittedEffect fit(std::size_t hypothesis, std::span<const float> measured) const;
  /// A name is taken back if the effect's strength may as well be none; unless the global test, whose p is given,
  /// refuses the plain model at a fifth of the level: then it isn't none, but poorly known.
  [[nodiscard]] bool takes_back(const FittedEffect& fitted, double p) const noexcept {
    return fitted.includes_off && p > settings_.alpha / 5.0;
  }
  [[nodiscard]] const FeatureMap& map() const noexcept { return view_->map(); }
  [[nodiscard]] const HypothesisClassifier& classifier() const noexcept { return classifier_; }

 private:
  void fit_named(Outcome& outcome, std::span<const float> measured) const;

  std::shared_ptr<const TableView> view_;
  ClassifierSettings settings_;
  Context context_;
  HypothesisClassifier classifier_;
  EffectFitter fitter_;
};

}  // namespace pirsim::reconcile
