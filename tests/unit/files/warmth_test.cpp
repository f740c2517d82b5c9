// Temperatures in scenes and scripts.
#include "engine/body/skeleton.hpp"

#include <cmath>
#include <utility>
#include <vector>

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

ScriptSpec warm_script(const std::string& person) {
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

namespace {

double surface_c(body::Part part, const WarmthSpec& warmth, double ambient_c) {
  return body::surface_temperatures_c(warmth, ambient_c)[body::at(part)];
}
constexpr double per_clo = 0.155, around = 0.125;  // m^2 K/W

}  // namespace

TEST_CASE("skin follows the air as measured in 1399 experiments", "[body][warmth]") {
  WarmthSpec warmth;
  warmth.hair_share = 0.0;
  for (const double ambient_c : {16.0, 20.0, 26.0, 32.0}) {
    // [Mehnert2000], without clothing: radiant temperature as the air's, 1.4 kPa of vapour, 0.1 m/s, rectum 37 degC.
    const double measured_c = 7.19 + (0.064 + 0.061) * ambient_c + 0.198 * 1.4 - 0.348 * 0.1 + 0.616 * 37.0;
    CHECK(surface_c(body::Part::head, warmth, ambient_c) == Approx(measured_c).margin(0.05));
  }
  // Foreheads of twenty people indoors: 33.4 +- 0.8 degC [Micheletti2022].
  CHECK(std::abs(surface_c(body::Part::head, warmth, 23.0) - 33.4) < 0.8);
  warmth.skin_above_k = 0.5;
  CHECK(surface_c(body::Part::head, warmth, 20.0) == Approx(33.2));
  warmth.skin_c = 31.0;
  CHECK(surface_c(body::Part::head, warmth, 20.0) == 31.0);
}

TEST_CASE("as much heat passes through clothing as leaves its surface", "[body][warmth]") {
  WarmthSpec warmth;
  warmth.skin_c = 33.5;
  for (const auto& [part, local_clo] : {std::pair{body::Part::torso, 2.2}, {body::Part::left_shank, 0.7}}) {
    for (const double ambient_c : {18.0, 25.0, 36.0}) {
      warmth.clothing_clo = 0.8;
      const double outside_c = surface_c(part, warmth, ambient_c);
      CHECK((33.5 - outside_c) / (per_clo * 0.8 * local_clo) == Approx((outside_c - ambient_c) / around));
      warmth.clothing_clo = 0.0;
      CHECK(surface_c(part, warmth, ambient_c) == Approx(33.5));
    }
  }
  warmth.parts_c["torso"] = 28.0;
  CHECK(surface_c(body::Part::torso, warmth, 20.0) == 28.0);
}

TEST_CASE("parts in clothes lose as much heat together as the whole outfit says", "[body][warmth]") {
  using body::Part;
  // Areas of head and neck, pelvis, chest and back, shoulders, arms, hands, thighs, legs, feet: m^2 [Takahashi2021].
  const std::vector<std::pair<Part, double>> areas{
      {Part::pelvis, 0.221},     {Part::torso, 0.336},      {Part::left_upper_arm, 0.192}, {Part::left_forearm, 0.126},
      {Part::left_thigh, 0.418}, {Part::left_shank, 0.224}, {Part::left_foot, 0.112}};
  constexpr double bare_m2 = 0.139 + 0.1, all_m2 = 1.868;
  WarmthSpec warmth;
  warmth.skin_c = 34.0;
  for (const double outfit_clo : {0.5, 0.61, 0.8}) {
    warmth.clothing_clo = outfit_clo;
    double watts_per_k = bare_m2 / around;
    for (const auto& [part, area_m2] : areas) {
      double step = (surface_c(part, warmth, 24.0) - 24.0) / 10.0;
      if (part == Part::left_forearm) step = (step - 0.32) / (1.0 - 0.32);  // without the hand
      watts_per_k += area_m2 * step / around;
    }
    const double whole_clo = (all_m2 / watts_per_k - around) / per_clo;
    CHECK(std::abs(whole_clo - outfit_clo) < 0.1 * outfit_clo);
  }
}

TEST_CASE("hair, sleeves and hands decide how much skin is seen", "[body][warmth]") {
  using body::Part;
  WarmthSpec warmth;
  warmth.skin_c = 33.0;
  const double under_hair_c = 23.0 + 10.0 * around / (around + per_clo);
  CHECK(surface_c(Part::head, warmth, 23.0) == Approx(0.5 * (33.0 + under_hair_c)));
  const double forearm_c = surface_c(Part::left_forearm, warmth, 23.0);
  const double sleeve_c = 23.0 + 10.0 * around / (around + per_clo * 1.2 * 0.61);
  CHECK(forearm_c == Approx(0.68 * sleeve_c + 0.32 * 33.0));
  warmth.bare.emplace_back("left_forearm");
  CHECK(surface_c(Part::left_forearm, warmth, 23.0) == 33.0);
  CHECK(surface_c(Part::right_forearm, warmth, 23.0) == forearm_c);
}

TEST_CASE("people vanish in air as warm as their skin and are cooler than warmer air", "[body][warmth]") {
  const double vanish_c = 30.2 / 0.875;
  for (const double part_c : body::surface_temperatures_c({}, vanish_c)) CHECK(part_c == Approx(vanish_c));
  for (const double part_c : body::surface_temperatures_c({}, vanish_c - 1.0)) CHECK(part_c > vanish_c - 1.0);
  for (const double part_c : body::surface_temperatures_c({}, vanish_c + 1.0)) CHECK(part_c < vanish_c + 1.0);
}

TEST_CASE("a script tells how warm its people are and writes it back", "[script][warmth]") {
  const ScriptSpec read =
      warm_script("warmth: {skin_c: 35, clothing_clo: 0.5, bare: [head], hair_share: 0.2, parts_c: {torso: 27}}");
  const WarmthSpec& warmth = read.trials.at(0).people.at(0).warmth;
  CHECK(warmth.skin_c == 35.0);
  CHECK(warmth.hair_share == 0.2);
  CHECK(warmth.clothing_clo == 0.5);
  CHECK(warmth.bare == std::vector<std::string>{"head"});
  CHECK(warmth.parts_c == std::map<std::string, double>{{"torso", 27.0}});
  CHECK_THAT(io::to_yaml(read), contains("torso: 27"));
  CHECK_THAT(fault_of([] { return warm_script("warmth: {bare: [haed]}"); }), contains("did you mean"));
  CHECK_THAT(fault_of([] { return warm_script("warmth: {parts_c: {trunk: 27}}"); }), contains("trunk"));
}
