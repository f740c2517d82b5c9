// How often each of some whole numbers came out.
#pragma once

#include <cstdint>
#include <map>

namespace pirsim {

/// Value -> how often it came out, once or more. As large as there are different values, however many were counted.
using Tally = std::map<int, std::int64_t>;

}  // namespace pirsim
