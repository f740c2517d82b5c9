#include "reconcile/report/sentences.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "engine/effects/catalogue.hpp"
#include "model/core/text.hpp"
#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/feature_map.hpp"

namespace pirsim::reconcile {
namespace {

/// The effect's name with those of its twins.
std::string name_in_words(const FittedEffect& fitted) {
  std::string text = fitted.effect.name;
  for (const std::string& twin : effects::twins_of(fitted.effect.name))
    text += " (or " + twin + ", the same in the model)";
  return text;
}

/// Its parameters and choices; empty for an effect that is there or not.
std::string strength_in_words(const FittedEffect& fitted) {
  const effects::EffectInfo& info = effects::find(fitted.effect.name).info;
  std::vector<std::string> told;
  for (const FittedParameter& p : fitted.parameters) {
    const auto parameter = std::ranges::find(info.parameters, p.name, &effects::ParameterInfo::name);
    constexpr double half_circle = 180.0;
    if (parameter->goes_round() && p.interval.high - p.interval.low >= half_circle) {
      told.push_back(effects::phrase_of(*parameter) + " not determined");
      continue;
    }
    told.push_back(effects::phrase_of(*parameter) + " " + with_unit(p.value, p.unit) +
                   (told.empty() ? " (90 % interval " : " (") + short_number(p.interval.low) + " to " +
                   short_number(p.interval.high) + ")");
  }
  for (const auto& [name, value] : fitted.effect.choices) {
    const auto choice = std::ranges::find(info.choices, name, &effects::ChoiceInfo::name);
    told.push_back(effects::phrase_of(*choice, value) + rivals_in_words(fitted, name, value));
  }
  return joined(told, ", ") + (fitted.includes_off ? ", so uncertain that the interval includes no effect" : "");
}

using What = DataFinding::What;

/// "1,800"
std::string grouped(std::size_t n) {
  std::string digits = std::to_string(n);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return digits;
}

std::string place(const DataFinding::Rows& place) {
  return "rows " + grouped(place.from_row) + " to " + grouped(place.to_row) + " of " + place.trial + " (run " +
         std::to_string(place.replicate) + ")";
}

std::string alike(const DataFinding& finding, const std::string& how) {
  const std::string both =
      enumerated(finding.sensors, "and") + " " + how + " in all " + grouped(finding.n_rows) + " rows";
  if (finding.n_exceptions == 0) return both;
  return both + " but for " + grouped(finding.n_exceptions) + (finding.n_exceptions == 1 ? " change" : " changes");
}

/// Where to look for the cause.
std::string advice(What what) {
  switch (what) {
    case What::equal_columns:
    case What::opposite_columns:
      return "see which input each of the two columns was read from";
    case What::constant_column:
      return "see whether the output or its wire is stuck";
    case What::beats:
      return "see whether the logger writes its sign of life or its polling as motion";
    case What::polled:
      return "see how often the logger asks: if only so often, set window_s to that and resample the rows";
    case What::repeated_rows:
      return "see whether files were joined or saved under a wrong name; take one of the two places out";
    case What::all_silent:
      return "see whether anything was recorded then; leave fields empty that are unknown";
    case What::silent_column:
      break;
  }
  return "see whether the sensor has power and its column is the right one";
}

using Names = std::vector<std::string>;

/// What was applied explains too little of the trials set aside: what is missing may well be none of it.
bool is_unsupported(const Outcome& outcome) { return outcome.verification && !outcome.verification->explains(); }

/// Which kind of effect it is, if that is clear though its name isn't.
std::string kind_of(const Outcome& outcome) {
  if (!outcome.family.is_sure() || is_unsupported(outcome)) return {};
  return " The cause belongs to the family " + std::string(name(outcome.family.family)) + " with probability " +
         short_number(outcome.family.probability) + ".";
}

/// Which part of the trials is off most, and by how much.
std::string most_of_all(const Location& location) {
  constexpr double worth_telling = 3.0, whole_s = 1.0;  // scatters; what is expected is hardly anything below a second
  const auto& [who, part, measured_s, expected_s, scatters] = location.strongest;
  if (std::abs(scatters) < worth_telling) return {};
  const std::string there = part == Deviation::Part::before  ? "before the main part"
                            : part == Deviation::Part::after ? "after the main part"
                                                             : "in the main part";
  const double change = 100.0 * std::abs(measured_s - expected_s) / std::max(expected_s, whole_s);
  return " Strongest " + there + ": " + (who.empty() ? "all sensors" : who) + " " + fixed(change, 0) + " % " +
         (measured_s < expected_s ? "less" : "more") + " (" + fixed(measured_s, 1) + " s with motion a trial, " +
         fixed(expected_s, 1) + " s expected).";
}

/// What the numbers of one sensor or trial as a whole, and of sensors together, say by themselves. A sensor that is off
/// takes its trials along; clocks and dead times that are named explain what is lost together.
std::string told_of_shared(const Outcome& outcome) {
  const auto places_beyond = [&](std::string_view statistic) {
    Names places;
    std::size_t n = 0;
    for (const EnvelopeFeature& feature : outcome.location.envelope) {
      if (feature.name.statistic != statistic) continue;
      ++n;
      if (feature.adjusted_p <= outcome.alpha && feature.observed > feature.median)
        places.push_back(feature.name.place);
    }
    return n > 1 && 2 * places.size() > n ? Names() : places;  // most of them: it is no matter of one
  };
  Names told;
  for (const std::string_view statistic : {of_whole_sensor, of_whole_trial}) {
    const Names off = told.empty() ? places_beyond(statistic) : Names();
    if (!off.empty())
      told.push_back(enumerated(off, "and") + (off.size() == 1 ? " differs" : " differ") + " as a whole");
  }
  const bool is_named = outcome.verdict == Verdict::named || outcome.verdict == Verdict::several;
  if (!is_named && !places_beyond(name(TrialStatistic::joint_loss)).empty())
    told.emplace_back("sensors are lost together");
  if (!is_named && !places_beyond(name(TrialStatistic::loss_in_company)).empty())
    told.emplace_back("sensors are lost where others report, and hardly alone");
  if (told.empty()) return {};
  std::string text = joined(told, "; ") + ".";
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string where(const Outcome& outcome) {
  const auto& cells = outcome.location.cells;
  const auto differing = std::ranges::count_if(cells, [&](const auto& c) { return c.differs(outcome.alpha); });
  const std::string of = std::to_string(cells.size()) + " cells (one trial at one sensor) ";
  const std::string p = p_in_words(outcome.location.p, outcome.location.least_p());
  if (differing == 0)
    return " None of the " + of + "differs by more than chance, but everything together does (" + p + ")." +
           most_of_all(outcome.location);
  return " " + std::to_string(differing) + " of " + of + (differing == 1 ? "differs" : "differ") +
         " by more than chance (everything together: " + p + ")." + most_of_all(outcome.location);
}

/// The effects of which a sentence speaks.
std::string all_of(const Outcome& outcome) { return outcome.looked_for.empty() ? "the catalogue" : "those looked for"; }

std::string among_known(const Outcome& outcome) {
  return outcome.looked_for.empty() ? "in the catalogue" : "among the effects looked for";
}

std::string something_else(const Outcome& outcome) { return "something that isn't " + among_known(outcome); }

/// The likeliest of several, and how many are left.
Names first_ones(const Names& names) {
  constexpr std::size_t most = 3;
  if (names.size() <= most + 1) return names;
  Names first(names.begin(), names.begin() + most);
  first.push_back(std::to_string(names.size() - most) + " other effects");
  return first;
}

/// Why nothing of the catalogue is taken for what is missing.
std::string no_effect(const Outcome& outcome) {
  for (const Candidate& candidate : outcome.candidates) {
    if (candidate.reason.what == Reason::What::like_impostors)
      return " It looks most like " + candidate.score.hypothesis + ", but " + candidate.score.hypothesis +
             " itself seldom makes such data (p = " + short_number(candidate.score.p_own) +
             "): more probably another cause imitates it.";
  }
  Names possible;
  double together = 0.0;
  for (const Candidate& candidate : outcome.candidates) {
    if (candidate.score.p <= outcome.alpha) continue;
    possible.push_back(candidate.score.hypothesis);
    together += candidate.score.probability;
  }
  if (possible.empty()) return " No effect of " + all_of(outcome) + " is likely to have made the data.";
  const std::string& likeliest = std::ranges::max_element(outcome.candidates, {}, [](const Candidate& c) {
                                   return c.score.probability;
                                 })->score.hypothesis;
  const bool one = possible.size() == 1;
  const std::string effects = outcome.looked_for.empty() ? "the catalogue's effects" : "the effects looked for";
  const std::string told =
      std::ranges::find(possible, likeliest) != possible.end()
          ? " Of " + effects + " only " + enumerated(possible, "and") + (one ? " isn't ruled out" : " aren't ruled out")
          : " The likelier ones of " + effects + " are ruled out. " + enumerated(possible, "and") +
                (one ? " isn't" : " aren't");
  return told + ", but " + (one ? "its probability" : "their probability together") + " is only " +
         short_number(together) + ".";
}

/// What else may have made the data beside the effect that is named.
std::string rivals(const Outcome& outcome) {
  Names names, unknown;
  for (const Candidate& candidate : outcome.candidates) {
    if (candidate.kept && candidate.score.hypothesis != outcome.named.front())
      names.push_back(candidate.score.hypothesis);
    if (candidate.reason.what == Reason::What::hardly_simulated) unknown.push_back(candidate.score.hypothesis);
  }
  if (!names.empty())
    return " " + enumerated(names, "and") + " can't be ruled out, but " + outcome.named.front() +
           " is the likeliest cause (probability " + short_number(outcome.candidates.front().score.probability) + ").";
  return " No other effect of " + all_of(outcome) + " explains the data." +
         (unknown.empty() ? "" : " " + enumerated(unknown, "and") + " could hardly be simulated in this room.");
}

/// What people wrote down, and not what the simulation leaves out.
bool is_of_data(const FittedEffect& fitted) { return !effects::find(fitted.effect.name).info.as_if.empty(); }

std::string as_if(const FittedEffect& fitted) {
  return "as if " + effects::find(fitted.effect.name).info.as_if + " (" + in_words(fitted) + ")";
}

std::string sentence_of_named(const Outcome& outcome) {
  const FittedEffect& fitted = outcome.fits.back();
  const std::string rest = where(outcome) + rivals(outcome);
  if (is_of_data(fitted)) return "The data look " + as_if(fitted) + "." + rest;
  const std::string strength = strength_in_words(fitted);
  return "The measurement shows " + name_in_words(fitted) + ", which the simulation doesn't include" +
         (strength.empty() ? "." : ": " + strength + ".") + rest;
}

/// While they may be wrong, nothing else is applied; said first where no other cause comes before them.
std::string counts_first(const Outcome& outcome) {
  if (!counts_in_doubt(outcome.candidates, outcome.alpha)) return {};
  if (!outcome.named.empty() && !is_about_counts(outcome.named.front())) return {};
  return "Check the people counts first: while they may be wrong, what else is missing can't be told. ";
}

std::string sentence_of_set(const Outcome& outcome) {
  const std::string places = where(outcome);
  if (outcome.named.empty()) return "Measurement and simulation differ, but by too little to name a cause." + places;
  Names causes = first_ones(outcome.named);
  const bool one = outcome.named.size() == 1;
  if (outcome.nothing.p > outcome.alpha) {
    causes.push_back(something_else(outcome));
    return counts_first(outcome) + "Taken as a whole, what measurement and simulation differ by may be chance." +
           places + " If it isn't, the cause is " + enumerated(causes, "or") + "." + kind_of(outcome);
  }
  const std::string first = counts_first(outcome) + "The measurement ";
  if (is_unsupported(outcome))
    return first + "shows something that the simulation doesn't include, quite possibly " + something_else(outcome) +
           "." + places + " " + enumerated(causes, "and") + " can't be ruled out, but " +
           (one ? "it" : "the likeliest of them") + " explains hardly anything of trials not used for fitting.";
  if (one)
    return first + "shows something that the simulation doesn't include. It may be " + causes.front() +
           ", but the data don't tell whether that effect is there at all. Or it is " + something_else(outcome) + "." +
           places;
  causes.push_back(something_else(outcome));
  return first + "shows one of these, and the data can't tell which: " + enumerated(causes, "or") + "." + places +
         kind_of(outcome);
}

/// The one effect that would have been named was dropped since the model with it can't have made the data.
bool was_refused(const Outcome& outcome) {
  return std::ranges::any_of(outcome.candidates, [](const Candidate& candidate) {
    return candidate.reason.what == Reason::What::refused_when_applied;
  });
}

std::string sentence_of_nearest(const Outcome& outcome) {
  const FittedEffect& fitted = outcome.fits.front();
  return (is_of_data(fitted) ? "The closest known cause is a fault of the data: they look " + as_if(fitted)
                             : "The closest known cause is " + in_words(fitted)) +
         ". It fits only roughly: simulations with it rarely look quite like your data. So the true cause may not be " +
         among_known(outcome) + "." + where(outcome);
}

std::string sentence_of_none(const Outcome& outcome) {
  const std::string shows =
      counts_first(outcome) + "The measurement shows " + something_else(outcome) + "." + where(outcome);
  if (!outcome.looks.empty() && !outcome.looks.back().passes() && was_refused(outcome)) {
    const Look& look = outcome.looks.back();
    return shows + " It looks most like " + enumerated(look.applied, "and") +
           ", but a simulation with that still differs from the data (" + p_in_words(look.p, look.least_p) + ").";
  }
  return shows + no_effect(outcome);
}

/// Of the likeliest effect if it was dropped, though the model with it passes.
std::string told_of_likeness(const Outcome& outcome) {
  const Look& look = outcome.looks.back();
  const auto is_it = [&](const Candidate& candidate) { return candidate.score.hypothesis == look.applied.front(); };
  return "The closest known cause is " + look.applied.front() +
         ": with it applied, the test of everything together sees no difference (" + p_in_words(look.p, look.least_p) +
         "). It was dropped all the same: " + std::ranges::find_if(outcome.candidates, is_it)->reason.why;
}

std::string told_of_end(const RangeEnd& end) {
  const std::vector<effects::ParameterInfo>& parameters = effects::find(end.effect).info.parameters;
  const auto parameter = std::ranges::find(parameters, end.parameter, &effects::ParameterInfo::name);
  const std::string text = end.effect + " was looked for with " + effects::phrase_of(*parameter) + " from " +
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
    ranges.push_back(candidate.score.hypothesis + " (" + effects::phrase_of(strength) + " from " +
                     short_number(strength.low) + " to " + with_unit(strength.high, strength.unit) + ")");
  }
  if (ranges.empty()) return {};
  return " Third, the strength: each effect was looked for in a range only, " + enumerated(ranges, "and") +
         ". pirsim effects lists all ranges. Yours may lie outside: write it with its value under effects: of the "
         "script, "
         "and "
         "reconcile again.";
}

/// What to look at before the effect is believed.
std::string step_of_nearest(const Outcome& outcome) {
  const std::string& effect = outcome.named.front();
  return "What to do next: look for " + effect +
         (is_of_data(outcome.fits.front()) ? " in the data" : " in the real room") +
         " before anything is changed. pirsim effects " + effect +
         " tells what it does, and script_patched.yaml has it applied. If it isn't that, look at the data, then at the "
         "model of the room.";
}

/// Faults of the data are mended in the data.
std::string step_of_several(const Outcome& outcome) {
  Names of_data, others;
  for (const std::string& effect : outcome.named)
    (effects::find(effect).info.as_if.empty() ? others : of_data).push_back(effect);
  if (of_data.empty())
    return "What to do next: look for " + enumerated(others, "and") +
           " in the real room. If they are there, simulate with script_patched.yaml, the same script with all of it "
           "applied.";
  return "What to do next: see whether the data have " + enumerated(of_data, "and") +
         "; if so, mend them and analyse again" +
         (others.empty() ? "." : ". Then see whether " + enumerated(others, "and") + " is still found.");
}

std::string step_of_named(const Outcome& outcome) {
  if (is_of_data(outcome.fits.back()))
    return "What to do next: see whether that is so, in the files and the wiring that the data come from. If it is, "
           "mend "
           "the data and analyse them again. script_patched.yaml simulates the fault as it was found, and is no model "
           "of "
           "your room.";
  if (outcome.verification && !outcome.verification->shrunk) return step_of_nearest(outcome);
  const std::string& effect = outcome.named.front();
  return "What to do next: look for " + effect + " in the real room; pirsim effects " + effect +
         " tells what it does. If it is there, simulate with script_patched.yaml, the same script with it applied.";
}

std::string step_of_set(const Outcome& outcome) {
  constexpr std::size_t most_told = 3;
  const bool counts = counts_in_doubt(outcome.candidates, outcome.alpha);
  Names rest = outcome.named;  // if the counts are right
  if (counts) std::erase_if(rest, is_about_counts);
  std::string step = std::string("What to do next: ") +
                     (counts ? "check the people counts, mend them, and analyse again. If they are right, " : "");
  if (is_unsupported(outcome))
    step +=
        "look at the data first, then at the model of the room: columns, labels, clock, seats, sensors, furniture. "
        "Then ";
  if (rest.size() < 2)
    return step + "measure more before anything is applied; pirsim reconcile plan finds what would tell most.";
  std::vector<std::string> texts;
  for (const std::string& effect : rest) {
    if (texts.size() < most_told) texts.push_back(effect + ": " + effects::find(effect).info.fingerprint);
  }
  return step + "measure more before one of them is applied. pirsim reconcile plan --effects " + joined(rest, ",") +
         " finds the measurement that separates them best. What " +
         (rest.size() > most_told ? "the likeliest do" : "each does") + " to the data: " + joined(texts, ". ") + ".";
}

std::string drivers_in_words(const Residuals& residuals) {
  std::vector<std::string> texts;
  for (const ResidualDriver& driver : residuals.drivers)
    texts.push_back(driver.who + (driver.when.empty() ? "" : ", " + driver.when) + ": " + driver.what + " (" +
                    p_in_words(driver.p, driver.least_p) + ")");
  return joined(texts, "; ");
}

/// Of the verdict no_disagreement: a cell beyond its own range may be more than chance, though all of them together
/// aren't.
std::string step_of_agreement(const Location& location) {
  const auto off = [](const LocatedCell& cell) { return cell.is_outside() ? std::abs(cell.scatters) : -1.0; };
  const auto worst = std::ranges::max_element(location.cells, {}, off);
  if (worst == location.cells.end() || off(*worst) < 0.0)
    return "What to do next: nothing, unless smaller differences matter; more runs make the experiment sharper.";
  const auto outside = std::ranges::count_if(location.cells, &LocatedCell::is_outside);
  return "What to do next: see whether " + worst->sensor + " hangs as drawn and " + worst->trial +
         " went as written (" + fixed(worst->measured_s, 0) + " s with motion, usually " + fixed(worst->low_s, 0) +
         " to " + fixed(worst->high_s, 0) + " s). " + std::to_string(outside) + " of " +
         std::to_string(location.cells.size()) +
         " cells lie outside their own range, and one of twenty does by chance. More runs make the experiment sharper.";
}

/// Of the verdict faulty_data: what is wrong with the file.
std::string sentence_of_file(const Outcome& outcome) {
  std::vector<std::string> told;
  for (const DataFinding& finding : outcome.data_findings) {
    if (finding.is_impossible) told.push_back(in_words(finding));
  }
  return "Look at the file first: " + joined(told, "; ") + ", which sensors can't have said.";
}

/// What a reader may do with that verdict.
std::string next_step_of_faulty(const Outcome& outcome) {
  std::vector<std::string> steps;
  for (const DataFinding& finding : outcome.data_findings) {
    const std::string step = advice(finding.what);
    if (finding.is_impossible && std::ranges::find(steps, step) == steps.end()) steps.push_back(step);
  }
  return "What to do next: " + joined(steps, "; ") +
         ". Then mend the file and analyse it again. What else is told here may come from the same fault.";
}

}  // namespace

std::string enumerated(const std::vector<std::string>& names, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " " + last + " " : ", ") + names[i];
  }
  return text;
}

