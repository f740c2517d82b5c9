// What people wear, in pictures and in the page of a run.
#pragma once

#include <array>
#include <cstddef>

#include "pirsim/geometry.hpp"

namespace pirsim::io {

/// Linear-light red, green, blue of person i, the first again after the last. None is a beam's blue or red, a door's
/// green or a seat's purple.
[[nodiscard]] inline const Vec3& person_colour(std::size_t i) {
  static const std::array<Vec3, 8> colours{Vec3(0.85, 0.58, 0.04), Vec3(0.82, 0.27, 0.50), Vec3(0.02, 0.40, 0.37),
                                           Vec3(0.70, 0.70, 0.68), Vec3(0.22, 0.25, 0.03), Vec3(0.52, 0.45, 0.78),
                                           Vec3(0.06, 0.06, 0.07), Vec3(0.26, 0.03, 0.09)};
  return colours[i % colours.size()];
}

}  // namespace pirsim::io
