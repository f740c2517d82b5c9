// What a room looks like: what its meshes are, and its plan seen from above.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/scene.hpp"
#include "pirsim/state.hpp"
#include "show/charts.hpp"
#include "show/png.hpp"

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

// A picture of a room with its people and beams.

/// What a picture explains beside the room itself: where they are, and their ids; what its colours mean.
enum class Mark { seats, doors, areas, sensors, people, scale, key };
inline constexpr std::array all_marks{Mark::seats,  Mark::doors, Mark::areas, Mark::sensors,
                                      Mark::people, Mark::scale, Mark::key};
[[nodiscard]] std::string_view name(Mark mark) noexcept;

struct PictureSpec {
  std::vector<std::size_t> beams_of;  ///< indices of sensors whose beams are drawn
  std::vector<Mark> marks{all_marks.begin(), all_marks.end()};
  std::optional<Vec3> camera, look_at;  ///< default: from above and beside, the whole floor in view
  double field_of_view_deg = 45.0;      ///< vertical
  int width = 1280, height = 720;       ///< pixels
};

/// The room as a doll's house, cut open towards the camera. Throws Error(usage) for a camera that can't be used.
[[nodiscard]] io::Pixels picture(const Model& model, const State& state, const PictureSpec& spec);

}  // namespace pirsim::studies
