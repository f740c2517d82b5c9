// What columns of rows are called, which no sensor may be.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace pirsim {

/// Those of a study's rows, of measured rows and of a dataset's.
inline constexpr std::array<std::string_view, 12> column_names{"replicate", "trial",    "seat",     "time_s",
                                                               "time",      "phase",    "people",   "room",
                                                               "day",       "presence", "arrivals", "departures"};

[[nodiscard]] inline bool is_column_name(std::string_view name) {
  return std::ranges::find(column_names, name) != column_names.end();
}

}  // namespace pirsim
