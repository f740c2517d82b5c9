// Ranges of rooms as YAML: `rooms:` of a recipe, and the options of `pirsim room`.
#pragma once

#include "io/read/yaml_map.hpp"
#include "pirsim/room.hpp"

namespace pirsim::dataset {

/// Reads the keys of a RoomSpec; the caller finishes the map.
[[nodiscard]] RoomSpec read_room_keys(io::YamlMap& map);

/// A number, or a list of the least and the most; `otherwise` if the key isn't there.
[[nodiscard]] Range read_range(io::YamlMap& map, const std::string& key, const Range& otherwise, NumberRange limits);
[[nodiscard]] CountRange read_count(io::YamlMap& map, const std::string& key, const CountRange& otherwise,
                                    IntegerRange limits);

}  // namespace pirsim::dataset
