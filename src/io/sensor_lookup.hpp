// Which file describes a sensor model. Private to io.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pirsim/io.hpp"

namespace pirsim::io::detail {

/// `first`, then `sensors` in the scene's folder and beside it, `$PIRSIM_DATA_DIR/sensors`, the installed data.
[[nodiscard]] std::vector<std::filesystem::path> sensor_directories(const SceneOptions& options,
                                                                    const std::filesystem::path& scene_folder);

/// Empty if no folder has `<model>.yaml`.
[[nodiscard]] std::filesystem::path find_sensor_file(const std::string& model,
                                                     const std::vector<std::filesystem::path>& directories);

/// Names of all models in the folders, sorted, each once.
[[nodiscard]] std::vector<std::string> available_sensor_models(const std::vector<std::filesystem::path>& directories);

}  // namespace pirsim::io::detail
