// From how well every hypothesis fits to a verdict.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirsim/reconcile.hpp"
#include "pirsim/reconcile_outcome.hpp"
#include "reconcile/inference/fit.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {

struct DecisionLevels {
  double alpha = 0.05;  ///< a hypothesis survives if its p exceeds it
  /// An effect at least as probable is named though others survive: their own tests lack the power to refuse them. On
  /// 1,620 injected datasets (Study A, one run) 0.8, 0.85, 0.9 and 0.95 gave the right name in 0.80, 0.79, 0.78 and
  /// 0.76 of the disagreements and a wrong one in 0.9, 0.6, 0.4 and 0.3 % of all.
  double sure = 0.85;
  /// What survives must be as probable together, else too much that is as likely was ruled out, and nothing of the
  /// catalogue made the data. One half: more probable than not. On injected datasets it drops the truth in 5 of 1,124
  /// disagreements and recognises 171 instead of 140 of 180 things that the catalogue lacks; smaller levels do less of
  /// both.
  double plausible = 0.5;
  /// An effect at least as probable is ruled out only at two fifths of alpha, or by the least p that there is: that the
  /// data are among the strangest twentieth of its own is then likelier than that nothing of the catalogue made them.
  /// On the injected datasets of two seeds, and with the geometry known, 0.849, 0.844 and 0.939 instead of 0.840, 0.832
  /// and 0.920 of the disagreements get the right name, no more get a wrong one. Of 180 things each that the catalogue
  /// lacks 4 and none more are named, and of the effects left out of it 7 in 1,000 more.
  double certain = 0.99;
  /// A name needs a greater p_own than this share of alpha. On 1,152 injected datasets (Study A, one run) half of alpha
  /// and all of it give the right name in 0.833 and 0.823 of the disagreements instead of 0.845. Of effects that the
  /// catalogue lacks 0.169 and 0.144 instead of 0.199 are named, and 0.53 and 0.57 instead of 0.49 called none in it.
  double entitled = 0.5;
};

struct Decision {
  Verdict verdict = Verdict::no_disagreement;
  /// The surviving hypotheses, the named one first, then by p; none if nothing of the catalogue made the data.
  std::vector<std::size_t> kept;
  /// The hypothesis that would have been named, but looks like something unknown that is taken for it.
  std::optional<std::size_t> likeness = {};
  bool operator==(const Decision&) const = default;
};

/// null_p: of the global test of the model as it is. scores: (n_hypotheses) nothing first. While the model as it is
/// survives too, no effect is named: the disagreement is too weak (one_of). Nor is one, but of the books, while wrong
/// counts of people survive. Never `several`, which takes a second look.
[[nodiscard]] Decision decide(double null_p, std::span<const HypothesisScore> scores, const DecisionLevels& levels);

/// Of relatives of a named effect, each applied in its place, the one that makes such data so much oftener that it may
/// be the cause: its p is twice as great. Of 56 names (Study A, one run) this takes back none of 33 right ones and 6 of
/// 23 wrong ones; a relative that merely passes takes back 11 and 12. Null if there is none.
[[nodiscard]] const Look* better_relative(std::span<const Look> relatives, const Look& named);
/// An effect that was dropped is told as the nearest: as probable as a name among several, and the model with it
/// passes.
[[nodiscard]] bool comes_nearest(const HypothesisScore& dropped, const Look& applied);

/// Several effects that explain too little of held-out trials become one of them, or something else; true if so.
[[nodiscard]] bool take_back_several(Outcome& outcome);

/// Does the effect change how many people were there?
[[nodiscard]] bool is_about_counts(const std::string& hypothesis);

/// Somebody may have been there whom the counts don't tell of: nothing else is applied before that is ruled out.
[[nodiscard]] bool counts_in_doubt(std::span<const Candidate> candidates, double alpha);

/// Why a hypothesis is kept or dropped, looked at by itself.
[[nodiscard]] Reason reason_of(const HypothesisScore& score, bool kept, double alpha);
/// Why the hypothesis that would have been named is dropped.
[[nodiscard]] Reason like_impostors(const HypothesisScore& score);
/// Why a hypothesis isn't named though it isn't ruled out.
[[nodiscard]] Reason less_likely(const HypothesisScore& score, const HypothesisScore& named);
/// The likeliest family. scores: (n_hypotheses) nothing first.
[[nodiscard]] FamilyScore likeliest_family(std::span<const HypothesisScore> scores);
/// The hypothesis of the greatest probability (at least 1) for which `wanted` holds; 0 if there is none above 0.
[[nodiscard]] std::size_t likeliest_hypothesis(std::span<const double> probabilities,
                                               const std::function<bool(std::size_t)>& wanted);

// Locating, naming and fitting with one reference table, ready for any number of datasets.

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
                                      const std::function<bool(std::size_t)>& wanted) const {
    return likeliest_hypothesis(classifier_.probabilities(measured), wanted);
  }
  [[nodiscard]] FittedEffect fit(std::size_t hypothesis, std::span<const float> measured) const {
    return fitter_.fit(hypothesis, measured);
  }
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
