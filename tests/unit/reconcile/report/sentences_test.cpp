#include "reconcile/report/sentences.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/feature_map.hpp"
#include "reconcile/report/pages.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

/// A disagreement in which these effects aren't ruled out, with these probabilities, the named or likeliest first.
Outcome outcome_of(Verdict verdict, const std::vector<std::pair<std::string, double>>& kept) {
  Outcome outcome;
  outcome.verdict = verdict;
  for (const auto& [effect, probability] : kept) {
    outcome.candidates.push_back({{effect, probability, 0.3, 0.4, 0.6}, effects::Family::person, true, {}});
    if (verdict != Verdict::named || outcome.named.empty()) outcome.named.push_back(effect);
  }
  if (verdict == Verdict::named) outcome.fits.push_back({{kept.front().first, {}, {}, {}}, {}, false});
  return outcome;
}

std::string sentence_of(Verdict verdict, const std::vector<std::pair<std::string, double>>& kept) {
  return sentence(outcome_of(verdict, kept));
}

}  // namespace

TEST_CASE("a name says whether it has rivals and how probable it is", "[reconcile]") {
  CHECK_THAT(sentence_of(Verdict::named, {{"seat_shift", 0.6}}), contains("No other effect of the catalogue explains"));
  const std::string rivals =
      sentence_of(Verdict::named, {{"seat_shift", 0.9}, {"body_size", 0.06}, {"dead_time", 0.01}});
  CHECK_THAT(rivals, contains("The measurement shows seat_shift, which the simulation doesn't include."));
  CHECK_THAT(rivals, contains("body_size and dead_time can't be ruled out, but seat_shift is the likeliest cause "
                              "(probability 0.9)."));
  CHECK_THAT(rivals, !contains("No other effect"));
}

TEST_CASE("where no cell stands out but all together do, both are said at once", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::named, {{"seat_shift", 0.9}});
  outcome.location.p = 0.0132;
  outcome.location.cells.resize(3);
  for (auto& cell : outcome.location.cells) cell.adjusted_p = 0.2;
  CHECK_THAT(
      sentence(outcome),
      contains("None of the 3 cells (one trial at one sensor) differs by more than chance, but everything together "
               "does (p = 0.0132)."));
  outcome.location.cells.front().adjusted_p = 0.01;
  CHECK_THAT(sentence(outcome), contains("None of the 3 cells"));  // off by less than it scatters
  outcome.location.cells.front().scatters = -5.0;
  CHECK_THAT(
      sentence(outcome),
      contains(
          "1 of 3 cells (one trial at one sensor) differs by more than chance (everything together: p = 0.0132)."));
}

TEST_CASE("the reason of a rival compares it with the one that is named", "[reconcile]") {
  const Reason reason = less_likely({.probability = 0.06, .p = 0.6}, {.hypothesis = "seat_shift", .probability = 0.9});
  CHECK_THAT(reason.why, contains("much less likely than seat_shift (0.06 against 0.9)"));
}

TEST_CASE("of a model with effects applied it is said whether it passes, and what may be missing beside them",
          "[reconcile]") {
  CHECK(in_words(Look{{"clock_lag"}, 0.025, 0.4, {}}) ==
        "With clock_lag applied, the model can have made these data (p = 0.4).");
  CHECK(
      in_words(Look{{"clock_lag", "dead_time"}, 0.0125, 0.01, {"seat_shift", "body_size"}}) ==
      "With clock_lag and dead_time applied, the model still differs from the data (p = 0.01). What is missing beside "
      "it may be seat_shift or body_size: these data can't tell.");
  CHECK_THAT(in_words(Look{{"clock_lag"}, 0.025, 0.01, {"seat_shift"}}), contains("may be seat_shift."));
}

TEST_CASE("a name that doesn't do when it is applied is taken back with that reason", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::none_in_catalogue, {{"trigger_bursts", 0.99}});
  outcome.looks.push_back({{"trigger_bursts"}, 0.025, 0.005, {}});
  outcome.candidates.front().kept = false;
  outcome.candidates.front().reason.what = Reason::What::refused_when_applied;
  const std::string told = sentence(outcome);
  CHECK_THAT(told, contains("The measurement shows something that isn't in the catalogue."));
  CHECK_THAT(told, contains("It looks most like trigger_bursts, but a simulation with that still differs from the data "
                            "(p = 0.005)."));
}

