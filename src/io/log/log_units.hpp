// Microseconds, in which logs are read. Private to io.
#pragma once

#include <cstdint>

namespace pirsim::io {

inline constexpr std::int64_t us_per_ms = 1'000, us_per_s = 1'000'000, us_per_day = 86'400 * us_per_s;

}  // namespace pirsim::io
