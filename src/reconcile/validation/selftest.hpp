// Does the workflow find what was hidden? Effects are injected into simulated data that no table has seen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "effects/catalogue.hpp"
#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/reference_study.hpp"
#include "reconcile/inference/verify.hpp"
#include "stats/intervals.hpp"
#include "stats/pooled_classifier.hpp"

namespace pirsim::reconcile {

enum class LeaveOut {
  none,
  effects,  ///< judge the datasets with one effect a second time, by a catalogue that lacks it
  variants  ///< the same, and those with one variant of an effect by a catalogue that lacks the variant
};

struct SelftestSettings {
  Settings analysis;
  Measured::Kind kind = Measured::Kind::series;
  int n_replicates = 1;                  ///< runs of every trial in an injected dataset
  std::uint32_t n_nulls = 60;            ///< datasets with nothing hidden
  std::uint32_t n_injected = 10;         ///< datasets of every effect and strength
  std::uint32_t n_beyond = 0;            ///< of every effect, stronger than its prior, in rooms wider than theirs
  std::uint32_t n_pairs = 0;             ///< datasets with two effects
  std::uint32_t n_out_of_catalogue = 0;  ///< of every out-of-catalogue fault
  LeaveOut leave_out = LeaveOut::none;
  /// Datasets with the right name, spread over effects and strengths, whose effect is applied and judged on held-out
  /// trials; if any, so are all with nothing hidden in which something is suspected. And so many names each that are
  /// right, that an effect got which the catalogue lacks, and that an out-of-catalogue fault got, are applied to see
  /// whether the model with them can have made the data.
  std::uint32_t n_verified = 0;
  /// Keeps finished datasets; its name is made longer by what they depend on. Empty: they are not kept.
  std::filesystem::path injected_folder = {};
};

/// What is hidden in a dataset, and from whom.
enum class CaseKind {
  nothing,
  one,               ///< effect of the catalogue, strength from its prior
  beyond_prior,      ///< stronger than any in the table, in a room drawn from a wider nuisance
  left_out,          ///< effect that the catalogue lacks when this dataset is judged
  left_out_variant,  ///< the catalogue has the effect in other variants only
  two,               ///< effects together
  out_of_catalogue   ///< something that no catalogue has
};
enum class Strength { none, weak, medium, strong, beyond };  ///< thirds of the prior, by distance from off
[[nodiscard]] std::string_view name(CaseKind kind) noexcept;
[[nodiscard]] std::string_view name(Strength strength) noexcept;
/// By the parameter that names an effect's strength; medium for an effect that is there or not.
[[nodiscard]] Strength strength_of(const EffectSpec& effect);

/// A dataset in which something is hidden, made to see whether it is found.
struct InjectedDataset {
  CaseKind kind = CaseKind::nothing;
  Strength strength = Strength::none;
  std::string fault;                ///< name; empty without one
  std::vector<EffectSpec> effects;  ///< as drawn
  std::vector<float> statistics;    ///< (n_statistics)

  [[nodiscard]] std::string truth() const;  ///< effects and fault in words; "nothing"
};

/// One dataset and what became of it.
struct InjectedCase {
  CaseKind kind = CaseKind::nothing;
  std::string truth;  ///< "nothing", an effect, an out-of-catalogue fault, or "one + another"
  Strength strength = Strength::none;
  std::vector<EffectSpec> effects;
  Verdict verdict = Verdict::no_disagreement;
  std::vector<std::string> named;         ///< or not to be told apart
  std::optional<effects::Family> family;  ///< of the named effect, or one whose effects together are sure
  std::string likeliest;                  ///< hypothesis with the greatest probability
  std::vector<double> probabilities;      ///< (n_hypotheses) as SelftestResult::hypotheses
  double p = 1.0;                         ///< of the global test
  std::size_t n_parameters = 0;           ///< fitted, if the right effect was named
  std::size_t n_covered = 0;              ///< of them, whose interval holds the truth

