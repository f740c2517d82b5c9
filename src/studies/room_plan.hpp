// What a room looks like: what its meshes are, and its plan seen from above.
#pragma once

#include <string>

#include "io/pages/charts.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::studies {

enum class MeshRole { ceiling, wall, floor, furniture };
/// By its size and height alone: tall or high things are walls and ceilings, flat ones on the floor are the floor.
[[nodiscard]] MeshRole role_of(const TriMesh& mesh, double floor_height_m);

/// Walls are cut through a metre above the floor, where doors and most windows are open. Furniture is outlined by the
/// convex hulls of its connected pieces.
[[nodiscard]] io::RoomPlan plan_of(const SceneSpec& scene);

[[nodiscard]] io::RoomPlan::Marker marker_of(const SensorSpec& sensor);

/// What the signs of a report's maps mean, where their markers are sensors.
[[nodiscard]] std::string signs_of_maps(const SceneSpec& scene);

}  // namespace pirsim::studies
