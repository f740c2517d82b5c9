// How strong is a named effect?
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "effects/catalogue.hpp"
#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/classifier.hpp"
#include "reconcile/inference/feature_map.hpp"
#include "reconcile/inference/kinds.hpp"
#include "stats/intervals.hpp"
#include "stats/posterior.hpp"

namespace pirsim::reconcile {

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

// How strong is a named effect?

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
  ~EffectFitter();
  EffectFitter(EffectFitter&&) noexcept;
  EffectFitter& operator=(EffectFitter&&) noexcept;

  /// hypothesis: 1 or more; measured: statistics. What is learnt about a hypothesis is kept for the next time. Safe to
  /// call from several threads.
  [[nodiscard]] FittedEffect fit(std::size_t hypothesis, std::span<const float> measured) const;

 private:
  struct Learnt;
  [[nodiscard]] const Learnt& learnt(std::size_t hypothesis) const;

  const SceneSpec* scene_;
  const ReferenceTable* table_;
  const FeatureMap* map_;
  std::vector<std::vector<std::size_t>> held_back_;
  unsigned threads_;
  std::string left_out_;
  std::unique_ptr<Learnt[]> learnt_;  ///< (n_hypotheses)
};

}  // namespace pirsim::reconcile
