// Boxes and what is made of them.
#pragma once

#include <span>
#include <string>

#include "dataset/floor_plan.hpp"

namespace pirsim::dataset {

/// In the axes of what it belongs to.
struct BoxPart {
  Rectangle footprint;
  double from_y_m = 0.0, to_y_m = 0.0;
};

/// One mesh of closed boxes, in world axes, in coordinates that single precision holds exactly.
[[nodiscard]] TriMesh boxes(const std::string& name, const Spot& spot, std::span<const BoxPart> parts);
/// The outline, facing up.
[[nodiscard]] TriMesh floor_mesh(const std::vector<Rectangle>& pieces);

}  // namespace pirsim::dataset
