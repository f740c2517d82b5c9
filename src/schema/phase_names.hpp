// What goes on in a row, in words; a script's own names of phases come beside these.
#pragma once

#include <array>
#include <string_view>

namespace pirsim {

/// Of a person who isn't there.
inline constexpr std::string_view phase_outside = "outside";
/// Of a person who carries out `work`.
inline constexpr std::string_view phase_working = "working";
/// Of a person otherwise; in the order of body::Stage.
inline constexpr std::array<std::string_view, 9> phases_of_body{
    "standing", "walking", "turning", "sitting_down", "seated", "rising", "lying_down", "lying", "getting_up"};
/// Of a room by a schedule.
inline constexpr std::string_view phase_empty = "empty", phase_occupied = "occupied", phase_meeting = "meeting",
                                  phase_cleaning = "cleaning";

}  // namespace pirsim
