// One entry of a person's `actions`.
#pragma once

#include "io/yaml_node.hpp"
#include "pirsim/script.hpp"

namespace pirsim::io {

/// `- sit: S1`, with `at_s` and `phase` beside the action where wanted; `- rise` alone may be a plain word.
[[nodiscard]] ScriptedAction read_action(const YamlNode& node, Diagnostics& faults);

}  // namespace pirsim::io
