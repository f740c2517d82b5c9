// Doors with leaves: their marks, what is refused and warned of.
#include "gltf_builder.hpp"
#include "support/catch.hpp"
#include "support/door_scene.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

json door(const std::string& id = "D") { return {{"type", "door"}, {"id", id}}; }

std::string door_fault(const json& mark, const json& place = json::object()) {
  return fault_of([&] {
    GltfBuilder scene;
    scene.floor();
    scene.node("leaf", GltfBuilder::marked(mark, place));
    return scene.read();
  });
}

/// Of the scene of two rooms, written and read again.
SceneSpec again(const SceneSpec& scene) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "two_rooms.gltf";
  io::write_scene(file, scene);
  return io::read_scene(file, {{data_dir() / "sensors"}});
}
std::string door_warnings(const SceneSpec& scene) {
  std::string text;
  for (const Issue& issue : again(scene).warnings) text += to_string(issue) + '\n';
  return text;
}

}  // namespace

TEST_CASE("a door's mark says where it is and how it turns", "[scene]") {
  json mark = door("bath");
  mark.update({{"width_m", 0.7}, {"hinge", "right"}, {"opens", "outward"}, {"state", "shut"}, {"open_deg", 110}});
  GltfBuilder scene;
  scene.floor();
  scene.node("leaf", GltfBuilder::marked(mark, {{"translation", {1, 0, -2}}}));
  const SceneSpec spec = scene.read();
  REQUIRE(spec.doors.size() == 1);
  const DoorSpec& read = spec.doors.front();
  CHECK(read.id == "bath");
  CHECK(read.world_from_door.origin == Vec3(1, 0, -2));
  CHECK(read.width_m == 0.7);
  CHECK(read.hinge == DoorHinge::right);
  CHECK(read.opens == DoorOpens::outward);
  CHECK(read.state == DoorState::shut);
  CHECK(read.open_deg == 110.0);
  CHECK(read.height_m == 2.0);
}

TEST_CASE("what a door's mark can't say is refused in one line", "[scene]") {
  json mark = door();
  mark["hinge"] = "lefft";
  CHECK_THAT(door_fault(mark),
             contains("node 'leaf': 'hinge' is \"lefft\", not one of left, right (did you mean 'left'?)"));
  mark = door();
  mark["state"] = 1;
  CHECK_THAT(door_fault(mark), contains("'state' is 1, not one of open, shut, habit"));
  mark = door();
  mark["open_deg"] = 270;
  CHECK_THAT(door_fault(mark), contains("'open_deg' must be a number of degrees from 5.0 to 180.0"));
  mark = door();
  mark["hinges"] = "left";
  CHECK_THAT(door_fault(mark), contains("unknown key 'hinges' (did you mean 'hinge'?)"));
  CHECK_THAT(door_fault({{"type", "door"}}), contains("door without 'id'"));
  CHECK_THAT(door_fault(door(), {{"rotation", {0.7071067811865476, 0, 0, 0.7071067811865476}}}),
             contains("must stand upright"));
}

TEST_CASE("two doors differ in their ids, and a sensor may have one of them", "[scene]") {
  SceneSpec scene = two_rooms({inner_door(DoorState::shut), front_door(DoorState::shut)});
  CHECK(again(scene).doors.size() == 2);
  scene.doors[1].id = "inner";
  CHECK_THAT(fault_of([&] { return again(scene); }), contains("door id 'inner' is taken by node 'inner'"));
  scene.doors[1].id = scene.sensors[0].id;
  CHECK(again(scene).doors[1].id == scene.sensors[0].id);
  scene.doors.pop_back();
  scene.sensors[0].id = "door_inner";
  CHECK_THAT(fault_of([&] { return again(scene); }), contains("begins as the columns of doors do: 'door_'"));
}

TEST_CASE("doors are written as they are read", "[scene]") {
  DoorSpec door = inner_door(DoorState::open);
  door.hinge = DoorHinge::right;
  door.shut_share = 0.25;
  const SceneSpec read = again(two_rooms({door}));
  REQUIRE(read.doors.size() == 1);
  CHECK(read.doors[0].hinge == DoorHinge::right);
  CHECK(read.doors[0].state == DoorState::open);
  CHECK(read.doors[0].shut_share == 0.25);
  CHECK(glm::distance(read.doors[0].world_from_door.forward(), Vec3(1, 0, 0)) < 1e-6);
}

TEST_CASE("what a door hardly means is told in one line", "[scene]") {
  const DoorSpec fits = inner_door(DoorState::shut);
  CHECK_THAT(door_warnings(two_rooms({fits, front_door(DoorState::shut)})), !contains("door"));
  DoorSpec door = fits;
  door.world_from_door.origin.x = 4.5;
  CHECK_THAT(door_warnings(two_rooms({door})), contains("door 'inner' is in no wall"));
  door = fits;
  door.width_m = 1.2;
  CHECK_THAT(door_warnings(two_rooms({door})),
             contains("door 'inner': 'wall' stands in 0.") && contains("of its leaf's width of 1.20 m"));
  door = fits;
  door.id = "other";
  door.world_from_door.origin.z = 0.05;
  CHECK_THAT(door_warnings(two_rooms({fits, door})), contains("door 'other' is at the place of door 'inner'"));
  SceneSpec scene = two_rooms({fits});
  scene.seats = {{"S1", {rotation_from_heading(0.0), Vec3(3.8, 0.45, 0.2)}}};
  CHECK_THAT(door_warnings(scene), contains("door 'inner': its leaf hits who sits on seat 'S1'"));
  scene = two_rooms({fits});
  scene.doors[0].world_from_door.origin.y = 0.3;
  CHECK_THAT(door_warnings(scene), contains("door 'inner' isn't on the floor, but 0.30 m above it"));
}

TEST_CASE("a door within one area is told of, one between two isn't", "[scene]") {
  SceneSpec scene = two_rooms({inner_door(DoorState::shut), front_door(DoorState::shut)});
  scene.areas = {{"east", FloorArea({{{3, -2}, {6, -2}, {6, 2}, {3, 2}}}, 0.0)}};
  CHECK_THAT(door_warnings(scene), !contains("between two areas"));  // the other side is in none
  scene.areas.front().outline = FloorArea({{{1, -2}, {6, -2}, {6, 2}, {1, 2}}}, 0.0);
  CHECK_THAT(door_warnings(scene),
             contains("door 'inner' doesn't lie between two areas: both of its sides are 'east'"));
}
