// Pulling a way tight, as a string.
#pragma once

#include <functional>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim::body {

/// Whether one can go straight from the first point to the second.
using StraightWay = std::function<bool(const Vec2&, const Vec2&)>;

/// A shorter way with the same ends, each leg of which `straight` allows; `way` itself must be allowed.
[[nodiscard]] std::vector<Vec2> pulled_tight(std::vector<Vec2> way, const StraightWay& straight);

}  // namespace pirsim::body
