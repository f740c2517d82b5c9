// What a reconciliation of model and measurement found: typed, with its numbers. Words for it: pirsim/reconcile.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pirsim/effects.hpp"
#include "pirsim/interval.hpp"
#include "pirsim/script.hpp"

namespace pirsim::reconcile {

enum class Verdict {
  no_disagreement,    ///< the model without any effect isn't refused
  named,              ///< one effect explains the data, or one of several is far likelier than the others
  one_of,             ///< several can have made the data, which can't tell them apart
  several,            ///< effects applied one after the other made the data together
  nearest,            ///< one is far likelier than all others and does when applied, but the data are strange for it
  none_in_catalogue,  ///< nothing known makes such data, or only what is improbable or merely resembles it
  faulty_data         ///< sensors can't have said these rows: look at the file first
};
/// In the order of the enumeration.
inline constexpr std::array<std::string_view, 7> verdict_names{
    "no-disagreement", "named", "one-of", "several", "nearest", "none-in-catalogue", "faulty-data"};
[[nodiscard]] constexpr std::string_view name(Verdict verdict) noexcept {
  return verdict_names[static_cast<std::size_t>(verdict)];
}

/// How one hypothesis fits the data: `nothing` (the model as it is), or an effect of the catalogue by its name.
struct HypothesisScore {
  std::string hypothesis = {};
  double probability = 0.0;  ///< calibrated, among all hypotheses, each as likely as the others beforehand
  double p_relative = 0.0;   ///< share of the hypothesis's own datasets that another hypothesis explains as well
  double p_absolute = 0.0;   ///< share of the hypothesis's own datasets that lie as far from the rest of them
  double p = 0.0;            ///< of both: min(1, 2 min)
  double least_p = 0.0;      ///< no data give a smaller one: the hypothesis has too few datasets
  /// Share of the hypothesis's own datasets that look as much like impostors: data of another effect that are taken for
  /// this one where the other is unknown.
  double p_own = 1.0;
};

/// Effects of one family taken together.
struct FamilyScore {
  effects::Family family = effects::Family::data;
  double probability = 0.0;
  /// It is told to the reader, with its probability. Fitted: at 0.85 of the injected datasets 0.905 are told the right
  /// family and 0.005 a wrong one, at 0.75 0.922 and 0.007, at 0.6 0.935 and 0.010 (docs/validation.md).
  [[nodiscard]] bool is_sure() const noexcept { return probability >= 0.75; }
};

/// Why an effect was kept or dropped.
namespace reason {
struct NotRuledOut {  ///< kept
  double p = 0.0;
};
struct Sure {  ///< kept, though data of its own seldom look like these
  double p = 0.0, probability = 0.0;
};
struct MayBeNone {};  ///< kept, but not named: its strength may as well be none
struct LessLikely {   ///< not ruled out, but another is named
  double p = 0.0, probability = 0.0;
  std::string named;
  double probability_of_named = 0.0;
};
struct Improbable {  ///< dropped: all that isn't ruled out is improbable together
  double p = 0.0;
};
struct LikeImpostors {  ///< dropped: what only resembles it makes such data more often than it does itself
  double p_own = 0.0;
};
struct HardlySimulated {};  ///< dropped: people can hardly get about with it in this room
struct RuledOut {           ///< dropped by one test or both
  std::optional<double> p_relative, p_absolute;
  double least_p = 0.0;  ///< that either test can give
};
struct RefusedWhenApplied {  ///< dropped: with it applied the model still differs, and nothing explains the rest
  double p = 0.0, least_p = 0.0;
};
struct DoesBetter {  ///< kept: a relative of the effect that would have been named, applied to the model
  double p = 0.0;
  std::string named;
  double p_of_named = 0.0;
};
struct SameAs {  ///< judged as that effect, which changes the model in the same way
  std::string effect;
};
}  // namespace reason
using Reason = std::variant<reason::NotRuledOut, reason::Sure, reason::MayBeNone, reason::LessLikely,
                            reason::Improbable, reason::LikeImpostors, reason::HardlySimulated, reason::RuledOut,
                            reason::RefusedWhenApplied, reason::DoesBetter, reason::SameAs>;

/// What became of one effect of the catalogue.
struct Candidate {
  HypothesisScore score;
  effects::Family family = effects::Family::data;
  bool kept = false;
  Reason reason;                ///< by itself
  bool named_together = false;  ///< kept all the same, together with the others named
};

/// One trial x sensor.
struct LocatedCell {
  std::string trial, sensor;
  double measured_s = 0.0;           ///< seconds with motion a run
  double expected_s = 0.0;           ///< mean of the simulated datasets
  double low_s = 0.0, high_s = 0.0;  ///< 95 % of the simulated datasets lie between
  double adjusted_p = 1.0;           ///< of the global test: below alpha, the cell differs whatever the others do
};
/// What a number that data are turned into is of.
struct FeatureName {
  enum class Kind {
    cell,      ///< `statistic` of a trial and a sensor, as all that follow against the plain model
    sensor,    ///< mean over the trials
    trial,     ///< mean over the sensors
    mean,      ///< over all cells, or all trials
    size,      ///< the same of its size, whatever its sign
    greatest,  ///< of all cells
    least,
    slope,              ///< over all cells, on `other`: what is expected or known of a cell
    first_less_second,  ///< of the sensors in order of their means
    last_but_one_less_last,
    first_less_last,
    share_of_time,  ///< of a sensor's motion (empty: all sensors'), in `part` of `n_parts` parts of the time
    together,       ///< odds that `sensor` moves while `other`, a sensor, does
    most_together,  ///< of all pairs
    least_together,
    likeness,        ///< of all cells' seconds to those of the model
    likeness_gained  ///< by permuting trials or sensors
  };
  enum class Permutation {
    trials_shifted,  ///< by one
    trials_shifted_back,
    trials_reversed,
    two_trials_swapped,
    sensors_shifted,
    sensors_shifted_back,
    sensors_reversed,
    two_sensors_swapped
  };
  Kind kind = Kind::cell;
  std::string trial = {}, sensor = {}, statistic = {};
  std::string other = {};
  std::size_t part = 0, n_parts = 0;  ///< part: from 1 on
  Permutation permutation = Permutation::trials_shifted;
  bool operator==(const FeatureName&) const = default;
};
/// A number that the global test looks at, with its band, in the number's own scale.
struct EnvelopeFeature {
  FeatureName name;
  double observed = 0.0, median = 0.0, lower = 0.0, upper = 0.0;
  double adjusted_p = 1.0;
};
struct Location {
  double p = 1.0;  ///< of the whole comparison
  std::vector<LocatedCell> cells;
  std::vector<EnvelopeFeature> envelope;
  double band_s = 0.0;  ///< half the width of the mean cell's 95 % band: what this experiment can't see
  std::size_t n_simulated = 0;
  /// No data give a smaller p.
  [[nodiscard]] double least_p() const noexcept {
    return n_simulated == 0 ? 0.0 : 1.0 / (static_cast<double>(n_simulated) + 1.0);
  }
};

struct FittedParameter {
  std::string name, unit;
  double value = 0.0;
  Interval interval;  ///< 90 %, nuisance included
  double off = 0.0;
  bool is_strength = true;             ///< has an `off` at which nothing happens
  std::vector<double> equally_likely;  ///< quantiles in the middles of twenty equal parts, ascending
};
/// What of an effect is no matter of more or less: which variant, sensor or wall.
struct FittedChoice {
  std::string name;
  struct Word {
    std::string word;  ///< empty: what happens if a script doesn't say, as all sensors
    double probability = 0.0;
  };
  std::vector<Word> words;  ///< likeliest first
};
struct FittedEffect {
  EffectSpec effect;  ///< with the fitted parameters, as a script takes it
  std::vector<FittedParameter> parameters;
  bool includes_off = false;  ///< every strength's interval holds its `off`
  std::vector<FittedChoice> choices{};
};

/// A parameter that was fitted at an end of the range that was looked for. What lies beyond is tried if the effect as
/// fitted doesn't do.
struct RangeEnd {
  std::string effect, parameter, unit;
  Interval looked_for;               ///< the prior
  double end = 0.0;                  ///< of the two, the one reached
  double tried_to = 0.0;             ///< beyond it; `end` if nothing was tried
  std::optional<double> found = {};  ///< the value beyond the end with which the model passes
};

/// A look at the measured data with some effects applied to the model.
struct Look {
  std::vector<std::string> applied;
  double level = 0.05;                   ///< of the global test; halved with every effect
  double p = 1.0;                        ///< of the global test
  std::vector<std::string> one_of = {};  ///< effects, one of which may be missing beside these and can't be told
  double least_p = 0.0;                  ///< no data give a smaller p: so few datasets were simulated
  [[nodiscard]] bool passes() const noexcept { return p > level; }
};

/// How far a model lies from data, summed up over held-out trials.
struct Gap {
  double energy_score = 0.0;      ///< of what the global test looks at in one trial, mean over trials
  double area_s = 0.0;            ///< mean absolute difference of measured and simulated seconds, mean over cells
  std::size_t cells_outside = 0;  ///< of the model's 95 % band
  std::size_t n_cells = 0;
  double p = 1.0;        ///< of the global test on the held-out trials together
  double least_p = 0.0;  ///< no data give a smaller p
};
/// Whether the model with the effects predicts trials that it was not fitted on better than the model without.
struct Verification {
  std::size_t n_folds = 0;
  Gap before, after;
  double noise_floor = 0.0;        ///< energy score of the patched model's own datasets
  Interval gain;                   ///< 95 % (Student's) of the mean drop in energy score per trial, over trials
  double share_closed = 0.0;       ///< (before - after) / (before - noise floor)
  std::size_t n_trials = 0;        ///< held out and measured; 0: people can hardly get about in the patched model
  std::size_t n_better = 0;        ///< of them, predicted better by the patched model
  double sign_p = 1.0;             ///< that so many are better by chance
  double placebo = 0.0;            ///< energy score after the best effect of another family; as before without one
  std::string placebo_effect;      ///< its name, in the first fold that has one
  std::vector<std::string> names;  ///< what each fold found, effects joined by " + "
  std::vector<std::vector<EffectSpec>> patches;  ///< with the parameters that each fold's other trials gave
  bool shrunk = false;   ///< the interval excludes 0 and the placebo does less; of sums, sign_p <= 0.05 too
  bool refused = false;  ///< the plain model fails the global test on the held-out trials
  bool closed = false;   ///< shrunk, the plain model is refused there and the patched one is not
};

/// One thing that the bits do and the model doesn't: which sensors, when, and what they do.
struct ResidualDriver {
  enum class Who { all_sensors, sensor, trial, near_seat, far_from_seat, faced, behind };
  enum class When {
    always,
    first_half,
    second_half,
    first_third,
    middle_third,
    last_third,
    of_minute,            ///< from, to: seconds of each minute
    after_posture,        ///< from, to: seconds after each change of posture
    before_posture,       ///< to - from: seconds before each change of posture
    of_arm_cycle,         ///< from, to: shares of the arm's cycle in percent
    wave,                 ///< from: the period in seconds; to: the second of its top
    from_trial,           ///< `since` and all runs after it, in the order of the session: the script's, again and again
    from_trial_to_trial,  ///< more and more
  };
  enum class How {
    more,
    more_where_little,
    more_where_much,
    opposite,
    beside,
    with_gaps,       ///< motion has more gaps of some seconds than expected, whatever motion there is
    silent_together  ///< all sensors at the same moments, oftener than by chance
  };
  Who who = Who::all_sensors;
  std::string name;  ///< of the sensor or the trial
  When when = When::always;
  double from = 0.0, to = 0.0;
  How how = How::more;
  bool up = true;         ///< or the contrary: less motion, silence
  std::string beside;     ///< of How::beside: the other sensor
  double log_odds = 0.0;  ///< of a logistic regression of the bits on this driver and those before it
  double standard_error = 0.0;
  double z = 0.0;          ///< the score against that of simulated datasets, in their standard deviations
  double p = 1.0;          ///< that the strongest of all drivers tried is so strong in a dataset of the model
  std::string since = {};  ///< of When::from_trial: the trial, with the run's number if there are several
  double least_p = 0.0;    ///< no data give a smaller p
};
struct Residuals {
  std::vector<ResidualDriver> drivers;  ///< strongest first; none: the residuals follow nothing that was tried
};

/// What was done with which measured rows, or what is odd about them.
struct DataNote {
  enum class What {
    sums_empty,       ///< n sums
    cells_absent,     ///< n cells of trials that are there
    sensors_absent,   ///< names: no column
    phases_unknown,   ///< names: the counted phases, for which all rows are taken
    rows_missing,     ///< n
    readings_empty,   ///< n
    runs_unread,      ///< n runs without a reading in the counted phases (names)
    trials_absent,    ///< names
    lead_left_out,    ///< what comes before the counted phases, of n runs
    tail_left_out,    ///< what comes after them
    runs_begin_late,  ///< n runs begin in a counted phase
    runs_end_early,   ///< n runs end before any simulated one
    runs_go_on,       ///< n runs go on after any simulated one
    people_unused,    ///< a column `people`
    effects_idle,     ///< names: effects that mean nothing to any sensor of the study, and aren't looked for
    log_read,         ///< n lines; names: seconds between readings (empty: events), those of the script's windows
    hold_told,        ///< n pulses; names: the sensor, seconds
    people_differ,    ///< in n windows; names: of how many, the first one's time, the data's count, the script's
    days_absent       ///< n rows outside of the script's runs
  };
  What what = What::rows_missing;
  std::size_t n = 0;
  std::vector<std::string> names = {};
};

/// What is wrong or odd with the measured rows themselves. It is found by what chance, and the model's own runs, can
/// do.
struct DataFinding {
  enum class What {
    equal_columns,     ///< sensors: two, whose columns are equal, or nearly
    opposite_columns,  ///< sensors: two, of which one is 1 where the other is 0
    constant_column,   ///< sensors: one, 1 in all rows
    beats,             ///< sensors: one, 1 every `every_s`, whatever happens
    polled,            ///< no sensor changes but every `every_s`
    repeated_rows,     ///< places: two, with the same rows
    all_silent,        ///< places: one, in which all sensors are silent
    silent_column      ///< sensors: one, without any 1
  };
  /// Rows from 1 on, gaps counted, both ends included.
  struct Place {
    std::string trial = {};
    int replicate = 1;
    std::size_t from_row = 0, to_row = 0;
    bool operator==(const Place&) const = default;
  };
  What what = What::equal_columns;
  std::vector<std::string> sensors = {};
  std::vector<Place> places = {};
  std::size_t n_rows = 0;        ///< of the file, or of each place
  std::size_t n_exceptions = 0;  ///< of columns: rows in which only one of them changes
  double every_s = 0.0;
  double chance = 0.0;        ///< that it comes about so: as of independent rows, so only small ones count
  bool is_impossible = true;  ///< sensors can't have said this; else it is odd
};
inline constexpr std::array<std::string_view, 8> data_finding_names{
    "equal_columns", "opposite_columns", "constant_column", "beats",
    "polled",        "repeated_rows",    "all_silent",      "silent_column"};
[[nodiscard]] constexpr std::string_view name(DataFinding::What what) noexcept {
  return data_finding_names[static_cast<std::size_t>(what)];
}

/// The decisions of an analysis, in order.
namespace trail {
struct Begun {
  std::string digest;  ///< of the data
  std::uint64_t seed = 0;
};
struct HeldOut {
  std::vector<std::string> trials;
};
struct Table {
  std::string key;
  std::size_t n_datasets = 0, n_left_out = 0;
};
struct Tested {
  double p = 1.0;        ///< of the global test
  double least_p = 0.0;  ///< no data give a smaller one
};
struct NotRuledOut {
  std::vector<std::string> hypotheses;  ///< `nothing` among them, first
};
struct IncludesOff {
  std::string effect;
};
struct AtRangeEnd {
  RangeEnd end;
};
struct LookedForMore {
  Verdict verdict = Verdict::no_disagreement;
};
struct Explained {
  Residuals residuals;
  FamilyScore family;
};
struct LeftOver {
  Residuals residuals;
};
struct JudgedOnHeldOut {
  Verification verification;
};
enum class Remark {
  relative_does_better,    ///< the name is taken back: applied in its place, a relative makes such data oftener
  may_be_none,             ///< the name is taken back
  refused_when_applied,    ///< the name is taken back: the model with it can't have made the data
  no_partner,              ///< no effect may explain the rest beside the one applied: nothing more is simulated
  nothing_more_simulated,  ///< people can hardly get about in that model: nothing more is looked for in it
  sums_without_residuals,  ///< sums don't tell when motion was seen
  one_trial_only,          ///< nothing can be held out
  patched_impassable,      ///< people can hardly get about in the patched model
  held_out_too_weak        ///< the held-out trials alone don't refuse the plain model
};
}  // namespace trail
using TrailEvent = std::variant<trail::Begun, DataNote, DataFinding, trail::HeldOut, trail::Table, trail::Tested,
                                trail::NotRuledOut, trail::IncludesOff, trail::AtRangeEnd, Look, trail::LookedForMore,
                                trail::Explained, trail::LeftOver, trail::JudgedOnHeldOut, trail::Remark>;

struct Outcome {
  Verdict verdict = Verdict::no_disagreement;
  /// What the comparison says with the rows as they are: the verdict, unless that is faulty_data.
  Verdict verdict_of_rows = Verdict::no_disagreement;
  double alpha = 0.05;                     ///< level of the tests
  std::vector<DataFinding> data_findings;  ///< strongest kind first
  Location location;
  /// Most probable first; without `nothing` and effects that are the same change. None without a disagreement.
  std::vector<Candidate> candidates;
  HypothesisScore nothing;            ///< how well the plain model fits
  FamilyScore family;                 ///< whose effects are likeliest together
  std::vector<std::string> named;     ///< effects applied to the model, or those that can't be told apart; of `one_of`
                                      ///< the plain model is one more if nothing.p exceeds the level
  std::vector<FittedEffect> fits;     ///< of the effects that were applied
  std::vector<Look> looks;            ///< with the effects applied, one after the other
  std::vector<Look> relatives;        ///< of the effect that was to be named, each applied in its place
  std::optional<RangeEnd> range_end;  ///< of the first effect applied
  std::optional<Verification> verification;
  std::optional<Residuals> residuals;  ///< if nothing fits and the data are series
  /// What changes in the course of the session, or strikes all sensors at once, and isn't explained by the effects
  /// applied: if there is a disagreement and the data are series.
  std::optional<Residuals> left_over;
  std::vector<FeatureName> telling_features;
  double calibration_error = 0.0;
  std::string table_key;
  std::vector<std::string> looked_for;  ///< effects, if not the whole catalogue
  std::vector<DataNote> notes;          ///< beside the data's own
  std::vector<TrailEvent> trail;
};

}  // namespace pirsim::reconcile
