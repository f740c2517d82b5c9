// What to say of a name that isn't known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pirsim {

/// ` (did you mean 'X'?)`, or `; there are A, B` if none is near; of very many only the first; `; there are none`.
[[nodiscard]] std::string near_or_all(std::string_view name, const std::vector<std::string>& known);

}  // namespace pirsim