std::string with_unit(double value, const std::string& unit) {
  const std::string number = short_number(value);
  if (unit.empty()) return number;
  return number + (unit.starts_with("1/") ? " per " + unit.substr(2) : " " + unit);
}

std::string rivals_in_words(const FittedEffect& fitted, const std::string& choice, const std::string& value) {
  constexpr double as_likely = 0.2;  // assumed: what is less probable isn't worth telling
  std::vector<std::string> rivals;
  for (const FittedChoice& fit : fitted.choices) {
    if (fit.name != choice) continue;
    for (const auto& [word, probability] : fit.words) {
      if (word == value || probability < as_likely) continue;
      rivals.push_back((word.empty() ? "all" : word) + ", probability " + fixed(probability, 2));
    }
  }
  return rivals.empty() ? "" : " (or " + joined(rivals, "; or ") + ")";
}

std::string in_words(const FittedEffect& fitted) {
  const std::string strength = strength_in_words(fitted);
  return name_in_words(fitted) + (strength.empty() ? "" : ": " + strength);
}

std::string in_words(const Look& look) {
  std::string text = "With " + enumerated(look.applied, "and") + " applied, the model " +
                     (look.passes() ? "can have made these data" : "still differs from the data") + " (" +
                     p_in_words(look.p, look.least_p) + ").";
  if (look.one_of.size() == 1) text += " What is missing beside it may be " + look.one_of.front() + ".";
  if (look.one_of.size() > 1)
    text += " What is missing beside it may be " + enumerated(look.one_of, "or") + ": these data can't tell.";
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
      all.back().reason = {"",
                           "Judged as " + candidate.score.hypothesis + ", which changes the model in the same way."};
      all.back().named_together = false;
    }
  }
  return all;
}

