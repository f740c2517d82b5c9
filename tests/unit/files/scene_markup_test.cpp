// Sensors, seats, entrances and floors of the scene reader.
#include <glm/geometric.hpp>

#include "gltf_builder.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

using pirsim::SceneSpec;
using pirsim::Vec3;
using namespace pirsim::test;

namespace {

json sensor_mark(const std::string& id, const std::string& model = "EKMC1604111") {
  return {{"type", "sensor"}, {"id", id}, {"model", model}};
}

json polygon_floor(const json& points) { return {{"type", "floor"}, {"polygon_xz_m", points}}; }

std::string markup_fault(const GltfBuilder& scene) {
  return fault_of([&] { return scene.read(); });
}

}  // namespace

TEST_CASE("sensors keep their order and look along -Z with +Y up, whatever the scale above them", "[scene]") {
  const double h = std::sqrt(0.5);
  GltfBuilder scene;
  scene.floor();
  const int a = scene.child("a", GltfBuilder::marked(sensor_mark("Z9"), {{"translation", {1, 2, 3}}}));
  const int b = scene.child("b", GltfBuilder::marked(sensor_mark("A1"), {{"rotation", {-h, 0, 0, h}}}));
  scene.node("parent", {{"children", {a, b}}, {"scale", {2, 3, 4}}, {"rotation", {0, h, 0, h}}});
  const SceneSpec spec = scene.read();
  REQUIRE(spec.sensors.size() == 2);
  CHECK(spec.sensors[0].id == "Z9");
  const pirsim::Frame& first = spec.sensors[0].world_from_sensor;
  check_vector(first.origin, {12, 6, -2});  // scaled (2, 6, 12), then (z, y, -x)
  check_vector(first.forward(), {-1, 0, 0});
  check_vector(first.up(), {0, 1, 0});
  const pirsim::Frame& second = spec.sensors[1].world_from_sensor;  // turned to look down, top towards -Z, then left
  check_vector(second.forward(), {0, -1, 0});
  check_vector(second.up(), {-1, 0, 0});
  check_vector(second.right(), {0, 0, -1});
}

TEST_CASE("a mirrored sensor looks the mirrored way and stays a right-handed frame", "[scene]") {
  GltfBuilder scene;
  scene.floor();
  const double s = std::sin(0.25), c = std::cos(0.25);  // 0.5 rad to the left
  const int child = scene.child("eye", GltfBuilder::marked(sensor_mark("PIR1"), {{"rotation", {0, s, 0, c}}}));
  scene.node("mirror", {{"children", {child}}, {"scale", {-1, 1, 1}}});
  const SceneSpec spec = scene.read();
  const pirsim::Frame& frame = spec.sensors.at(0).world_from_sensor;
  check_vector(frame.forward(), {std::sin(0.5), 0, -std::cos(0.5)});
  check_vector(frame.up(), {0, 1, 0});
  check_vector(frame.right(), glm::cross(frame.forward(), frame.up()));
}

TEST_CASE("seats and entrances are read with their settings and defaults", "[scene]") {
  GltfBuilder scene;
  scene.floor();
  scene.node("chair", GltfBuilder::marked({{"type", "seat"}, {"id", "S1"}}, {{"translation", {1, 0.5, 2}}}));
  scene.node("door", GltfBuilder::marked({{"type", "entrance"}, {"id", "door"}}));
  scene.node("gate", GltfBuilder::marked({{"type", "entrance"}, {"id", "gate"}, {"width_m", 2.5}, {"outside_m", 3}}));
  const SceneSpec spec = scene.read();
  check_vector(spec.seats.at(0).world_from_seat.origin, {1, 0.5, 2});
  REQUIRE(spec.entrances.size() == 2);
  CHECK(spec.entrances[0].width_m == 0.9);
  CHECK(spec.entrances[0].outside_m == 1.5);
  CHECK(spec.entrances[1].width_m == 2.5);
  CHECK(spec.entrances[1].outside_m == 3.0);
}

