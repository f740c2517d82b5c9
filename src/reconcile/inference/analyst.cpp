#include "reconcile/inference/analyst.hpp"

#include <algorithm>
#include <utility>

#include "effects/catalogue.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {
Analyst::Analyst(std::shared_ptr<const TableView> view, const ClassifierSettings& settings, const Context& context)
    : view_(std::move(view)),
      settings_(settings),
      context_(context),
      classifier_(*view_, settings, context),
      fitter_(view_->scene(), view_->table(), view_->map(), classifier_.seen_rows(), context, settings.left_out) {}

FittedEffect Analyst::fit(std::size_t hypothesis, std::span<const float> measured) const {
  return fitter_.fit(hypothesis, measured);
}

std::size_t Analyst::likeliest(std::span<const float> measured, const std::function<bool(std::size_t)>& wanted) const {
  return likeliest_hypothesis(classifier_.probabilities(measured), wanted);
}

Judgement Analyst::judge(std::span<const float> measured) const {
  Judgement judgement;
  judgement.p = view_->p(measured);
  judgement.scores = classifier_.judge(measured);
  judgement.family = likeliest_family(judgement.scores);
  judgement.decision = decide(judgement.p, judgement.scores, {settings_.alpha});
  return judgement;
}

Outcome agreement(const TableView& view, std::span<const float> measured, double alpha, const Context& context) {
  Outcome outcome;
  outcome.location = locate(view.frame(), view.map(), view.plain(), measured, alpha, context);
  outcome.trail.emplace_back(trail::Tested{outcome.location.p, outcome.location.least_p()});
  return outcome;
}

Outcome Analyst::analyse(std::span<const float> measured) const {
  Outcome outcome = agreement(*view_, measured, settings_.alpha, context_);
  const Judgement judgement = judge(measured);
  const auto& [verdict, kept, likeness] = judgement.decision;
  outcome.verdict = verdict;
  if (outcome.verdict == Verdict::no_disagreement) return outcome;
  outcome.nothing = judgement.scores.front();
  outcome.family = judgement.family;
  outcome.calibration_error = classifier_.reliability().expected_calibration_error;
  for (std::size_t hypothesis = 1; hypothesis < judgement.scores.size(); ++hypothesis) {
    const HypothesisScore& score = judgement.scores[hypothesis];
    Candidate candidate{score, effects::find(score.hypothesis).info.family, false, {}};
    candidate.kept = std::ranges::find(kept, hypothesis) != kept.end();
    candidate.reason = reason_of(score, candidate.kept, settings_.alpha);
    if (likeness == hypothesis) {
      candidate.reason = reason::LikeImpostors{score.p_own};
    } else if (likeness && score.p > settings_.alpha) {
      const HypothesisScore& alike = judgement.scores[*likeness];
      candidate.reason = reason::LessLikely{score.p, score.probability, alike.hypothesis, alike.probability};
    }
    outcome.candidates.push_back(std::move(candidate));
  }
  // The named one is the likeliest of those that are kept.
  std::ranges::stable_sort(outcome.candidates, [](const Candidate& a, const Candidate& b) {
    if (a.kept != b.kept) return a.kept;
    return a.score.probability > b.score.probability;
  });
  outcome.telling_features = classifier_.telling_features(8);
  trail::NotRuledOut left;
  if (outcome.nothing.p > settings_.alpha) left.hypotheses.push_back(outcome.nothing.hypothesis);
  for (const Candidate& candidate : outcome.candidates) {
    if (candidate.kept) left.hypotheses.push_back(candidate.score.hypothesis);
  }
  outcome.trail.emplace_back(std::move(left));
  fit_named(outcome, measured);
  return outcome;
}

/// Fits the effect that a name was given to, and takes the name back if its strength may as well be none.
void Analyst::fit_named(Outcome& outcome, std::span<const float> measured) const {
  if (outcome.verdict == Verdict::named) {
    Candidate& candidate = outcome.candidates.front();
    FittedEffect fitted = fit(hypothesis_of(view_->table(), candidate.score.hypothesis), measured);
    if (fitted.includes_off) outcome.trail.emplace_back(trail::IncludesOff{candidate.score.hypothesis});
    if (takes_back(fitted, outcome.location.p)) {
      outcome.trail.emplace_back(trail::Remark::may_be_none);
      candidate.reason = reason::MayBeNone{};
      outcome.verdict = Verdict::one_of;
    } else {
      outcome.fits.push_back(std::move(fitted));
    }
  }
  for (Candidate& candidate : outcome.candidates) {
    if (!candidate.kept) continue;
    if (outcome.verdict != Verdict::named || outcome.named.empty()) {
      outcome.named.push_back(candidate.score.hypothesis);
    } else {
      const HypothesisScore& named = outcome.candidates.front().score;
      candidate.reason =
          reason::LessLikely{candidate.score.p, candidate.score.probability, named.hypothesis, named.probability};
    }
  }
}

}  // namespace pirsim::reconcile
