// The `sensing` block, which all kinds of studies share. Private to io.
#pragma once

#include <optional>

#include "io/yaml_node.hpp"
#include "pirsim/script.hpp"

namespace pirsim::io {

[[nodiscard]] SensingSpec read_sensing(const std::optional<YamlNode>& node, Diagnostics& faults);

}  // namespace pirsim::io
