// The `schedule` of a script as YAML.
#pragma once

#include <yaml-cpp/yaml.h>

#include "pirsim/schedule.hpp"

namespace pirsim::io {

/// What read_schedule() reads back to the same schedule.
[[nodiscard]] YAML::Node to_node(const ScheduleSpec& schedule);

}  // namespace pirsim::io