TEST_CASE("a likeness that got no name is told with its p", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::none_in_catalogue, {{"seat_scatter", 0.9}});
  outcome.candidates.front().kept = false;
  outcome.candidates.front().score.p_own = 0.02;
  outcome.candidates.front().reason = like_impostors(outcome.candidates.front().score);
  CHECK_THAT(sentence(outcome), contains("It looks most like seat_scatter, but seat_scatter itself seldom makes "
                                         "such data (p = 0.02): more probably another cause imitates it."));
  CHECK_THAT(in_words(outcome.candidates.front()), contains("Dropped: other things that are taken for it"));
}

TEST_CASE("of an effect that does when it is applied and was dropped all the same both is said", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::none_in_catalogue, {{"labels_swapped", 0.99}});
  outcome.candidates.front().reason = reason_of({.p_relative = 0.5, .p_absolute = 0.01, .p = 0.02}, false, 0.05);
  outcome.looks.push_back({{"labels_swapped"}, 0.025, 0.524, {}});
  CHECK(details(outcome) ==
        std::vector<std::string>{"The closest known cause is labels_swapped: with it applied, the test of everything "
                                 "together sees no difference (p = 0.524). It was dropped all the same: simulations "
                                 "with it hardly ever look like these data (p = 0.01)."});
}

TEST_CASE("what a name leaves over is told beside it, and nothing if there is nothing", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::named, {{"missed_triggers", 0.99}});
  outcome.left_over.emplace();
  const std::vector<std::string> without = details(outcome);
  outcome.left_over->drivers = {
      {.who = "PIR2", .when = "from about trial S6 on", .what = "motion has more gaps", .p = 0.01},
      {.who = "all sensors", .what = "silent at the same moments", .p = 0.03}};
  std::vector<std::string> with = details(outcome);
  REQUIRE(with.size() == without.size() + 1);
  CHECK(
      with.back() ==
      "Something else shows: PIR2, from about trial S6 on: motion has more gaps (p = 0.01); all sensors: silent at the "
      "same moments (p = 0.03).");
}

TEST_CASE("where no name is given the sentence says why", "[reconcile]") {
  CHECK_THAT(sentence_of(Verdict::one_of, {{"seat_shift", 0.5}, {"body_size", 0.4}}),
             contains("The measurement shows one of these, and the data can't tell which: seat_shift, body_size or "
                      "something that isn't in the catalogue."));
  CHECK_THAT(sentence_of(Verdict::one_of, {{"seat_shift", 0.9}}),
             contains("It may be seat_shift, but the data don't tell whether that effect is there at all."));
  Outcome weak = outcome_of(Verdict::one_of, {{"seat_shift", 0.9}, {"body_size", 0.05}});
  weak.nothing.p = 0.2;
  CHECK_THAT(sentence(weak), contains("what measurement and simulation differ by may be chance"));
}

TEST_CASE("improbable effects that might have made the data are told with their probability", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::none_in_catalogue, {{"seat_shift", 0.1}, {"body_size", 0.03}});
  CHECK_THAT(
      sentence(outcome),
      contains("Of the catalogue's effects only seat_shift and body_size aren't ruled out, but their probability "
               "together is only 0.13"));
  outcome.candidates.push_back({{"dead_time", 0.6, 0.0, 0.0, 0.01}, effects::Family::electronics, false, {}});
  CHECK_THAT(sentence(outcome),
             contains("The likelier ones of the catalogue's effects are ruled out. seat_shift and body_size"));
  const Reason improbable = reason_of({.p = 0.6}, false, 0.05);
  CHECK(improbable.decision == "Dropped");
  CHECK_THAT(improbable.why, contains("by itself it might have made these data (p = 0.6)"));
  for (Candidate& candidate : outcome.candidates) candidate.score.p = 0.01;
  CHECK_THAT(sentence(outcome), contains("No effect of the catalogue is likely"));
}

TEST_CASE("where no name is given the family is said if it is clear", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::one_of, {{"seat_shift", 0.5}, {"body_size", 0.4}, {"dead_time", 0.05}});
  outcome.family = likeliest_family(
      std::vector<HypothesisScore>{{"nothing", 0.05}, {"dead_time", 0.05}, {"seat_shift", 0.5}, {"body_size", 0.4}});
  CHECK(outcome.family.family == effects::Family::person);
  CHECK(outcome.family.probability == Approx(0.9));
  CHECK_THAT(sentence(outcome), contains("The cause belongs to the family person with probability 0.9."));
  outcome.family.probability = 0.7;
  CHECK_THAT(sentence(outcome), !contains("family"));
}

