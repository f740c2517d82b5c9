// Whether tracked positions are metres and seconds of this room.
#pragma once

#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim {

/// Of a script's `occupancy: positions`, a warning a file: nobody is ever over the floor, steps that nobody can take, a
/// walk that is hardly a walk, everybody in a small part of the floor; with what the numbers look like, if one unit or
/// axis makes more of them.
[[nodiscard]] std::vector<Issue> doubts_of_positions(const SceneSpec& scene, const ScriptSpec& script);

}  // namespace pirsim
