// Areas of the floor: their marks, what is refused and warned of, and which of them a sensor watches.
#include "gltf_builder.hpp"
#include "model/schema/check_scene.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

json area(const std::string& id, double x0, double z0, double x1, double z1) {
  return {{"type", "area"}, {"id", id}, {"polygon_xz_m", {{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}}}};
}

/// The floor of 10 m x 10 m around the origin with these marks.
GltfBuilder scene_of_areas(const std::vector<json>& marks) {
  GltfBuilder scene;
  scene.floor();
  for (const json& mark : marks) scene.node("a " + mark.value("type", ""), GltfBuilder::marked(mark));
  return scene;
}
std::string area_fault(const std::vector<json>& marks) {
  return fault_of([&] { return scene_of_areas(marks).read(); });
}
std::string warnings(const std::vector<json>& marks) {
  std::string text;
  for (const Issue& issue : scene_of_areas(marks).read().warnings) text += to_string(issue) + '\n';
  return text;
}

json sensor(const std::string& id) { return {{"type", "sensor"}, {"id", id}, {"model", "EKMC1604111"}}; }

/// In words, of a sensor that hangs at (x, z) and looks along the heading, between two areas that meet at x = 0.
std::string watched_from(double x, double z, double yaw_deg, const std::string& said = "", double tilt_deg = 20.0) {
  SceneSpec scene = scene_of_areas({area("left", -5, -5, 0, 5), area("right", 0, -5, 4, 5)}).read();
  SensorSpec spec{"PIR", "EKMC1604111", mounted({x, 2.0, z}, yaw_deg, tilt_deg)};
  if (!said.empty()) spec.area = said;
  scene.sensors = {spec};
  return std::string(Areas(scene).name_of_sensor(0));
}

}  // namespace

