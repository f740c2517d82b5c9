// From one tick's triggers to a window's bits: the one way, of runs as they go and of remembered zones.
#pragma once

#include "pirsim/effects/stage.hpp"

namespace pirsim::sim {

/// triggers: (n_sensors) what the detectors said at this tick, changed by the effects; bits: (n_sensors) collects them.
inline void add_triggers(effects::Pipeline& pipeline, std::int64_t tick, std::span<std::uint8_t> triggers,
                         std::span<std::uint8_t> bits) noexcept {
  pipeline.tick(tick, triggers);
  for (std::size_t sensor = 0; sensor < bits.size(); ++sensor) bits[sensor] |= triggers[sensor];
}

}  // namespace pirsim::sim
