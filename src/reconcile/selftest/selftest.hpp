// Does the workflow find what was hidden? Effects are injected into simulated data that no table has seen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/effects/catalogue.hpp"
#include "reconcile/inference/analyst.hpp"
#include "reconcile/inference/locate.hpp"
#include "stats/intervals.hpp"
#include "stats/trees.hpp"

namespace pirsim::reconcile {

enum class LeaveOut {
  none,
  effects  ///< judge the datasets with one effect a second time, by a catalogue that lacks it
};

struct SelftestSettings {
  Settings analysis;
  Measured::Kind kind = Measured::Kind::series;
  int n_replicates = 1;           ///< runs of every trial in an injected dataset
  std::uint32_t n_nulls = 60;     ///< datasets with nothing hidden
  std::uint32_t n_injected = 10;  ///< datasets of every effect and strength
  std::uint32_t n_pairs = 0;      ///< datasets with two effects
  LeaveOut leave_out = LeaveOut::none;
  /// Keeps finished datasets; its name is made longer by what they depend on. Empty: they are not kept.
  std::filesystem::path injected_folder = {};
};

/// What is hidden in a dataset, and from whom.
enum class CaseKind {
  nothing,
  one,       ///< effect of the catalogue, strength from its prior
  left_out,  ///< effect that the catalogue lacks when this dataset is judged
  two        ///< effects together
};
enum class Strength { none, weak, medium, strong };  ///< thirds of the prior, by distance from off
[[nodiscard]] std::string_view name(CaseKind kind) noexcept;
[[nodiscard]] std::string_view name(Strength strength) noexcept;
/// By the parameter that names an effect's strength; medium for an effect that is there or not.
[[nodiscard]] Strength strength_of(const EffectSpec& effect);

/// A dataset in which something is hidden, made to see whether it is found.
struct InjectedDataset {
  CaseKind kind = CaseKind::nothing;
  Strength strength = Strength::none;
  std::vector<EffectSpec> effects;  ///< as drawn
  std::vector<float> statistics;    ///< (n_statistics)

  [[nodiscard]] std::string truth() const;  ///< effects in words; "nothing"
};

/// One dataset and what became of it.
struct InjectedCase {
  CaseKind kind = CaseKind::nothing;
  std::string truth;  ///< "nothing", an effect, or "one + another"
  Strength strength = Strength::none;
  std::vector<EffectSpec> effects;
  Verdict verdict = Verdict::no_disagreement;
  std::vector<std::string> named = {};         ///< or not to be told apart
  std::optional<effects::Family> family = {};  ///< of the named effect, or one whose effects together are sure
  std::string likeliest = {};                  ///< hypothesis with the greatest probability
  std::vector<double> probabilities = {};      ///< (n_hypotheses) as SelftestResult::hypotheses
  double p = 1.0;                              ///< of the global test
  std::size_t n_parameters = 0;                ///< fitted, if the right effect was named
  std::size_t n_covered = 0;                   ///< of them, whose interval holds the truth

  std::size_t injected = 0;  ///< which dataset it is of those that were injected

  [[nodiscard]] bool seen() const noexcept { return verdict != Verdict::no_disagreement; }
};

// What a self-test counts and tells first.
inline constexpr const char* alarm_on_nothing = "a disagreement although nothing is hidden";
inline constexpr const char* disagreement_seen = "a disagreement seen";
inline constexpr const char* exact_name = "exactly the right name, given a disagreement";
inline constexpr const char* wrong_name = "one wrong name";

/// A share.
struct Rate {
  std::string what;  ///< is counted, in words
  std::size_t hits = 0, of = 0;

  void count(bool hit) {
    ++of;
    hits += hit ? 1 : 0;
  }
  [[nodiscard]] double value() const noexcept {
    return of == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(of);
  }
  /// Exact, 95 %; 0 to 1 without any case.
  [[nodiscard]] Interval interval() const { return of == 0 ? Interval{0.0, 1.0} : stats::clopper_pearson(hits, of); }
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
/// Injects and judges, with a reference study for full data of the settings' kind.
[[nodiscard]] SelftestResult selftest(const SceneSpec& scene, const ScriptSpec& script,
                                      const SelftestSettings& settings, const Context& context = {});

/// The design's rates: alarms and names on nulls, power, right name, right family, wrong name, truth in the set,
/// coverage; what becomes of effects that the catalogue lacks, and of pairs.
[[nodiscard]] std::vector<Rate> rates_of(const SelftestResult& result);
/// Of one effect, of weak, medium and strong ones each: how often a disagreement is seen, and how often the effect is
/// then in the set.
[[nodiscard]] std::vector<Rate> power_of(const SelftestResult& result, const std::string& effect);
/// Two effects that are often taken for each other.
struct ConfusedPair {
  std::string first, second;
  Rate rate;              ///< either taken for the other, of both one's cases with a disagreement
  bool expected = false;  ///< the catalogue names one as confused with the other
};
/// Pairs whose share is at least so great, in three cases or more; the most confused first.
[[nodiscard]] std::vector<ConfusedPair> confused_pairs(const SelftestResult& result, double least_share = 0.1);
/// Each row divided by its sum, if that isn't 0.
[[nodiscard]] std::vector<std::vector<double>> shares_of_rows(std::vector<std::vector<double>> counts);
/// (n_hypotheses x n_hypotheses) row: truth, column: likeliest hypothesis; shares of the row, of cases with a
/// disagreement.
[[nodiscard]] std::vector<std::vector<double>> confusion_of(const SelftestResult& result);

}  // namespace pirsim::reconcile
