#include "reconcile/report/sentences.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <variant>

#include "core/text.hpp"
#include "effects/catalogue.hpp"

namespace pirsim::reconcile {
namespace {

std::string fingerprints_of(const std::vector<std::string>& named) {
  std::vector<std::string> texts;
  for (const std::string& effect : named) texts.push_back(effect + ": " + effects::find(effect).info.fingerprint);
  return joined(texts, ". ");
}

/// Which kind of effect it is, if that is clear though its name isn't.
std::string kind_of(const Outcome& outcome) {
  if (!outcome.family.is_sure()) return {};
  return " (with probability " + short_number(outcome.family.probability) + " something of the family " +
         std::string(name(outcome.family.family)) + ")";
}

std::string where(const Outcome& outcome, double alpha) {
  const auto differing =
      std::ranges::count_if(outcome.location.cells, [&](const auto& c) { return c.adjusted_p <= alpha; });
  const std::string p = short_number(outcome.location.p);
  if (differing == 0)
    return "none of the " + std::to_string(outcome.location.cells.size()) +
           " cells (trial x sensor) differs by itself, but everything together does, p = " + p;
  return std::to_string(differing) + " of " + std::to_string(outcome.location.cells.size()) +
         " cells (trial x sensor) differ by themselves, everything together with p = " + p;
}

/// Of which effects a sentence speaks.
std::string all_of(const Outcome& outcome) { return outcome.looked_for.empty() ? "the catalogue" : "those looked for"; }

std::string lacks_something_else(const Outcome& outcome) {
  return std::string("The model lacks something that is not ") +
         (outcome.looked_for.empty() ? "in the catalogue" : "among the effects looked for");
}

/// Why no name was given to the effects that are left.
std::string doubt(const Outcome& outcome, double alpha) {
  if (outcome.nothing.p > alpha) return ", or nothing: the disagreement is weak";
  return outcome.named.size() > 1 ? ", which these data can't tell apart" : ", but its strength may as well be none";
}

/// Why nothing of the catalogue is taken for what is missing.
std::string no_effect(const Outcome& outcome, double alpha) {
  for (const Candidate& candidate : outcome.candidates) {
    if (const auto* likeness = std::get_if<reason::LikeImpostors>(&candidate.reason))
      return "what resembles it most, " + candidate.score.hypothesis +
             ", is hardly it: other things that are taken for it make such data more often (p = " +
             short_number(likeness->p_own) + ")";
  }
  std::vector<std::string> possible;
  double together = 0.0;
  for (const Candidate& candidate : outcome.candidates) {
    if (candidate.score.p <= alpha) continue;
    possible.push_back(candidate.score.hypothesis);
    together += candidate.score.probability;
  }
  if (possible.empty()) return "no effect of " + all_of(outcome) + " is likely to have made the data";
  const std::string& likeliest = std::ranges::max_element(outcome.candidates, {}, [](const Candidate& c) {
                                   return c.score.probability;
                                 })->score.hypothesis;
  const bool likeliest_is_possible = std::ranges::find(possible, likeliest) != possible.end();
  const bool one = possible.size() == 1;
  return (likeliest_is_possible ? std::string("of ") : "the likelier ones of ") +
         (outcome.looked_for.empty() ? "the catalogue's effects" : "the effects looked for") +
         (likeliest_is_possible ? " only " : " are ruled out; ") + enumerated(possible, "and") +
         (one && likeliest_is_possible ? " isn't ruled out"
          : one                        ? " isn't"
                                       : " aren't ruled out") +
         ", but " + (one ? "its probability" : "their probability together") + " is only " + short_number(together);
}

/// What else may have made the data beside the effect that is named.
std::string rivals(const Outcome& outcome) {
  std::vector<std::string> names;
  for (const Candidate& candidate : outcome.candidates) {
    if (candidate.kept && candidate.score.hypothesis != outcome.named.front())
      names.push_back(candidate.score.hypothesis);
  }
  if (names.empty()) {
    std::vector<std::string> unknown;
    for (const Candidate& candidate : outcome.candidates) {
      if (std::holds_alternative<reason::HardlySimulated>(candidate.reason))
        unknown.push_back(candidate.score.hypothesis);
    }
    return ", and no other effect of " + all_of(outcome) + " explains the data" +
           (unknown.empty() ? "." : "; " + enumerated(unknown, "and") + " could hardly be simulated in this room.");
  }
  return "; with probability " + short_number(outcome.candidates.front().score.probability) + " it is this one, " +
         enumerated(names, "and") + " can't be ruled out.";
}

/// The one effect that would have been named was dropped since the model with it can't have made the data.
bool was_refused(const Outcome& outcome) {
  return std::ranges::any_of(outcome.candidates, [](const Candidate& candidate) {
    return std::holds_alternative<reason::RefusedWhenApplied>(candidate.reason);
  });
}

/// The verdict then.
std::string sentence_of_refused(const Outcome& outcome, double alpha) {
  const Look& look = outcome.looks.back();
  return lacks_something_else(outcome) + ": " + where(outcome, alpha) + ". What resembles it most, " +
         enumerated(look.applied, "and") +
         ", doesn't explain it: with that applied, the model still differs from the data (p = " + short_number(look.p) +
         "), and none of the others that were tried beside it explains what is left.";
}

/// Of the likeliest effect if it was dropped, though the model with it passes.
std::string sentence_of_nearest(const Outcome& outcome) {
  const Look& look = outcome.looks.back();
  const auto nearest = std::ranges::find(outcome.candidates, look.applied.front(),
                                         [](const Candidate& candidate) { return candidate.score.hypothesis; });
  return look.applied.front() +
         " comes nearest: with it applied, the test of everything together sees no difference (p = " +
         short_number(look.p) + "). It was dropped all the same: " + why(nearest->reason);
}

/// Which strengths were looked for of the likeliest effects, and how to try others: a fault outside a prior has no
/// name.
std::string ranges_looked_for(const Outcome& outcome) {
  constexpr std::size_t most_told = 3;
  std::vector<Candidate> likeliest = outcome.candidates;
  std::ranges::stable_sort(likeliest, std::ranges::greater{}, [](const Candidate& c) { return c.score.probability; });
  std::vector<std::string> ranges;
  for (const Candidate& candidate : likeliest) {
    const auto& parameters = effects::find(candidate.score.hypothesis).info.parameters;
    if (parameters.empty() || ranges.size() == most_told) continue;
    const effects::ParameterInfo& strength = parameters.front();
    ranges.push_back(candidate.score.hypothesis + " with " + strength.name + " from " + short_number(strength.low) +
                     " to " + short_number(strength.high));
  }
  if (ranges.empty()) return {};
  return "Each effect was looked for in a range only: " + enumerated(ranges, "and") +
         " (pirsim effects lists all). Yours may lie outside: write it with its value under effects: of the script, "
         "and "
         "reconcile again. ";
}

}  // namespace

std::string enumerated(const std::vector<std::string>& names, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " " + last + " " : ", ") + names[i];
  }
  return text;
}

