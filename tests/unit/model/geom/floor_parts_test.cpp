// How floors and their parts overlap, and which part a point is in: against crossing numbers and sums of squares.
#include "model/geom/floor.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pirsim/geometry.hpp"
#include "support/catch.hpp"

using namespace pirsim;

namespace {

using Loops = std::vector<std::vector<Vec2>>;

FloorArea rectangle(double x0, double z0, double x1, double z1) {
  return FloorArea({{{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}}}, 0.0);
}

/// By the angle that the outlines turn round the point, unlike FloorArea::contains().
bool is_inside(const FloorArea& area, const Vec2& point) {
  int inside_of = 0;
  for (const auto& loop : area.loops()) {
    double turned = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 a = loop[i] - point, b = loop[(i + 1) % loop.size()] - point;
      turned += std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
    }
    inside_of += std::abs(turned) > 3.0 ? 1 : 0;
  }
  return inside_of % 2 == 1;
}

/// A star-shaped polygon round a centre.
FloorArea star(std::mt19937& random, const Vec2& centre) {
  std::uniform_real_distribution<double> radius(0.5, 2.5);
  std::vector<Vec2> loop;
  const int n = 3 + static_cast<int>(random() % 9);
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * pi * i / n;
    loop.push_back(centre + radius(random) * Vec2(std::cos(angle), std::sin(angle)));
  }
  return FloorArea({loop}, 0.0);
}

/// Squares of 1 cm whose centres are inside both.
double common_by_squares(const FloorArea& a, const FloorArea& b) {
  constexpr double side = 0.01;
  double sum = 0.0;
  for (double z = a.lower().y + side / 2; z < a.upper().y; z += side) {
    for (double x = a.lower().x + side / 2; x < a.upper().x; x += side) {
      if (is_inside(a, {x, z}) && is_inside(b, {x, z})) sum += side * side;
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("what two rectangles have in common is the product of its sides") {
  CHECK(common_m2(rectangle(0, 0, 4, 3), rectangle(1, 1, 2, 5)) == Approx(2.0));
  CHECK(common_m2(rectangle(0, 0, 4, 3), rectangle(4, 0, 5, 3)) == 0.0);  // side by side
  CHECK(common_m2(rectangle(0, 0, 4, 3), rectangle(5, 0, 6, 3)) == 0.0);
  CHECK(common_m2(rectangle(0, 0, 4, 3), rectangle(0, 0, 4, 3)) == Approx(12.0));
  const FloorArea with_hole({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}, {1, 3}, {3, 3}, {3, 1}}}, 0.0);
  CHECK(common_m2(with_hole, rectangle(0, 0, 2, 2)) == Approx(3.0));
  CHECK(common_m2(with_hole, rectangle(1, 1, 3, 3)) == Approx(0.0).margin(1e-12));
}

TEST_CASE("what two polygons have in common is what the squares inside both add up to") {
  std::mt19937 random(7);
  for (int i = 0; i < 12; ++i) {
    const FloorArea a = star(random, {0.0, 0.0}), b = star(random, {1.0, 0.5});
    const double common = common_m2(a, b);
    CHECK(common ==
          Approx(common_by_squares(a, b)).margin(0.03));  // an outline of 15 m, half a square's error, averaged
    CHECK(common == Approx(common_m2(b, a)).margin(1e-9));
    CHECK(common_m2(a, a) == Approx(a.area_m2()).margin(1e-9));
    // Halves of the plane share it out.
    const double left = common_m2(a, rectangle(-9, -9, 0.3, 9)), right = common_m2(a, rectangle(0.3, -9, 9, 9));
    CHECK(left + right == Approx(a.area_m2()).margin(1e-9));
  }
}

TEST_CASE("a point is in the part whose outline turns round it, or in the rest") {
  std::mt19937 random(11);
  const FloorArea floor = rectangle(-3, -3, 6, 4);
  const std::vector<FloorArea> parts{star(random, {-0.3, 0.0}), rectangle(3, -3, 6, 0), rectangle(3, 0, 6, 4)};
  const FloorParts cut(floor, parts);
  REQUIRE(cut.has_rest());
  double sum = 0.0;
  for (const double m2 : cut.areas_m2()) sum += m2;
  CHECK(sum == Approx(63.0));
  std::uniform_real_distribution<double> x(-3, 6), z(-3, 4);
  int in_parts = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec2 point(x(random), z(random));
    const auto holds = [&](const FloorArea& part) { return is_inside(part, point); };
    const auto near_edge = [&](const FloorArea& part) { return distance_to_edge_m(part, point) < 0.002; };
    if (std::ranges::any_of(parts, near_edge)) continue;
    const auto found = static_cast<std::size_t>(std::ranges::find_if(parts, holds) - parts.begin());
    REQUIRE(cut.at(point) == found);
    in_parts += found < parts.size() ? 1 : 0;
  }
  CHECK(in_parts > 5000);
}

TEST_CASE("parts that share the floor out have no rest, and a point on a border is in one beside it") {
  const FloorArea floor = rectangle(0, 0, 8, 4);
  // A border aslant, with a corner of one part only; numbers that no binary fraction holds.
  const FloorArea left({{{0, 0}, {4.1, 0}, {3.7, 4}, {0, 4}}}, 0.0);
  const FloorArea right({{{4.1, 0}, {8, 0}, {8, 4}, {3.7, 4}, {3.7 + 0.4 * 0.35, 4 * 0.65}}}, 0.0);
  const FloorParts cut(floor, {left, right});
  CHECK_FALSE(cut.has_rest());
  REQUIRE(cut.areas_m2().size() == 2);
  CHECK(cut.areas_m2()[0] + cut.areas_m2()[1] == Approx(32.0));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 5000; ++i) CHECK(cut.at(Vec2(4.1, 0) + share(random) * Vec2(-0.4, 4)) < 2);
  CHECK(cut.at({0.0, 0.0}) == 0);  // the floor's own corners
  CHECK(cut.at({8.0, 4.0}) == 1);
}

TEST_CASE("between parts a gap as wide as a hair belongs to one of them, a wider one to the rest") {
  const FloorArea floor = rectangle(0, 0, 8, 4);
  const FloorParts cut(floor, {rectangle(0, 0, 3, 4), rectangle(3.0005, 0, 4, 4), rectangle(4.2, 0, 8, 4)});
  REQUIRE(cut.has_rest());
  CHECK(cut.rest_m2() == Approx(0.8 + 0.002));
  CHECK(cut.at({3.0002, 2.0}) == 0);
  CHECK(cut.at({3.0004, 2.0}) == 1);
  CHECK(cut.at({4.1, 2.0}) == 3);
}

TEST_CASE("a name has room in the middle of a rectangle and inside of a bent room") {
  CHECK(roomiest_point(rectangle(0, 0, 4, 2)) == Vec2(2, 1));
  const FloorArea bent({{{0, 0}, {6, 0}, {6, 1}, {1, 1}, {1, 6}, {0, 6}}}, 0.0);
  CHECK(is_inside(bent, roomiest_point(bent)));
  CHECK(distance_to_edge_m(bent, roomiest_point(bent)) > 0.45);
}

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
