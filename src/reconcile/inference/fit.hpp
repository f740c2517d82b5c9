// How strong is a named effect?
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "reconcile/ensemble/reference_table.hpp"
#include "reconcile/inference/classifier.hpp"
#include "reconcile/inference/feature_map.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {

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
               std::vector<std::vector<std::size_t>> held_back, const Context& context, Omission left_out = {});
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
  Omission left_out_;
  std::unique_ptr<Learnt[]> learnt_;  ///< (n_hypotheses)
};

}  // namespace pirsim::reconcile
