// An effect is several things: on this sensor or that, to the left or to the right, hardly or strongly.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/effects/catalogue.hpp"
#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/feature_map.hpp"
#include "reconcile/inference/locate.hpp"
#include "stats/classes.hpp"
#include "stats/conformal.hpp"
#include "stats/intervals.hpp"
#include "stats/trees.hpp"

namespace pirsim::reconcile {

/// A value beyond the prior is moved to its end.
[[nodiscard]] double to_flat(const effects::ParameterInfo& info, double value);
/// Whole where it must be, and within what is accepted.
[[nodiscard]] double from_flat(const effects::ParameterInfo& info, double value);

/// (n) numbers from 0 on of datasets of one hypothesis that are alike: with the same choices, strengths on the same
/// side of `off`, and, as far as ten datasets remain in each, in the same third by the parameter that names the
/// strength. Kinds with fewer than `fewest` datasets are one group.
[[nodiscard]] std::vector<int> number_alike(const ReferenceTable& table, std::span<const std::size_t> rows,
                                            std::size_t fewest);

/// Finds what of an effect isn't a matter of more or less, by a discriminant between the kinds of its training
/// datasets.
class KindFinder {
 public:
  /// rows: of one hypothesis of the table; features: (n_rows x n_features).
  KindFinder(const ReferenceTable& table, std::span<const std::size_t> rows, const stats::Matrix<float>& features);
  /// Place in `rows` of a dataset with the likeliest choices and sides.
  [[nodiscard]] std::size_t one_like(std::span<const float> features) const;
  /// One of each kind, as a place in `rows`, with the probability that the dataset is of that kind.
  struct Share {
    std::size_t example = 0;
    double probability = 0.0;
  };
  [[nodiscard]] std::vector<Share> shares(std::span<const float> features) const;

 private:
  std::vector<std::size_t> examples_;  ///< (n_kinds) places in rows
  std::vector<double> n_;              ///< (n_kinds) datasets of the kind
  stats::Discriminant discriminant_;   ///< between kinds, if there are several
};

// Which effects of the catalogue can have made these data?

/// (n_hypotheses) Datasets (rows of the table) that nothing is learnt from and in which the global test sees something,
/// as in data that a name is given to; or, of few, the likeliest to be seen.
using SeenRows = std::vector<std::vector<std::size_t>>;

/// Of these rows of a table, those that the catalogue without an effect makes; empty: of the whole.
[[nodiscard]] std::vector<std::size_t> still_made(const ReferenceTable& table, std::vector<std::size_t> rows,
                                                  const std::string& left_out);

/// alpha: level of the global test.
[[nodiscard]] SeenRows seen_rows(const TableView& view, double alpha, const std::string& left_out = {});

struct ClassifierSettings {
  double alpha = 0.05;  ///< level of the global test
  std::size_t trees = 300;
  std::string left_out = {};  ///< effect that the catalogue is made to lack; empty: none
};

/// Rows of the table that its hypotheses are told apart by, with their classes. Hypotheses without enough datasets are
/// none.
struct LabelledRows {
  /// Throws Error(infeasible) without rows of nothing.
  LabelledRows(const ReferenceTable& table, const SeenRows& seen, const std::string& left_out);
  /// (n_classes) -> (n_hypotheses); what is no candidate has 0.
  [[nodiscard]] std::vector<double> by_hypothesis(std::span<const double> of_classes) const;

  std::vector<std::size_t> rows;        ///< (n) of the table
  std::vector<int> labels;              ///< (n)
  std::vector<int> kinds;               ///< (n) finer classes of the training rows: datasets that are alike; else -1
  stats::Split split;                   ///< training realizations and seen rows, by place in `rows`
  std::vector<std::size_t> hypotheses;  ///< (n_classes)
  std::size_t n_hypotheses = 0;
};

/// How probable each hypothesis is, seen in some of the trials only, without a test of whether it can have made the
/// data.
class HypothesisProbabilities {
 public:
  /// map must outlive it.
  HypothesisProbabilities(const ReferenceTable& table, const FeatureMap& map, const SeenRows& seen,
                          const stats::PooledClassifierSettings& settings);
  /// (n_hypotheses) of a dataset's statistics.
  [[nodiscard]] std::vector<double> of(std::span<const float> statistics) const;

 private:
  const FeatureMap* map_;
  LabelledRows data_;
  stats::PooledClassifier classifier_;
};

/// Trained on the training realizations of a table, calibrated on the others. Names are given only where the global
/// test sees a disagreement, so an effect is calibrated on those of its datasets in which the test sees one: weak
/// datasets, which look like anything, would make every effect hard to rule out.
class HypothesisClassifier {
 public:
  /// view must outlive it. The p of what is no candidate is 0.
  HypothesisClassifier(const TableView& view, const ClassifierSettings& settings, const Context& context);