std::string next_step(const Outcome& outcome) {
  switch (outcome.verdict) {
    case Verdict::no_disagreement:
      return "What to do next: nothing, unless smaller differences matter; more runs make the experiment sharper.";
    case Verdict::named:
    case Verdict::several:
      return "What to do next: run script_patched.yaml, the same script with what was found applied, and see below "
             "whether it comes closer to trials that it was not fitted on.";
    case Verdict::one_of:
      if (outcome.named.size() < 2)
        return "What to do next: measure more before anything is applied; pirsim reconcile plan finds what would tell "
               "most.";
      return "What to do next: measure more before one of them is applied. pirsim reconcile plan --effects " +
             joined(outcome.named, ",") +
             " finds the measurement that separates them best. What each does to the data: " +
             fingerprints_of(outcome.named) + ".";
    case Verdict::none_in_catalogue:
      break;
  }
  return "What to do next: look at the cells and numbers marked below. " + ranges_looked_for(outcome) +
         "A cause that is none of the effects can be added to the catalogue (docs/howto/add_an_effect.md).";
}

std::string short_number(double value) {
  std::ostringstream out;
  out << std::setprecision(3) << value;
  return out.str();
}

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str() == "-0" ? "0" : out.str();
}

std::string percent(double share) { return fixed(100.0 * share, 0) + " %"; }

std::string rivals_in_words(const FittedEffect& fitted, const std::string& choice, const std::string& value) {
  constexpr double as_likely = 0.2;  // assumed: what is less probable isn't worth telling
  std::string rivals;
  for (const FittedChoice& fit : fitted.choices) {
    if (fit.name != choice) continue;
    for (const auto& [word, probability] : fit.words) {
      if (word == value || probability < as_likely) continue;
      rivals += (rivals.empty() ? "" : " or ") + (word.empty() ? "all" : word) + " " + fixed(probability, 2);
    }
  }
  return rivals.empty() ? "" : " (hardly told from " + rivals + ")";
}

