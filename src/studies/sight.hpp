// What each sensor can see of a standing and a seated person: the report of `pirsim check`.
#pragma once

#include <string>
#include <vector>

#include "pirsim/look.hpp"
#include "pirsim/model.hpp"

namespace pirsim::studies {

/// Stands a person (the script's first, or the default one) on every place of a grid and on every seat.
[[nodiscard]] SightReport look_around(const Model& model);

/// "it hangs outside of the room, 70.0 m from the floor's edge", or empty: on a wall is as good as inside.
[[nodiscard]] std::string hangs_outside(const FloorArea& floor, const Vec3& place);

/// Of sensors that see nothing, a warning for each reason; none where it follows from the scene's unit.
[[nodiscard]] std::vector<Issue> warnings(const SightReport& report, const SceneSpec& scene);

}  // namespace pirsim::studies
