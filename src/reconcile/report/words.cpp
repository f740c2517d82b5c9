#include <array>
#include <cmath>
#include <utility>

#include "model/core/text.hpp"
#include "reconcile/report/sentences.hpp"

// Reasons, notes, events and residuals in words.

namespace pirsim::reconcile {
namespace {

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

std::string plural(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}
std::string runs(std::size_t n) { return plural(n, "run", "runs"); }
std::string whole(double value) { return std::to_string(std::lround(value)); }
std::string list(const std::vector<std::string>& names) { return joined(names, ", "); }
std::string sum(const std::vector<std::string>& names) { return joined(names, " + "); }

struct Worded {
  std::string head, body;  ///< "Kept", and why
};

Worded worded(const Reason& of) {
  const auto p = [](double value, double least = 0.0) { return "(" + p_in_words(value, least) + ")"; };
  return std::visit(
      Overloaded{
          [&](const reason::NotRuledOut& r) {
            return Worded{"Kept", "it can have made these data " + p(r.p) +
                                      ", and no other effect explains them so much better that it can be ruled out."};
          },
          [&](const reason::Sure& r) {
            return Worded{
                "Kept, though simulations with it seldom look like these data " + p(r.p),
                "with probability " + short_number(r.probability) + " it is this one of those looked for, if any."};
          },
          [](const reason::MayBeNone&) {
            return Worded{"Kept, but not named", "its strength may as well be none."};
          },
          [&](const reason::LessLikely& r) {
            return Worded{"", "Not ruled out " + p(r.p) + ", but much less likely than " + r.named + " (" +
                                  short_number(r.probability) + " against " + short_number(r.probability_of_named) +
                                  ")."};
          },
          [&](const reason::Improbable& r) {
            return Worded{"Dropped", "by itself it might have made these data " + p(r.p) +
                                         ", but all that isn't ruled out is improbable together."};
          },
          [&](const reason::LikeImpostors& r) {
            return Worded{"Dropped",
                          "other things that are taken for it make such data more often than it does "
                          "itself " +
                              p(r.p_own) + "."};
          },
          [](const reason::HardlySimulated&) {
            return Worded{"Dropped", "it could hardly be simulated in this room."};
          },
          [&](const reason::RuledOut& r) {
            std::string text;
            if (r.p_relative)
              text += "another explains the data better than is usual for its own " + p(*r.p_relative, r.least_p);
            if (r.p_relative && r.p_absolute) text += "; and ";
            if (r.p_absolute)
              text += "simulations with it hardly ever look like these data " + p(*r.p_absolute, r.least_p);
            return Worded{"Dropped", text + "."};
          },
          [&](const reason::RefusedWhenApplied& r) {
            return Worded{"Dropped", "with it applied, the model still differs from the data " + p(r.p, r.least_p) +
                                         ", and none of the others that were tried explains what is left."};
          },
          [&](const reason::DoesBetter& r) {
            return Worded{"Kept", "applied to the model, it makes such data oftener than " + r.named + " does " +
                                      p(r.p) + ", against " + short_number(r.p_of_named) + "."};
          },
          [](const reason::SameAs& r) {
            return Worded{"", "Judged as " + r.effect + ", which changes the model in the same way."};
          }},
      of);
}

std::string in_words(const trail::JudgedOnHeldOut& event) {
  const Verification& v = event.verification;
  return "held-out trials: energy score " + short_number(v.before.energy_score) + " before, " +
         short_number(v.after.energy_score) + " after, " + std::to_string(v.n_better) + " of " +
         std::to_string(v.n_trials) + " trials better; global test " + p_in_words(v.before.p, v.before.least_p) +
         " before, " + p_in_words(v.after.p, v.after.least_p) + " after";
}

std::string_view in_words(trail::Remark remark) noexcept {
  constexpr std::array<std::string_view, 9> texts{
      "the name is taken back: a relative applied in its place does better",
      "the name is taken back",
      "the name is taken back: the model with it can't have made the data",
      "added to it, no other effect comes near these data: nothing more is looked for",
      "people can hardly get about in that model: nothing more is looked for in it",
      "sums don't tell when motion was seen: the residuals are not looked into",
      "one trial only: nothing can be held out",
      "people can hardly get about in the patched model: it can't be judged on held-out trials",
      "the held-out trials alone don't refuse the plain model: too weak to call the gap closed"};
  return texts[static_cast<std::size_t>(remark)];
}

std::string left_out_of(std::size_t n, const std::string& which, const std::string& because) {
  return "What comes " + which + " the counted phases is left out of the comparison in " + runs(n) +
         ", of all sensors or some: " + because + ", or some readings are unknown.";
}

std::string in_words(const ResidualDriver& driver) {
  const std::string when = when_of(driver);
  return who_of(driver) + (when.empty() ? "" : ", " + when) + ": " + what_of(driver) + " (" +
         p_in_words(driver.p, driver.least_p) + ")";
}

}  // namespace

std::string in_words(const FeatureName& feature) {
  using Kind = FeatureName::Kind;
  static constexpr std::array<std::string_view, 8> permutations{
      "trials shifted by one",  "trials shifted back by one",  "trials in reverse",  "two trials swapped",
      "sensors shifted by one", "sensors shifted back by one", "sensors in reverse", "two sensors swapped"};
  const std::string& statistic = feature.statistic;
  switch (feature.kind) {
    case Kind::cell:
      return feature.trial + " " + feature.sensor + " " + statistic;
    case Kind::sensor:
      return feature.sensor + " " + statistic;
    case Kind::trial:
      return feature.trial + " " + statistic;
    case Kind::mean:
      return "mean " + statistic;
    case Kind::size:
      return "size of " + statistic;
    case Kind::greatest:
      return "greatest " + statistic;
    case Kind::least:
      return "least " + statistic;
    case Kind::slope:
      return "slope on " + feature.other + " of " + statistic;
    case Kind::first_less_second:
      return "first less second sensor: " + statistic;
    case Kind::last_but_one_less_last:
      return "last but one less last sensor: " + statistic;
    case Kind::first_less_last:
      return "first less last sensor: " + statistic;
    case Kind::share_of_time:
      return (feature.sensor.empty() ? "all sensors" : feature.sensor) + ", part " + std::to_string(feature.part) +
             " of " + std::to_string(feature.n_parts) + " of the time";
    case Kind::together:
      return feature.sensor + " while " + feature.other + " moves";
    case Kind::most_together:
      return "most together";
    case Kind::least_together:
      return "least together";
    case Kind::likeness:
      return "likeness";
    case Kind::likeness_gained:
      break;
  }
  return "likeness gained by " + std::string(permutations[static_cast<std::size_t>(feature.permutation)]);
}

std::string why(const Reason& reason) { return worded(reason).body; }

std::string in_words(const Reason& reason) {
  const Worded words = worded(reason);
  return (words.head.empty() ? "" : words.head + ": ") + words.body;
}

std::string in_words(const Candidate& candidate) {
  return (candidate.named_together ? "Kept, together with the others named. By itself: " : "") +
         in_words(candidate.reason);
}

std::string in_words(const DataNote& note) {
  using What = DataNote::What;
  switch (note.what) {
    case What::sums_empty:
      return plural(note.n, "sum is", "sums are") + " empty and left out of every comparison.";
    case What::cells_absent:
      return plural(note.n, "cell", "cells") + " (trial and sensor) of the trials in the file " +
             (note.n == 1 ? "has" : "have") + " no sum: left out of every comparison.";
    case What::sensors_absent:
      return "The file has no column for " + list(note.names) + ": left out of every comparison.";
    case What::phases_unknown:
      return "The file has no column 'phase': its rows are taken for those of the phase '" + list(note.names) +
             "', from its beginning.";
    case What::rows_missing:
      return plural(note.n, "row is", "rows are") + " missing: taken for unknown, in the simulation too.";
    case What::readings_empty:
      return plural(note.n, "reading is", "readings are") + " empty: taken for unknown, in the simulation too.";
    case What::runs_unread:
      return plural(note.n, "run has", "runs have") + " no reading" +
             (note.names.empty() ? "" : " in a counted phase (" + list(note.names) + ")") + " and " +
             (note.n == 1 ? "is" : "are") + " left out.";
    case What::trials_absent:
      return "The file has nothing of " + list(note.names) + ": left out of every comparison.";
    case What::lead_left_out:
      return left_out_of(note.n, "before", "the recording begins later than any simulated one");
    case What::tail_left_out:
      return left_out_of(note.n, "after", "the recording ends earlier than any simulated one");
    case What::runs_begin_late:
      return runs(note.n) + " of the file " + (note.n == 1 ? "begins" : "begin") +
             " in a counted phase: the first row is taken for its beginning.";
    case What::runs_end_early:
      return "The main part of " + runs(note.n) +
             " of the file ends before any simulated one, by a twentieth or more: compared as far as it goes.";
    case What::people_unused:
      return "The column 'people' is left out of every comparison: it is the script that says who is there.";
    case What::effects_idle:
      return list(note.names) + (note.n == 1 ? " isn't" : " aren't") + " looked for: to an analog sensor " +
             (note.n == 1 ? "it means" : "they mean") + " nothing.";
    case What::log_read:
      return "Read as a log of " + plural(note.n, "line", "lines") +
             (note.names[0].empty() ? ", an event each" : ", a reading every " + note.names[0] + " s") +
             ": a window of " + note.names[1] + " s has motion if there is any in it.";
    case What::hold_told:
      return note.names[0] + " holds motion for " + note.names[1] + " s: its " + std::to_string(note.n) +
             " pulses are hardly ever shorter. The simulated sensor does so too.";
    case What::people_differ:
      return "The data count other people than the script in " + std::to_string(note.n) + " of " + note.names[0] +
             " windows, first " + note.names[2] + " instead of " + note.names[3] + " at " + note.names[1] +
             ". Who is there in the simulation is what the script says.";
    case What::days_absent:
      return plural(note.n, "row lies", "rows lie") + " outside of the script's days: left out.";
    case What::runs_go_on:
      break;
  }
  return "What goes on after the end of the longest simulated run is left out of the comparison in " + runs(note.n) +
         ".";
}

std::string in_words(const TrailEvent& event) {
  return std::visit(
      Overloaded{[](const trail::Begun& e) { return "data " + e.digest + ", analysis seed " + std::to_string(e.seed); },
                 [](const DataNote& e) { return "data: " + in_words(e); },
                 [](const DataFinding& e) { return "file: " + in_words(e); },
                 [](const trail::HeldOut& e) { return "held out from naming and fitting: " + joined(e.trials, " "); },
                 [](const trail::Table& e) {
                   return "table " + e.key + ": " + std::to_string(e.n_datasets) + " datasets, " +
                          std::to_string(e.n_left_out) + " left out because people couldn't get about";
                 },
                 [](const trail::Tested& e) { return "global test: " + p_in_words(e.p, e.least_p); },
                 [](const trail::NotRuledOut& e) {
                   return "hypotheses that can have made the data: " +
                          (e.hypotheses.empty() ? "none" : joined(e.hypotheses, " "));
                 },
                 [](const trail::AtRangeEnd& e) {
                   const std::string end =
                       e.end.effect + "'s " + e.end.parameter + " at the end of its range, " + short_number(e.end.end);
                   if (e.end.tried_to == e.end.end) return end;
                   return end + ", tried to " + short_number(e.end.tried_to) + ": " +
                          (e.end.found ? short_number(*e.end.found) : "none") + " passes";
                 },
                 [](const trail::IncludesOff& e) { return "the interval of " + e.effect + " includes off"; },
                 [](const Look& e) {
                   return "with " + sum(e.applied) + " applied, at level " + short_number(e.level) + ": " +
                          p_in_words(e.p, e.least_p);
                 },
                 [](const trail::LookedForMore& e) { return "looked for more: " + std::string(name(e.verdict)); },
                 [](const trail::Explained& e) { return "residuals: " + sentence(e.residuals); },
                 [](const trail::LeftOver& e) {
                   const std::string text = sentence_of_rest(e.residuals);
                   return text.empty() ? "nothing more changes from trial to trial or strikes all sensors at once"
                                       : text;
                 },
                 [](const trail::JudgedOnHeldOut& e) { return in_words(e); },
                 [](trail::Remark e) { return std::string(in_words(e)); }},
      event);
}

std::string in_words(const Stage& stage) {
  using What = Stage::What;
  switch (stage.what) {
    case What::pilot_runs:
      return "pilot runs";
    case What::reference_table:
      return "reference table";
    case What::comparing:
      return "where they differ, and which effects can have made the data";
    case What::checking_model:
      return "does the model with " + sum(stage.effects) + " applied pass";
    case What::looking_for_more:
      return "what is missing beside " + sum(stage.effects);
    case What::explaining_residuals:
      return "what the residuals follow";
    case What::verifying:
      return "does it help on held-out trials";
    case What::injecting_faults:
      return "datasets with injected faults";
    case What::judging:
      return "judging";
    case What::judging_without:
      return "judging by a catalogue that lacks " + sum(stage.effects);
    case What::judging_planned:
      return "judging what is planned";
    case What::judging_trial:
      return "judging trial " + sum(stage.effects) + " once more";
    case What::judging_all_again:
      return "judging every trial once more";
    case What::judging_walk:
      return "judging one person walking slowly through the room";
    case What::judging_empty_room:
      return "judging the empty room";
    case What::judging_series:
      break;
  }
  return "judging the same, second by second instead of sums";
}

std::string in_words(const LeftOut& left_out) {
  const bool walk = left_out.trial == LeftOut::Trial::slow_walk;
  return std::string(walk ? "a slow walk" : "the empty room") + " is left out: " + left_out.error;
}

std::string who_of(const ResidualDriver& driver) {
  using enum ResidualDriver::Who;
  switch (driver.who) {
    case all_sensors:
      return "all sensors";
    case sensor:
    case trial:
      return driver.name;
    case near_seat:
      return "sensors near the seat";
    case far_from_seat:
      return "sensors far from the seat";
    case faced:
      return "sensors that the sitter faces";
    case behind:
      break;
  }
  return "sensors behind the sitter";
}

namespace {

std::string time_of(const ResidualDriver& driver) {
  using enum ResidualDriver::When;
  const std::string from = whole(driver.from), to = whole(driver.to);
  switch (driver.when) {
    case always:
      return {};
    case first_half:
      return "in the first half of each run";
    case second_half:
      return "in the second half of each run";
    case first_third:
      return "in the first third of each run";
    case middle_third:
      return "in the middle third of each run";
    case last_third:
      return "in the last third of each run";
    case of_minute:
      return driver.from == 0.0 ? "in the first " + to + " s of each minute"
                                : "from second " + from + " to " + to + " of each minute";
    case after_posture:
      return (driver.from == 0.0 ? "in the first " + to + " s" : "from " + from + " to " + to + " s") +
             " after each change of posture";
    case before_posture:
      return "in the last " + whole(driver.to - driver.from) + " s before each change of posture";
    case of_arm_cycle:
      return "from " + from + " to " + to + " % of the arm's cycle";
    case from_trial:
      return "from about trial " + driver.since + " on";
    case from_trial_to_trial:
      return "from trial to trial";
    case wave:
      break;
  }
  return "rising and falling every " + from + " s, most around second " + to;
}

bool is_of_session(const ResidualDriver& driver) noexcept {
  return driver.when == ResidualDriver::When::from_trial || driver.when == ResidualDriver::When::from_trial_to_trial;
}

bool is_joint(const ResidualDriver& driver) noexcept { return driver.how == ResidualDriver::How::silent_together; }

}  // namespace

std::string when_of(const ResidualDriver& driver) {
  std::string when = time_of(driver);
  if (is_of_session(driver) || is_joint(driver)) return when;
  if (driver.who != ResidualDriver::Who::trial) when += (when.empty() ? "" : ", ") + std::string("whatever the seat");
  return when;
}

std::string what_of(const ResidualDriver& driver) {
  using enum ResidualDriver::How;
  const bool up = driver.up;
  switch (driver.how) {
    case more:
      return up ? "more motion than expected" : "less motion than expected";
    case more_where_little:
      return up ? "motion where hardly any is expected" : "still less motion where hardly any is expected";
    case more_where_much:
      return up ? "still more motion where much is expected" : "less motion where much is expected";
    case opposite:
      return up ? "the opposite of what is expected"
                : "what is expected, with less chance in it: likely motion comes nearly always, unlikely motion nearly "
                  "never";
    case with_gaps:
      if (driver.when == ResidualDriver::When::from_trial_to_trial)
        return up ? "motion has more and more gaps" : "motion has fewer and fewer gaps";
      return up ? "motion has more gaps than before" : "motion has fewer gaps than before";
    case silent_together:
      return "silent at the same moments oftener than by chance";
    case beside:
      break;
  }
  return up ? "motion whenever " + driver.beside + " sees some" : "silence whenever " + driver.beside + " sees motion";
}

std::string sentence_of_rest(const Residuals& rest) {
  std::string text;
  for (const ResidualDriver& driver : rest.drivers) text += (text.empty() ? "" : "; ") + in_words(driver);
  return text.empty() ? "" : "Something else shows: " + text + ".";
}

std::string sentence(const Residuals& residuals) {
  std::string text;
  for (const ResidualDriver& driver : residuals.drivers) text += (text.empty() ? "" : "; ") + in_words(driver);
  return text.empty() ? "What is left follows no sensor, seat, time or neighbour that was tried."
                      : "What is left: " + text + ".";
}

}  // namespace pirsim::reconcile
