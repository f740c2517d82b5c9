// Resolves what the people of a script do against the scene, and finds out whether they can do it. People walk through
// their actions in thought, one after the other, each as if alone in the room.
#pragma once

#include <vector>

#include "body/humanoid.hpp"
#include "pirsim/scene.hpp"
#include "schema/study_in_force.hpp"
#include "sim/compiled_study.hpp"

namespace pirsim::sim {

/// Throws Error(input) with every unknown name and impossible order at once, then Error(infeasible) for the first
/// places that can't be reached. study: all but its trials; trials: with all effects, which may have added people at
/// the end. Who is larger than the script says gets through where the person of the script does, turning sideways if
/// need be. like: a study whose floors are shared where they are the same, or null.
[[nodiscard]] std::vector<TrialModel> plan_people(const CompiledStudy& study, const std::vector<TrialInForce>& trials,
                                                  const CompiledStudy* like);

// Where people stand who come in through an entrance.

/// Where they wait and come into being.
[[nodiscard]] inline Vec2 outside_of(const EntranceSpec& door) {
  return floor_point(door.world_from_entrance * Vec3(0, 0, door.outside_m));
}
/// Where they stop who only come in.
[[nodiscard]] inline Vec2 inside_of(const EntranceSpec& door, const body::Humanoid& humanoid) {
  return floor_point(door.world_from_entrance * Vec3(0, 0, -2.0 * humanoid.clearance_radius_m()));
}

// What can be said about a script's actions without moving anybody.

/// Throws Error(input) with all faults: unknown seats and entrances (with the nearest name), actions before the
/// person is there, work without a seat, times that run backwards.
void check_actions(const SceneSpec& scene, const std::vector<TrialInForce>& trials);

}  // namespace pirsim::sim
