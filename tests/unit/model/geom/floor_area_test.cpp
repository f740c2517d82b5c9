#include "pirsim/geometry.hpp"

#include "support/catch.hpp"

using pirsim::FloorArea;
using pirsim::Vec2;

TEST_CASE("a square with a square hole has the area of their difference and does not contain the hole") {
  const FloorArea floor({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}, {1, 2}, {2, 2}, {2, 1}}}, 0.0);
  CHECK(floor.area_m2() == Approx(15.0));
  CHECK(floor.contains({0.5, 0.5}));
  CHECK_FALSE(floor.contains({1.5, 1.5}));
  CHECK_FALSE(floor.contains({4.5, 1.5}));
  CHECK(floor.upper() == Vec2(4, 4));
}

TEST_CASE("a point on the edge between two areas counts for exactly one of them") {
  const FloorArea left({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, 0.0);
  const FloorArea right({{{1, 0}, {2, 0}, {2, 1}, {1, 1}}}, 0.0);
  CHECK(left.contains({1.0, 0.5}) != right.contains({1.0, 0.5}));
}
