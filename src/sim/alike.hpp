// What two studies have in common, decided from what their specs say, not from how they came to differ.
#pragma once

#include "sim/model.hpp"

namespace pirsim::sim {

/// The same surfaces: rays end alike.
[[nodiscard]] bool same_meshes(const SceneSpec& a, const SceneSpec& b);
/// The same floor, entrances and solid meshes: one can walk alike.
[[nodiscard]] bool same_ground(const SceneSpec& a, const SceneSpec& b);
/// Would the people of `like` be planned and move the same in this study? scene and script with their effects applied;
/// as_written: before.
[[nodiscard]] bool same_people(const Model& like, const SceneSpec& scene, const ScriptSpec& script,
                               const ScriptSpec& as_written);

}  // namespace pirsim::sim