TEST_CASE("what to do next names a plan only for effects that are to be told apart", "[reconcile]") {
  CHECK_THAT(next_step(outcome_of(Verdict::one_of, {{"seat_shift", 0.5}, {"body_size", 0.4}})),
             contains("--effects seat_shift,body_size"));
  CHECK_THAT(next_step(outcome_of(Verdict::one_of, {{"seat_shift", 0.13}})), !contains("--effects"));
}

TEST_CASE("where no effect is named, the ranges looked for and the way beyond them are told", "[reconcile]") {
  const std::string step =
      next_step(outcome_of(Verdict::none_in_catalogue, {{"dead_time", 0.02}, {"pulse_stretching", 0.1}}));
  const auto& hold = effects::info("pulse_stretching").parameters.front();
  std::ostringstream range;
  range << "pulse_stretching (hold from " << hold.low << " to " << hold.high << " s) and dead_time (dead time from ";
  CHECK_THAT(step, contains(range.str()) && contains("under effects: of the script"));
}

TEST_CASE("of a rest that the model still differs by, and of a catalogue cut down, is told", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::named, {{"seat_shift", 0.9}});
  outcome.looks.push_back({{"seat_shift"}, 0.025, 0.01, {}});
  outcome.looked_for = {"seat_shift", "body_size"};
  REQUIRE(details(outcome).size() == 2);
  CHECK(details(outcome)[0] == "The catalogue was cut down to seat_shift and body_size.");
  CHECK_THAT(details(outcome)[1], contains("That is not all. With seat_shift applied, the model still differs"));
  outcome.looks.back().p = 0.5;
  CHECK(details(outcome).size() == 1);
}

TEST_CASE("of a catalogue cut down nothing is said about the effects that weren't looked for", "[reconcile]") {
  const auto cut_down = [](Outcome outcome) {
    outcome.looked_for = {"seat_shift", "body_size"};
    return outcome;
  };
  CHECK_THAT(sentence(cut_down(outcome_of(Verdict::named, {{"seat_shift", 0.6}}))),
             contains("No other effect of those looked for explains the data"));
  Outcome none = cut_down(outcome_of(Verdict::none_in_catalogue, {{"seat_shift", 0.1}}));
  CHECK_THAT(
      sentence(none),
      contains("something that isn't among the effects looked for. ") &&
          contains("Of the effects looked for only seat_shift isn't ruled out, but its probability is only 0.1"));
  none.candidates.front().score.p = 0.01;
  CHECK_THAT(sentence(none), contains("No effect of those looked for is likely"));
  none.candidates.front().reason.what = Reason::What::refused_when_applied;
  none.looks.push_back({{"seat_shift"}, 0.025, 0.005, {}});
  CHECK(details(none).back() == "None of the others that were tried beside it explains what is left.");
  const std::string page = to_html(report_page(none));
  CHECK_THAT(page, contains("Every effect looked for was simulated") && !contains("ffect of the catalogue"));
}

TEST_CASE("a fitted effect names its twin and others name none", "[reconcile]") {
  CHECK_THAT(in_words(FittedEffect{{"range_scale", {}, {}, {}}, {}, false}),
             contains("or thermal_contrast, the same in the model"));
  CHECK(in_words(FittedEffect{{"seat_shift", {}, {}, {}}, {}, false}) == "seat_shift");
}

TEST_CASE("a set of effects leaves a door open and shows its first three", "[reconcile]") {
  Outcome outcome = outcome_of(
      Verdict::one_of,
      {{"seat_scatter", 0.3}, {"warm_chair", 0.2}, {"missing_occluder", 0.1}, {"dead_time", 0.1}, {"body_size", 0.1}});
  CHECK_THAT(sentence(outcome),
             contains("the data can't tell which: seat_scatter, warm_chair, missing_occluder, 2 other effects or "
                      "something that isn't in the catalogue."));
  outcome.verification.emplace().share_closed = 0.15;
  CHECK_THAT(sentence(outcome), contains("quite possibly something that isn't in the catalogue."));
  outcome.verification->share_closed = 0.16;
  CHECK_THAT(sentence(outcome), !contains("quite possibly"));
}

TEST_CASE("what comes nearest is told with its doubt, and applied", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::nearest, {{"pulse_stretching", 0.98}});
  outcome.fits.push_back({{"pulse_stretching", {}, {}, {}}, {{"hold_s", "s", 2.0, {1.5, 2.5}, 0.0, true, {}}}, false});
  CHECK_THAT(sentence(outcome),
             contains("The closest known cause is pulse_stretching: hold 2 s (90 % interval 1.5 to 2.5). It fits only "
                      "roughly: simulations with it rarely look quite like your data. So the true cause may not be in "
                      "the catalogue. "));
  CHECK_THAT(sentence(outcome), !contains("0.98"));
  CHECK_THAT(next_step(outcome), contains("look for pulse_stretching in the real room"));
}

