// What a scene may say, but hardly means: the reader warns, with the node and its place.
#include "gltf_builder.hpp"
#include "support/catch.hpp"

using namespace pirsim::test;

namespace {

json door_mark() { return {{"type", "entrance"}, {"id", "door"}}; }
json seat_mark(const std::string& id) { return {{"type", "seat"}, {"id", id}}; }

/// All warnings but that of missing sensors, one a line.
std::string doubts(const GltfBuilder& scene) {
  std::string text;
  for (const pirsim::Issue& issue : scene.read().warnings) {
    if (issue.message != "the scene has no sensors") text += to_string(issue) + '\n';
  }
  return text;
}

/// A floor of 10 m x 10 m around the origin with a door in the middle of one side, moved by (x, y, z).
std::string doubts_of_door(double x, double y, double z, const json& more = json::object()) {
  GltfBuilder scene;
  scene.floor();
  json mark = door_mark();
  mark.update(more);
  scene.node("gap", GltfBuilder::marked(mark, {{"translation", {x, y, 5.0 + z}}}));
  return doubts(scene);
}

/// The same door in a wall without thickness, which has a gap of 1 m.
std::string doubts_of_gap(double x, double width_m = 0.9) {
  GltfBuilder scene;
  scene.floor();
  const int corners =
      scene.positions({-5, 0, 5, -0.5, 0, 5, -0.5, 2.5, 5, -5, 2.5, 5, 0.5, 0, 5, 5, 0, 5, 5, 2.5, 5, 0.5, 2.5, 5});
  const int mesh = scene.mesh(corners, scene.indices<std::uint8_t>({0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}));
  scene.node("front wall", {{"mesh", mesh}});
  json mark = door_mark();
  mark["width_m"] = width_m;
  scene.node("gap", GltfBuilder::marked(mark, {{"translation", {x, 0, 5}}}));
  return doubts(scene);
}

}  // namespace

TEST_CASE("a seat off the floor is in doubt, one on it isn't", "[scene]") {
  GltfBuilder scene;
  scene.floor();
  scene.node("inside", GltfBuilder::marked(seat_mark("S1"), {{"translation", {0, 0.5, 4.9}}}));
  CHECK(doubts(scene).empty());
  scene.node("outside", GltfBuilder::marked(seat_mark("S2"), {{"translation", {0, 0.5, 6.2}}}));
  CHECK_THAT(doubts(scene), contains("warning: node 'outside': seat 'S2' lies off the floor"));
  CHECK_THAT(doubts(scene), !contains("S1"));
}

TEST_CASE("two seats at nearly one place are in doubt, by both names", "[scene]") {
  GltfBuilder scene;
  scene.floor();
  scene.node("one", GltfBuilder::marked(seat_mark("S1"), {{"translation", {1, 0.5, 0}}}));
  scene.node("two", GltfBuilder::marked(seat_mark("S2"), {{"translation", {1.5, 0.5, 0}}}));
  scene.node("far", GltfBuilder::marked(seat_mark("S3"), {{"translation", {1, 0.5, 3}}}));
  CHECK(doubts(scene).empty());
  scene.node("copy", GltfBuilder::marked(seat_mark("S4"), {{"translation", {0.95, 0.5, 0}}}));
  CHECK_THAT(doubts(scene), contains("warning: node 'copy': seat 'S4' is 0.05 m from seat 'S1'"));
  CHECK_THAT(doubts(scene), !contains("S2") && !contains("S3"));
}

TEST_CASE("an entrance is at the floor's edge and at its height", "[scene]") {
  CHECK(doubts_of_door(0, 0, 0).empty());
  CHECK(doubts_of_door(0, 0.05, 0.15).empty());
  CHECK_THAT(doubts_of_door(0, 1, 0), contains("node 'gap': entrance 'door' isn't on the floor, but 1.00 m above it"));
  CHECK_THAT(doubts_of_door(0, -0.2, 0), contains("entrance 'door' isn't on the floor, but 0.20 m below it"));
  CHECK_THAT(doubts_of_door(0, 0, 0.25),
             contains("node 'gap': entrance 'door' isn't at the floor's edge, but 0.25 m outside of it"));
  CHECK_THAT(doubts_of_door(0, 0, -3), contains("entrance 'door' isn't at the floor's edge, but 3.00 m inside of it"));
}

TEST_CASE("an entrance that is partly in a wall is in doubt", "[scene]") {
  CHECK(doubts_of_gap(0).empty());
  CHECK(doubts_of_gap(0, 1.2).empty());  // a frame takes as much
  CHECK_THAT(doubts_of_gap(0.5), contains("node 'gap': entrance 'door': 'front wall' stands in 0.45 m of its width"));
  CHECK_THAT(doubts_of_gap(3), contains("'front wall' stands in 0.90 m of its width of 0.90 m"));
  CHECK_THAT(doubts_of_gap(0, 2.0), contains("'front wall' stands in 1.00 m of its width of 2.00 m"));
}

TEST_CASE("'occludes' of a polygon without a mesh says nothing, and that is told", "[scene]") {
  GltfBuilder scene;
  scene.node("ground",
             GltfBuilder::marked(
                 {{"type", "floor"}, {"polygon_xz_m", {{0, 0}, {4, 0}, {4, -3}, {0, -3}}}, {"occludes", true}}));
  CHECK_THAT(doubts(scene), contains("warning: node 'ground': 'occludes' has no effect without a mesh"));
}
