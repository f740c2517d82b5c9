#include "io/read/reader_parts.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "geom/triangle_surface.hpp"
#include "io/read/gltf_geometry.hpp"

namespace pirsim::io::detail {
namespace {

/// What is left of a node's transform within its own frame: scale and mirroring.
glm::dmat4 scale_of(const glm::dmat4& world_from_node) {
  const Frame node_from_world = inverse(rigid_frame(world_from_node));
  return glm::translate(glm::dmat4(1.0), node_from_world.origin) * glm::mat4_cast(node_from_world.rotation) *
         world_from_node;
}

class BodyBuilder {
 public:
  BodyBuilder(const std::filesystem::path& file, Diagnostics& faults)
      : faults_(faults), document_(load_gltf(file, faults)) {}

  [[nodiscard]] const std::vector<InputFile>& files() const noexcept { return document_.files; }
  BodyMeshes build() {
    const PlacedNodes nodes = place_nodes(document_, faults_);
    for (const PlacedNode& placed : nodes.shown) {
      if (document_.model.nodes[static_cast<std::size_t>(placed.node)].mesh >= 0) add_part(placed);
    }
    for (const HiddenNode& hidden : nodes.hidden) error(hidden.node, "", "it is hidden, and a body's parts can't be");
    warnings_.tell(faults_);
    if (meshes_.empty() && !faults_.has_errors()) faults_.error(document_.text.where(""), "no node has a mesh");
    return std::move(meshes_);
  }

 private:
  void add_part(const PlacedNode& placed) {
    const auto& node = document_.model.nodes[static_cast<std::size_t>(placed.node)];
    const std::string name_fault = body_part_fault(node.name);
    if (!name_fault.empty()) return error(placed.node, node.name.empty() ? "" : "/name", name_fault);
    if (meshes_.contains(node.name)) return error(placed.node, "/name", "a second mesh for this part");
    const TriMesh local = read_mesh(document_, node.mesh, budget_, faults_, warnings_);
    TriMesh part = clean(transformed(local, scale_of(placed.world_from_node), node.name)).mesh;
    if (part.triangles.empty()) return error(placed.node, "/mesh", "its mesh has no triangle with an area");
    const std::string size_fault = body_mesh_fault(part);
    if (!size_fault.empty()) return error(placed.node, "/mesh", size_fault);
    meshes_[node.name] = MeshSolid{std::make_shared<const TriangleSurface>(std::move(part))};
  }

  void error(int node, const std::string& member, const std::string& message) {
    faults_.error(document_.text.where("/nodes/" + std::to_string(node) + member),
                  node_label(document_.model, node) + ": " + message);
  }

  Diagnostics& faults_;
  GltfDocument document_;
  GeometryBudget budget_;
  GroupedWarnings warnings_;
  BodyMeshes meshes_;
};

}  // namespace

BodyMeshes BodyMeshReader::read(const std::string& file, const Where& where, Diagnostics& faults) {
  if (file.empty()) return {};
  const auto [known, is_first] = known_.try_emplace(file);
  if (!is_first) return known->second;
  const NamedFile named = beside_.find(file, DataKind::rooms);
  if (!named.fault.empty()) {
    faults.error(where, "body_mesh: " + named.fault);
    return {};
  }
  try {
    BodyBuilder body(named.path, faults);
    files_.insert(files_.end(), body.files().begin(), body.files().end());
    known->second = body.build();
  } catch (const Error& fault) {
    for (const Issue& issue : fault.issues()) faults.error(issue.where, issue.message);
  }
  return known->second;
}

}  // namespace pirsim::io::detail