std::string in_words(const DataFinding& finding) {
  const std::string every = "every " + short_number(finding.every_s) + " s";
  const std::string& sensor = finding.sensors.empty() ? std::string() : finding.sensors.front();
  switch (finding.what) {
    case What::equal_columns:
      return alike(finding, "are equal");
    case What::opposite_columns:
      return alike(finding, "are opposite");
    case What::constant_column:
      return sensor + " is 1 in all " + grouped(finding.n_rows) + " rows";
    case What::beats:
      return sensor + " is 1 " + every + ", whatever happens";
    case What::polled:
      return "no sensor changes but " + every;
    case What::repeated_rows:
      return place(finding.places.front()) + " stand again as " + place(finding.places.back());
    case What::all_silent:
      return "all sensors are silent together in " + place(finding.places.front()) +
             (finding.is_impossible ? ", far longer than else in that run and than" : ", longer than") +
             " in any simulated one";
    case What::silent_column:
      break;
  }
  return sensor + " has no 1 in " + grouped(finding.n_rows) + " rows, though the model expects some";
}

Outcome as_compared(const Outcome& outcome) {
  Outcome rows = outcome;
  if (rows.verdict == Verdict::faulty_data) rows.verdict = rows.verdict_of_rows;
  return rows;
}

io::ReportSection file_section(const std::vector<DataFinding>& findings) {
  io::Table table{{"finding", "told since", "what to do"}, {}};
  for (const DataFinding& finding : findings) {
    const std::string chance = finding.chance < 1e-12 ? "below 1e-12" : short_number(finding.chance);
    table.rows.push_back({in_words(finding),
                          finding.is_impossible ? "by chance " + chance : "odd, but sensors can do that",
                          advice(finding.what)});
  }
  return {"A look at the file",
          {"Before anything is compared, the rows themselves are looked at: can sensors have said them? What the "
           "model's own runs do as well, as repeating a movement by the metronome, isn't told."},
          {std::move(table)},
          {}};
}

