// Resolves what the people of a script do against the scene, and finds out whether they can do it.
#pragma once

#include <vector>

#include "rt/room.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

/// Throws Error(input) with every unknown name and impossible order at once, then Error(infeasible) for the first
/// places that can't be reached. study: all but its trials; trials: with all effects, which may have added people at
/// the end. Who is larger than the script says gets through where the person of the script does, turning sideways if
/// need be. like: a study whose floors are shared where they are the same, or null.
[[nodiscard]] std::vector<TrialModel> plan_people(const CompiledStudy& study, const std::vector<TrialInForce>& trials,
                                                  const CompiledStudy* like);

}  // namespace pirsim::sim
