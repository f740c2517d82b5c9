// Rooms from glTF 2.0 files. How a room is marked up: docs/formats/scene.md.
#pragma once

#include <filesystem>
#include <vector>

#include "pirsim/schema/scene_spec.hpp"

namespace pirsim::io {

struct SceneOptions {
  /// Where `<model>.yaml` of a sensor is looked for first; then in `sensors` beside the scene and beside its folder,
  /// in `$PIRSIM_DATA_DIR/sensors`, in `sensors` of the data_directories and in the installed data.
  std::vector<std::filesystem::path> sensor_directories;
  std::vector<std::filesystem::path> data_directories{};
};

/// Reads a .gltf or .glb file with everything it refers to. Meshes are in world coordinates and cleaned.
/// Throws Error(io) for a file that can't be read and Error(input) with all faults of the file that could be told
/// apart; what was repaired or ignored stands in SceneSpec::warnings.
[[nodiscard]] SceneSpec read_scene(const std::filesystem::path& file, const SceneOptions& options = {});

}  // namespace pirsim::io
