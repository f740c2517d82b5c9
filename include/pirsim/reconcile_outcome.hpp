// What a reconciliation of model and measurement found: typed, with its numbers. Words for it: pirsim/reconcile.hpp.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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

/// Why an effect was kept or dropped, in words.
struct Reason {
  /// Where the verdict's sentence says more of it.
  enum class What {
    other,
    hardly_simulated,     ///< people can hardly get about with it in this room
    like_impostors,       ///< what only resembles it makes such data more often than it does itself
    refused_when_applied  ///< with it applied the model still differs, and nothing explains the rest
  };
  std::string decision = {};  ///< "Kept", "Dropped"; empty: `why` says it too
  std::string why = {};
  What what = What::other;
};

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
  double scatters = 0.0;             ///< by which it is off; a scatter is at least a fifth of the usual cell's

  /// By enough to look there: where no simulated dataset varies, a second is beyond all of them (assumed: 3).
  [[nodiscard]] bool differs(double alpha) const noexcept { return adjusted_p <= alpha && std::abs(scatters) >= 3.0; }
  [[nodiscard]] bool is_outside() const noexcept { return measured_s < low_s || measured_s > high_s; }
};
/// Seconds with motion in a part of a trial, mean over the trials and sums over the sensors of `who`.
struct Deviation {
  enum class Part { before, main, after };
  std::string who = {};  ///< a sensor or a trial; empty: all sensors
  Part part = Part::main;
  double measured_s = 0.0, expected_s = 0.0;
  double scatters = 0.0;  ///< by which it is off; a scatter is at least a row in each cell
};
/// What a number that data are turned into is of.
struct FeatureName {
  std::string text;            ///< "S1 PIR1 seconds"
  std::string statistic = {};  ///< of them what is measured, whoever's it is
  std::string place = {};      ///< and whose it is; empty: as the text says
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
  Deviation strongest;  ///< of all parts of trials
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
  /// Enough to tell a family, several effects or a set without doubt. Chosen on eight datasets; docs/validation.md has
  /// what others close.
  [[nodiscard]] bool explains() const noexcept { return share_closed > 0.15; }
  bool shrunk = false;   ///< the interval excludes 0 and the placebo does less; of sums, sign_p <= 0.05 too
  bool refused = false;  ///< the plain model fails the global test on the held-out trials
  bool closed = false;   ///< shrunk, the plain model is refused there and the patched one is not
};

/// One thing that the bits do and the model doesn't.
struct ResidualDriver {
  std::string who = {}, when = {}, what = {};  ///< sensors or trial, times (or empty), what they do: in words
  double log_odds = 0.0;  ///< of a logistic regression of the bits on this driver and those before it
  double standard_error = 0.0;
  double z = 0.0;        ///< the score against that of simulated datasets, in their standard deviations
  double p = 1.0;        ///< that the strongest of all drivers tried is so strong in a dataset of the model
  double least_p = 0.0;  ///< no data give a smaller p
};
struct Residuals {
  std::vector<ResidualDriver> drivers;  ///< strongest first; none: the residuals follow nothing that was tried
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
  /// Of one run, from 1 on, gaps counted, both ends included.
  struct Rows {
    std::string trial = {};
    int replicate = 1;
    std::size_t from_row = 0, to_row = 0;
    bool operator==(const Rows&) const = default;
  };
  What what = What::equal_columns;
  std::vector<std::string> sensors = {};
  std::vector<Rows> places = {};
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
  std::vector<std::string> notes;       ///< of the data, beside their own
  std::vector<std::string> trail;       ///< the decisions, in order, a line each
};

}  // namespace pirsim::reconcile
