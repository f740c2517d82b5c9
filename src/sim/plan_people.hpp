// Resolves what the people of a script do against the scene, and finds out whether they can do it.
#pragma once

#include <vector>

#include "rt/room.hpp"
#include "sim/model.hpp"

namespace pirsim::sim {

/// Throws Error(input) with every unknown name and impossible order at once, then Error(infeasible) for the first
/// places that can't be reached. as_written: before effects, which may add people at the end. Who is larger than the
/// script says gets through where the person of the script does, turning sideways if need be. like: a Model whose
/// floors are shared where they are the same, or null.
[[nodiscard]] std::vector<TrialModel> plan_people(const SceneSpec& scene, const ScriptSpec& script,
                                                  const ScriptSpec& as_written, const rt::Room& room,
                                                  const Model* like);

}  // namespace pirsim::sim