TEST_CASE("markup may come as a text, as editors with custom properties write it", "[scene]") {
  GltfBuilder scene;
  scene.floor();
  scene.node("chair", GltfBuilder::marked("{\"type\": \"seat\", \"id\": \"S1\"}"));
  CHECK(scene.read().seats.at(0).id == "S1");
  scene.node("broken", GltfBuilder::marked("{\"type\": \"seat\""));
  CHECK_THAT(markup_fault(scene), contains("node 'broken': the text at 'pirsim' is not valid JSON: it ends too early"));
}

TEST_CASE("a floor mesh bounds the floor and occludes unless it says otherwise, ignored meshes do neither", "[scene]") {
  GltfBuilder scene;
  const int p = scene.positions({0, 0, 0, 4, 0, 0, 4, 0, -3, 0, 0, -3});
  const int mesh = scene.mesh(p, scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
  json mark = {{"type", "floor"}};
  const bool occludes = GENERATE(true, false);
  if (!occludes) mark["occludes"] = false;
  scene.node("floor", GltfBuilder::marked(mark, {{"mesh", mesh}, {"translation", {0, 0.2, 0}}}));
  scene.node("ghost", GltfBuilder::marked({{"type", "ignore"}}, {{"mesh", mesh}}));
  const SceneSpec spec = scene.read();
  CHECK(spec.floor.area_m2() == Approx(12.0));
  CHECK(spec.floor.height_m() == Approx(0.2));
  CHECK(spec.floor.contains({1, -1}));
  CHECK_FALSE(spec.floor.contains({1, 1}));
  CHECK(spec.meshes.size() == (occludes ? 1 : 0));
}

TEST_CASE("floors side by side are joined, floors that overlap, differ in height or cross themselves are refused",
          "[scene]") {
  GltfBuilder scene;
  scene.node("left", GltfBuilder::marked(polygon_floor({{0, 0}, {2, 0}, {2, 3}, {0, 3}})));
  SECTION("side by side") {
    scene.node("right",
               GltfBuilder::marked(polygon_floor({{0, 0}, {2, 0}, {2, 3}, {0, 3}}), {{"translation", {2, 0, 0}}}));
    const SceneSpec spec = scene.read();
    CHECK(spec.floor.area_m2() == Approx(12.0));
    CHECK(spec.floor.contains({3, 1}));
  }
  SECTION("the same twice") {
    scene.node("again", GltfBuilder::marked(polygon_floor({{0, 0}, {2, 0}, {2, 3}, {0, 3}})));
    CHECK_THAT(markup_fault(scene), contains("node 'again' overlaps the floor of node 'left'"));
  }
  SECTION("one shifted along a common edge") {
    scene.node("shifted", GltfBuilder::marked(polygon_floor({{1, 0}, {3, 0}, {3, 3}, {1, 3}})));
    CHECK_THAT(markup_fault(scene), contains("overlaps"));
  }
  SECTION("one within the other") {
    scene.node("within", GltfBuilder::marked(polygon_floor({{0.5, 0.5}, {1, 0.5}, {1, 1}})));
    CHECK_THAT(markup_fault(scene), contains("overlaps"));
  }
  SECTION("another height") {
    scene.node("step", GltfBuilder::marked(polygon_floor({{3, 0}, {4, 0}, {4, 1}}), {{"translation", {0, 0.3, 0}}}));
    CHECK_THAT(markup_fault(scene), contains("different heights"));
  }
  SECTION("a bow tie") {
    scene.node("tie", GltfBuilder::marked(polygon_floor({{5, 0}, {6, 1}, {6, 0}, {5, 1}})));
    CHECK_THAT(markup_fault(scene), contains("node 'tie': the outline of the floor crosses itself"));
  }
  SECTION("a slope") {
    scene.node("ramp", GltfBuilder::marked(polygon_floor({{5, 0}, {6, 0}, {6, 1}}), {{"rotation", {0.6, 0, 0, 0.8}}}));
    CHECK_THAT(markup_fault(scene), contains("must be flat and level"));
  }
}

TEST_CASE("a number out of its range is told with the ends that there are, and its unit", "[scene]") {
  const auto told = [](json mark) {
    GltfBuilder scene;
    scene.floor();
    scene.node("a", GltfBuilder::marked(std::move(mark)));
    return markup_fault(scene);
  };
  json loud = sensor_mark("PIR1");
  loud["gain"] = 0;
  CHECK_THAT(told(loud), contains("'gain' must be a number above 0.0 to 100.0"));
  CHECK_THAT(told({{"type", "entrance"}, {"id", "door"}, {"width_m", 0.1}}),
             contains("'width_m' must be a number of metres from 0.3 to 20.0"));
}

TEST_CASE("every fault of a scene is told, not only the first", "[scene]") {
  GltfBuilder scene;
  scene.floor();
  scene.node("a", GltfBuilder::marked({{"type", "seat"}}));
  scene.node("b", GltfBuilder::marked({{"type", "sensro"}, {"id", "PIR1"}}));
  scene.node("c", GltfBuilder::marked(sensor_mark("PIR1", "EKMC1604112")));
  const std::string told = markup_fault(scene);
  CHECK_THAT(told, contains("node 'a': seat without 'id'"));
  CHECK_THAT(told, contains("unknown type 'sensro' (did you mean 'sensor'?)"));
  CHECK_THAT(told, contains("sensor model 'EKMC1604112' is not known (did you mean 'EKMC1604111'?)"));
}

TEST_CASE("ids that can't name a column or a file are refused", "[scene]") {
  for (const std::string id : {"", "a,b", "../x", ".hidden", "a\nb", "\"q\""}) {
    GltfBuilder scene;
    scene.floor();
    scene.node("eye", GltfBuilder::marked(sensor_mark(id)));
    CHECK_THAT(markup_fault(scene), contains("it needs letters, digits"));
    scene.root["nodes"][1]["extras"]["pirsim"] = sensor_mark("PIR1", id);
    CHECK_THAT(markup_fault(scene), contains("it needs letters, digits"));
  }
}

TEST_CASE("sensor files are looked for in the given folders before those beside the scene, last in the library",
          "[scene]") {
  GltfBuilder scene;
  scene.floor();
  scene.node("eye", GltfBuilder::marked(sensor_mark("PIR1")));
  const TemporaryFolder folder;
  const auto file = folder.write("rooms/room.gltf", scene.text());
  const auto read = [&] { return pirsim::io::read_scene(file); };
  const auto sensor_file = [&] { return read().files.size() < 2 ? std::string() : read().files.at(1).path; };
  CHECK(read().sensor_models.count("EKMC1604111") == 1);
  CHECK(sensor_file().empty());
  REQUIRE(setenv("PIRSIM_DATA_DIR", pirsim::test::data_dir().c_str(), 1) == 0);
  CHECK(sensor_file() == (pirsim::test::data_dir() / "sensors" / "EKMC1604111.yaml").string());
  REQUIRE(unsetenv("PIRSIM_DATA_DIR") == 0);
  std::filesystem::copy(pirsim::test::data_dir() / "sensors", folder.path() / "sensors");
  CHECK_THAT(sensor_file(), contains(folder.path().string()));
  const auto first = folder.write("first/EKMC1604111.yaml", "not a sensor");
  CHECK_THAT(fault_of([&] { return pirsim::io::read_scene(file, {{folder.path() / "first"}}); }),
             contains("first/EKMC1604111.yaml"));
}

TEST_CASE("the library carries every shipped sensor as its file has it", "[scene]") {
  std::size_t n_shipped = 0;
  for (const auto& entry : std::filesystem::directory_iterator(pirsim::test::data_dir() / "sensors")) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string name = entry.path().stem().string();
    const auto carried = pirsim::io::find_sensor_model(name, "/nowhere/rooms/room.gltf");
    const auto read = pirsim::io::read_sensor_model(entry.path());
    CHECK(carried.id == read.id);
    CHECK(carried.plane_m == read.plane_m);
    REQUIRE(carried.clusters.size() == read.clusters.size());
    ++n_shipped;
  }
  CHECK(n_shipped == 25);
}

