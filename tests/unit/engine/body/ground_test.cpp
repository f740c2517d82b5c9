#include "engine/body/ground.hpp"

#include <vector>

#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using body::WalkableFloor;

namespace {

FloorArea plain_rectangle(double width, double depth) {
  return FloorArea({{{0, 0}, {width, 0}, {width, depth}, {0, depth}}}, 0.0);
}

/// Triangles whose tips a step passes without an end near them, all over 3 m x 2 m.
std::vector<TriMesh> random_needles(Stream& stream) {
  std::vector<TriMesh> needles;
  for (int i = 0; i < 6; ++i) {
    const Vec3 tip(3.0 * stream.uniform(), 0.5, 2.0 * stream.uniform());
    const auto aside = [&] { return Vec3(stream.uniform() - 0.5, 0.0, stream.uniform() - 0.5); };
    needles.push_back({"needle", {tip, tip + 0.3 * aside(), tip + 0.3 * aside()}, {{0, 1, 2}}});
  }
  return needles;
}

}  // namespace

TEST_CASE("a ground for people of all sizes gives each the floor of a ground of their own", "[ground]") {
  Stream stream({.seed = 25});
  int found = 0;
  for (int round = 0; round < 60; ++round) {
    const std::vector<TriMesh> things = random_needles(stream);
    const body::Ground shared(plain_rectangle(3, 2), {}, things, 0.4);
    for (const double keep_m : {0.1, 0.23, 0.3, 0.4}) {
      const WalkableFloor floor(shared, keep_m), own(plain_rectangle(3, 2), {}, things, keep_m);
      const body::Ground ground(plain_rectangle(3, 2), {}, things, keep_m);
      const auto open = shared.open_cells(keep_m);
      REQUIRE(open == ground.open_cells(keep_m));
      REQUIRE(shared.steps_between(open, keep_m).open == ground.steps_between(open, keep_m).open);
      const auto place = [&] { return Vec2(3.0 * stream.uniform(), 2.0 * stream.uniform()); };
      const Vec2 from = place(), to = place();
      const auto way = floor.find_way(from, to);
      REQUIRE(way == own.find_way(from, to));
      if (way) ++found;
    }
  }
  CHECK(found > 50);
}

TEST_CASE("a step is taken exactly where its whole line keeps clear, and its diagonal passes no closed corner",
          "[ground]") {
  Stream stream({.seed = 26});
  int taken = 0, narrow = 0;
  for (int round = 0; round < 100; ++round) {
    const body::Ground ground(plain_rectangle(3, 2), {}, random_needles(stream), 0.35);
    const double keep_m = 0.05 + 0.3 * stream.uniform();
    const auto open = ground.open_cells(keep_m);
    const body::StepGrid grid = ground.steps_between(open, keep_m);
    const auto is_open = [&](int column, int row) {
      return column >= 0 && row >= 0 && column < grid.columns && row < grid.rows &&
             open[std::size_t(row * grid.columns + column)] != 0;
    };
    for (int cell = 0; cell < grid.columns * grid.rows; ++cell) {
      const int column = cell % grid.columns, row = cell / grid.columns;
      for (int direction = 0; direction < body::n_directions; ++direction) {
        const body::Step step = body::steps[std::size_t(direction)];
        const bool ends = is_open(column, row) && is_open(column + step.column, row + step.row) &&
                          is_open(column + step.column, row) && is_open(column, row + step.row);
        const bool clear = ends && ground.cells()->obstacles.clear(
                                       ground.cells()->centre(column, row),
                                       ground.cells()->centre(column + step.column, row + step.row), keep_m);
        REQUIRE(grid.is_open(cell, direction) == clear);
        taken += clear ? 1 : 0;
        narrow += ends && !clear ? 1 : 0;
      }
    }
  }
  CHECK(taken > 1000);
  CHECK(narrow > 10);
}

TEST_CASE("there is a way exactly where one is found: from and to any place, among others", "[ground]") {
  Stream stream({.seed = 24});
  int found = 0, none = 0;
  for (int round = 0; round < 100; ++round) {
    const WalkableFloor floor(plain_rectangle(3, 2), {}, random_needles(stream), 0.3);
    const auto place = [&] { return Vec2(3.4 * stream.uniform() - 0.2, 2.4 * stream.uniform() - 0.2); };
    std::vector<body::Disc> others;
    for (std::uint32_t i = stream.index(3); i > 0; --i) others.push_back({place(), 0.25});
    for (int k = 0; k < 5; ++k) {
      const Vec2 from = place(), to = place();
      const bool has_way = floor.find_way(from, to, others).has_value();
      REQUIRE(floor.has_way(from, to, others) == has_way);
      (has_way ? found : none) += 1;
    }
  }
  CHECK(found > 50);
  CHECK(none > 50);
}
