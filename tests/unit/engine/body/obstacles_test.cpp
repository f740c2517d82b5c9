#include "engine/body/ground.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::body;

namespace {

/// Triangles of a hand's breadth to a wall's length, some of them upright, all over a hall.
std::vector<TriMesh> random_things(Stream& stream, std::size_t n, double hall_m) {
  std::vector<TriMesh> meshes;
  for (std::size_t i = 0; i < n; ++i) {
    const double size_m = stream.uniform() < 0.1 ? 15.0 : 1.0;
    const Vec3 corner(hall_m * stream.uniform(), 0.5, hall_m * stream.uniform());
    const auto aside = [&] { return Vec3(size_m * (stream.uniform() - 0.5), 0.0, size_m * (stream.uniform() - 0.5)); };
    const Vec3 end = corner + aside();
    const Vec3 third = stream.uniform() < 0.5 ? 0.5 * (corner + end) + Vec3(0.0, 1.0, 0.0) : corner + aside();
    meshes.push_back({"thing", {corner, end, third}, {{0, 1, 2}}});
  }
  return meshes;
}

}  // namespace

TEST_CASE("a segment is clear of obstacles exactly where each of them, asked one by one, is far enough away",
          "[obstacles]") {
  Stream stream({.seed = 45});
  int clear = 0, barred = 0;
  for (int round = 0; round < 40; ++round) {
    const double hall_m = 3.0 + 40.0 * stream.uniform();
    const auto things = random_things(stream, 1 + stream.index(60), hall_m);
    const Obstacles obstacles(footprints(things, solid_from_m, solid_to_m));
    for (int k = 0; k < 500; ++k) {
      const auto anywhere = [&] { return Vec2(stream.uniform(), stream.uniform()) * (hall_m + 4.0) - 2.0; };
      const double turn = stream.uniform();  // a point, level, upright, short or of any length
      const Vec2 a = anywhere();
      Vec2 b = turn < 0.2 ? a : turn < 0.5 ? a + 0.2 * (anywhere() - a) / hall_m : anywhere();
      if (turn > 0.8) b.y = a.y;
      if (turn > 0.9) b = {a.x, anywhere().y};
      const double keep_m = 0.6 * stream.uniform();
      const bool expected = std::ranges::none_of(
          obstacles.all(), [&](const Footprint& one) { return distance(a, b, one) < keep_m - rounding_m; });
      REQUIRE(obstacles.clear(a, b, keep_m) == expected);
      (expected ? clear : barred) += 1;
    }
  }
  CHECK(clear > 2000);
  CHECK(barred > 2000);
}

TEST_CASE("whoever asks for obstacles near a segment meets all that are, and few of a large hall's", "[obstacles]") {
  Stream stream({.seed = 46});
  const Obstacles obstacles(footprints(random_things(stream, 2000, 80.0), solid_from_m, solid_to_m));
  std::size_t n_visits = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec2 a(80.0 * stream.uniform(), 80.0 * stream.uniform()), b = a + Vec2(stream.uniform(), stream.uniform());
    std::set<const Footprint*> met;
    const bool stopped = obstacles.any_near(a, b, 0.3, [&](const Footprint& one) {
      met.insert(&one);
      ++n_visits;
      return false;
    });
    CHECK_FALSE(stopped);
    for (const Footprint& one : obstacles.all()) REQUIRE((distance(a, b, one) > 0.3 || met.contains(&one)));
  }
  CHECK(n_visits < 200 * 100);
}

TEST_CASE("without obstacles everything is clear", "[obstacles]") {
  CHECK(Obstacles().clear({0, 0}, {9, 9}, 1.0));
  CHECK(Obstacles(std::vector<Footprint>{}).clear({0, 0}, {0, 0}, 1.0));
}
