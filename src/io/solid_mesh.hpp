// Triangles of solids, for pictures: rays are traced against the solids themselves.
#pragma once

#include <cstdint>
#include <vector>

#include "pirsim/shapes.hpp"

namespace pirsim::io {

struct SolidMesh {
  std::vector<Vec3> positions;         ///< on the solid's surface, in its frame
  std::vector<Vec3> normals;           ///< outward, unit, one a position
  std::vector<std::uint32_t> indices;  ///< three a triangle, counter-clockwise from outside
};

/// Of primitives closed; a sphere of radius r is missed by 0.02 r at most. A mesh is its own, flat shaded.
[[nodiscard]] SolidMesh tessellated(const Shape& shape);

}  // namespace pirsim::io
