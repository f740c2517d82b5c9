// The verdict in one sentence, what was found on the way to it, and what a reader may do.
#include <algorithm>
#include <variant>

#include "core/text.hpp"
#include "effects/catalogue.hpp"
#include "reconcile/report/data_sentences.hpp"
#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {
namespace {

/// Which kind of effect it is, if that is clear though its name isn't.
std::string kind_of(const Outcome& outcome) {
  if (!outcome.family.is_sure()) return {};
  return " (with probability " + short_number(outcome.family.probability) + " something of the family " +
         std::string(name(outcome.family.family)) + ")";
}

std::string where(const Outcome& outcome) {
  const auto differing =
      std::ranges::count_if(outcome.location.cells, [&](const auto& c) { return c.adjusted_p <= outcome.alpha; });
  const std::string p = short_number(outcome.location.p);
  if (differing == 0)
    return "none of the " + std::to_string(outcome.location.cells.size()) +
           " cells (trial x sensor) differs by itself, but everything together does, p = " + p;
  return std::to_string(differing) + " of " + std::to_string(outcome.location.cells.size()) +
         " cells (trial x sensor) differ by themselves, everything together with p = " + p;
}

/// Of which effects a sentence speaks.
std::string all_of(const Outcome& outcome) { return outcome.looked_for.empty() ? "the catalogue" : "those looked for"; }

std::string something_else(const Outcome& outcome) {
  return std::string("something that is not ") +
         (outcome.looked_for.empty() ? "in the catalogue" : "among the effects looked for");
}

/// The likeliest of several, and how many are left.
std::string first_ones(const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  if (names.size() <= most + 1) return enumerated(names, "or");
  const std::vector<std::string> first(names.begin(), names.begin() + most);
  return joined(first, ", ") + ", one of " + std::to_string(names.size() - most) + " others";
}

/// Why nothing of the catalogue is taken for what is missing.
std::string no_effect(const Outcome& outcome) {
  for (const Candidate& candidate : outcome.candidates) {
    if (const auto* likeness = std::get_if<reason::LikeImpostors>(&candidate.reason))
      return "what resembles it most, " + candidate.score.hypothesis +
             ", is hardly it: other things that are taken for it make such data more often (p = " +
             short_number(likeness->p_own) + ")";
  }
  std::vector<std::string> possible;
  double together = 0.0;
  for (const Candidate& candidate : outcome.candidates) {
    if (candidate.score.p <= outcome.alpha) continue;
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

std::string sentence_of_set(const Outcome& outcome) {
  const std::string places = where(outcome);
  if (outcome.named.empty())
    return "Model and measurement differ, but so little that nothing can be named: " + places + ".";
  const std::string set = first_ones(outcome.named);
  if (outcome.nothing.p > outcome.alpha)
    return "Model and measurement differ so little that it may be chance: " + places +
           "; if it isn't, the model lacks " + set + kind_of(outcome) + ", or " + something_else(outcome) + ".";
  if (is_unsupported(outcome))
    return "The model lacks something, quite possibly " + something_else(outcome) + ": " + places + "; " + set +
           (outcome.named.size() > 1 ? " can't be ruled out" : " can't be ruled out either") +
           ", but the likeliest of them brings the model no closer to trials that it was not fitted on.";
  if (outcome.named.size() == 1)
    return "The model may lack " + set + ", whose strength may as well be none, or " + something_else(outcome) + ": " +
           places + ".";
  return "The model lacks " + set + kind_of(outcome) + ", or " + something_else(outcome) +
         ", and these data can't tell which: " + places + ".";
}

/// The one effect that would have been named was dropped since the model with it can't have made the data.
bool was_refused(const Outcome& outcome) {
  return std::ranges::any_of(outcome.candidates, [](const Candidate& candidate) {
    return std::holds_alternative<reason::RefusedWhenApplied>(candidate.reason);
  });
}

const Candidate& candidate_of(const Outcome& outcome, const std::string& effect) {
  return *std::ranges::find(outcome.candidates, effect,
                            [](const Candidate& candidate) { return candidate.score.hypothesis; });
}

std::string sentence_of_nearest(const Outcome& outcome) {
  const Candidate& nearest = candidate_of(outcome, outcome.named.front());
  return "The model lacks something that comes nearest to " + in_words(outcome.fits.front()) + ": " + where(outcome) +
         "; with that applied it can have made the data, and no other effect is as likely " + "(probability " +
         short_number(nearest.score.probability) + "), but its own data seldom look like these, so it may be " +
         something_else(outcome) + ".";
}

std::string sentence_of_none(const Outcome& outcome) {
  const std::string lacks = "The model lacks " + something_else(outcome) + ": " + where(outcome);
  if (!outcome.looks.empty() && !outcome.looks.back().passes() && was_refused(outcome)) {
    const Look& look = outcome.looks.back();
    return lacks + "; what resembles it most, " + enumerated(look.applied, "and") +
           ", doesn't explain it, since with that applied the model still differs from the data (p = " +
           short_number(look.p) + ").";
  }
  return lacks + ", and " + no_effect(outcome) + ".";
}

/// Of the likeliest effect if it was dropped, though the model with it passes.
std::string told_of_likeness(const Outcome& outcome) {
  const Look& look = outcome.looks.back();
  return look.applied.front() +
         " comes nearest: with it applied, the test of everything together sees no difference (p = " +
         short_number(look.p) +
         "). It was dropped all the same: " + why(candidate_of(outcome, look.applied.front()).reason);
}

std::string with_unit(double value, const std::string& unit) {
  return short_number(value) + (unit.empty() ? "" : " " + unit);
}

std::string told_of_end(const RangeEnd& end) {
  const std::string text = end.effect + " was looked for with " + end.parameter + " from " +
                           short_number(end.looked_for.low) + " to " + with_unit(end.looked_for.high, end.unit);
  if (end.found)
    return text + ". Beyond that, up to " + with_unit(end.tried_to, end.unit) + ", the model with " +
           with_unit(*end.found, end.unit) + " passes.";
  if (end.tried_to != end.end)
    return text + ", and the data want the end of that range. Up to " + with_unit(end.tried_to, end.unit) +
           " was tried beyond it; no such model passes.";
  return text +
         ", and the data want the end of that range. It may be stronger: write it with other values under effects: of "
         "the script, and reconcile again.";
}

std::string seen_on_held_out(const Verification& v) {
  if (v.closed) return "With what was applied, the model agrees with trials that it was not fitted on.";
  if (v.shrunk) return "With what was applied, the model is closer to trials that it was not fitted on.";
  return "That the model is closer to trials that it was not fitted on is not shown.";
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
  return " Third, the strength: each effect was looked for in a range only, " + enumerated(ranges, "and") +
         " (pirsim effects lists all). Yours may lie outside: write it with its value under effects: of the script, "
         "and "
         "reconcile again.";
}

std::string step_of_set(const Outcome& outcome) {
  if (outcome.named.size() < 2)
    return "What to do next: measure more before anything is applied; pirsim reconcile plan finds what would tell "
           "most.";
  constexpr std::size_t most_told = 3;
  std::vector<std::string> texts;
  for (const std::string& effect : outcome.named) {
    if (texts.size() < most_told) texts.push_back(effect + ": " + effects::find(effect).info.fingerprint);
  }
  return "What to do next: measure more before one of them is applied. pirsim reconcile plan --effects " +
         joined(outcome.named, ",") + " finds the measurement that separates them best. What " +
         (outcome.named.size() > most_told ? "the likeliest do" : "each does") +
         " to the data: " + joined(texts, ". ") + ".";
}

}  // namespace

bool is_unsupported(const Outcome& outcome) {
  if (!outcome.verification || outcome.verification->shrunk) return false;
  const std::vector<std::string>& found = outcome.verification->names;
  const auto of_the_set = std::ranges::count_if(
      found, [&](const std::string& name) { return std::ranges::find(outcome.named, name) != outcome.named.end(); });
  const auto as_first = std::ranges::count(found, found.empty() ? std::string() : found.front());
  return 2 * of_the_set <= std::ssize(found) || 2 * as_first <= std::ssize(found);
}

std::string next_step(const Outcome& outcome) {
  switch (outcome.verdict) {
    case Verdict::no_disagreement:
      return "What to do next: nothing, unless smaller differences matter; more runs make the experiment sharper.";
    case Verdict::named:
    case Verdict::several:
      return "What to do next: run script_patched.yaml, the same script with what was found applied, and see below "
             "whether it comes closer to trials that it was not fitted on.";
    case Verdict::nearest:
      return "What to do next: look at the real thing for " + outcome.named.front() +
             " before anything is changed; script_patched.yaml has it applied. If it isn't that, look at the data, "
             "then "
             "at the model of the room.";
    case Verdict::one_of:
      return step_of_set(outcome);
    case Verdict::faulty_data:
      return next_step_of_faulty(outcome);
    case Verdict::none_in_catalogue:
      break;
  }
  return "What to do next: first look at the data. Is each column its sensor's, each label its trial's, and does the "
         "clock run with the script? The framed cells below show where to look. Second, the model: do seats, sensors "
         "and furniture stand as in the real room, and did people do what the script says?" +
         ranges_looked_for(outcome) +
         " Only then think of a cause that the catalogue lacks (docs/howto/add_an_effect.md).";
}

std::string sentence(const Outcome& outcome) {
  switch (outcome.verdict) {
    case Verdict::no_disagreement:
      return "No disagreement: model and measurement agree as well as the model agrees with itself (p = " +
             short_number(outcome.location.p) + "); this experiment would hardly see differences below " +
             short_number(outcome.location.band_s) + " s a cell.";
    case Verdict::named:
      return "The model lacks " + in_words(outcome.fits.back()) + ": " + where(outcome) + rivals(outcome);
    case Verdict::one_of:
      return sentence_of_set(outcome);
    case Verdict::several:
      return "The model lacks " + enumerated(outcome.named, "and") + " together" +
             (is_unsupported(outcome) ? ", or " + something_else(outcome) : "") + ": " + where(outcome) + ".";
    case Verdict::nearest:
      return sentence_of_nearest(outcome);
    case Verdict::faulty_data:
      return sentence_of_file(outcome);
    case Verdict::none_in_catalogue:
      break;
  }
  return sentence_of_none(outcome);
}

std::vector<std::string> details(const Outcome& outcome) {
  if (outcome.verdict == Verdict::faulty_data) return details_of_faulty(outcome);
  std::vector<std::string> texts;
  if (!outcome.looked_for.empty())
    texts.push_back("The catalogue was cut down to " + enumerated(outcome.looked_for, "and") + ".");
  const bool none = outcome.verdict == Verdict::none_in_catalogue;
  const bool applied = outcome.verdict == Verdict::named || outcome.verdict == Verdict::several;
  if (!outcome.looks.empty()) {
    const Look& look = outcome.looks.back();
    if (none && look.passes()) texts.push_back(told_of_likeness(outcome));
    if (none && !look.passes() && was_refused(outcome))
      texts.emplace_back("None of the others that were tried beside it explains what is left.");
    if (applied && !look.passes()) texts.push_back("That is not all. " + in_words(look));
  }
  if (outcome.range_end) texts.push_back(told_of_end(*outcome.range_end));
  if (outcome.verification) texts.push_back(seen_on_held_out(*outcome.verification));
  if (outcome.residuals) texts.push_back(sentence(*outcome.residuals));
  if (outcome.left_over && !outcome.left_over->drivers.empty()) texts.push_back(sentence_of_rest(*outcome.left_over));
  return texts;
}

}  // namespace pirsim::reconcile
