// The scale on which a parameter's prior is flat.
#pragma once

#include "effects/catalogue.hpp"

namespace pirsim::reconcile {

/// A value beyond the prior is moved to its end.
[[nodiscard]] double to_flat(const effects::ParameterInfo& info, double value);
/// Whole where it must be, and within what is accepted.
[[nodiscard]] double from_flat(const effects::ParameterInfo& info, double value);

}  // namespace pirsim::reconcile
