// Triangle meshes, and their clean-up through OpenMesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/geom/frame.hpp"

namespace pirsim {

enum class Solidity {
  solid,  ///< hides from sensors and must be walked round
  screen  ///< hides, but nobody minds it: stands for what people move with them, a chair's back
};

/// Indexed triangles. positions: (n_vertices) world metres; triangles: (n_triangles x 3) indices.
struct TriMesh {
  std::string name;
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles{};
  Solidity solidity = Solidity::solid;
  std::optional<double> temperature_c = std::nullopt;  ///< of its surface, where it differs from the room's
};

/// What clean-up found in a mesh.
struct MeshAudit {
  std::size_t welded_vertices = 0;         ///< vertices merged into an equal one
  std::size_t degenerate_triangles = 0;    ///< triangles of no area, dropped
  std::size_t duplicate_triangles = 0;     ///< same three vertices again, dropped
  std::size_t non_manifold_triangles = 0;  ///< triangles that OpenMesh can't attach as a manifold; kept as occluders
  std::size_t boundary_edges = 0;          ///< 0 for a closed surface
};

struct CleanMesh {
  TriMesh mesh;
  MeshAudit audit;
};

/// Welds vertices closer than `tolerance_m`, drops triangles without area and duplicates, and reports what a
/// half-edge structure can't hold. Nothing that occludes is lost.
[[nodiscard]] CleanMesh clean(const TriMesh& mesh, double tolerance_m = 1e-6);

/// Boundary loops of a mesh projected onto the floor, (x, z) in order; outer loops counter-clockwise seen from
/// above (from +Y), holes clockwise. Throws Error(input) for a mesh whose boundary isn't a set of simple loops.
[[nodiscard]] std::vector<std::vector<Vec2>> boundary_loops_xz(const TriMesh& mesh);

}  // namespace pirsim
