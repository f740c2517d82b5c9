// What the thirteen parts of a body are called in files.
#pragma once

#include <array>
#include <string_view>

namespace pirsim {

/// In the order of body::Part.
inline constexpr std::array<std::string_view, 13> body_part_names{
    "pelvis",     "torso",       "head",       "left_upper_arm", "right_upper_arm", "left_forearm", "right_forearm",
    "left_thigh", "right_thigh", "left_shank", "right_shank",    "left_foot",       "right_foot"};

}  // namespace pirsim
