// What a room looks like: what its meshes are, and its plan seen from above.
#pragma once

#include "io/pages/charts.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::studies {

enum class MeshRole { ceiling, wall, floor, furniture };
/// By its size and height alone: tall or high things are walls and ceilings, flat ones on the floor are the floor.
[[nodiscard]] MeshRole role_of(const TriMesh& mesh, double floor_height_m);

/// Walls are cut through a metre above the floor, where doors and most windows are open. Furniture is outlined by the
/// convex hulls of its connected pieces.
[[nodiscard]] io::RoomPlan plan_of(const SceneSpec& scene);

/// What the signs of a report's maps mean, where their markers are sensors.
inline constexpr const char* signs_of_maps =
    "Red triangles are sensors and white ones seats, both pointing the way they face; a name is left out where there "
    "is "
    "no room for it, then point at the seat. A green line is a door, dotted lines are furniture, black areas are "
    "walls, "
    "the solid line is the floor's edge.";

}  // namespace pirsim::studies
