// Words that logs and messages of motion sensors use for a state, in small letters. tools/words/write.py copies them to
// pirsim-live (python/live), so each word stands here alone, as a plain text.
#pragma once

#include <array>
#include <cstddef>

namespace pirsim::io {

// clang-format off
/// What is longer is no state.
inline constexpr std::size_t longest_state = 32;
inline constexpr std::array on_words{
    "on", "true", "yes", "motion", "motion detected", "motion_detected", "motion active", "detected motion",
    "det", "detected", "active", "occupied", "moving", "motion detector", "movement", "present", "t", "y", "ein",
    "ja", "oui", "wahr", "bewegung", "anwesend"};
inline constexpr std::array off_words{
    "off", "false", "no", "clear", "no motion", "no_motion", "motion inactive", "not detected", "inactive",
    "vacant", "not_detected", "unoccupied", "idle", "cleared (no motion detected)", "cleared", "no one",
    "no movement", "absent", "not present", "f", "n", "aus", "nein", "non", "falsch", "keine bewegung", "abwesend"};
// clang-format on
inline constexpr std::array unknown_words{"",   "unavailable", "unknown", "none", "null", "nan",
                                          "na", "n/a",         "<na>",    "-",    "?"};

}  // namespace pirsim::io
