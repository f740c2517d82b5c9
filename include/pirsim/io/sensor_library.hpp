// Sensor models by name.
#pragma once

#include <filesystem>
#include <string>

#include "pirsim/io/scene_reader.hpp"
#include "pirsim/schema/sensor_model_spec.hpp"

namespace pirsim::io {

/// The model that a sensor of this scene would get. Throws Error(input) for a name that no folder has.
[[nodiscard]] SensorModelSpec find_sensor_model(const std::string& model, const std::filesystem::path& scene_file,
                                                const SceneOptions& options = {});

}  // namespace pirsim::io