// The verdict in one sentence, what was found on the way to it, and what a reader may do.

std::string seen_on_held_out(const Outcome& outcome) {
  const Verification& v = *outcome.verification;
  const std::string there = "On trials not used for fitting, ";
  if (!v.shrunk) return there + "no improvement could be demonstrated.";
  return there + "the simulation with " + applied_to_held_out(outcome) +
         (v.closed ? " agrees with the data." : " comes closer to the data.");
}

std::string applied_to_held_out(const Outcome& outcome) {
  if (!outcome.fits.empty()) return enumerated(outcome.named, "and");
  Names found;  // the likeliest of each fold
  for (const std::string& name : outcome.verification->names) {
    if (std::ranges::find(found, name) == found.end()) found.push_back(name);
  }
  return found.empty() ? "the likeliest of each fold" : enumerated(found, "or");
}

std::string next_step(const Outcome& outcome) {
  switch (outcome.verdict) {
    case Verdict::no_disagreement:
      return step_of_agreement(outcome.location);
    case Verdict::named:
      return step_of_named(outcome);
    case Verdict::several:
      return step_of_several(outcome);
    case Verdict::nearest:
      return step_of_nearest(outcome);
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
      return "No difference detected: the measurement looks like the simulation's own runs (p = " +
             short_number(outcome.location.p) + "). A difference below " + short_number(outcome.location.band_s) +
             " s in a cell (one trial at one sensor) would hardly have been seen.";
    case Verdict::named:
      return sentence_of_named(outcome);
    case Verdict::one_of:
      return sentence_of_set(outcome);
    case Verdict::several:
      return "The measurement shows " + enumerated(outcome.named, "and") + " together." + where(outcome);
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
  std::vector<std::string> texts;
  if (outcome.verdict == Verdict::faulty_data) {
    const Outcome rows = as_compared(outcome);
    texts = details(rows);
    texts.insert(texts.begin(), "With the rows taken as they are: " + sentence(rows));
    return texts;
  }
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
  if (std::string shared = told_of_shared(outcome); !shared.empty()) texts.push_back(std::move(shared));
  if (outcome.range_end) texts.push_back(told_of_end(*outcome.range_end));
  if (outcome.verification) texts.push_back(seen_on_held_out(outcome));
  if (outcome.residuals) texts.push_back(sentence(*outcome.residuals));
  if (outcome.left_over && !outcome.left_over->drivers.empty()) texts.push_back(sentence_of_rest(*outcome.left_over));
  return texts;
}

std::string in_words(const Candidate& candidate) {
  const auto& [decision, why, what] = candidate.reason;
  return (candidate.named_together ? "Kept, together with the others named. By itself: " : "") + decision +
         (decision.empty() ? "" : ": ") + why;
}

std::string sentence_of_rest(const Residuals& rest) {
  const std::string text = drivers_in_words(rest);
  return text.empty() ? "" : "Something else shows: " + text + ".";
}

std::string sentence(const Residuals& residuals) {
  const std::string text = drivers_in_words(residuals);
  return text.empty() ? "What is left follows no sensor, seat, time or neighbour that was tried."
                      : "What is left: " + text + ".";
}

}  // namespace pirsim::reconcile