TEST_CASE("a fault of the data is told as one, by a name and as the nearest", "[reconcile]") {
  const FittedEffect swapped{{"labels_swapped", {}, {{"sensor", "PIR_1"}, {"other", "PIR2"}}, {}}, {}, false};
  Outcome outcome = outcome_of(Verdict::named, {{"labels_swapped", 0.98}});
  outcome.fits = {swapped};
  const std::string told = "as if two sensors' labels were swapped (labels_swapped: other PIR2, sensor PIR_1).";
  CHECK_THAT(sentence(outcome), contains("The data look " + told) && !contains("simulation doesn't include"));
  CHECK_THAT(next_step(outcome), contains("mend the data and analyse them again"));
  outcome.verdict = Verdict::nearest;
  CHECK_THAT(sentence(outcome), contains("The closest known cause is a fault of the data: they look " + told));
  CHECK_THAT(next_step(outcome), contains("look for labels_swapped in the data"));
}

TEST_CASE("a strength is told in the reader's words, and no probability beside it is the analysis's own",
          "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::named, {{"missed_triggers", 0.99}});
  outcome.fits = {{{"missed_triggers", {}, {{"trend", "growing"}}, {}},
                   {{"probability", "", 0.517, {0.45, 0.58}, 0.0, true, {}}},
                   false,
                   {{"trend", {{"growing", 0.7}, {"steady", 0.3}}}}}};
  CHECK_THAT(sentence(outcome),
             contains("The measurement shows missed_triggers, which the simulation doesn't include: probability of a "
                      "miss 0.517 (90 % interval 0.45 to 0.58), trend growing (or steady, probability 0.30). "));
  const FittedEffect two{
      {"false_triggers", {}, {}, {}}, {{"rate_per_s", "1/s", 0.01, {0.005, 0.02}, 0.0, true, {}}}, true};
  CHECK(in_words(two) ==
        "false_triggers: rate 0.01 per s (90 % interval 0.005 to 0.02), so uncertain that the interval "
        "includes no effect");
}

TEST_CASE("a name that improves nothing on held-out trials is to be looked for first", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::named, {{"pulse_stretching", 0.98}});
  CHECK_THAT(next_step(outcome), contains("If it is there, simulate with script_patched.yaml"));
  outcome.verification.emplace();
  CHECK_THAT(next_step(outcome), contains("look for pulse_stretching in the real room before anything is changed"));
  outcome.verification->shrunk = true;
  CHECK_THAT(next_step(outcome), contains("If it is there, simulate with script_patched.yaml"));
}

TEST_CASE("of several causes those of the data are mended in the data", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::several, {{"missed_triggers", 0.9}, {"labels_swapped", 0.8}});
  CHECK_THAT(next_step(outcome),
             contains("see whether the data have labels_swapped; if so, mend them and analyse again. "
                      "Then see whether missed_triggers is still found."));
  CHECK_THAT(next_step(outcome_of(Verdict::several, {{"missed_triggers", 0.9}, {"dead_time", 0.8}})),
             contains("look for missed_triggers and dead_time in the real room"));
}

TEST_CASE("what may be none of a set is looked for in data and model first", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::one_of, {{"seat_shift", 0.5}, {"body_size", 0.4}});
  CHECK_THAT(next_step(outcome), contains("What to do next: measure more before one of them is applied."));
  outcome.verification.emplace().share_closed = 0.1;
  CHECK_THAT(next_step(outcome), contains("look at the data first, then at the model of the room"));
}

TEST_CASE("as long as people may be miscounted the counts come first", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::one_of, {{"people_miscounted", 0.5}, {"missed_triggers", 0.2}});
  CHECK_THAT(sentence(outcome), Catch::Matchers::StartsWith("Check the people counts first: "));
  outcome.nothing.p = 0.3;
  CHECK_THAT(sentence(outcome), Catch::Matchers::StartsWith("Check the people counts first: "));
  outcome = outcome_of(Verdict::one_of, {{"missed_triggers", 0.9}, {"people_miscounted", 0.05}});
  CHECK_THAT(sentence(outcome), Catch::Matchers::StartsWith("The measurement shows one of these"));
  CHECK_THAT(next_step(outcome), contains("check the people counts, mend them, and analyse again. If they are right, "
                                          "measure more before anything is applied; pirsim reconcile plan finds"));
  outcome.candidates.back().score.p = 0.01;
  CHECK_THAT(sentence(outcome), !contains("counts"));
  CHECK_THAT(next_step(outcome), !contains("counts"));
}

