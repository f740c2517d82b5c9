// Marks beside a scene: the same room as with marks in its nodes, the model's unit, axes and origin, and every fault
// with its place.
#include "gltf_builder.hpp"
#include "model/schema/fingerprint.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

using pirsim::SceneSpec;
using pirsim::Vec3;
using namespace pirsim::test;

namespace {

const std::vector<float> box_corners{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 2, 1, 0, 2, 1, 1, 2, 0, 1, 2};
const std::vector<std::uint16_t> box_triangles{0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                               3, 7, 6, 3, 6, 2, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5};

/// A model as others make it: a desk, a radiator, panes in a group, nothing marked.
GltfBuilder model() {
  GltfBuilder scene;
  const int box = scene.mesh(scene.positions(box_corners), scene.indices(box_triangles));
  scene.node("Desk", {{"mesh", box}, {"translation", {1, 0, -3}}});
  scene.node("Radiator_1", {{"mesh", box}, {"translation", {-4, 0, -4}}});
  const int pane = scene.child("pane", {{"mesh", box}, {"translation", {3, 0, 3}}});
  const int inner = scene.child("frame", {{"children", {pane}}});
  scene.node("front_glass", {{"children", {inner}}});
  return scene;
}

struct Read {
  SceneSpec scene;
  std::string fault;  ///< "accepted", or what the Error says; files without their folder
};

Read read_marked(const GltfBuilder& scene, const std::string& marks) {
  const TemporaryFolder folder;
  const auto file = folder.write("model.gltf", scene.text()), beside = folder.write("marks.yaml", marks);
  Read result;
  result.fault = fault_of([&] {
    result.scene = pirsim::io::read_scene(file, {{pirsim::test::data_dir() / "sensors"}, {}, beside});
    return 0;
  });
  const std::string prefix = folder.path().string() + '/';
  for (std::size_t at = 0; (at = result.fault.find(prefix)) != std::string::npos;)
    result.fault.erase(at, prefix.size());
  return result;
}

const std::string version = "pirsim_marks: 1\n";
const std::string floor_of_10_m = "floors: [{polygon_xz_m: [[-5, -5], [5, -5], [5, 5], [-5, 5]]}]\n";

std::string digest(SceneSpec scene) {
  pirsim::Fingerprint print;
  print.add(scene);
  return print.digest();
}

}  // namespace

TEST_CASE("marks in a file make the room that marks in nodes make", "[marks]") {
  GltfBuilder marked = model();
  json& nodes = marked.root["nodes"];
  nodes[1]["extras"]["pirsim"] = {{"type", "surface"}, {"temperature_c", 45}};
  nodes[2]["extras"]["pirsim"] = {{"type", "ignore"}};
  marked.floor();
  marked.node("eye", GltfBuilder::marked({{"type", "sensor"}, {"id", "PIR1"}, {"model", "EKMC1604111"}, {"gain", 1.5}},
                                         {{"translation", {0, 2.5, 0}}, {"rotation", {-0.5, 0.5, 0.5, 0.5}}}));
  marked.node("chair", GltfBuilder::marked({{"type", "seat"}, {"id", "7"}},
                                           {{"translation", {1.5, 0.45, 0}}, {"rotation", {0, 1, 0, 0}}}));
  marked.node("door", GltfBuilder::marked({{"type", "entrance"}, {"id", "door"}, {"width_m", 1.1}},
                                          {{"translation", {0, 0, 5}}}));
  const Read beside = read_marked(model(), version + floor_of_10_m +
                                               "ignore: [\"*_glass\"]\n"
                                               "nodes: {\"Radiator_?\": {type: surface, temperature_c: 45}}\n"
                                               "sensors:\n"
                                               "- {id: PIR1, model: EKMC1604111, gain: 1.5, position_m: [0, 2.5, 0], "
                                               "yaw_deg: 90, tilt_deg: 90}\n"
                                               "seats: [{id: 7, position_m: [1.5, 0.45, 0], direction: [0, 0, 3]}]\n"
                                               "entrances: [{id: door, width_m: 1.1, position_m: [0, 0, 5]}]\n");
  REQUIRE(beside.fault == "accepted");
  const SceneSpec inside = marked.read();
  CHECK(beside.scene.warnings.size() == inside.warnings.size());
  REQUIRE(beside.scene.sensors.size() == 1);
  const pirsim::Frame &one = inside.sensors[0].world_from_sensor, &other = beside.scene.sensors[0].world_from_sensor;
  check_vector(other.forward(), one.forward());
  check_vector(other.up(), one.up());
  check_vector(beside.scene.seats.at(0).world_from_seat.forward(), {0, 0, 1});
  // The frames are the same to the last digits; with one for the other the rooms are the same in every digit.
  SceneSpec same = beside.scene;
  same.sensors[0].world_from_sensor = one;
  same.seats[0].world_from_seat = inside.seats.at(0).world_from_seat;
  CHECK(digest(same) == digest(inside));
  REQUIRE(beside.scene.files.size() == 3);  // the model, its marks, the sensor
  CHECK(beside.scene.files[1].path.ends_with("marks.yaml"));
}

