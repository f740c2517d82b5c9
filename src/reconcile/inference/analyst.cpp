#include "reconcile/inference/analyst.hpp"

#include <algorithm>
#include <utility>

#include "effects/catalogue.hpp"
#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {

Analyst::Analyst(std::shared_ptr<const TableView> view, const AnalystSettings& settings)
    : view_(std::move(view)),
      settings_(settings),
      classifier_(*view_, {settings.alpha, settings.trees, settings.seed, settings.threads, settings.left_out}),
      fitter_(view_->scene(), view_->table(), view_->map(), classifier_.seen_rows(), {settings.threads}) {}

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
    candidates.push_back({score.p, score.probability, score.least_p});
  judgement.decision = stats::decide(judgement.p, candidates, {settings_.alpha});
  return judgement;
}

Outcome Analyst::analyse(std::span<const float> measured) const {
  const Judgement judgement = judge(measured);
  Outcome outcome;
  outcome.verdict = judgement.decision.verdict;
  outcome.location = locate(view_->frame(), view_->map(), view_->plain(), measured,
                            {settings_.alpha, settings_.seed, settings_.threads});
  outcome.trail.push_back("global test: p " + short_number(outcome.location.p));
  outcome.nothing = judgement.scores.front();
  outcome.family = judgement.family;
  outcome.calibration_error = classifier_.reliability().expected_calibration_error;
  const bool differs = outcome.verdict != Verdict::no_disagreement;
  for (std::size_t hypothesis = 1; hypothesis < judgement.scores.size(); ++hypothesis) {
    const HypothesisScore& score = judgement.scores[hypothesis];
    Candidate candidate{score, std::string(name(effects::find(score.hypothesis).info.family)), false, {}};
    candidate.kept = differs && std::ranges::find(judgement.decision.kept, hypothesis) != judgement.decision.kept.end();
    candidate.reason = differs ? reason_of(candidate, settings_.alpha) : "Not looked for: there is no disagreement.";
    outcome.candidates.push_back(std::move(candidate));
  }
  // The named one is the likeliest of those that are kept.
  std::ranges::stable_sort(outcome.candidates, [](const Candidate& a, const Candidate& b) {
    if (a.kept != b.kept) return a.kept;
    return a.score.probability > b.score.probability;
  });
  if (differs) {
    outcome.telling_features = classifier_.telling_features(8);
    std::string set = outcome.nothing.p > settings_.alpha ? " nothing" : "";
    for (const Candidate& candidate : outcome.candidates) set += candidate.kept ? " " + candidate.score.hypothesis : "";
    outcome.trail.push_back("hypotheses that can have made the data:" + (set.empty() ? " none" : set));
    fit_named(outcome, measured);
  }
  outcome.sentence = verdict_sentence(outcome, settings_.alpha);
  return outcome;
}

/// Fits the effect that a name was given to, and takes the name back if its strength may as well be none.
void Analyst::fit_named(Outcome& outcome, std::span<const float> measured) const {
  if (outcome.verdict == Verdict::named) {
    Candidate& candidate = outcome.candidates.front();
    FittedEffect fitted = fit(hypothesis_of(view_->table(), candidate.score.hypothesis), measured);
    if (fitted.includes_off) outcome.trail.push_back("the interval of " + candidate.score.hypothesis + " includes off");
    if (takes_back(fitted, outcome.location.p)) {
      outcome.trail.push_back("the name is taken back");
      candidate.reason = "Kept, but not named: its strength may as well be none.";
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
      candidate.reason = reason_of_unlikely(candidate, outcome.candidates.front());
    }
  }
}

}  // namespace pirsim::reconcile
