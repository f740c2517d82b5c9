#include "io/read/model_parts.hpp"

#include <map>
#include <utility>

#include "core/grouped_warnings.hpp"
#include "io/read/gltf_geometry.hpp"
#include "io/read/marks_file.hpp"

namespace pirsim::io {

ModelParts read_model_parts(const std::filesystem::path& file) {
  Diagnostics remarks;
  GroupedWarnings warnings;
  const detail::GltfDocument document = detail::load_gltf(file, remarks);
  const detail::PlacedNodes placed = detail::place_nodes(document, remarks);
  remarks.throw_if_errors();
  detail::GeometryBudget budget;
  ModelParts model;
  std::map<int, int> parents;     // by node of the file
  std::map<int, TriMesh> meshes;  // by mesh of the file
  for (const detail::PlacedNode& shown : placed.shown) {
    const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(shown.node)];
    const auto above = parents.find(shown.node);
    const int place = static_cast<int>(model.nodes.size());
    for (const int child : node.children) parents.emplace(child, place);
    model.nodes.push_back({detail::node_name(document.model, shown.node), above == parents.end() ? -1 : above->second});
    if (node.mesh < 0) continue;
    const auto [known, is_first] = meshes.try_emplace(node.mesh);
    if (is_first) known->second = detail::read_mesh(document, node.mesh, budget, remarks, warnings);
    if (known->second.triangles.empty()) continue;
    if (!is_first && !budget.take(known->second.positions.size() + known->second.triangles.size()))
      remarks.error({file.string()}, "the copies of its meshes make the scene too large");
    remarks.throw_if_errors();
    model.parts.push_back({place, detail::transformed(known->second, shown.world_from_node, model.nodes.back().name)});
  }
  remarks.throw_if_errors();
  warnings.tell(remarks);
  model.warnings = remarks.warnings();
  return model;
}

}  // namespace pirsim::io
