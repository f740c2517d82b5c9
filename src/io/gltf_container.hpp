// The file behind a glTF: plain JSON, or chunks in a .glb, and buffers in files beside it. Private to io.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/json_text.hpp"

namespace pirsim::io::detail {

struct GltfContainer {
  enum class Kind { json, binary };
  Kind kind = Kind::json;
  std::string json;
  std::vector<unsigned char> binary_chunk;  ///< of a .glb, may be empty
  std::vector<std::string> files{};         ///< all that was read
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
