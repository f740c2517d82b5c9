// Everything that changes during one run: people, what the optics show, detectors, logger.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pirsim/sample.hpp"
#include "sim/crowd.hpp"
#include "sim/detector.hpp"
#include "sim/logger.hpp"
#include "sim/scratch.hpp"
#include "sim/sensor_array.hpp"
#include "sim/zone_cache.hpp"

namespace pirsim::sim {

/// A value: a copy goes on by itself from the same moment. The study outlives it.
struct RunState {
  /// The moment before the first tick of a run, run in [0, study.n_runs()).
  RunState(const CompiledStudy& study, std::uint32_t run);

  [[nodiscard]] Exposure& exposure() noexcept { return exposures[static_cast<std::size_t>(tick % 2)]; }
  [[nodiscard]] const Exposure& exposure() const noexcept { return exposures[static_cast<std::size_t>(tick % 2)]; }

  std::uint32_t run = 0;
  std::int64_t tick = 0;
  bool finished = false;  ///< everybody has carried out all actions and the last window is complete
  Crowd crowd;
  std::array<Exposure, 2> exposures;  ///< of this tick and of the one before, by turns
  Detector detector;
  Logger logger;
  std::int64_t empty_ticks = 0;        ///< for how many of the latest ticks nobody was there
  bool at_rest = false;                ///< nothing changes before somebody comes
  std::optional<std::int64_t> day;     ///< since 1970-01-01, of a schedule
  std::vector<std::uint8_t> triggers;  ///< (n_sensors) at this tick
  Sample sample;                       ///< at the end of the last whole window
  /// What has been traced before; changes no result. Made when first needed, unless whoever runs many lends theirs.
  Scratch<std::shared_ptr<ZoneCache>> cache;
};

/// Advances people alone by a tick: what sensors do stays as it is. For a state that isn't stepped otherwise. True if
/// a window ended with it.
bool move_tick(const CompiledStudy& study, RunState& state);
/// Advances one tick: people, optics, detectors, logger. True if a window ended with it.
bool step_tick(const CompiledStudy& study, RunState& state);
/// Advances by a window in which nobody is there and nobody comes, at next to no cost, to what step_tick() comes to in
/// as many ticks, bit for bit. False, and nothing done, if there may be somebody.
bool pass_empty_window(const CompiledStudy& study, RunState& state);

}  // namespace pirsim::sim
