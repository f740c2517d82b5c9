#include "reconcile/inference/analyst.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "engine/effects/catalogue.hpp"
#include "model/core/text.hpp"
#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::size_t plain_model = 0;

std::vector<std::size_t> survivors(std::span<const HypothesisScore> scores, const DecisionLevels& levels) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const bool is_certain = i != plain_model && scores[i].probability >= levels.certain;
    const double level =
        is_certain ? std::min(levels.alpha, std::max(0.4 * levels.alpha, scores[i].least_p)) : levels.alpha;
    if (scores[i].p > level) kept.push_back(i);
  }
  std::stable_sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) { return scores[a].p > scores[b].p; });
  return kept;
}

/// Puts the hypothesis that is to be named first; false if none is.
bool find_name(std::span<const HypothesisScore> scores, std::vector<std::size_t>& kept, double sure) {
  const auto likeliest = std::ranges::max_element(kept, {}, [&](std::size_t i) { return scores[i].probability; });
  if (kept.size() > 1 && scores[*likeliest].probability < sure) return false;
  std::rotate(kept.begin(), likeliest, likeliest + 1);
  return true;
}

/// Whether wrong counts of people can have made the data, while something else is to be named: who was there comes
/// first, since a sensor is easily blamed for somebody who came unnoticed.
bool may_be_miscounted(std::span<const HypothesisScore> scores, const std::vector<std::size_t>& kept) {
  const bool counts = std::ranges::any_of(kept, [&](std::size_t i) { return is_about_counts(scores[i].hypothesis); });
  return counts && effects::find(scores[kept.front()].hypothesis).info.family != effects::Family::data;
}

}  // namespace

bool is_about_counts(const std::string& hypothesis) {
  const auto& all = effects::catalogue();
  const auto effect = std::ranges::find_if(all, [&](const effects::Effect* e) { return e->info.name == hypothesis; });
  return effect != all.end() && (*effect)->info.needs == effects::Needs::counts;
}

Decision decide(double null_p, std::span<const HypothesisScore> scores, const DecisionLevels& levels) {
  if (null_p > levels.alpha) return {};
  std::vector<std::size_t> kept = survivors(scores, levels);
  if (std::ranges::find(kept, plain_model) != kept.end()) return {Verdict::one_of, std::move(kept)};
  double together = 0.0;
  for (const std::size_t i : kept) together += scores[i].probability;
  if (kept.empty() || together < levels.plausible) return {Verdict::none_in_catalogue, {}};
  if (!find_name(scores, kept, levels.sure)) return {Verdict::one_of, std::move(kept)};
  if (scores[kept.front()].p_own <= levels.entitled * levels.alpha)
    return {Verdict::none_in_catalogue, {}, kept.front()};
  if (may_be_miscounted(scores, kept)) return {Verdict::one_of, std::move(kept)};
  return {Verdict::named, std::move(kept)};
}

const Look* better_relative(std::span<const Look> relatives, const Look& named) {
  constexpr double much_better = 2.0;
  const auto best = std::ranges::max_element(relatives, {}, &Look::p);
  return best != relatives.end() && best->passes() && best->p >= much_better * named.p ? &*best : nullptr;
}

bool comes_nearest(const HypothesisScore& dropped, const Look& applied) {
  return applied.passes() && dropped.probability >= DecisionLevels().sure;
}

bool take_back_several(Outcome& outcome) {
  if (outcome.verdict != Verdict::several || !outcome.verification || outcome.verification->explains()) return false;
  outcome.verdict = Verdict::one_of;
  outcome.fits.clear();
  for (Candidate& candidate : outcome.candidates) candidate.named_together = false;
  return true;
}

bool counts_in_doubt(std::span<const Candidate> candidates, double alpha) {
  return std::ranges::any_of(
      candidates, [&](const Candidate& c) { return c.score.p > alpha && is_about_counts(c.score.hypothesis); });
}

