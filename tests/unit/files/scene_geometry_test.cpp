// Accessors, primitives and node transforms of the scene reader.
#include <glm/geometric.hpp>

#include "gltf_builder.hpp"
#include "support/catch.hpp"

using pirsim::SceneSpec;
using pirsim::TriMesh;
using pirsim::Vec3;
using namespace pirsim::test;

namespace {

const std::vector<float> square{0, 0, 0, 2, 0, 0, 2, 3, 0, 0, 3, 0};  // corners in order, area 6

/// Corners of all triangles in the world, in order.
std::vector<Vec3> corners(const TriMesh& mesh) {
  std::vector<Vec3> result;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) result.push_back(mesh.positions[v]);
  }
  return result;
}

void check_corners(const TriMesh& mesh, const std::vector<Vec3>& expected) {
  const std::vector<Vec3> given = corners(mesh);
  REQUIRE(given.size() == expected.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    INFO("corner " << i << ": " << given[i].x << ' ' << given[i].y << ' ' << given[i].z);
    CHECK(glm::distance(given[i], expected[i]) < 1e-6);
  }
}

/// Six times the enclosed volume; positive if triangles are counter-clockwise seen from outside.
double signed_volume(const TriMesh& mesh) {
  const std::vector<Vec3> c = corners(mesh);
  double sum = 0.0;
  for (std::size_t i = 0; i < c.size(); i += 3) sum += glm::dot(c[i], glm::cross(c[i + 1], c[i + 2]));
  return sum / 6.0;
}

const std::vector<Vec3> two_triangles{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 0, 0}, {2, 3, 0}, {0, 3, 0}};

/// The only mesh of a scene with one node that carries it.
TriMesh only_mesh(GltfBuilder& scene, int mesh, json node = json::object()) {
  node["mesh"] = mesh;
  scene.node("thing", node);
  scene.floor();
  const SceneSpec spec = scene.read();
  REQUIRE(spec.meshes.size() == 1);
  return spec.meshes[0];
}

}  // namespace

TEST_CASE("indices of 8, 16 and 32 bit and no indices at all give the same triangles", "[scene]") {
  GltfBuilder scene;
  SECTION("8") {
    const int p = scene.positions(square);
    check_corners(only_mesh(scene, scene.mesh(p, scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}))), two_triangles);
  }
  SECTION("16") {
    const int p = scene.positions(square);
    check_corners(only_mesh(scene, scene.mesh(p, scene.indices<std::uint16_t>({0, 1, 2, 0, 2, 3}))), two_triangles);
  }
  SECTION("32") {
    const int p = scene.positions(square);
    check_corners(only_mesh(scene, scene.mesh(p, scene.indices<std::uint32_t>({0, 1, 2, 0, 2, 3}))), two_triangles);
  }
  SECTION("none") {
    const int p = scene.positions({0, 0, 0, 2, 0, 0, 2, 3, 0, 0, 0, 0, 2, 3, 0, 0, 3, 0});
    check_corners(only_mesh(scene, scene.mesh(p)), two_triangles);
  }
}

TEST_CASE("strips and fans are turned into triangles of one winding", "[scene]") {
  GltfBuilder scene;
  SECTION("strip of three") {
    const int p = scene.positions({0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0});
    check_corners(only_mesh(scene, scene.mesh(p, -1, 5)),
                  {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}});
  }
  SECTION("fan of two") {
    const int p = scene.positions(square);
    check_corners(only_mesh(scene, scene.mesh(p, scene.indices<std::uint8_t>({0, 1, 2, 3}), 6)),
                  {{2, 0, 0}, {2, 3, 0}, {0, 0, 0}, {2, 3, 0}, {0, 3, 0}, {0, 0, 0}});
  }
}

TEST_CASE("interleaved positions are read with the view's stride and the accessor's offset", "[scene]") {
  GltfBuilder scene;
  std::vector<float> mixed;
  for (std::size_t v = 0; v < 4; ++v) {
    mixed.insert(mixed.end(), {9, 9, 9});  // a normal, say
    mixed.insert(mixed.end(), square.begin() + 3 * v, square.begin() + 3 * v + 3);
  }
  const int p = scene.accessor(scene.view(bytes_of(mixed), 24), "VEC3", f32, 4, {{"byteOffset", 12}});
  check_corners(only_mesh(scene, scene.mesh(p, scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}))), two_triangles);
}

