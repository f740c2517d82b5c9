#include "engine/body/gait.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using pirsim::pi;
using pirsim::Vec2;
using pirsim::body::Route;

namespace {

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 ab = b - a;
  const double length2 = glm::dot(ab, ab);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + t * ab);
}

double distance_to_polyline(const Vec2& p, const std::vector<Vec2>& points) {
  double nearest = glm::distance(p, points.front());
  for (std::size_t i = 1; i < points.size(); ++i) {
    nearest = std::min(nearest, distance_to_segment(p, points[i - 1], points[i]));
  }
  return nearest;
}

/// Length of an L of two legs whose corner, turning by `turn`, is rounded with `radius`.
double rounded_length(double legs_m, double turn, double radius) {
  return legs_m - 2.0 * radius * std::tan(0.5 * turn) + radius * turn;
}

std::vector<Vec2> random_polyline(pirsim::Stream& stream, int n_points) {
  std::vector<Vec2> points;
  for (int i = 0; i < n_points; ++i) points.emplace_back(4.0 * stream.uniform(), 4.0 * stream.uniform());
  return points;
}

}  // namespace

TEST_CASE("a straight route is as long as its leg and keeps its heading", "[route]") {
  const Route route({{1.0, 2.0}, {1.0, 0.5}, {1.0, -1.0}});
  CHECK(route.length_m() == Approx(3.0).margin(1e-14));
  CHECK(glm::distance(route.position(0.75), Vec2(1.0, 1.25)) < 1e-14);
  CHECK(route.heading(2.0) == Approx(0.0).margin(1e-14));
  CHECK(route.curvature(1.5) == 0.0);
  CHECK(route.sharp_turns_s().empty());
}

TEST_CASE("the length of a rounded corner is the closed form of legs and arc", "[route]") {
  SECTION("45 degrees: the wanted radius cuts 2.5 cm and is kept") {
    const double h = std::sqrt(2.0);
    const Route route({{0, 0}, {0, -2}, {-h, -2 - h}}, 0.3);
    CHECK(route.length_m() == Approx(rounded_length(4.0, pi / 4, 0.3)).epsilon(1e-13));
    CHECK(route.heading(route.length_m()) == Approx(pi / 4));
  }
  SECTION("90 degrees: the radius is what cuts exactly 5 cm") {
    const double radius = Route::max_corner_cut_m / (std::sqrt(2.0) - 1.0);
    const Route route({{0, 0}, {0, -2}, {2, -2}}, 0.3);
    CHECK(route.length_m() == Approx(rounded_length(4.0, pi / 2, radius)).epsilon(1e-13));
    CHECK(glm::distance(route.position(0.5 * route.length_m()), Vec2(0, -2)) == Approx(Route::max_corner_cut_m));
    CHECK(route.heading(route.length_m()) == Approx(-pi / 2));
    CHECK(route.curvature(0.5 * route.length_m()) == Approx(-1.0 / radius));
  }
  SECTION("a short leg: the arc ends in its middle") {
    const Route route({{0, 0}, {0, -2}, {0.1, -2}}, 0.3);
    CHECK(route.length_m() == Approx(rounded_length(2.1, pi / 2, 0.05)).epsilon(1e-13));
  }
}

TEST_CASE("points of an arc have the arc's distance from its centre", "[route]") {
  const double radius = Route::max_corner_cut_m / (std::sqrt(2.0) - 1.0);
  const Route route({{0, 0}, {0, -1}, {1, -1}}, 0.3);
  const Vec2 centre(radius, -1.0 + radius);
  for (int i = 0; i <= 10; ++i) {
    const double s = 1.0 - radius + 0.1 * i * radius * pi / 2;
    CHECK(glm::distance(route.position(s), centre) == Approx(radius).epsilon(1e-12));
  }
}

