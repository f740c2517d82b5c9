// An occupancy's counts as actions in a room.
#pragma once

#include <cstdint>

#include "sim/compiled_study.hpp"
#include "sim/schedule.hpp"

namespace pirsim::sim {

/// Finds where people stand once all seats are taken. A fault: more people than the room holds. trial: with its people
/// planned.
void plan_occupancy(TrialModel& trial, const SceneSpec& scene, Diagnostics& faults);

/// The actions of everybody in a run of a trial with counts. People without a part in it keep the actions that they
/// have. Times are such that somebody alone crosses the floor's edge at the moment that was drawn.
[[nodiscard]] DayPlan draw_occupancy(const CompiledStudy& study, std::uint32_t run);

}  // namespace pirsim::sim
