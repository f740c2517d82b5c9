// The `schedule` of a script.
#pragma once

#include <optional>

#include "io/yaml_node.hpp"
#include "pirsim/schedule.hpp"

namespace pirsim::io {

[[nodiscard]] std::optional<ScheduleSpec> read_schedule(const std::optional<YamlNode>& node, Diagnostics& faults);

}  // namespace pirsim::io
