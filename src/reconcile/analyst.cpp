#include "pirsim/reconcile/analyst.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "pirsim/effects/catalogue.hpp"
#include "reconcile/sentences.hpp"

namespace pirsim::reconcile {

std::string_view name(Verdict verdict) noexcept {
  constexpr std::array<std::string_view, 5> names{"no-disagreement", "named", "one-of", "several", "none-in-catalogue"};
  return names[static_cast<std::size_t>(verdict)];
}

std::vector<std::size_t> all_trials(const StudyFrame& frame) {
  std::vector<std::size_t> trials(frame.trials.size());
  std::iota(trials.begin(), trials.end(), std::size_t{0});
  return trials;
}

Analyst::Analyst(const StudyFrame& frame, const std::vector<CellKnowledge>& knowledge, const ReferenceTable& table,
                 std::vector<std::size_t> trials, const AnalystSettings& settings)
    : frame_(frame),
      table_(table),
      settings_(settings),
      map_(frame, knowledge, table.statistics.select_rows(rows_of(table, 0, Part::training)), std::move(trials)),
      plain_(table.statistics.select_rows(rows_of(table, 0, Part::all))),
      namer_(std::make_unique<Namer>(table, map_, NamerSettings{settings.trees, settings.seed, settings.threads})) {}

FittedEffect Analyst::fit(std::size_t entry, std::span<const float> measured) const {
  return fit_from_table(table_, map_, entry, measured, {settings_.seed, settings_.threads, 0.9});
}

std::size_t Analyst::likeliest(std::span<const float> measured, const std::function<bool(std::size_t)>& wanted) const {
  const std::vector<double> probabilities = namer_->probabilities(measured);
  std::size_t best = 0;
  for (std::size_t entry = 1; entry < probabilities.size(); ++entry) {
    if (wanted(entry) && (best == 0 || probabilities[entry] > probabilities[best])) best = entry;
  }
  return best;
}

Outcome Analyst::analyse(std::span<const float> measured) const {
  Outcome outcome;
  outcome.location = locate(frame_, map_, plain_, measured, {settings_.alpha, settings_.seed, settings_.threads});
  outcome.trail.push_back("global test: p " + short_number(outcome.location.p));
  const std::vector<EntryScore> scores = namer_->judge(measured);
  outcome.nothing = scores.front();
  outcome.calibration_error = namer_->reliability().expected_calibration_error;
  const bool differs = outcome.location.p <= settings_.alpha;
  std::vector<std::size_t> kept;
  for (std::size_t entry = 1; entry < scores.size(); ++entry) {
    Candidate candidate{scores[entry], std::string(name(effects::find(scores[entry].entry).info.family)), false, {}};
    candidate.kept = differs && candidate.score.p > settings_.alpha;
    candidate.reason = differs ? reason_of(candidate, settings_.alpha) : "Not looked for: there is no disagreement.";
    if (candidate.kept) kept.push_back(entry);
    outcome.candidates.push_back(std::move(candidate));
  }
  if (differs) {
    outcome.telling_features = namer_->telling_features(8);
    decide(outcome, std::move(kept), measured);
  }
  std::ranges::stable_sort(outcome.candidates, [](const Candidate& a, const Candidate& b) {
    if (a.kept != b.kept) return a.kept;
    return a.score.probability > b.score.probability;
  });
  for (const Candidate& candidate : outcome.candidates) {
    if (candidate.kept) outcome.named.push_back(candidate.score.entry);
  }
  outcome.sentence = verdict_sentence(outcome, settings_.alpha);
  return outcome;
}

void Analyst::decide(Outcome& outcome, std::vector<std::size_t> kept, std::span<const float> measured) const {
  std::erase_if(kept, [&](std::size_t entry) {
    if (kept.size() > 1) return false;
    FittedEffect fitted = fit(entry, measured);
    if (!fitted.includes_off) {
      outcome.fits.push_back(std::move(fitted));
      return false;
    }
    outcome.trail.push_back("the interval of " + table_.entry_name(entry) + " includes off: the name is withdrawn");
    outcome.candidates[entry - 1].kept = false;
    outcome.candidates[entry - 1].reason = "Withdrawn: its strength may as well be none.";
    return true;
  });
  outcome.verdict = kept.empty() ? Verdict::none_in_catalogue : kept.size() == 1 ? Verdict::named : Verdict::one_of;
  std::string set;
  for (const std::size_t entry : kept) set += " " + table_.entry_name(entry);
  outcome.trail.push_back("entries that can have made the data:" + (set.empty() ? " none" : set));
}

}  // namespace pirsim::reconcile
