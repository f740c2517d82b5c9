// Triangles and transforms out of a glTF document, every access checked. Private to io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/read/gltf_document.hpp"
#include "model/core/error.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::io::detail {

// Elements of one accessor: plain, interleaved, sparse, quantised.

/// Reads accessors after checking type, component type, count and every byte range. A fault is added to the
/// diagnostics and gives an empty result; nothing is allocated before the bytes are known to be there.
class AccessorReader {
 public:
  AccessorReader(const GltfDocument& document, Diagnostics& faults) : document_(document), faults_(faults) {}

  /// VEC3 of floats, or of integers (KHR_mesh_quantization), finite.
  [[nodiscard]] std::vector<Vec3> positions(int accessor);
  /// SCALAR of unsigned integers.
  [[nodiscard]] std::vector<std::uint32_t> indices(int accessor);
  [[nodiscard]] std::size_t count(int accessor) const;

 private:
  /// Bytes of `count` elements, `stride` apart.
  struct Range {
    const unsigned char* data = nullptr;
    std::size_t stride = 0;
  };
  [[nodiscard]] bool locate(int view, std::size_t byte_offset, std::size_t element_size, std::size_t count,
                            const std::string& pointer, Range& range);
  [[nodiscard]] bool check_type(int accessor, int type, const char* what);
  [[nodiscard]] bool read_components(int accessor, std::size_t n_components, std::vector<double>& values);
  [[nodiscard]] bool apply_sparse(int accessor, std::size_t n_components, std::vector<double>& values);
  bool fault(const std::string& pointer, const std::string& message);

  const GltfDocument& document_;
  Diagnostics& faults_;
};

/// How many vertices and triangles a scene may still bring in, over all copies of its meshes. A few bytes of JSON can
/// ask for billions.
class GeometryBudget {
 public:
  /// False if `elements` more would pass the limit.
  [[nodiscard]] bool take(std::size_t elements) noexcept;

 private:
  std::size_t left_ = limits::scene_elements;
};

/// All triangles of a mesh in its own frame. Faults name the mesh and stand at the accessor or primitive; what isn't
/// triangles is left out with a warning.
[[nodiscard]] TriMesh read_mesh(const GltfDocument& document, int mesh, GeometryBudget& budget, Diagnostics& faults,
                                GroupedWarnings& warnings);

/// Reads a mesh in parts that are equally warm, in the order in which they come; temperatures_c: (n_materials).
[[nodiscard]] std::vector<TriMesh> read_mesh_parts(const GltfDocument& document, int mesh,
                                                   std::span<const std::optional<double>> temperatures_c,
                                                   GeometryBudget& budget, Diagnostics& faults,
                                                   GroupedWarnings& warnings);
/// All triangles of the parts; without a temperature if there are several.
[[nodiscard]] TriMesh joined(const std::vector<TriMesh>& parts);

/// The mesh moved, scaled or mirrored, under a new name; its triangles stay counter-clockwise seen from outside.
[[nodiscard]] TriMesh transformed(const TriMesh& mesh, const glm::dmat4& transform, std::string name);

// The node hierarchy of the scene that is shown, flattened into world transforms.

struct PlacedNode {
  int node = 0;  ///< index into `nodes`
  glm::dmat4 world_from_node{1.0};
};

/// A node that isn't shown, by KHR_node_visibility or by a scale of zero along all axes, with all that is below it.
struct HiddenNode {
  int node = 0;                 ///< index into `nodes`
  std::vector<int> below = {};  ///< all nodes below it, in file order
};

struct PlacedNodes {
  std::vector<PlacedNode> shown;   ///< children after parents, in file order
  std::vector<HiddenNode> hidden;  ///< the topmost of each hidden part
};

/// ": a marks file ... brings it here", of a place before any origin is taken away.
[[nodiscard]] std::string brought_here(const Vec3& place);

enum class Reach { world, anywhere };  ///< how far from the origin a node may be that has a mesh or a mark
/// Nodes of the default scene. Faults: no scene, a node below itself or below two parents, transforms that are
/// singular, not finite or out of reach. world_from_file: what the whole file is turned, scaled and moved by.
[[nodiscard]] PlacedNodes place_nodes(const GltfDocument& document, Diagnostics& remarks,
                                      const glm::dmat4& world_from_file = glm::dmat4(1.0), Reach reach = Reach::world);

/// The rigid part of a transform: looks along its -Z exactly, +Y as near as it can be; scale and mirroring drop out.
[[nodiscard]] Frame rigid_frame(const glm::dmat4& world_from_node);

}  // namespace pirsim::io::detail
