// From one tick's triggers to what is read of them: the one way, of runs as they go and of remembered zones.
#pragma once

#include "pir/window_reader.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/script.hpp"

namespace pirsim::sim {

[[nodiscard]] inline pir::WindowReader make_reader(Reader kind, std::size_t n_sensors, std::int32_t ticks_per_window,
                                                   std::uint64_t seed, std::uint32_t run) {
  if (kind == Reader::in_step) return {std::vector<std::int32_t>(n_sensors, 0), ticks_per_window};
  return {pir::drawn_leads(n_sensors, ticks_per_window, seed, run), ticks_per_window};
}

/// triggers: (n_sensors) what the detectors said at this tick, changed by the effects.
inline void add_triggers(effects::Pipeline& pipeline, std::int64_t tick, std::span<std::uint8_t> triggers,
                         pir::WindowReader& reader) noexcept {
  pipeline.tick(tick, triggers);
  reader.advance(triggers);
}

}  // namespace pirsim::sim
