// How warm a recipe's rooms and days are, and which units of a make its sensors are.
#include <algorithm>
#include <cmath>
#include <vector>

#include "model/schema/fields.hpp"
#include "pirsim/error.hpp"
#include "rooms/recipe.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::dataset;

namespace {

RecipeSpec recipe_of(const std::string& text) {
  const TemporaryFolder folder;
  return read_recipe(folder.write("recipe.yaml", "pirsim_recipe: 1\nseed: 5\n" + text));
}
const std::string offices = "rooms: [{count: 400, seats: 2}]\ndays: 5\n";

double ambient_c(const RecipeSpec& recipe, int room, int day) {
  return script_of(recipe, SceneSpec{}, room, day).sensing.ambient_c;
}

struct Spread {
  double mean = 0.0, of_rooms = 0.0, of_days = 0.0;  ///< standard deviations of rooms' means, of days about them
};

Spread spread_of(const RecipeSpec& recipe) {
  const int n = recipe.n_rooms(), n_days = recipe.days;
  double sum = 0.0, squares = 0.0, within = 0.0;
  for (int room = 1; room <= n; ++room) {
    double own = 0.0, own_squares = 0.0;
    for (int day = 1; day <= n_days; ++day) {
      const double c = ambient_c(recipe, room, day) - 20.0;
      own += c, own_squares += c * c;
    }
    own /= n_days;
    within += (own_squares / n_days - own * own) * n_days / (n_days - 1.0);
    sum += own, squares += own * own;
  }
  const double mean = sum / n;
  return {20.0 + mean, std::sqrt(squares / n - mean * mean), std::sqrt(std::max(0.0, within / n))};
}

std::string refusal_of(const std::string& text) {
  try {
    static_cast<void>(recipe_of(text));
  } catch (const Error& fault) {
    return fault.what();
  }
  return {};
}

}  // namespace

TEST_CASE("A recipe's rooms are as warm as offices and its days differ", "[dataset][warmth]") {
  const Spread all = spread_of(recipe_of(offices));
  const double of_rooms = std::sqrt(4.0 * 4.0 / 12.0 + 0.7 * 0.7 / 5.0);  // uniform over 4 K, and five days' mean
  CHECK(std::abs(all.mean - 23.0) < 3.0 * of_rooms / std::sqrt(400.0));
  CHECK(std::abs(all.of_rooms - of_rooms) < 3.0 * of_rooms / std::sqrt(2.0 * 400.0));
  CHECK(std::abs(all.of_days - 0.7) < 3.0 * 0.7 / std::sqrt(2.0 * 1600.0));
  CHECK(std::abs(all.of_days - 0.8) > 3.0 * 0.7 / std::sqrt(2.0 * 1600.0));
  CHECK(std::abs(all.mean - 23.5) > 3.0 * of_rooms / std::sqrt(400.0));
}

TEST_CASE("A recipe, a group and the sensing may say how warm rooms are", "[dataset][warmth]") {
  const Spread warm = spread_of(recipe_of(offices + "ambient_c: [25.6, 26.3]\nambient_sd_k: 0\n"));
  CHECK(std::abs(warm.mean - 25.95) < 3.0 * 0.7 / std::sqrt(12.0 * 400.0));
  CHECK(warm.of_days < 0.01);
  const RecipeSpec groups =
      recipe_of("rooms: [{count: 1, ambient_c: 30}, {count: 1}, {count: 1, kind: home}]\ndays: 1\nambient_sd_k: 0\n");
  CHECK(ambient_c(groups, 1, 1) == 30.0);
  CHECK(groups.rooms[1].ambient_c == Range{21.0, 25.0});
  CHECK(groups.rooms[2].ambient_c == Range{19.0, 24.0});
  const Spread fixed = spread_of(recipe_of(offices + "sensing: {ambient_c: 20}\n"));
  CHECK(fixed.mean == Approx(20.0));
  CHECK(fixed.of_rooms == Approx(0.0).margin(1e-9));
  CHECK_THAT(refusal_of(offices + "sensing: {ambient_c: 20}\nambient_c: 25\n"),
             contains("sensing.ambient_c says it already"));
  CHECK_THAT(refusal_of("rooms: [{count: 1, ambient_c: 30}]\nsensing: {ambient_c: 20}\n"),
             contains("sensing.ambient_c says it already"));
  CHECK_THAT(refusal_of(offices + "ambient_c: [25, 21]\n"), contains("less than the first"));
}

TEST_CASE("How warm rooms are changes nothing else of them", "[dataset][warmth]") {
  const std::string effects = "effects: [range_scale, {missed_triggers: {probability: [0, 0.2]}, per: day}]\n";
  const RecipeSpec drawn = recipe_of(offices + effects),
                   fixed = recipe_of(offices + effects + "sensing: {ambient_c: 23}\n");
  for (const int room : {1, 77}) {
    const SceneSpec scene = room_of(drawn, room, {});
    ScriptSpec a = script_of(drawn, scene, room, 2);
    const ScriptSpec b = script_of(fixed, scene, room, 2);
    CHECK(a.sensing.ambient_c != b.sensing.ambient_c);
    a.sensing.ambient_c = b.sensing.ambient_c;
    CHECK(same(a, b));
  }
}

TEST_CASE("A room drawn by weight is as warm as the recipe's own", "[dataset][warmth]") {
  const std::string rooms = "rooms: [{count: 4, seats: 2}]\ndays: 2\nambient_sd_k: 0\n";
  const RecipeSpec plain = recipe_of(rooms), drawn = recipe_of(rooms + "draw_by: {count: 3, weights: [0, 0, 1, 0]}\n");
  CHECK(ambient_c(drawn, 1, 1) == ambient_c(plain, 3, 1));
  CHECK(ambient_c(drawn, 2, 2) == ambient_c(plain, 3, 1));
  CHECK(ambient_c(plain, 2, 1) != ambient_c(plain, 3, 1));
}

TEST_CASE("Sensors of a recipe are units drawn from their make unless it says otherwise", "[dataset][warmth]") {
  CHECK(recipe_of(offices).sensing.units == Units::drawn);
  CHECK(recipe_of(offices + "sensing: {tick_rate_hz: 10}\n").sensing.units == Units::drawn);
  CHECK(recipe_of(offices + "sensing: {units: guaranteed}\n").sensing.units == Units::guaranteed);
}