TEST_CASE("files that can't be read are told apart from files that are no scenes", "[scene]") {
  const TemporaryFolder folder;
  const auto code_of = [](const std::filesystem::path& file) {
    try {
      static_cast<void>(pirsim::io::read_scene(file));
    } catch (const pirsim::Error& error) {
      CHECK_THAT(error.what(), contains(file.string()));
      return error.code();
    }
    return pirsim::ErrorCode::internal;
  };
  CHECK(code_of(folder.path() / "missing.gltf") == pirsim::ErrorCode::io);
  CHECK(code_of(folder.path()) == pirsim::ErrorCode::io);
  CHECK(code_of(folder.write("empty.gltf", "")) == pirsim::ErrorCode::input);
  CHECK(code_of(folder.write("picture.gltf", "\x89PNG\r\n")) == pirsim::ErrorCode::input);
  CHECK(code_of(folder.write("list.gltf", "[]")) == pirsim::ErrorCode::input);
  CHECK_THAT(fault_of([&] { return pirsim::io::read_scene(folder.write("s.yaml", "# A study\npirsim_script: 1\n")); }),
             contains("is neither glTF") && contains(", but a script: `--script` of run"));
}

TEST_CASE("buffers outside the scene's folder are not opened, not even through a link", "[scene]") {
  GltfBuilder scene;
  const int mesh = scene.mesh(scene.positions({0, 0, 0, 1, 0, 0, 0, 1, 0}));
  scene.node("wall", {{"mesh", mesh}});
  scene.floor();
  const TemporaryFolder folder;
  const auto outside = folder.write("outside.bin", scene.buffer);
  std::filesystem::create_directories(folder.path() / "room");
  std::filesystem::create_symlink(outside, folder.path() / "room" / "link.bin");
  const auto read = [&](const std::string& uri) {
    return fault_of([&] { return pirsim::io::read_scene(folder.write("room/room.gltf", scene.text_with_file(uri))); });
  };
  CHECK_THAT(read("../outside.bin"), contains("leads out of the scene's folder"));
  CHECK_THAT(read("%2e%2e/outside.bin"), contains("leads out of the scene's folder"));
  CHECK_THAT(read(outside.string()), contains("absolute path"));
  CHECK_THAT(read("file://" + outside.string()), contains("not a file in the scene's folder"));
  CHECK_THAT(read("link.bin"), contains("link that leads out"));
  CHECK_THAT(read("missing.bin"), contains("can't be found"));
  folder.write("room/inside.bin", scene.buffer);
  CHECK(read("inside.bin") == "accepted");
  folder.write("room/short.bin", scene.buffer.substr(4));
  CHECK_THAT(read("short.bin"), contains("cut short: it has 32 of 36 bytes"));
}