TEST_CASE("unit, axis and origin of a model lead to the room as by hand", "[marks]") {
  const auto corner = [](const std::string& keys) {
    GltfBuilder scene;
    const int point = scene.mesh(scene.positions({100, 200, 300, 101, 200, 300, 100, 201, 300}));
    scene.node("piece", {{"mesh", point}});
    const Read given = read_marked(scene, version + keys + floor_of_10_m);
    INFO(given.fault);
    REQUIRE(given.scene.meshes.size() == 1);
    return given.scene.meshes[0].positions[0];
  };
  check_vector(corner("unit: cm\n"), {1, 2, 3});
  check_vector(corner("unit: mm\n"), {0.1, 0.2, 0.3});
  check_vector(corner("unit: in\n"), {2.54, 5.08, 7.62});
  check_vector(corner("unit: ft\n"), {30.48, 60.96, 91.44});
  check_vector(corner("scale: 0.02\n"), {2, 4, 6});
  check_vector(corner("up: z\n"), {100, 300, -200});
  check_vector(corner("up: x\n"), {-200, 100, 300});
  check_vector(corner("unit: cm\nup: z\norigin_m: [1, 0.5, -1]\n"), {0, 2.5, -1});
}

TEST_CASE("a model's own marks hold beside those of a file, and go with its unit", "[marks]") {
  GltfBuilder scene = model();
  scene.node("chair", GltfBuilder::marked({{"type", "seat"}, {"id", "S1"}}, {{"translation", {200, 45, -100}}}));
  const Read given =
      read_marked(scene, version + floor_of_10_m + "unit: cm\nseats: [{id: S2, position_m: [0, 0.45, 0]}]\n");
  REQUIRE(given.fault == "accepted");
  REQUIRE(given.scene.seats.size() == 2);
  check_vector(given.scene.seats[0].world_from_seat.origin, {2, 0.45, -1});
  check_vector(given.scene.seats[1].world_from_seat.origin, {0, 0.45, 0});
}

TEST_CASE("what is ignored isn't loaded, with all that is below it", "[marks]") {
  const Read given = read_marked(model(), version + floor_of_10_m + "ignore: [front*, Desk]\n");
  REQUIRE(given.fault == "accepted");
  REQUIRE(given.scene.meshes.size() == 1);
  CHECK(given.scene.meshes[0].name == "Radiator_1");
}

TEST_CASE("a floor may be a mesh of the model", "[marks]") {
  GltfBuilder scene;
  scene.node("Slab.001", {{"mesh", scene.mesh(scene.positions({0, 0, 0, 0, 0, -3, 4, 0, -3, 4, 0, 0}),
                                              scene.indices<std::uint16_t>({0, 2, 1, 0, 3, 2}))}});
  const Read given = read_marked(scene, version + "nodes: {Slab*: {type: floor}}\n");
  REQUIRE(given.fault == "accepted");
  CHECK(given.scene.floor.area_m2() == Approx(12.0));
}

