// Words that logs and messages of motion sensors use for a state, in small letters. tools/words/write.py copies them to
// pirsim-live (python/live), so each word stands here alone, as a plain text.
#pragma once

#include <array>

namespace pirsim::io {

inline constexpr std::array on_words{"on",  "true",     "yes",    "motion",   "motion detected", "motion_detected",
                                     "det", "detected", "active", "occupied", "moving"};
inline constexpr std::array off_words{"off",          "false",    "no",     "clear",        "no motion",  "no_motion",
                                      "not detected", "inactive", "vacant", "not_detected", "unoccupied", "idle"};
inline constexpr std::array unknown_words{"",   "unavailable", "unknown", "none", "null", "nan",
                                          "na", "n/a",         "<na>",    "-",    "?"};

}  // namespace pirsim::io