TEST_CASE("sparse accessors replace elements of a view, or of zeros where there is none", "[scene]") {
  GltfBuilder scene;
  const auto sparse = [&](const std::vector<std::uint16_t>& at, const std::vector<float>& values) {
    return json{{"count", at.size()},
                {"indices", {{"bufferView", scene.view(bytes_of(at))}, {"componentType", u16}}},
                {"values", {{"bufferView", scene.view(bytes_of(values))}}}};
  };
  SECTION("over a view") {
    std::vector<float> wrong = square;
    wrong[3] = 77.0F;
    wrong[10] = -5.0F;
    const json part = sparse({1, 3}, {2, 0, 0, 0, 3, 0});
    const int p = scene.accessor(scene.view(bytes_of(wrong)), "VEC3", f32, 4, {{"sparse", part}});
    check_corners(only_mesh(scene, scene.mesh(p, scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}))), two_triangles);
  }
  SECTION("over zeros") {
    const json part = sparse({1, 2, 3}, {2, 0, 0, 2, 3, 0, 0, 3, 0});
    const int p = scene.add("accessors", {{"type", "VEC3"}, {"componentType", f32}, {"count", 4}, {"sparse", part}});
    check_corners(only_mesh(scene, scene.mesh(p, scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}))), two_triangles);
  }
}

TEST_CASE("quantised positions are scaled as KHR_mesh_quantization says", "[scene]") {
  GltfBuilder scene;
  scene.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  scene.root["extensionsUsed"] = {"KHR_mesh_quantization"};
  SECTION("plain shorts") {
    const std::vector<std::int16_t> q{0, 0, 0, 0, 2, 0, 0, 0, 2, 3, 0, 0};  // padded to 8 bytes a vertex
    const int p = scene.accessor(scene.view(bytes_of(q), 8), "VEC3", i16, 3);
    check_corners(only_mesh(scene, scene.mesh(p)), {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}});
  }
  SECTION("normalised bytes") {
    const std::vector<std::int8_t> q{-128, 0, 0, 0, 127, 0, 0, 0, -127, 127, 0, 0};
    const int p = scene.accessor(scene.view(bytes_of(q), 4), "VEC3", i8, 3, {{"normalized", true}});
    check_corners(only_mesh(scene, scene.mesh(p)), {{-1, 0, 0}, {1, 0, 0}, {-1, 1, 0}});
  }
}

TEST_CASE("a vertex goes through its node's scale, rotation and translation and then through its parents'", "[scene]") {
  // (1, 1, 1), (0, 1, 0), (0, 0, 1) in the child; scaled (2, 1, 1), moved (1, 0, 0): (3, 1, 1), (1, 1, 0), (1, 0, 1);
  // the parent turns 90 degrees about +Y, (x, y, z) to (z, y, -x): (1, 1, -3), (0, 1, -1), (1, 0, -1); moved (1, 2, 3).
  const std::vector<Vec3> expected{{2, 3, 0}, {1, 3, 2}, {2, 2, 2}};
  const double h = std::sqrt(0.5);
  GltfBuilder scene;
  const int mesh = scene.mesh(scene.positions({1, 1, 1, 0, 1, 0, 0, 0, 1}));
  SECTION("as translation, rotation and scale") {
    const int child = scene.child("child", {{"mesh", mesh}, {"scale", {2, 1, 1}}, {"translation", {1, 0, 0}}});
    scene.node("parent", {{"children", {child}}, {"rotation", {0, h, 0, h}}, {"translation", {1, 2, 3}}});
  }
  SECTION("as matrices") {
    const int child =
        scene.child("child", {{"mesh", mesh}, {"matrix", {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}}});
    scene.node("parent", {{"children", {child}}, {"matrix", {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 2, 3, 1}}});
  }
  scene.floor();
  const SceneSpec spec = scene.read();
  REQUIRE(spec.meshes.size() == 1);
  check_corners(spec.meshes[0], expected);
}

