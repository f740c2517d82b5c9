// How warm the surface of each part of a person is.
#pragma once

#include <array>

#include "body/body_part.hpp"
#include "pirsim/script.hpp"

namespace pirsim::body {

/// Degrees Celsius, indexed by Part. Bare parts have the skin's temperature. Clothing lies between the skin's and the
/// room's, as its insulation (0.155 m^2 K/W a clo) does to that of the air around it (8 W/(m^2 K) by convection and
/// radiation, `assumed`; 6 to 10). Ref: [ISO7730].
[[nodiscard]] std::array<double, n_parts> surface_temperatures_c(const WarmthSpec& warmth, double ambient_c);

}  // namespace pirsim::body
