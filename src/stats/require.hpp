// One way to refuse an argument.
#pragma once

#include <cmath>
#include <string>

#include "pirsim/error.hpp"

namespace pirsim::stats {

/// Throws Error(usage) unless the condition holds.
inline void require(bool condition, const char* message) {
  if (!condition) throw Error(ErrorCode::usage, message);
}

template <typename Range>
void require_finite(const Range& values, const char* message) {
  for (const auto value : values) require(std::isfinite(value), message);
}

}  // namespace pirsim::stats