TEST_CASE("a mesh of several nodes occludes once for each, under the node's name", "[scene]") {
  GltfBuilder scene;
  const int mesh = scene.mesh(scene.positions(square), scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
  scene.node("left", {{"mesh", mesh}});
  scene.node("right", {{"mesh", mesh}, {"translation", {10, 0, 0}}});
  scene.floor();
  const SceneSpec spec = scene.read();
  REQUIRE(spec.meshes.size() == 2);
  CHECK(spec.meshes[0].name == "left");
  CHECK(spec.meshes[1].name == "right");
  check_corners(spec.meshes[0], two_triangles);
  CHECK(spec.meshes[1].positions[0].x == Approx(10.0));
}

TEST_CASE("mirroring by a negative scale keeps the outside of a solid outside", "[scene]") {
  const std::vector<float> tetrahedron{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<std::uint8_t> outward{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const json scale = GENERATE(json{1, 1, 1}, json{-1, 1, 1}, json{-1, -1, 1}, json{-2, -1, -1});
  GltfBuilder scene;
  const int p = scene.positions(tetrahedron);
  const TriMesh mesh = only_mesh(scene, scene.mesh(p, scene.indices(outward)), {{"scale", scale}});
  const double size = std::abs(scale[0].get<double>() * scale[1].get<double>() * scale[2].get<double>());
  CHECK(signed_volume(mesh) == Approx(size / 6.0));
}

TEST_CASE("a binary glTF and one with its buffer in a file read as the one with embedded data", "[scene]") {
  GltfBuilder scene;
  const int mesh = scene.mesh(scene.positions(square), scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
  scene.node("wall", {{"mesh", mesh}});
  scene.floor();
  const TemporaryFolder folder;
  folder.write("data/my room.bin", scene.buffer);
  const auto check = [&](const std::filesystem::path& file) {
    const SceneSpec spec = pirsim::io::read_scene(file);
    CHECK(spec.name == file.filename());
    REQUIRE(spec.meshes.size() == 1);
    check_corners(spec.meshes[0], two_triangles);
  };
  check(folder.write("embedded.gltf", scene.text()));
  check(folder.write("external.gltf", scene.text_with_file("data/my%20room.bin")));
  check(folder.write("binary.glb", scene.binary()));
  check(folder.write("binary_named_otherwise.gltf", scene.binary()));
}

TEST_CASE("only nodes of the default scene are read", "[scene]") {
  GltfBuilder scene;
  const int mesh = scene.mesh(scene.positions(square), scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
  scene.node("elsewhere", {{"mesh", mesh}});
  scene.root["scenes"].push_back({{"nodes", json::array()}});
  scene.root["scenes"][1]["nodes"].push_back(scene.child("here", {{"mesh", mesh}}));
  scene.floor();
  scene.root["scenes"][1]["nodes"].push_back(2);
  scene.root["scene"] = 1;
  const SceneSpec spec = scene.read();
  REQUIRE(spec.meshes.size() == 1);
  CHECK(spec.meshes[0].name == "here");
}

TEST_CASE("what can't occlude or move is left out with a warning, and images are never opened", "[scene]") {
  GltfBuilder scene;
  const int p = scene.positions(square);
  const int lines = scene.mesh(p, -1, 1);
  scene.node("wire", {{"mesh", lines}});
  const int flawed = scene.mesh(p, scene.indices<std::uint8_t>({0, 1, 2, 2, 1, 0, 3, 3, 1}));
  scene.root["meshes"][static_cast<std::size_t>(flawed)]["name"] = "flawed";
  scene.node("plate", {{"mesh", flawed}});
  scene.root["images"] = {{{"uri", "../../nowhere.png"}}, {{"bufferView", 99}}};
  scene.root["animations"] = {{{"channels", json::array()}, {"samplers", json::array()}}};
  scene.floor();
  const SceneSpec spec = scene.read();
  std::string warnings;
  for (const auto& issue : spec.warnings) {
    warnings += to_string(issue) + '\n';
    CHECK(issue.where.line > 0);
  }
  INFO(warnings);
  CHECK(spec.meshes.size() == 1);
  CHECK(warnings.find("mesh 'shape': points and lines don't occlude") != std::string::npos);
  CHECK(warnings.find("mesh 'flawed' (node 'plate'): 1 triangle without area") != std::string::npos);
  CHECK(warnings.find("mesh 'flawed' (node 'plate'): 1 triangle given twice") != std::string::npos);
  CHECK(warnings.find("animations are not played") != std::string::npos);
  CHECK(warnings.find("no sensors") != std::string::npos);
}
