// Two rooms with a door between them, made of numbers.
#pragma once

#include <string>
#include <vector>

#include "support/random_scene.hpp"
#include "support/shipped.hpp"

namespace pirsim::test {

/// West: x from 0 to 3, east: x from 3 to 6; z from -2 to 2. A wall of 0.1 m with an opening 0.9 m wide and 2.05 m high
/// around (3, 0); -Z of a door there leads east. PIR1 hangs at the east wall and looks at the opening, PIR2 at the
/// entrance from the ceiling in the west, whose opening is as large.
inline SceneSpec two_rooms(std::vector<DoorSpec> doors) {
  SceneSpec scene = shipped_scene("meeting_room.gltf");
  scene.name = "two rooms";
  constexpr double height_m = 2.6, gap_m = 0.45, lintel_m = 2.05, wall_m = 0.05;
  scene.floor = FloorArea({{{0, -2}, {6, -2}, {6, 2}, {0, 2}}}, 0.0);
  scene.meshes.clear();
  const auto box = [&](const std::string& name, const Vec3& low, const Vec3& high) {
    scene.meshes.push_back(pirsim::testing::box_mesh(low, high));
    scene.meshes.back().name = name;
  };
  box("south", {-0.1, 0, -2.1}, {6.1, height_m, -2});
  box("north", {-0.1, 0, 2}, {6.1, height_m, 2.1});
  box("east", {6, 0, -2}, {6.1, height_m, 2});
  for (const double x : {0.0, 3.0}) {
    box("wall", {x - wall_m, 0, -2}, {x + wall_m, height_m, -gap_m});
    box("wall", {x - wall_m, 0, gap_m}, {x + wall_m, height_m, 2});
    box("lintel", {x - wall_m, lintel_m, -gap_m}, {x + wall_m, height_m, gap_m});
  }
  scene.seats.clear();
  const Quat east = rotation_from_heading(heading_of(Vec2(1, 0))),
             west = rotation_from_heading(heading_of(Vec2(-1, 0)));
  scene.entrances = {EntranceSpec{"in", {east, Vec3(0)}, 0.9, 1.5}};
  scene.sensors.resize(2);
  scene.sensors[0].world_from_sensor = {west, Vec3(5.9, 1.5, 0)};
  scene.sensors[1].world_from_sensor = {east * glm::angleAxis(radians(-30.0), Vec3(1, 0, 0)), Vec3(0.1, 2.4, 1.5)};
  for (DoorSpec& door : doors) {
    door.world_from_door.rotation = east;
    door.world_from_door.origin.y = 0.0;
  }
  scene.doors = std::move(doors);
  return scene;
}

/// In the middle of the opening between the rooms.
inline DoorSpec inner_door(DoorState state) {
  DoorSpec door;
  door.id = "inner";
  door.world_from_door.origin = {3, 0, 0};
  door.width_m = 0.9;
  door.state = state;
  return door;
}
inline DoorSpec front_door(DoorState state) {
  DoorSpec door = inner_door(state);
  door.id = "front";
  door.world_from_door.origin = {0, 0, 0};
  return door;
}

}  // namespace pirsim::test