TEST_CASE("a p that can't be smaller is told as a bound", "[reconcile]") {
  CHECK(p_in_words(0.02, 0.0099) == "p = 0.02");
  CHECK(p_in_words(1.0 / 101.0, 1.0 / 101.0) == "p <= 0.0099");
  Outcome outcome = outcome_of(Verdict::named, {{"seat_shift", 0.9}});
  outcome.location.n_simulated = 100;
  outcome.location.p = 1.0 / 101.0;
  CHECK_THAT(sentence(outcome), contains("(p <= 0.0099)"));
  CHECK_THAT(in_words(Look{{"clock_lag"}, 0.025, 0.005, {}, 0.005}),
             contains("still differs from the data (p <= 0.005)."));
}

TEST_CASE("where nothing differs it is said how little would have been seen", "[reconcile]") {
  Outcome outcome;
  outcome.location.p = 0.4;
  outcome.location.band_s = 12.0;
  CHECK(
      sentence(outcome) ==
      "No difference detected: the measurement looks like the simulation's own runs (p = 0.4). A difference below 12 s "
      "in a cell (one trial at one sensor) would hardly have been seen.");
}

TEST_CASE("held-out trials agree with what was applied, come closer, or show no improvement", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::named, {{"seat_shift", 0.9}});
  Verification& v = outcome.verification.emplace();
  CHECK(seen_on_held_out(outcome) == "On trials not used for fitting, no improvement could be demonstrated.");
  v.shrunk = true;
  CHECK_THAT(seen_on_held_out(outcome), contains("the simulation with seat_shift comes closer to the data."));
  v.closed = true;
  CHECK_THAT(seen_on_held_out(outcome), contains("the simulation with seat_shift agrees with the data."));
  outcome.fits.clear();  // of a set, the likeliest of each fold
  v.names = {"body_size", "seat_shift", "body_size"};
  CHECK_THAT(seen_on_held_out(outcome), contains("the simulation with body_size or seat_shift agrees"));
}

TEST_CASE("no family is told of what explains hardly anything of the held-out trials", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::one_of, {{"seat_shift", 0.5}, {"body_size", 0.4}});
  outcome.family = {effects::Family::person, 0.9};
  Verification& v = outcome.verification.emplace();
  v.names = {"seat_shift", "seat_shift", "body_size"};
  v.share_closed = 0.3;
  CHECK_THAT(sentence(outcome), contains("family person"));
  v.share_closed = 0.15;
  CHECK_THAT(sentence(outcome), !contains("family"));
}

TEST_CASE("an angle that may be any is told as not determined", "[reconcile]") {
  FittedEffect fan{{"warm_object", {}, {}, {}}, {{"heading_deg", "deg", 20.0, {-100.0, 102.0}, 0.0, false, {}}}, false};
  CHECK_THAT(in_words(fan), contains("heading not determined") && !contains("102"));
  fan.parameters.front().interval = {-60.0, 80.0};
  CHECK_THAT(in_words(fan), contains("heading 20 deg (90 % interval -60 to 80)"));
}

TEST_CASE("a sensor that is off takes its trials along, and a name what is lost together", "[reconcile]") {
  const auto told = [](Verdict verdict, const std::vector<std::string>& beyond) {
    Outcome outcome = outcome_of(verdict, {{"missed_triggers", 0.99}});
    const auto add = [&](std::string_view statistic, const std::string& place) {
      const bool is_off = std::ranges::find(beyond, place) != beyond.end();
      outcome.location.envelope.push_back(
          {{place, std::string(statistic), place}, is_off ? 2.0 : 0.0, 0.0, -1.0, 1.0, is_off ? 0.01 : 1.0});
    };
    for (const char* place : {"A", "B", "C"}) add(of_whole_sensor, place);
    for (const char* place : {"S1", "S2", "S3"}) add(of_whole_trial, place);
    add(name(TrialStatistic::joint_loss), "all");
    const std::vector<std::string> texts = details(outcome);
    return texts.empty() ? std::string() : texts.front();
  };
  CHECK(told(Verdict::one_of, {"S1", "all"}) == "S1 differs as a whole; sensors are lost together.");
  CHECK(told(Verdict::one_of, {"B", "S1"}) == "B differs as a whole.");
  CHECK(told(Verdict::one_of, {"A", "B", "S1"}) == "S1 differs as a whole.");  // most sensors: no matter of one
  CHECK(told(Verdict::named, {"B", "all"}) == "B differs as a whole.");
}

