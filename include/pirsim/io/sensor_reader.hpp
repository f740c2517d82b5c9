// Reads a sensor's optics; the format is docs/formats/sensor.md.
#pragma once

#include <filesystem>

#include "pirsim/schema/sensor_model_spec.hpp"

namespace pirsim::io {

/// data/sensors/*.yaml. Facets with a zone law are expanded to zones' corners. Throws Error (io, input).
[[nodiscard]] SensorModelSpec read_sensor_model(const std::filesystem::path& path);

}  // namespace pirsim::io
