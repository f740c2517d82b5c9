#include "pirsim/body/body_part.hpp"

namespace pirsim::body {

std::string_view name(Part part) noexcept {
  static constexpr std::array<std::string_view, n_parts> names{
      "pelvis",     "torso",       "head",       "left_upper_arm", "right_upper_arm", "left_forearm", "right_forearm",
      "left_thigh", "right_thigh", "left_shank", "right_shank",    "left_foot",       "right_foot"};
  return names[static_cast<std::size_t>(part)];
}

}  // namespace pirsim::body