TEST_CASE("the strongest deviation is told with its part of the trial, if it is more than scatter", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::none_in_catalogue, {});
  outcome.location.cells.resize(3);
  outcome.location.strongest = Deviation{"", Deviation::Part::before, 6.0, 30.0, -9.0};
  CHECK_THAT(sentence(outcome), contains("Strongest before the main part: all sensors 80 % less (6.0 s with motion a "
                                         "trial, 30.0 s expected)."));
  outcome.location.strongest.scatters = -2.0;
  CHECK_THAT(sentence(outcome), !contains("Strongest"));
}

TEST_CASE("beside a cell outside its own range what to do next is never nothing", "[reconcile]") {
  Outcome outcome;
  outcome.location.cells = {{"S1", "PIR3", 119.0, 9.0, 2.0, 20.0, 0.2, 6.0}, {"S2", "PIR3", 8.0, 9.0, 2.0, 20.0}};
  CHECK_THAT(next_step(outcome), contains("see whether PIR3 hangs as drawn and S1 went as written (119 s with motion, "
                                          "usually 2 to 20 s). 1 of 2 cells"));
  outcome.location.cells.erase(outcome.location.cells.begin());
  CHECK_THAT(next_step(outcome), contains("nothing"));
}

TEST_CASE("a strength at the end of what was looked for is told, and what lies beyond", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::named, {{"pulse_stretching", 0.98}});
  outcome.range_end = RangeEnd{"pulse_stretching", "hold_s", "s", {0.2, 4.0}, 4.0, 4.0};
  CHECK_THAT(details(outcome).back(),
             contains("looked for with hold from 0.2 to 4 s, and the data want the end") && contains("under effects:"));
  outcome.range_end->tried_to = 80.0;
  CHECK_THAT(details(outcome).back(), contains("Up to 80 s was tried beyond it; no such model passes."));
  outcome.range_end->found = 60.0;
  CHECK_THAT(details(outcome).back(), contains("Beyond that, up to 80 s, the model with 60 s passes."));
}

TEST_CASE("what to do where nothing fits is the data, then the model, then a new cause", "[reconcile]") {
  const std::string step = next_step(outcome_of(Verdict::none_in_catalogue, {{"dead_time", 0.02}}));
  const auto data = step.find("first look at the data"), model = step.find("Second, the model"),
             cause = step.find("add_an_effect");
  CHECK(data < model);
  CHECK(model < cause);
  CHECK(cause != std::string::npos);
}

TEST_CASE("a faulty file is told first, and then what the comparison says of its rows", "[reconcile]") {
  Outcome outcome = outcome_of(Verdict::named, {{"seat_shift", 0.9}});
  outcome.verdict_of_rows = outcome.verdict;
  const std::string of_rows = sentence(outcome);
  outcome.verdict = Verdict::faulty_data;
  outcome.data_findings = {
      {.what = DataFinding::What::equal_columns, .sensors = {"PIR3", "PIR4"}, .n_rows = 1800, .chance = 1e-40},
      {.what = DataFinding::What::repeated_rows,
       .places = {{"S3", 1, 31, 90}, {"S4", 2, 12, 71}},
       .n_rows = 60,
       .chance = 1e-12},
      {.what = DataFinding::What::silent_column, .sensors = {"PIR1"}, .n_rows = 1800, .is_impossible = false}};
  CHECK(sentence(outcome) ==
        "Look at the file first: PIR3 and PIR4 are equal in all 1,800 rows; rows 31 to 90 of S3 (run 1) stand again as "
        "rows 12 to 71 of S4 (run 2), which sensors can't have said.");
  CHECK(details(outcome).front() == "With the rows taken as they are: " + of_rows);
  CHECK_THAT(next_step(outcome), contains("which input each of the two columns was read from"));
  const io::Report page = report_page(outcome, {});
  CHECK(page.sections.front().heading == "A look at the file");
  CHECK(page.sections.front().tables.front().rows.size() == 3);
  CHECK(page.finding == sentence(outcome));
  outcome.fits = {{{"seat_shift", {}, {}, {}}, {}, false}};
  CHECK(patched(ScriptSpec{}, outcome).effects.empty());
}
