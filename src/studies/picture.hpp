// A picture of a room with its people and beams.
#pragma once

#include <optional>
#include <vector>

#include "pirsim/state.hpp"
#include "rt/renderer.hpp"

namespace pirsim::studies {

struct PictureSpec {
  std::vector<std::size_t> beams_of;    ///< indices of sensors whose beams are drawn
  std::optional<Vec3> camera, look_at;  ///< default: from above and beside, the whole floor in view
  double field_of_view_deg = 45.0;      ///< vertical
  int width = 1280, height = 720;       ///< pixels
};

/// The room as a doll's house, cut open towards the camera. Throws Error(usage) for a camera that can't be used.
[[nodiscard]] rt::Image picture(const Model& model, const State& state, const PictureSpec& spec);

}  // namespace pirsim::studies
