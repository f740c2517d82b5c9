// Draws the days of a schedule: who comes when, what they do, and when they leave.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pirsim/schedule.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

/// Actions of every person of a trial on one day, in the order of its people; times are seconds of the run.
using DayPlan = std::vector<std::vector<ScriptedAction>>;

/// The day that a run simulates: replicates are days that follow each other. The same seed gives the same days.
/// trial: one with a schedule. People without a part in it keep the actions that they have.
[[nodiscard]] DayPlan draw_day(const CompiledStudy& study, const TrialModel& trial, std::uint32_t run);

/// Rates of a Markov chain over places from the share of time spent in each and the mean stay, in any one unit of time:
/// (i x n + j) is the rate from i to j. Solves x_i (sum x - x_i) = share_i / stay_i. Ref: [ChenHongLuo2018].
[[nodiscard]] std::vector<double> markov_rates(const std::vector<double>& shares, const std::vector<double>& stays);

}  // namespace pirsim::sim
