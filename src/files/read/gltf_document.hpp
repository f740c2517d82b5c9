// A glTF file in memory: its JSON with places, what pirsim reads of it as tinygltf's structures, and its buffers.
// Private to io.
#pragma once

#include <tiny_gltf.h>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "files/read/json_text.hpp"
#include "files/read/yaml.hpp"
#include "pirsim/input_file.hpp"

namespace pirsim::io::detail {

constexpr std::size_t max_faults = 20;  ///< told at once; a broken exporter would make thousands

struct GltfDocument {
  std::string file;  ///< as messages name it
  JsonText text;
  tinygltf::Model model;           ///< scenes, nodes, meshes, accessors, buffer views and buffers only
  std::vector<InputFile> files{};  ///< all that was read: the file and those of its buffers
};

/// Reads a .gltf or .glb (told apart by content). Indices between top-level arrays are in range afterwards;
/// accessors are not yet checked against their buffers. Warnings go to `remarks`.
[[nodiscard]] GltfDocument load_gltf(const std::filesystem::path& file, Diagnostics& remarks);

/// Of nodes that aren't shown, nor anything below them.
inline constexpr const char* visibility_extension = "KHR_node_visibility";

/// "node 'PIR1'" or "node 4".
[[nodiscard]] std::string node_label(const tinygltf::Model& model, int node);
[[nodiscard]] std::string mesh_label(const tinygltf::Model& model, int mesh);

// The parts of a glTF JSON that pirsim reads, checked for type, size and reference.

/// Adds a fault for every member that pirsim reads whose type, size or reference is not as glTF asks. Buffers' contents
/// are not looked at.
void check_structure(const JsonText& text, Diagnostics& faults);

// The file behind a glTF: plain JSON, or chunks in a .glb, and buffers in files beside it.

struct GltfContainer {
  enum class Kind { json, binary };
  Kind kind = Kind::json;
  std::string json;
  std::vector<unsigned char> binary_chunk;  ///< of a .glb, may be empty
  std::vector<InputFile> files{};           ///< all that was read
};

/// Throws Error(io) for a missing or unreadable file, Error(input) for a file that is no glTF or is cut short.
[[nodiscard]] GltfContainer read_container(const std::filesystem::path& file);

/// Contents of all `buffers`, at least `byteLength` long each. Files are read from the scene's folder only: no
/// absolute paths, no `..`, no links that lead out. Faults are added and leave an empty buffer. Names of files go to
/// the container.
[[nodiscard]] std::vector<std::vector<unsigned char>> read_buffers(const JsonText& text, GltfContainer& container,
                                                                   const std::filesystem::path& folder,
                                                                   Diagnostics& faults);

}  // namespace pirsim::io::detail

// What kind of file one is, told by the key of its format's version. Private to io and dataset.

namespace pirsim::io {

/// "a walk test: `pirsim walktest --script` takes it", of a text with such a key at the beginning of a line; or "".
[[nodiscard]] std::string kind_of_text(std::string_view text);
/// Throws Error(input) if the file lacks the key that it should have, and has that of another kind.
void refuse_other_kinds(const YamlMap& map, const std::string& version_key);

}  // namespace pirsim::io
