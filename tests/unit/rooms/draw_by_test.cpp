// Rooms drawn by weight.
#include <algorithm>
#include <cmath>
#include <set>

#include "pirsim/error.hpp"
#include "rooms/recipe.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::dataset;

namespace {

RecipeSpec recipe_with(const std::string& more) {
  const TemporaryFolder folder;
  return read_recipe(
      folder.write("recipe.yaml", "pirsim_recipe: 1\nseed: 5\nrooms: [{count: 4, seats: 2}]\ndays: 2\n" + more));
}

}  // namespace

TEST_CASE("Rooms are drawn about as often as their weight says, and never more than one away from it") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const std::vector<double> weights{0.5, 0.0, 0.2, 1.3};
    const std::vector<int> rooms = drawn_by_weight({100, weights, {}}, seed);
    REQUIRE(rooms.size() == 100);
    CHECK(std::ranges::is_sorted(rooms));
    for (int room = 1; room <= 4; ++room) {
      const double expected = 100.0 * weights[static_cast<std::size_t>(room - 1)] / 2.0;
      CHECK(std::abs(static_cast<double>(std::ranges::count(rooms, room)) - expected) < 1.0);
    }
  }
}

TEST_CASE("A room drawn by weight is the recipe's own, with other days") {
  const RecipeSpec plain = recipe_with("effects: [range_scale]\n");
  const RecipeSpec drawn = recipe_with("effects: [range_scale]\ndraw_by: {count: 3, weights: [0, 0, 1, 0]}\n");
  REQUIRE(drawn.n_rooms() == 3);
  CHECK(drawn.n_room_days() == 6);
  const SceneSpec original = room_of(plain, 3, {});
  std::set<std::uint64_t> seeds;
  for (int room = 1; room <= 3; ++room) {
    const SceneSpec scene = room_of(drawn, room, {});
    REQUIRE(scene.sensors.size() == original.sensors.size());
    CHECK(scene.sensors[0].world_from_sensor.origin == original.sensors[0].world_from_sensor.origin);
    const ScriptSpec script = script_of(drawn, scene, room, 1), of_pool = script_of(plain, original, 3, 1);
    CHECK(script.effects[0].parameters == of_pool.effects[0].parameters);
    seeds.insert(script.seed);
    CHECK(script.seed != of_pool.seed);
  }
  CHECK(seeds.size() == 3);
}

TEST_CASE("Rooms take a recipe's own scenes in turn") {
  const TemporaryFolder folder;
  folder.write("a.gltf", "{}");
  folder.write("b.gltf", "{}");
  folder.write("b.yaml", "");
  const RecipeSpec recipe = read_recipe(folder.write(
      "recipe.yaml",
      "pirsim_recipe: 1\nrooms:\n  - {scenes: [a.gltf, {scene: b.gltf, marks: b.yaml}], count: 5}\n  - {count: 1}\n"));
  REQUIRE(recipe.n_rooms() == 6);
  std::string names;
  for (int room = 1; room <= 6; ++room) {
    const OwnScene* own = own_scene(recipe, room);
    names += (own == nullptr ? "" : own->file.stem().string() + own->marks.extension().string()) + ",";
  }
  CHECK(names == "a,b.yaml,a,b.yaml,a,,");
}

TEST_CASE("Weights that can't be drawn by are refused at their place") {
  for (const char* text :
       {"draw_by: {count: 3, weights: [1, 2]}\n", "draw_by: {count: 3, weights: [0, 0, 0, 0]}\n",
        "draw_by: {count: 3, weights: [1, 1, -1, 1]}\n", "draw_by: {count: 0, weights: [1, 1, 1, 1]}\n",
        "draw_by: {count: 3}\n", "draw_by: {count: 3, weights: [1, 1, 1, .nan]}\n",
        "draw_by: {count: 3, weights: [1, 1, 1, 1], more: 1}\n",
        "draw_by: {count: 9, weights: [1, 1, 1, 1]}\nsplit: {test_rooms: 0.3}\n"}) {
    CHECK_THROWS_WITH(recipe_with(text), contains("recipe.yaml:5:") || contains("recipe.yaml:6:"));
  }
}