Reason reason_of(const HypothesisScore& score, bool kept, double alpha) {
  const auto p = [](double value, double least = 0.0) { return "(" + p_in_words(value, least) + ")"; };
  if (kept && score.p <= alpha)
    return {"Kept, though simulations with it seldom look like these data " + p(score.p),
            "with probability " + short_number(score.probability) + " it is this one of those looked for, if any."};
  if (kept)
    return {"Kept", "it can have made these data " + p(score.p) +
                        ", and no other effect explains them so much better that it can be ruled out."};
  if (score.p > alpha)
    return {"Dropped", "by itself it might have made these data " + p(score.p) +
                           ", but all that isn't ruled out is improbable together."};
  if (score.p == 0.0) return {"Dropped", "it could hardly be simulated in this room.", Reason::What::hardly_simulated};
  const double least = 0.5 * score.least_p;
  std::vector<std::string> by;
  if (2.0 * score.p_relative <= alpha)
    by.push_back("another explains the data better than is usual for its own " + p(score.p_relative, least));
  if (2.0 * score.p_absolute <= alpha)
    by.push_back("simulations with it hardly ever look like these data " + p(score.p_absolute, least));
  return {"Dropped", joined(by, "; and ") + "."};
}

Reason like_impostors(const HypothesisScore& score) {
  return {"Dropped",
          "other things that are taken for it make such data more often than it does itself (" +
              p_in_words(score.p_own) + ").",
          Reason::What::like_impostors};
}

Reason less_likely(const HypothesisScore& score, const HypothesisScore& named) {
  return {"", "Not ruled out (" + p_in_words(score.p) + "), but much less likely than " + named.hypothesis + " (" +
                  short_number(score.probability) + " against " + short_number(named.probability) + ")."};
}

FamilyScore likeliest_family(std::span<const HypothesisScore> scores) {
  std::map<effects::Family, double> sums;
  for (const HypothesisScore& score : scores.subspan(1))
    sums[effects::find(score.hypothesis).info.family] += score.probability;
  const auto likeliest = std::ranges::max_element(sums, {}, [](const auto& sum) { return sum.second; });
  return likeliest == sums.end() ? FamilyScore{} : FamilyScore{likeliest->first, likeliest->second};
}

std::size_t likeliest_hypothesis(std::span<const double> probabilities,
                                 const std::function<bool(std::size_t)>& wanted) {
  std::size_t best = 0;
  for (std::size_t hypothesis = 1; hypothesis < probabilities.size(); ++hypothesis) {
    const double most = best == 0 ? 0.0 : probabilities[best];  // what is no candidate has 0
    if (wanted(hypothesis) && probabilities[hypothesis] > most) best = hypothesis;
  }
  return best;
}

Analyst::Analyst(std::shared_ptr<const TableView> view, const ClassifierSettings& settings, const Context& context)
    : view_(std::move(view)),
      settings_(settings),
      context_(context),
      classifier_(*view_, settings, context),
      fitter_(view_->study().source.scene, view_->table(), view_->map(), classifier_.seen_rows(), context,
              settings.left_out) {}

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
  outcome.location = locate(view.study().frame, view.map(), view.plain(), measured, alpha, context);
  outcome.trail.push_back("global test: " + p_in_words(outcome.location.p, outcome.location.least_p()));
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
      candidate.reason = like_impostors(score);
    } else if (likeness && score.p > settings_.alpha) {
      candidate.reason = less_likely(score, judgement.scores[*likeness]);
    }
    outcome.candidates.push_back(std::move(candidate));
  }
  // The named one is the likeliest of those that are kept.
  std::ranges::stable_sort(outcome.candidates, [](const Candidate& a, const Candidate& b) {
    if (a.kept != b.kept) return a.kept;
    return a.score.probability > b.score.probability;
  });
  outcome.telling_features = classifier_.telling_features(8);
  std::vector<std::string> left;
  if (outcome.nothing.p > settings_.alpha) left.push_back(outcome.nothing.hypothesis);
  for (const Candidate& candidate : outcome.candidates) {
    if (candidate.kept) left.push_back(candidate.score.hypothesis);
  }
  outcome.trail.push_back("hypotheses that can have made the data: " + (left.empty() ? "none" : joined(left, " ")));
  fit_named(outcome, measured);
  return outcome;
}

/// Fits the effect that a name was given to, and takes the name back if its strength may as well be none.
void Analyst::fit_named(Outcome& outcome, std::span<const float> measured) const {
  if (outcome.verdict == Verdict::named) {
    Candidate& candidate = outcome.candidates.front();
    FittedEffect fitted = fit(hypothesis_of(view_->table(), candidate.score.hypothesis), measured);
    if (fitted.includes_off) outcome.trail.push_back("the interval of " + fitted.effect.name + " includes off");
    if (takes_back(fitted, outcome.location.p)) {
      outcome.trail.emplace_back("the name is taken back");
      candidate.reason = {"Kept, but not named", "its strength may as well be none."};
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
      candidate.reason = less_likely(candidate.score, outcome.candidates.front().score);
    }
  }
}

}  // namespace pirsim::reconcile
