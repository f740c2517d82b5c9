// Can the model with effects applied have made the data?
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "reconcile/inference/locate.hpp"

namespace pirsim::reconcile {

/// Level of the global test of a model into which so many effects were applied: halved with every one.
[[nodiscard]] double level_with(std::size_t n_applied, double alpha);

/// What is asked of one model.
struct PatchedModel {
  std::span<const FittedEffect> applied;
  std::span<const float> observed;  ///< statistics of the data
};

/// What the global test says.
struct GlobalP {
  double p = 0.0;      ///< 0 for a model in which people can hardly get about
  double least = 0.0;  ///< no data give a smaller one: so few datasets were simulated
};

/// The global test of each model: (n_models).
///
/// The datasets come from realizations that no table has seen. Each realization draws the fitted parameters anew, since
/// they are known only up to their posterior. A model is simulated until its datasets surely don't refuse it; a model
/// that is refused is simulated in all of them, so that looking more than once refuses no more models than the level
/// allows. All models share the tracing of a realization, and p of one doesn't depend on the others.
///
/// map: features of the plain model, for the trials to be looked at. level: of the global test.
[[nodiscard]] std::vector<GlobalP> p_with(std::span<const PatchedModel> models, const ReferenceStudy& reference,
                                          const FeatureMap& map, double level, const Context& context);

// Effects that are stronger than what was looked for.

/// The parameter of a fitted effect that lies in the last tenth of its prior, on the scale on which that is flat; the
/// strength before the others. None if all lie within, or at the end at which next to nothing happens.
[[nodiscard]] std::optional<RangeEnd> range_end_of(const FittedEffect& fitted);

/// The end of its strength's prior that is farther from none on the fitted side, wherever the fit lies. Data of a far
/// stronger effect are like none of the prior's, and a fit to them may land anywhere. None without a strength.
[[nodiscard]] std::optional<RangeEnd> strong_end_of(const FittedEffect& fitted);

/// Tries the effect with that parameter ever farther beyond the end, each step a third farther from none, up to twenty
/// times as far or to what a script may say, the other parameters as they were fitted. The strength of the greatest p
/// is taken; its interval goes from the step before the first that passes to the step after the last. None if no step
/// passes: `end` then only tells how far was tried. measured: statistics.
[[nodiscard]] std::optional<FittedEffect> fitted_beyond(const FittedEffect& fitted, RangeEnd& end,
                                                        const ReferenceStudy& reference, const FeatureMap& map,
                                                        std::span<const float> measured, double level,
                                                        const Context& context);

}  // namespace pirsim::reconcile