TEST_CASE("position and heading of a route are continuous and the heading is that of the tangent", "[route]") {
  pirsim::Stream stream({.seed = 1});
  for (int round = 0; round < 200; ++round) {
    const Route route(random_polyline(stream, 6), 0.3);
    const double step = 1e-5;
    for (double s = 0.0; s < route.length_m(); s += 0.0173) {
      const Vec2 moved = route.position(s + step) - route.position(s);
      CHECK(glm::length(moved) <= step * (1.0 + 1e-6));
      const bool turns = std::any_of(route.sharp_turns_s().begin(), route.sharp_turns_s().end(),
                                     [&](double at) { return at > s - step && at < s + 2 * step; });
      if (turns || s + step > route.length_m()) continue;
      // The heading changes by curvature times step at most, whichever piece the step is on.
      const double bound = step * std::max({std::abs(route.curvature(s)), std::abs(route.curvature(s + step))}) + 1e-9;
      CHECK(std::abs(route.heading(s + step) - route.heading(s)) <= bound);
      const double chord = std::remainder(pirsim::heading_of(moved) - route.heading(s + 0.5 * step), 2 * pi);
      CHECK(std::abs(chord) <= bound);
    }
  }
}

TEST_CASE("arcs end where and as the next leg begins", "[route]") {
  pirsim::Stream stream({.seed = 2});
  for (int round = 0; round < 200; ++round) {
    const Route route(random_polyline(stream, 5), 0.3);
    // Bisect every change of curvature and compare both sides of it.
    for (double s = 0.0; s + 0.001 < route.length_m(); s += 0.001) {
      if (route.curvature(s) == route.curvature(s + 0.001)) continue;
      double low = s;
      double high = s + 0.001;
      for (int i = 0; i < 45; ++i) {
        const double middle = 0.5 * (low + high);
        (route.curvature(middle) == route.curvature(low) ? low : high) = middle;
      }
      CHECK(glm::distance(route.position(low), route.position(high)) < 1e-12);
      const bool turns = std::any_of(route.sharp_turns_s().begin(), route.sharp_turns_s().end(),
                                     [&](double at) { return std::abs(at - high) < 1e-9; });
      if (!turns) CHECK(std::abs(route.heading(low) - route.heading(high)) < 1e-8);
    }
  }
}

TEST_CASE("a route stays within the corner cut of its polyline and never leaves its convex corner", "[route]") {
  pirsim::Stream stream({.seed = 3});
  for (int round = 0; round < 200; ++round) {
    const std::vector<Vec2> points = random_polyline(stream, 6);
    const Route route(points, 0.05 + 2.0 * stream.uniform());
    double polyline_m = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) polyline_m += glm::distance(points[i - 1], points[i]);
    CHECK(route.length_m() <= polyline_m + 1e-12);
    CHECK(glm::distance(route.position(0.0), points.front()) < 1e-12);
    CHECK(glm::distance(route.position(route.length_m()), points.back()) < 1e-12);
    for (double s = 0.0; s < route.length_m(); s += 0.01) {
      CHECK(distance_to_polyline(route.position(s), points) <= Route::max_corner_cut_m + 1e-12);
    }
    for (const Vec2& p : points) {  // the route passes every corner, too
      double nearest = 1e9;
      for (double s = 0.0; s < route.length_m(); s += 0.001)
        nearest = std::min(nearest, glm::distance(route.position(s), p));
      CHECK(nearest <= Route::max_corner_cut_m + 1e-3);
    }
  }
}

TEST_CASE("a reversal is a turn in place: the route goes there and back and the heading jumps by half a turn",
          "[route]") {
  const Route route({{0, 0}, {2, 0}, {0.5, 0}});
  CHECK(route.length_m() == Approx(3.5));
  REQUIRE(route.sharp_turns_s().size() == 1);
  CHECK(route.sharp_turns_s().front() == Approx(2.0));
  CHECK(glm::distance(route.position(2.0), Vec2(2, 0)) < 1e-14);
  CHECK(route.heading(1.999) == Approx(-pi / 2));
  CHECK(std::abs(std::remainder(route.heading(2.001) - pi / 2, 2 * pi)) < 1e-12);
  CHECK(std::abs(route.heading(2.001) - route.heading(1.999)) == Approx(pi));
}

