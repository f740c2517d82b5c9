// `effects:` of a script.
#pragma once

#include <vector>

#include "io/yaml_node.hpp"
#include "pirsim/script.hpp"

namespace pirsim::io {

/// Items are `name` or `name: {parameter: number, choice: text}`. What names mean is the catalogue's business.
[[nodiscard]] std::vector<EffectSpec> read_effects(const std::vector<YamlNode>& items, Diagnostics& faults);

}  // namespace pirsim::io
