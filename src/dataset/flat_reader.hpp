// Ranges of flats as YAML: homes of a recipe, and the options of `pirsim room --home`.
#pragma once

#include "io/read/yaml_map.hpp"
#include "pirsim/flat.hpp"

namespace pirsim::dataset {

/// Reads the keys of a FlatSpec; the caller finishes the map.
[[nodiscard]] FlatSpec read_flat_keys(io::YamlMap& map);

}  // namespace pirsim::dataset
