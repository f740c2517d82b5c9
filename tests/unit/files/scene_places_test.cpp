// Marks of places: what is read, what is refused, and what is in doubt.
#include <string>

#include "gltf_builder.hpp"
#include "support/catch.hpp"

using namespace pirsim::test;

namespace {

json place(const std::string& id, const std::string& posture, const json& more = json::object()) {
  json mark{{"type", "place"}, {"id", id}, {"posture", posture}};
  mark.update(more);
  return mark;
}

/// A floor of 10 m x 10 m around the origin and a bed of 2 m x `length_m` whose top is 0.5 m up, its head at +Z.
void furnish(GltfBuilder& scene, double length_m = 2.0) {
  scene.floor();
  const auto z = static_cast<float>(0.5 * length_m);
  const int corners = scene.positions({-1, 0.5, -z, 1, 0.5, -z, 1, 0.5, z, -1, 0.5, z});
  scene.node("mattress", {{"mesh", scene.mesh(corners, scene.indices<std::uint8_t>({0, 2, 1, 0, 3, 2}))}});
}
json at(double x, double y, double z) { return {{"translation", {x, y, z}}}; }

std::string doubts_of_places(const GltfBuilder& scene) {
  std::string text;
  for (const pirsim::Issue& issue : scene.read().warnings) {
    if (issue.message != "the scene has no sensors") text += to_string(issue) + '\n';
  }
  return text;
}

std::string faults(const json& mark) {
  GltfBuilder scene;
  furnish(scene);
  scene.node("here", GltfBuilder::marked(mark, at(0, 0.5, 0)));
  try {
    static_cast<void>(scene.read());
  } catch (const pirsim::Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("places are read with posture and uses, and one to sit is a seat", "[scene]") {
  GltfBuilder scene;
  furnish(scene);
  scene.node("bed", GltfBuilder::marked(place("bed", "lie", {{"for", {"sleep", "read"}}}), at(0, 0.5, 0)));
  scene.node("stove", GltfBuilder::marked(place("stove", "stand", {{"for", "cook"}}), at(3, 0, 0)));
  scene.node("sofa", GltfBuilder::marked(place("sofa", "sit", {{"for", "tv"}}), at(-3, 0.5, 0)));
  const pirsim::SceneSpec read = scene.read();
  REQUIRE(read.places.size() == 2);
  CHECK(read.places[0].id == "bed");
  CHECK(read.places[0].posture == pirsim::PlacePosture::lie);
  CHECK(read.places[0].uses == std::vector<std::string>{"sleep", "read"});
  CHECK(read.places[0].world_from_place.origin == pirsim::Vec3(0, 0.5, 0));
  CHECK(read.places[1].posture == pirsim::PlacePosture::stand);
  REQUIRE(read.seats.size() == 1);
  CHECK(read.seats[0].id == "sofa");
  CHECK(read.seats[0].uses == std::vector<std::string>{"tv"});
  CHECK(doubts_of_places(scene).empty());
}

TEST_CASE("faulty places are refused with the nearest word", "[scene]") {
  CHECK_THAT(faults(place("bed", "lye")), contains("'posture' can't be 'lye' (did you mean 'lie'?)"));
  CHECK_THAT(faults({{"type", "place"}, {"id", "bed"}}),
             contains("place without 'posture'; known are sit, lie and stand"));
  CHECK_THAT(faults(place("bed", "lie", {{"for", "slep"}})),
             contains("'slep' isn't a use of a place (did you mean 'sleep'?)"));
  CHECK_THAT(faults(place("bed", "lie", {{"for", 3}})), contains("'for' must be a word or a list of words"));
  CHECK_THAT(faults(place("bed", "lie", {{"fro", "sleep"}})), contains("unknown key 'fro'"));
  CHECK_THAT(faults({{"type", "plase"}, {"id", "bed"}}), contains("did you mean 'place'?"));
  GltfBuilder twice;
  furnish(twice);
  twice.node("one", GltfBuilder::marked(place("x", "lie"), at(0, 0.5, 0)));
  twice.node("other", GltfBuilder::marked(place("x", "sit"), at(3, 0.5, 0)));
  CHECK_THROWS_WITH(twice.read(), contains("'x' is taken by node 'one'"));
}

TEST_CASE("a place in the air, in a wall, too short a bed and two at one spot are in doubt, in a line each",
          "[scene]") {
  GltfBuilder air;
  furnish(air);
  air.node("bed", GltfBuilder::marked(place("bed", "lie"), at(3, 0.5, 0)));
  CHECK_THAT(doubts_of_places(air), contains("place 'bed' is in the air"));

  GltfBuilder wall;
  furnish(wall);
  const int corners = wall.positions({-2, 0, 0.3, 2, 0, 0.3, 2, 2.5, 0.3, -2, 2.5, 0.3});
  wall.node("partition", {{"mesh", wall.mesh(corners, wall.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}))}});
  wall.node("bed", GltfBuilder::marked(place("bed", "lie"), at(0, 0.5, 0)));
  CHECK_THAT(doubts_of_places(wall), contains("place 'bed': 'partition' goes through whoever lies there"));

  GltfBuilder cot;
  furnish(cot, 1.2);
  cot.node("bed", GltfBuilder::marked(place("bed", "lie"), at(0, 0.5, 0.1)));
  CHECK_THAT(doubts_of_places(cot), contains("place 'bed': nothing is under the head"));

  GltfBuilder turned;
  furnish(turned);
  turned.node("bed", GltfBuilder::marked(place("bed", "lie"), at(0, 0.5, -0.3)));
  CHECK_THAT(doubts_of_places(turned), contains("nothing is under the feet"));

  GltfBuilder two;
  furnish(two);
  two.node("one", GltfBuilder::marked(place("one", "lie"), at(0, 0.5, 0)));
  two.node("two", GltfBuilder::marked(place("two", "lie"), at(0.2, 0.5, 0)));
  CHECK_THAT(doubts_of_places(two), contains("place 'two' is 0.20 m from place 'one': two would lie in each other"));

  GltfBuilder high;
  furnish(high);
  high.node("stove", GltfBuilder::marked(place("stove", "stand"), at(3, 0.9, 0)));
  CHECK_THAT(doubts_of_places(high), contains("place 'stove' isn't on the floor, but 0.90 m above it"));
  GltfBuilder off;
  furnish(off);
  off.node("stove", GltfBuilder::marked(place("stove", "stand", {{"as_meant", true}}), at(30, 0, 0)));
  CHECK(doubts_of_places(off).empty());
}
