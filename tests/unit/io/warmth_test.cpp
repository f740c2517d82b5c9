// Temperatures in scenes and scripts.
#include "body/body_part.hpp"

#include "gltf_builder.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

/// Two triangles, each a primitive with a material of its own.
int two_primitives(GltfBuilder& scene, int first_material, int second_material) {
  const auto primitive = [&](float x, int material) {
    json result = {{"attributes", {{"POSITION", scene.positions({x, 0, 0, x + 1, 0, 0, x, 1, 0})}}}};
    if (material >= 0) result["material"] = material;
    return result;
  };
  const json first = primitive(0.0F, first_material), second = primitive(2.0F, second_material);
  return scene.add("meshes", {{"name", "pane"}, {"primitives", {first, second}}});
}

json warm(const json& temperature) { return {{"extras", {{"pirsim", {{"temperature_c", temperature}}}}}}; }

std::string fault_with_material(const json& material) {
  GltfBuilder scene;
  scene.floor();
  scene.add("materials", material);
  return fault_of([&] { return scene.read(); });
}

ScriptSpec script(const std::string& person) {
  const TemporaryFolder folder;
  return io::read_script(folder.write("s.yaml", "pirsim_script: 1\npeople:\n  - {id: a, " + person + "}\n"));
}

}  // namespace

TEST_CASE("a mesh is split where its materials differ in temperature and only there", "[scene][warmth]") {
  for (const bool differ : {false, true}) {
    GltfBuilder scene;
    scene.floor();
    const int hot = scene.add("materials", warm(45.0));
    const int plain = scene.add("materials", {{"name", "plaster"}});
    scene.node("wall", {{"mesh", two_primitives(scene, plain, differ ? hot : plain)}});
    const SceneSpec spec = scene.read();
    std::size_t n_triangles = 0;
    for (const TriMesh& mesh : spec.meshes) n_triangles += mesh.triangles.size();
    CHECK(n_triangles == 2);
    REQUIRE(spec.meshes.size() == (differ ? 2U : 1U));
    CHECK_FALSE(spec.meshes[0].temperature_c);
    if (differ) CHECK(spec.meshes[1].temperature_c == 45.0);
  }
}

TEST_CASE("a node's surface mark overrules the temperatures of its materials", "[scene][warmth]") {
  GltfBuilder scene;
  scene.floor();
  const int hot = scene.add("materials", warm(45.0));
  const json mark = {{"type", "surface"}, {"temperature_c", 12.5}};
  scene.node("wall", GltfBuilder::marked(mark, {{"mesh", two_primitives(scene, -1, hot)}}));
  const SceneSpec spec = scene.read();
  REQUIRE(spec.meshes.size() == 1);
  CHECK(spec.meshes[0].temperature_c == 12.5);
  CHECK(spec.meshes[0].triangles.size() == 2);
}

TEST_CASE("faulty temperatures are told with their place", "[scene][warmth]") {
  CHECK_THAT(fault_with_material(warm(450.0)), contains("temperature_c"));
  CHECK_THAT(fault_with_material(warm("hot")), contains("temperature_c"));
  CHECK_THAT(fault_with_material({{"extras", {{"pirsim", {{"temperature", 45}}}}}}), contains("did you mean"));
  GltfBuilder scene;
  scene.floor();
  scene.node("wall", GltfBuilder::marked({{"type", "surface"}, {"temperature_c", 45}}));
  CHECK_THAT(fault_of([&] { return scene.read(); }), contains("needs a mesh"));
}

TEST_CASE("clothing lies between skin and room as its insulation says", "[body][warmth]") {
  WarmthSpec warmth;
  const auto torso = static_cast<std::size_t>(body::Part::torso), head = static_cast<std::size_t>(body::Part::head);
  CHECK(body::surface_temperatures_c(warmth, 20.0)[head] == 33.5);
  // 33.5 - 20 over 0.155 + 0.125 m^2 K/W, of which 0.125 lie between clothing and air.
  CHECK(body::surface_temperatures_c(warmth, 20.0)[torso] == Approx(20.0 + 13.5 * 0.125 / 0.28));
  CHECK(body::surface_temperatures_c(warmth, 33.5)[torso] == Approx(33.5));
  warmth.clothing_clo = 0.0;
  CHECK(body::surface_temperatures_c(warmth, 20.0)[torso] == Approx(33.5));
  warmth.parts_c["torso"] = 28.0;
  CHECK(body::surface_temperatures_c(warmth, 20.0)[torso] == 28.0);
}

TEST_CASE("a script tells how warm its people are and writes it back", "[script][warmth]") {
  const ScriptSpec read = script("warmth: {skin_c: 35, clothing_clo: 0.5, bare: [head], parts_c: {torso: 27}}");
  const WarmthSpec& warmth = read.trials.at(0).people.at(0).warmth;
  CHECK(warmth.skin_c == 35.0);
  CHECK(warmth.clothing_clo == 0.5);
  CHECK(warmth.bare == std::vector<std::string>{"head"});
  CHECK(warmth.parts_c == std::map<std::string, double>{{"torso", 27.0}});
  CHECK_THAT(io::to_yaml(read), contains("torso: 27"));
  CHECK_THAT(fault_of([] { return script("warmth: {bare: [haed]}"); }), contains("did you mean"));
  CHECK_THAT(fault_of([] { return script("warmth: {parts_c: {trunk: 27}}"); }), contains("trunk"));
}