  /// (n_hypotheses) of a dataset's statistics; nothing first.
  [[nodiscard]] std::vector<HypothesisScore> judge(std::span<const float> statistics) const;
  /// (n_hypotheses) probabilities only.
  [[nodiscard]] std::vector<double> probabilities(std::span<const float> statistics) const;
  [[nodiscard]] const SeenRows& seen_rows() const noexcept { return seen_rows_; }
  /// How well the probabilities of the calibration datasets mean what they say.
  [[nodiscard]] const stats::Reliability& reliability() const noexcept { return reliability_; }
  /// Names of the features with the greatest share in the trees' decisions.
  [[nodiscard]] std::vector<FeatureName> telling_features(std::size_t n) const;

 private:
  const FeatureMap* map_;
  std::vector<std::string> names_;  ///< of all hypotheses
  SeenRows seen_rows_;
  LabelledRows data_;
  stats::ConformalClassifier classifier_;
  stats::ImpostorTests impostors_;
  stats::Reliability reliability_;
};

// How strong is a named effect?

/// Some of a hypothesis's datasets, as features.
struct HypothesisDatasets {
  std::span<const std::size_t> rows;  ///< (n) of the table
  stats::Matrix<float> features;      ///< (n x n_features)
};

/// Linear estimates of the parameters that vary, on the scale on which their priors are flat; learnt from the training
/// datasets and made of the held-back ones, whose estimates err as that of measured data does. First the likeliest
/// choices are found (which sensor, which wall). Then each parameter is estimated twice: as learnt from the datasets
/// with these choices alone (if there are enough), and from all, in which the strength of others is taken for none.
class PointEstimator {
 public:
  /// hypothesis: 1 or more; held_back: of it, outside the training part.
  PointEstimator(const ReferenceTable& table, std::size_t hypothesis, const HypothesisDatasets& training,
                 const HypothesisDatasets& held_back);

  [[nodiscard]] const std::vector<const effects::ParameterInfo*>& infos() const noexcept { return infos_; }
  [[nodiscard]] std::vector<Interval> bounds() const;
  /// As a training dataset of the likeliest kind was drawn.
  [[nodiscard]] const EffectSpec& kind_of(std::span<const float> features) const;
  /// How probable the words of each choice are, by the kinds that the training datasets were drawn as.
  [[nodiscard]] std::vector<FittedChoice> choices_of(std::span<const float> features) const;
  /// Held-back datasets in which the same parameters apply, ascending; all, if these are too few.
  [[nodiscard]] std::vector<std::size_t> rows_like(const EffectSpec& kind) const;
  /// (n_estimates) of a dataset's features.
  [[nodiscard]] std::vector<double> of(std::span<const float> features) const;
  /// (n x n_parameters) of the held-back datasets.
  [[nodiscard]] const stats::Matrix<double>& parameters() const noexcept { return parameters_; }
  /// (n x n_estimates) what is estimated of them.
  [[nodiscard]] const stats::Matrix<double>& estimates() const noexcept { return estimates_; }

 private:
  using Choices = std::map<std::string, std::string, std::less<>>;
  struct Alike {
    std::size_t number = 0;  ///< of these choices
    std::optional<stats::ParameterEstimator>
        from_own;  ///< (n_parameters) learnt from their datasets, if these are enough
  };

  std::vector<const effects::ParameterInfo*> infos_;
  std::vector<const EffectSpec*> drawn_;      ///< (n_training)
  std::vector<const EffectSpec*> held_back_;  ///< (n)
  KindFinder finder_;
  std::map<Choices, Alike> alike_;
  stats::ParameterEstimator from_all_;  ///< (n_choices x n_parameters) each with the others' strength taken for none
  stats::Matrix<double> parameters_, estimates_;
};

/// Fits effects from the datasets of one hypothesis of a table alone: a linear estimate of its parameters, then
/// regression-adjusted ABC on it, widened until held-back datasets like the measured one are covered as often as
/// promised. What is no matter of more or less (which sensor, which wall, which way) is the likeliest kind by a
/// discriminant between the kinds; and where the room has no place for what comes out, it is moved to the nearest. Ref:
/// [FearnheadPrangle2012], [Beaumont2002]
class EffectFitter {
 public:
  /// scene, table and map must outlive it. held_back: (n_hypotheses) rows of each hypothesis outside the training part:
  /// give those in which a disagreement is seen, since nothing else is fitted. left_out: nothing is learnt from it.
  EffectFitter(const SceneSpec& scene, const ReferenceTable& table, const FeatureMap& map,
               std::vector<std::vector<std::size_t>> held_back, const Context& context, std::string left_out = {});

  /// hypothesis: 1 or more; measured: statistics. What is learnt about a hypothesis is kept for the next time. Safe to
  /// call from several threads.
  [[nodiscard]] FittedEffect fit(std::size_t hypothesis, std::span<const float> measured) const;

 private:
  struct Learnt {
    std::once_flag once;
    std::optional<PointEstimator> estimator;
  };
  [[nodiscard]] const PointEstimator& estimator_of(std::size_t hypothesis) const;

  const SceneSpec* scene_;
  const ReferenceTable* table_;
  const FeatureMap* map_;
  std::vector<std::vector<std::size_t>> held_back_;
  unsigned threads_;
  std::string left_out_;
  std::unique_ptr<Learnt[]> learnt_;  ///< (n_hypotheses)
};

}  // namespace pirsim::reconcile
