// Effects that are stronger than what was looked for.
#pragma once

#include <optional>
#include <span>

#include "reconcile/inference/reference_study.hpp"

namespace pirsim::reconcile {

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
