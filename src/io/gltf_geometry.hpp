// Triangles out of a glTF's accessors, every access checked. Private to io.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/gltf_document.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::io::detail {

/// How many vertices and triangles a scene may still bring in, over all copies of its meshes. A few bytes of JSON can
/// ask for billions.
class GeometryBudget {
 public:
  /// False if `elements` more would pass the limit.
  [[nodiscard]] bool take(std::size_t elements) noexcept;

 private:
  static constexpr std::size_t limit = 20'000'000;  // assumed: a scanned office has a few million
  std::size_t left_ = limit;
};

/// All triangles of a mesh in its own frame. Faults name the mesh and stand at the accessor or primitive; what isn't
/// triangles is left out with a warning.
[[nodiscard]] TriMesh read_mesh(const GltfDocument& document, int mesh, GeometryBudget& budget, Diagnostics& remarks);

/// The same in parts that are equally warm, in the order in which they come; temperatures_c: (n_materials).
[[nodiscard]] std::vector<TriMesh> read_mesh_parts(const GltfDocument& document, int mesh,
                                                   std::span<const std::optional<double>> temperatures_c,
                                                   GeometryBudget& budget, Diagnostics& remarks);
/// All triangles of the parts; without a temperature if there are several.
[[nodiscard]] TriMesh joined(const std::vector<TriMesh>& parts);

/// The mesh moved, scaled or mirrored, under a new name; its triangles stay counter-clockwise seen from outside.
[[nodiscard]] TriMesh transformed(const TriMesh& mesh, const glm::dmat4& transform, std::string name);

}  // namespace pirsim::io::detail
