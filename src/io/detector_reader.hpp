// A sensor file's element, amplifier and comparator.
#pragma once

#include <string>
#include <vector>

#include "io/yaml_map.hpp"
#include "pirsim/sensor.hpp"

namespace pirsim::io {

/// Reads the maps `element`, `amplifier` and `comparator` of a sensor file; what isn't there keeps its default.
[[nodiscard]] DetectorSpec read_detector(YamlMap& sensor);

/// The names of their keys that need a source.
[[nodiscard]] const std::vector<std::string>& sourced_detector_keys();

}  // namespace pirsim::io
