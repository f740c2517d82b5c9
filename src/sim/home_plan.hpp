// A household's day as actions in a scene: which places what is drawn takes.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "sim/home_draw.hpp"
#include "sim/schedule.hpp"

namespace pirsim::sim {

/// How an activity is told and done: the rows' phase, how somebody of natural style moves, and marks' words for places
/// to do it, the best first.
struct HomeManner {
  const char* phase;
  std::optional<Activity> activity;
  std::vector<std::string_view> uses;
};
[[nodiscard]] HomeManner manner_of(HomeActivity activity);

/// Whether the scene has a place to do it: one whose mark says so, or a seat for anything.
[[nodiscard]] bool has_place_for(const SceneSpec& scene, HomeActivity activity);

/// Residents lie in bed when the day begins. Whatever they do, they do at a place for it, or at a seat for anything;
/// two share no place at one time. Where the scene has none that is free they stay where they are. The run is of a
/// trial with a household.
[[nodiscard]] DayPlan plan_home_day(const CompiledStudy& study, std::uint32_t run);

}  // namespace pirsim::sim
