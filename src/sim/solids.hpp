// People as the solids that sensors see.
#pragma once

#include <vector>

#include "pirsim/shapes.hpp"
#include "sim/actor.hpp"

namespace pirsim::sim {

/// Appends the thirteen posed solids of a posture, or of a person if present, in the order of body::Part.
void append_solids(const body::Humanoid& humanoid, const body::Posture& posture, std::vector<PosedShape>& solids);
void append_solids(const Actor& actor, std::vector<PosedShape>& solids);

}  // namespace pirsim::sim
