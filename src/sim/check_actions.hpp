// What can be said about a script's actions without moving anybody.
#pragma once

#include "pirsim/scene.hpp"
#include "schema/study_in_force.hpp"

namespace pirsim::sim {

/// Throws Error(input) with all faults: unknown seats and entrances (with the nearest name), actions before the
/// person is there, work without a seat, times that run backwards.
void check_actions(const SceneSpec& scene, const std::vector<TrialInForce>& trials);

}  // namespace pirsim::sim