TEST_CASE("the heading does not jump where a route turns across due south", "[route]") {
  std::vector<Vec2> circle;
  for (int i = 0; i <= 72; ++i) circle.push_back(pirsim::direction_of(2 * pi * i / 36.0) * 2.0);
  const Route route(circle);
  CHECK(route.heading(route.length_m()) - route.heading(0.0) == Approx(2 * pi * 71 / 36.0));
}

TEST_CASE("one point, repeated points and a radius of zero are routes, too", "[route]") {
  const Route point({{1.5, -2.0}});
  CHECK(point.length_m() == 0.0);
  CHECK(point.position(3.0) == Vec2(1.5, -2.0));
  CHECK(point.heading(0.0) == 0.0);

  const Route still({{1, 1}, {1, 1}, {1, 1}});
  CHECK(still.length_m() == 0.0);
  CHECK(still.position(0.0) == Vec2(1, 1));

  CHECK(Route({{0, 0}, {0, 0}, {0, -1}, {0, -1}, {1, -1}, {1, -1}}) == Route({{0, 0}, {0, -1}, {1, -1}}));

  const Route angular({{0, 0}, {0, -1}, {1, -1}}, 0.0);
  CHECK(angular.length_m() == Approx(2.0));
  CHECK(angular.sharp_turns_s() == std::vector<double>{1.0});

  CHECK(Route().length_m() == 0.0);
  CHECK(Route().position(1.0) == Vec2(0.0));
  CHECK(Route().heading(1.0) == 0.0);
}

TEST_CASE("s outside of the route, even NaN, gives its ends", "[route]") {
  const Route route({{0, 0}, {0, -1}, {1, -1}});
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double s : {-1.0, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK(route.position(s) == Vec2(0, 0));
    CHECK(route.heading(s) == 0.0);
  }
  for (const double s : {7.0, infinity}) CHECK(glm::distance(route.position(s), Vec2(1, -1)) < 1e-14);
}

TEST_CASE("no polyline of tiny legs, near reversals or near straight corners makes a NaN", "[route]") {
  pirsim::Stream stream({.seed = 4});
  for (int round = 0; round < 500; ++round) {
    std::vector<Vec2> points{{0, 0}};
    for (int i = 0; i < 8; ++i) {
      const double turn = std::array{0.0, pi, 1e-9, pi - 1e-9, 1e-5, 2.356194490192345, 0.5}[stream.index(7)];
      const double length = std::array{1e-7, 1e-6, 1.1e-6, 1e-3, 1.0}[stream.index(5)];
      points.push_back(points.back() + length * pirsim::direction_of(turn + stream.index(4) * pi / 2));
    }
    const Route route(points);
    REQUIRE(std::isfinite(route.length_m()));
    for (int i = 0; i <= 50; ++i) {
      const double s = route.length_m() * i / 50.0;
      REQUIRE(std::isfinite(route.position(s).x + route.position(s).y + route.heading(s) + route.curvature(s)));
      // Merging points less than 1e-6 m apart moves the line by that much at most.
      REQUIRE(distance_to_polyline(route.position(s), points) <= Route::max_corner_cut_m + 1e-6);
    }
  }
}

TEST_CASE("a route of no points, of numbers that aren't finite or of a negative radius is refused", "[route]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(Route(std::vector<Vec2>{}), pirsim::Error);
  CHECK_THROWS_AS(Route({{0, 0}, {nan, 1}}), pirsim::Error);
  CHECK_THROWS_AS(Route({{0, 0}, {1, 1}}, -0.1), pirsim::Error);
  CHECK_THROWS_AS(Route({{0, 0}, {1, 1}}, nan), pirsim::Error);
}
