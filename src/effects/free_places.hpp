// Where in a room something more has its place.
#pragma once

#include <vector>

#include "pirsim/scene.hpp"

namespace pirsim::effects {

/// Points of a grid on the floor with `clear_m` to everything solid below a person's height, to seats and to
/// entrances; the one farthest from all seats first. Empty in a room without such a place.
[[nodiscard]] std::vector<Vec2> free_places(const SceneSpec& scene, double clear_m);
/// The place itself if it is within a cell of the grid of a free one, else the nearest of these; the place if none is.
[[nodiscard]] Vec2 nearest_free(const SceneSpec& scene, double clear_m, const Vec2& place);

}  // namespace pirsim::effects