TEST_CASE("areas are read from polygons and from flat meshes, which hide nothing unless they are said to", "[scene]") {
  GltfBuilder scene;
  scene.floor();
  scene.node("one", GltfBuilder::marked(area("kitchen", -5, -5, 0, 5)));
  const int mesh = scene.mesh(scene.positions({0, 0, -5, 0, 0, 5, 5, 0, 5, 5, 0, -5}),
                              scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
  scene.node("two",
             GltfBuilder::marked({{"type", "area"}, {"id", "hall"}}, {{"mesh", mesh}, {"translation", {0, 0.02, 0}}}));
  const SceneSpec spec = scene.read();
  REQUIRE(spec.areas.size() == 2);
  CHECK(spec.areas[0].id == "kitchen");
  CHECK(spec.areas[1].outline.area_m2() == Approx(50.0));
  CHECK(spec.meshes.empty());
  CHECK(Areas(spec).names() == std::vector<std::string>{"kitchen", "hall"});  // they share the floor out
  scene.root["nodes"].back()["extras"]["pirsim"]["occludes"] = true;
  CHECK(scene.read().meshes.size() == 1);
}

TEST_CASE("what of the floor is in no area is a part of its own", "[scene]") {
  const SceneSpec spec = scene_of_areas({area("kitchen", -5, -5, 0, 5)}).read();
  CHECK(Areas(spec).names() == std::vector<std::string>{"kitchen", "elsewhere"});
  CHECK(Areas(spec).areas_m2() == std::vector<double>{50.0, 50.0});
  CHECK(Areas(scene_of_areas({}).read()).empty());
}

TEST_CASE("faulty areas are refused with their names, one line each", "[scene]") {
  const json kitchen = area("kitchen", -5, -5, 0, 5);
  CHECK_THAT(area_fault({kitchen, area("hall", -1, 0, 5, 5)}),
             contains("area 'hall' overlaps area 'kitchen' by 5.00 m2"));
  CHECK_THAT(area_fault({{{"type", "area"}, {"id", "hall"}}}),
             contains("an area needs a mesh at its node, or 'polygon_xz_m'"));
  CHECK_THAT(area_fault({{{"type", "area"}, {"id", "hall"}, {"polygon_xz_m", {{0, 0}, {2, 2}, {2, 0}, {0, 2}}}}}),
             contains("the outline of the area crosses itself"));
  CHECK_THAT(area_fault({{{"type", "area"}, {"id", "hall"}, {"polygon_xz_m", {{0, 0}, {2, 2}}}}}),
             contains("three points"));
  CHECK_THAT(area_fault({area("hall", 6, 0, 8, 2)}), contains("area 'hall' lies off the floor"));
  CHECK_THAT(area_fault({kitchen, area("kitchen", 0, 0, 1, 1)}), contains("area id 'kitchen' is taken by"));
  CHECK_THAT(area_fault({{{"type", "area"}, {"polygon_xz_m", {{0, 0}, {2, 0}, {2, 2}}}}}),
             contains("area without 'id'"));
  CHECK_THAT(area_fault({area("time_s", 0, 0, 1, 1)}), contains("area id 'time_s' is the name of a column of rows"));
  CHECK_THAT(area_fault({area("elsewhere", 0, 0, 1, 1)}), contains("the floor that is in no area"));
  CHECK_THAT(area_fault({sensor("people_kitchen"), kitchen}), contains("begins as the columns of areas do: 'people_'"));
  json watcher = sensor("PIR1");
  watcher["area"] = "kitchn";
  CHECK_THAT(area_fault({kitchen, watcher}), contains("there is no area 'kitchn' (did you mean 'kitchen'?)"));
  CHECK_THAT(area_fault({watcher}), contains("there is no area 'kitchn': the scene has none"));
  GltfBuilder high = scene_of_areas({});
  high.node("up", GltfBuilder::marked(kitchen, {{"translation", {0, 0.5, 0}}}));
  CHECK_THAT(fault_of([&] { return high.read(); }), contains("area 'kitchen' lies 0.50 m above the floor"));
}

TEST_CASE("an area that sticks out of the floor is told of, by how much, unless it is meant so", "[scene]") {
  json hall = area("hall", 3, 0, 6, 1);
  CHECK_THAT(warnings({hall}), contains("1.00 m2 of area 'hall' (33 %) lie off the floor"));
  hall["as_meant"] = true;
  CHECK_THAT(warnings({hall}), !contains("lie off the floor"));
  CHECK_THAT(warnings({area("hall", 3, 0, 5, 1)}), !contains("lie off the floor"));
}

TEST_CASE("a sensor watches the area below it, on a wall the one that it faces, or the one that it names", "[scene]") {
  CHECK(watched_from(-2, 0, 0) == "left");
  CHECK(watched_from(2, 0, 90) == "right");      // looks left, along -x, but hangs over the right one
  CHECK(watched_from(0, 0, 90) == "left");       // on the border
  CHECK(watched_from(0, 0, -90) == "right");     // back to back with it
  CHECK(watched_from(-5.05, 0, -90) == "left");  // in the wall
  CHECK(watched_from(2, 5.1, 0) == "right");
  CHECK(watched_from(4.5, 0, 180, "", 90) == "elsewhere");  // on the ceiling
  CHECK(watched_from(2, 7, 0) == "elsewhere");
  CHECK(watched_from(-2, 0, 0, "right") == "right");
}

TEST_CASE("areas and what sensors watch are written as they are read", "[scene]") {
  SceneSpec scene = shipped_scene("two_rooms.gltf");
  scene.sensors[1].area = "living_room";
  const TemporaryFolder folder;
  io::write_scene(folder.path() / "scene.gltf", scene);
  const SceneSpec read = io::read_scene(folder.path() / "scene.gltf");
  REQUIRE(read.areas.size() == 2);
  CHECK(read.areas[1].id == "bedroom");
  CHECK(read.areas[1].outline.loops() == scene.areas[1].outline.loops());
  CHECK_FALSE(read.sensors[0].area);
  CHECK(read.sensors[1].area == "living_room");
}

TEST_CASE("areas that a program made are refused as those of files are", "[scene]") {
  const auto refusal = [](const SceneSpec& scene) {
    Diagnostics diagnostics;
    check(scene, diagnostics);
    return diagnostics.has_errors() ? diagnostics.issues().front().message : std::string();
  };
  SceneSpec scene = shipped_scene("two_rooms.gltf");
  CHECK(refusal(scene).empty());
  SceneSpec overlapping = scene;
  overlapping.areas.push_back({"third", overlapping.areas[0].outline});
  CHECK_THAT(refusal(overlapping), contains("scene.areas[2].outline") && contains("overlaps area 'living_room'"));
  SceneSpec unknown = scene;
  unknown.sensors[0].area = "bedrom";
  CHECK_THAT(refusal(unknown), contains("scene.sensors[0].area") && contains("did you mean 'bedroom'"));
  SceneSpec empty = scene;
  empty.areas[0].outline = {};
  CHECK_THAT(refusal(empty), contains("scene.areas[0].outline") && contains("no outline"));
}