TEST_CASE("a direction is that of view, straight down too", "[marks]") {
  const auto forward = [](const std::string& direction) {
    const Read given =
        read_marked(model(), version + floor_of_10_m + "sensors: [{id: P, model: EKMC1604111, position_m: [0, 2, 0], " +
                                 direction + "}]\n");
    INFO(given.fault);
    return given.scene.sensors.at(0).world_from_sensor.forward();
  };
  check_vector(forward("direction: [0, -1, 0]"), {0, -1, 0});
  check_vector(forward("direction: [3, 0, 4]"), {0.6, 0, 0.8});
  check_vector(forward("direction: [-1, -1, 0]"), Vec3(-1, -1, 0) / std::sqrt(2.0));
  check_vector(forward("yaw_deg: 90"), {-1, 0, 0});
}

TEST_CASE("every fault of marks has its place and the nearest name", "[marks]") {
  const auto fault = [](const std::string& text) { return read_marked(model(), version + text).fault; };
  using Catch::Matchers::Contains;
  CHECK_THAT(
      fault(floor_of_10_m + "ignore: [radiator_1, Desc]\n"),
      Contains("marks.yaml:3:10: error: ignore: no node of the scene is called 'radiator_1' (did you mean "
               "'Radiator_1'?)") &&
          Contains("marks.yaml:3:22: error: ignore: no node of the scene is called 'Desc' (did you mean 'Desk'?)"));
  CHECK_THAT(fault(floor_of_10_m + "nodes: {\"*_glas\": {type: ignore}}\n"), Contains("(did you mean 'front_glass'?)"));
  CHECK_THAT(
      fault(floor_of_10_m + "nodes: {Desk: {type: surface, temperatur_c: 3}}\n"),
      Contains("marks.yaml:3:31: error: nodes: 'Desk': unknown key 'temperatur_c' (did you mean 'temperature_c'?)"));
  CHECK_THAT(fault(floor_of_10_m + "nodes: {front_glass: {type: surface, temperature_c: 3}}\n"),
             Contains("a surface needs a mesh at its node"));
  CHECK_THAT(fault(floor_of_10_m + "nodes: {D*: {type: ignore}, Desk: {type: ignore}}\n"),
             Contains("marks.yaml:3:29: error: nodes: 'Desk': node 'Desk' is marked already in marks.yaml:3:13"));
  CHECK_THAT(fault(floor_of_10_m + "sensor: []\n"), Contains("marks.yaml:3:1: error:") && Contains("'sensors'"));
  CHECK_THAT(fault(floor_of_10_m + "seats: [{id: A, positon_m: [0, 0, 0]}]\n"),
             Contains("marks.yaml:3:17: error: seat 'A': unknown key 'positon_m' (did you mean 'position_m'?)") &&
                 Contains("'position_m' is missing"));
  CHECK_THAT(fault(floor_of_10_m + "seats: [{id: A, position_m: [0, 0, 0], tilt_deg: 3}]\n"),
             Contains("unknown key 'tilt_deg'"));
  CHECK_THAT(fault(floor_of_10_m + "seats: [{id: A, position_m: [0, 0, 0], direction: [1, 1, 0]}]\n"),
             Contains("marks.yaml:3:9: error: seat 'A': must stand upright"));
  CHECK_THAT(fault(floor_of_10_m + "seats:\n- {id: A, position_m: [0, 0, 0]}\n- {id: A, position_m: [1, 0, 0]}\n"),
             Contains("marks.yaml:5:8: error: seat 'A': seat id 'A' is taken by seat 'A' in marks.yaml:4:8"));
  CHECK_THAT(fault(floor_of_10_m + "sensors: [{id: A, model: EKMC160411, position_m: [0, 1, 0]}]\n"),
             Contains("marks.yaml:3:26: error:") && Contains("EKMC1604111"));
  CHECK_THAT(fault("unit: cm\nscale: 2\n"), Contains("marks.yaml:3:8: error: scale: 'unit' says it already"));
  CHECK_THAT(fault("unit: yd\n"), Contains("marks.yaml:2:7: error: marks: unit: expected one of m, cm, mm, in, ft"));
  CHECK_THAT(fault("scale: 0\n"), Contains("marks.yaml:2:8: error: marks: scale: expected"));
  CHECK_THAT(fault("up: w\n"), Contains("marks.yaml:2:5: error: marks: up: expected one of x, y, z"));
  CHECK_THAT(fault("floors: [{polygon_xz_m: [[0, 0], [1, 0]]}]\n"), Contains("at least three points"));
  CHECK_THAT(fault("floors: [{position_m: [0, 0, 0]}]\n"), Contains("floor"));
  CHECK_THAT(fault("floors: {a: 1}\n"), Contains("marks.yaml:2:9: error:"));
  CHECK_THAT(fault("nodes: [Desk]\n"), Contains("marks.yaml:2:8: error: nodes: expected a map"));
  CHECK_THAT(fault("nodes: {Desk: warm}\n"), Contains("expected a mark"));
  CHECK_THAT(fault(""), Contains("the scene has no floor area"));
}

