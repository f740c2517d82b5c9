#include "reconcile/inference/analyst.hpp"

#include <algorithm>
#include <utility>

#include "effects/catalogue.hpp"
#include "reconcile/inference/locate.hpp"
#include "stats/decision.hpp"

namespace pirsim::reconcile {
namespace {

/// Of one by itself.
Reason reason_of(const HypothesisScore& score, bool kept, double alpha) {
  if (kept && score.p <= alpha) return reason::Sure{score.p, score.probability};
  if (kept) return reason::NotRuledOut{score.p};
  if (score.p > alpha) return reason::Improbable{score.p};
  if (score.p == 0.0) return reason::HardlySimulated{};
  reason::RuledOut by;
  if (2.0 * score.p_relative <= alpha) by.p_relative = score.p_relative;
  if (2.0 * score.p_absolute <= alpha) by.p_absolute = score.p_absolute;
  return by;
}

/// In the order of stats' own.
Verdict verdict_of(stats::Verdict verdict) { return static_cast<Verdict>(verdict); }
static_assert(static_cast<int>(stats::Verdict::none_in_catalogue) == static_cast<int>(Verdict::none_in_catalogue));

}  // namespace

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
  std::vector<stats::Candidate> candidates;
  for (const HypothesisScore& score : judgement.scores)
    candidates.push_back({score.p, score.probability, score.least_p, score.p_own});
  const stats::Decision decision = stats::decide(judgement.p, candidates, {settings_.alpha});
  judgement.verdict = verdict_of(decision.verdict);
  judgement.kept = decision.kept;
  judgement.likeness = decision.likeness;
  return judgement;
}

Outcome agreement(const TableView& view, std::span<const float> measured, double alpha, const Context& context) {
  Outcome outcome;
  outcome.location = locate(view.frame(), view.map(), view.plain(), measured, alpha, context);
  outcome.trail.emplace_back(trail::Tested{outcome.location.p});
  return outcome;
}

Outcome Analyst::analyse(std::span<const float> measured) const {
  Outcome outcome = agreement(*view_, measured, settings_.alpha, context_);
  const Judgement judgement = judge(measured);
  outcome.verdict = judgement.verdict;
  if (outcome.verdict == Verdict::no_disagreement) return outcome;
  outcome.nothing = judgement.scores.front();
  outcome.family = judgement.family;
  outcome.calibration_error = classifier_.reliability().expected_calibration_error;
  for (std::size_t hypothesis = 1; hypothesis < judgement.scores.size(); ++hypothesis) {
    const HypothesisScore& score = judgement.scores[hypothesis];
    Candidate candidate{score, effects::find(score.hypothesis).info.family, false, {}};
    candidate.kept = std::ranges::find(judgement.kept, hypothesis) != judgement.kept.end();
    candidate.reason = reason_of(score, candidate.kept, settings_.alpha);
    if (judgement.likeness == hypothesis) {
      candidate.reason = reason::LikeImpostors{score.p_own};
    } else if (judgement.likeness && score.p > settings_.alpha) {
      const HypothesisScore& likeness = judgement.scores[*judgement.likeness];
      candidate.reason = reason::LessLikely{score.p, score.probability, likeness.hypothesis, likeness.probability};
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
