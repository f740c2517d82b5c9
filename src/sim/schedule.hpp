// A schedule's day as actions in a room: what was drawn as times and places, with the seats and ways that it takes.
#pragma once

#include <cstdint>
#include <vector>

#include "pirsim/schedule.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

struct DayDraw;

/// Actions of every person of a trial on one day, in the order of its people; times are seconds of the run.
using DayPlan = std::vector<std::vector<ScriptedAction>>;

/// Days since 1970-01-01 of the day that a run simulates: replicates are days that follow each other.
[[nodiscard]] std::int64_t day_of(const CompiledStudy& study, std::uint32_t run);

/// The times and places of that day. The same seed gives the same days. The run is of a trial with a schedule.
[[nodiscard]] DayDraw draw_times(const CompiledStudy& study, std::uint32_t run);
/// The actions of that day. People without a part in the schedule keep the actions that they have.
[[nodiscard]] DayPlan draw_day(const CompiledStudy& study, std::uint32_t run);

}  // namespace pirsim::sim