  std::size_t injected = 0;            ///< which dataset it is of those that were injected
  std::optional<FittedEffect> fitted;  ///< of the effect named

  std::optional<Verification> verification;  ///< of the effect named, or of the first that can't be ruled out
  std::optional<Look> applied;               ///< what the model with the effect named looks like

  [[nodiscard]] bool seen() const noexcept { return verdict != Verdict::no_disagreement; }
};

/// What a self-test counts.
enum class Counted {
  alarm_on_nothing,  ///< a disagreement although nothing is hidden
  name_on_nothing,
  seen,        ///< a disagreement
  exact_name,  ///< given a disagreement, as the family, any name, the truth in the set and none in the catalogue
  right_family,
  any_name,
  right_of_names,  ///< given a name
  wrong_name,
  wrong_family,
  truth_in_set,
  none_in_catalogue,
  parameters_covered,  ///< by their 90 % intervals
  shrunk,              ///< gaps on held-out trials, given the right name
  closed,
  most_closed,  ///< nine tenths of what can be closed
  shrunk_on_nothing,
  right_passes,  ///< the model with the right name applied
  left_out_passes,
  out_of_catalogue_passes,
  left_out_seen,
  left_out_none,       ///< called none in the catalogue, given a disagreement
  told_left_out_none,  ///< the same of those that the whole catalogue gives the right name: others are as good as
                       ///< nested
  left_out_named,
  left_out_named_outside,  ///< by a name of another family
  variant_named,           ///< by the others, given that the whole catalogue gives the right name
  motion_as_sensor,        ///< people's motion, in or left out of the catalogue: a name of optics or electronics
  out_of_catalogue_seen,
  out_of_catalogue_none,
  out_of_catalogue_named,
  beyond_exact,
  beyond_wrong,
  pair_in_set,
  pair_none,
  pair_wrong,
  seen_and_in_set,  ///< of one effect and strength
  confused          ///< two effects taken for each other
};

/// A share with its exact 95 % interval.
struct Rate {
  Counted what = Counted::seen;
  std::size_t hits = 0, of = 0;
  Interval interval;                   ///< empty (0 to 1) without any case
  Strength strength = Strength::none;  ///< of one effect, where only that is counted
  [[nodiscard]] double value() const noexcept {
    return of == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(of);
  }
};

struct SelftestResult {
  std::vector<InjectedCase> cases;
  std::vector<std::string> hypotheses;  ///< of the table, nothing first
  stats::Reliability reliability;       ///< of the probabilities, over cases of the kind `one` with a disagreement
};

/// What the settings ask for, in realizations that no table has seen; those in which people can't get about are
/// missing.
[[nodiscard]] std::vector<InjectedDataset> inject(const ReferenceStudy& reference, const SelftestSettings& settings,
                                                  const Context& context = {});
/// What a reference study's table says of them.
[[nodiscard]] SelftestResult judge(const ReferenceStudy& reference, const std::vector<InjectedDataset>& injected,
                                   const SelftestSettings& settings, const Context& context = {});
/// Both, with a reference study for full data of the settings' kind.
[[nodiscard]] SelftestResult selftest(const SceneSpec& scene, const ScriptSpec& script,
                                      const SelftestSettings& settings, const Context& context = {});

/// The design's rates: alarms and names on nulls, power, right name, right family, wrong name, truth in the set,
/// coverage; gaps closed on held-out trials; what becomes of effects that the catalogue lacks, of pairs and of
/// strengths beyond the prior.
[[nodiscard]] std::vector<Rate> rates_of(const SelftestResult& result);
/// Of one effect and strength: how often a disagreement is seen, and how often the effect is then in the set.
[[nodiscard]] std::vector<Rate> power_of(const SelftestResult& result, const std::string& effect);
/// (n_hypotheses x n_hypotheses) row: truth, column: likeliest hypothesis; shares of the row, of cases with a
/// disagreement.
[[nodiscard]] std::vector<std::vector<double>> confusion_of(const SelftestResult& result);

}  // namespace pirsim::reconcile
