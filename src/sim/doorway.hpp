// Where people stand who come in through an entrance, and where they go on to.
#pragma once

#include "body/humanoid.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::sim {

/// Where they wait and come into being.
[[nodiscard]] inline Vec2 outside_of(const EntranceSpec& door) {
  return floor_point(door.world_from_entrance * Vec3(0, 0, door.outside_m));
}
/// Where they stop who only come in.
[[nodiscard]] inline Vec2 inside_of(const EntranceSpec& door, const body::Humanoid& humanoid) {
  return floor_point(door.world_from_entrance * Vec3(0, 0, -2.0 * humanoid.clearance_radius_m()));
}

}  // namespace pirsim::sim
