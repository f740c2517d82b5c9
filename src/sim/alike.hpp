// What two studies have in common, decided from what their specs say, not from how they came to differ.
#pragma once

#include "sim/compiled_study.hpp"

namespace pirsim::sim {

/// Whether two scenes have the same surfaces: rays end alike in both.
[[nodiscard]] bool same_meshes(const SceneSpec& a, const SceneSpec& b);
/// Whether two scenes have the same floor, entrances and solid meshes: one can walk alike in both.
[[nodiscard]] bool same_ground(const SceneSpec& a, const SceneSpec& b);
/// Would the people of `like` be planned and move the same in `study`, whose trials with all effects these are?
[[nodiscard]] bool same_people(const CompiledStudy& like, const CompiledStudy& study,
                               const std::vector<TrialInForce>& trials);

}  // namespace pirsim::sim