TEST_CASE("the example of the documentation is a scene", "[scene]") {
  std::ifstream page(pirsim::test::data_dir() / ".." / "docs/formats/scene.md");
  const std::string text(std::istreambuf_iterator<char>(page), {});
  const std::size_t begin = text.find("```json\n") + 8;
  const TemporaryFolder folder;
  const auto file = folder.write("room.gltf", text.substr(begin, text.find("```", begin) - begin));
  const SceneSpec spec = pirsim::io::read_scene(file, {{pirsim::test::data_dir() / "sensors"}});
  CHECK(spec.floor.area_m2() == Approx(12.0));
  CHECK(spec.seats.size() == 1);
  CHECK(spec.entrances.size() == 1);
  CHECK(std::asin(-spec.sensors.at(0).world_from_sensor.forward().y) ==
        Approx(20.0 * 3.14159265358979 / 180.0).epsilon(1e-5));
}

TEST_CASE("a node has a matrix or translation, rotation and scale, not both", "[scene]") {
  GltfBuilder scene;
  scene.floor();
  scene.node("both", {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}, {"scale", {2, 2, 2}}});
  CHECK_THAT(markup_fault(scene), contains("node 'both': it has both 'matrix' and 'scale'"));
}

TEST_CASE("of thousands of faults the first are told, and soon", "[scene]") {
  GltfBuilder scene;
  scene.floor();
  for (int i = 0; i < 20000; ++i) scene.node("n", GltfBuilder::marked({{"type", "seat"}}));
  const std::string told = markup_fault(scene);
  CHECK(std::count(told.begin(), told.end(), '\n') == 19);
  json repeated = json::array();
  for (int i = 0; i < 200000; ++i) repeated.push_back(1);
  scene.root["nodes"] = {{{"name", "a"}}, {{"name", "b"}, {"children", repeated}}};
  scene.root["scenes"][0]["nodes"] = {0, 1};
  CHECK_THAT(markup_fault(scene), contains("node 'b' is its own ancestor or has two parents"));
}