std::string in_words(const FittedEffect& fitted) {
  std::string text = fitted.effect.name;
  std::string details;
  for (const FittedParameter& p : fitted.parameters) {
    details += (details.empty() ? "" : ", ") + p.name + " " + short_number(p.value) + " (" +
               short_number(p.interval.low) + " to " + short_number(p.interval.high) + ")";
  }
  for (const auto& [choice, value] : fitted.effect.choices) {
    details += (details.empty() ? "" : ", ") + choice + " " + value + rivals_in_words(fitted, choice, value);
  }
  if (!details.empty()) text += " with " + details;
  if (fitted.includes_off) text += ", a strength that these data can hardly distinguish from zero";
  for (const std::string& twin : effects::twins_of(fitted.effect.name))
    text += " (or " + twin + ", the same in the model)";
  return text;
}

std::string verdict_sentence(const Outcome& outcome, double alpha) {
  switch (outcome.verdict) {
    case Verdict::no_disagreement:
      return "No disagreement: model and measurement agree as well as the model agrees with itself (p = " +
             short_number(outcome.location.p) + "); this experiment would hardly see differences below " +
             short_number(outcome.location.band_s) + " s a cell.";
    case Verdict::named:
      return "The model lacks " + in_words(outcome.fits.back()) + ": " + where(outcome, alpha) + rivals(outcome);
    case Verdict::one_of:
      if (outcome.named.empty())
        return "Model and measurement differ, but so little that nothing can be named: " + where(outcome, alpha) + ".";
      return (outcome.named.size() == 1 ? "The model may lack " : "The model lacks one of ") +
             enumerated(outcome.named, "or") + kind_of(outcome) + doubt(outcome, alpha) + ": " + where(outcome, alpha) +
             ".";
    case Verdict::several:
      return "The model lacks " + enumerated(outcome.named, "and") + " together: " + where(outcome, alpha) + ".";
    case Verdict::none_in_catalogue:
      break;
  }
  return lacks_something_else(outcome) + ": " + where(outcome, alpha) + ", and " + no_effect(outcome, alpha) + ".";
}

std::string in_words(const Look& look) {
  std::string text = "With " + enumerated(look.applied, "and") + " applied, the model " +
                     (look.passes() ? "can have made these data" : "still differs from the data") +
                     " (p = " + short_number(look.p) + ").";
  if (look.one_of.size() == 1) text += " What is missing beside it may be " + look.one_of.front() + ".";
  if (look.one_of.size() > 1)
    text += " What is missing beside it may be " + enumerated(look.one_of, "or") + ": these data can't tell.";
  return text;
}

std::string sentence(const Outcome& outcome, double alpha) {
  std::string text;
  if (!outcome.looked_for.empty())
    text = "The catalogue was cut down to " + enumerated(outcome.looked_for, "and") + ". ";
  const bool none = outcome.verdict == Verdict::none_in_catalogue;
  const bool taken_back = none && !outcome.looks.empty() && !outcome.looks.back().passes() && was_refused(outcome);
  text += taken_back ? sentence_of_refused(outcome, alpha) : verdict_sentence(outcome, alpha);
  if (!outcome.looks.empty()) {
    const Look& look = outcome.looks.back();
    if (none && look.passes()) text += " " + sentence_of_nearest(outcome);
    const bool applied = outcome.verdict == Verdict::named || outcome.verdict == Verdict::several;
    if (applied && !look.passes()) text += " That is not all. " + in_words(look);
  }
  if (outcome.residuals) text += " " + sentence(*outcome.residuals, outcome.family);
  return text;
}

std::vector<Candidate> with_twins(const std::vector<Candidate>& candidates) {
  std::vector<Candidate> all;
  for (const Candidate& candidate : candidates) {
    all.push_back(candidate);
    for (const std::string& twin : effects::twins_of(candidate.score.hypothesis)) {
      const auto is_twin = [&](const Candidate& other) { return other.score.hypothesis == twin; };
      if (std::ranges::any_of(candidates, is_twin)) continue;  // it was asked for
      all.push_back(candidate);
      all.back().score.hypothesis = twin;
      all.back().reason = reason::SameAs{candidate.score.hypothesis};
      all.back().named_together = false;
    }
  }
  return all;
}

}  // namespace pirsim::reconcile
