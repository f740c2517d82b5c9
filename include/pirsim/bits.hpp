// What stands in a row where nobody knows.
#pragma once

#include <cstdint>

namespace pirsim {

inline constexpr std::uint8_t unknown_bit = 2;  ///< nobody knows; it counts for nothing
inline constexpr std::uint8_t absent_bit = 3;   ///< the room of these rows has no such sensor, or no such door
inline constexpr int unknown_people = -1, absent_people = -2;  ///< absent: the room has no such area

}  // namespace pirsim