TEST_CASE("two marks of one id or one node are told with both places", "[marks]") {
  GltfBuilder scene = model();
  scene.node("chair", GltfBuilder::marked({{"type", "seat"}, {"id", "S1"}}, {{"translation", {2, 0.45, -1}}}));
  using Catch::Matchers::Contains;
  CHECK_THAT(read_marked(scene, version + floor_of_10_m + "seats: [{id: S1, position_m: [0, 0.45, 0]}]\n").fault,
             Contains("marks.yaml:3:14: error: seat 'S1': seat id 'S1' is taken by node 'chair' in model.gltf:"));
  CHECK_THAT(read_marked(scene, version + floor_of_10_m + "nodes: {chair: {type: ignore}}\n").fault,
             Contains("marks.yaml:3:16: error: nodes: 'chair': node 'chair' has a mark of its own in model.gltf:"));
  scene.root["nodes"][0]["extras"]["pirsim"] = {{"type", "surface"}, {"temperature_c", 45}};
  CHECK_THAT(
      read_marked(scene, version + floor_of_10_m + "ignore: [D*]\n").fault,
      Contains("marks.yaml:3:10: error: ignore: 'D*': node 'Desk' has a mark that needs its mesh in model.gltf:"));
}

TEST_CASE("a hidden node's mark in a file is told, and ignoring it is silent", "[marks]") {
  GltfBuilder scene = model();
  scene.root["nodes"][1]["extensions"]["KHR_node_visibility"] = {{"visible", false}};
  const auto warnings = [&](const std::string& text) {
    std::string all;
    for (const pirsim::Issue& issue : read_marked(scene, version + floor_of_10_m + text).scene.warnings)
      all += issue.message;
    return all;
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(warnings("nodes: {Radiator_1: {type: seat, id: S1}}\n"), Contains("is hidden and left out: seat 'S1'"));
  CHECK_THAT(warnings(""), Contains("is hidden"));
  CHECK_THAT(warnings("ignore: [Radiator_1]\n"), !Contains("is hidden"));
}

TEST_CASE("patterns match as globs do", "[marks]") {
  GltfBuilder scene;
  for (const char* name : {"a", "ab", "abc", "a*c", "wall (2)"}) {
    scene.node(name, {{"mesh", scene.mesh(scene.positions({0, 0, 0, 1, 0, 0, 0, 1, 0}))}});
  }
  const auto left = [&](const std::string& pattern) {
    std::string names;
    for (const pirsim::TriMesh& mesh :
         read_marked(scene, version + floor_of_10_m + "ignore: [\"" + pattern + "\"]\n").scene.meshes)
      names += mesh.name + ' ';
    return names;
  };
  CHECK(left("a") == "ab abc a*c wall (2) ");
  CHECK(left("a?") == "a abc a*c wall (2) ");
  CHECK(left("a*c") == "a ab wall (2) ");
  CHECK(left("*b*") == "a a*c wall (2) ");
  CHECK(left("*(2)") == "a ab abc a*c ");
  CHECK(left("**") == "");
}
