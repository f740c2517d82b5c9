// Where a mesh meets a horizontal plane.
#pragma once

#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim {

/// Lines in (x, z), metres.
struct MeshSection {
  /// Closed; the last point isn't the first one's copy. Where all triangles look outwards, holes run the other way
  /// round.
  std::vector<std::vector<Vec2>> loops;
  std::vector<std::vector<Vec2>> lines;  ///< open: where the mesh has a rim
};
/// At y = height_m. A corner at this very height counts as below it.
[[nodiscard]] MeshSection section_of(const TriMesh& mesh, double height_m);

/// What the loops enclose by the even-odd rule, divided by half their length: the thickness of a long thin wall.
[[nodiscard]] double mean_thickness_m(const std::vector<std::vector<Vec2>>& loops);

}  // namespace pirsim
