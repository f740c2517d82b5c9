// A glTF file in memory: its JSON with places, what pirsim reads of it as tinygltf's structures, and its buffers.
// Private to io.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <string>
#include <vector>

#include "io/json_text.hpp"

namespace pirsim::io::detail {

struct GltfDocument {
  std::string file;  ///< as messages name it
  JsonText text;
  tinygltf::Model model;             ///< scenes, nodes, meshes, accessors, buffer views and buffers only
  std::vector<std::string> files{};  ///< all that was read: the file and those of its buffers
};

/// Reads a .gltf or .glb (told apart by content). Indices between top-level arrays are in range afterwards;
/// accessors are not yet checked against their buffers. Warnings go to `remarks`.
[[nodiscard]] GltfDocument load_gltf(const std::filesystem::path& file, Diagnostics& remarks);

/// "node 'PIR1'" or "node 4".
[[nodiscard]] std::string node_label(const tinygltf::Model& model, int node);
[[nodiscard]] std::string mesh_label(const tinygltf::Model& model, int mesh);

}  // namespace pirsim::io::detail
