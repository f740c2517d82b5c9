// What light goes by, row by row, as bits: who is where, and which sensor moved it. People don't depend on sensors, so
// what a set of sensors does to light follows from the columns of its sensors, whichever run they are from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "control/light_switch.hpp"
#include "pirsim/error.hpp"
#include "pirsim/look.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/survey.hpp"

namespace pirsim::studies {

/// Rows as bits, 64 a word; unused ones are 0.
using RowBits = std::vector<std::uint64_t>;

/// Of one run, which begins in the dark.
struct LightRun {
  std::size_t n_rows = 0;
  std::vector<RowBits> occupied;  ///< (n_areas)
  std::vector<RowBits> moved;     ///< (n_sensors)
};

struct LightRows {
  double window_s = 1.0;
  std::vector<std::string> areas;                   ///< without areas one, without a name
  std::vector<std::string> sensors;                 ///< ids
  std::vector<std::optional<std::size_t>> area_of;  ///< (n_sensors) that the sensor watches; none: none of them
  std::vector<LightRun> runs;
  std::vector<Issue> warnings;  ///< of runs that can't go on, which are left out
};

/// Called with the runs done and their number, from one thread at a time; what it throws ends the work.
using RunsDone = std::function<void(std::size_t n_done, std::size_t n_runs)>;

/// Runs all trials of the light's people in sight of the scene's sensors. sensing: of the study, whose response, if it
/// says one, replaces the script's. Throws Error as compile() and run_study() do.
[[nodiscard]] LightRows light_rows(
    const SceneSpec& scene, const PlacementLightSpec& light, const SensingSpec& sensing, unsigned threads = 0,
    const RunsDone& done = [](std::size_t, std::size_t) {});

/// What becomes of an area's light, in rows.
struct LightSums {
  std::int64_t occupied = 0, false_offs = 0, dark = 0, lit_empty = 0;
  LightSums& operator+=(const LightSums& other) noexcept;
  /// False-offs first, then time in the dark, then empty light. Occupied rows don't count: they are the same.
  [[nodiscard]] bool better_than(const LightSums& other) const noexcept;
  bool operator==(const LightSums&) const = default;
};

/// Switches an area's light by any of these sensors.
[[nodiscard]] LightSums switch_light(const LightRows& rows, std::size_t area, std::span<const std::size_t> sensors,
                                     const PlacementLightSpec& light);

/// Of all sensors: each area's light, and all together.
struct LightScore {
  PlacementLight all;
  std::vector<PlacementLight> areas;  ///< that have people or sensors
};
[[nodiscard]] LightScore score_light(const LightRows& rows, const PlacementLightSpec& light);

}  // namespace pirsim::studies
