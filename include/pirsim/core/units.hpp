// SI and radians inside; degrees only at the border, and only through these.
#pragma once

#include <numbers>

namespace pirsim {

inline constexpr double pi = std::numbers::pi;
[[nodiscard]] constexpr double radians(double degrees) noexcept { return degrees * (pi / 180.0); }
[[nodiscard]] constexpr double degrees(double radians) noexcept { return radians * (180.0 / pi); }

}  // namespace pirsim
