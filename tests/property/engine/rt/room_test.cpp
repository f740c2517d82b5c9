#include "engine/rt/room.hpp"

#include <vector>

#include "support/catch.hpp"
#include "support/random_scene.hpp"

using namespace pirsim;
using pirsim::testing::Draw;

namespace {

/// A closed room whose walls are fine, uneven and share all their edges: a warped grid on each side of a cube.
TriMesh closed_room(int n) {
  TriMesh mesh{"closed room", {}, {}};
  for (int side = 0; side < 6; ++side) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        Vec3 p(0.0);
        p[side % 3] = side < 3 ? -1.0 : 1.0;
        p[(side + 1) % 3] = 2.0 * i / n - 1.0;
        p[(side + 2) % 3] = 2.0 * j / n - 1.0;
        // A smooth map of space: equal points stay equal, so that the sides still hit without a gap.
        mesh.positions.push_back(Vec3(3.1, 1.4, 2.3) *
                                 (p + 0.07 * Vec3(std::sin(5 * p.y), std::sin(6 * p.z), std::sin(7 * p.x))));
      }
    }
    const auto at = [&](int i, int j) { return base + static_cast<std::uint32_t>(i * (n + 1) + j); };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("no ray leaves a closed room, not even at its edges and corners", "[rt]") {
  const TriMesh mesh = closed_room(12);
  const rt::Room room(std::span(&mesh, 1));
  Draw draw(31);
  const auto must_hit = [&](const Vec3& from, const Vec3& to) {
    const auto hit = room.first_hit(testing::ray_through(from, to), 100.0F);
    if (!hit) FAIL("from " << from.x << ' ' << from.y << ' ' << from.z << " to " << to.x << ' ' << to.y << ' ' << to.z);
  };
  const auto somewhere_inside = [&] { return draw.inside({-2, -0.9, -1.5}, {2, 0.9, 1.5}); };
  for (int i = 0; i < 400000; ++i) {
    const Vec3 from = somewhere_inside();
    must_hit(from, from + draw.direction());
  }
  for (int i = 0; i < 200000; ++i) {
    must_hit(somewhere_inside(), mesh.positions[draw.index(static_cast<std::uint32_t>(mesh.positions.size()))]);
  }
  for (int i = 0; i < 400000; ++i) {
    const auto& triangle = mesh.triangles[draw.index(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const std::uint32_t side = draw.index(3);
    const Vec3 a = mesh.positions[triangle[side]], b = mesh.positions[triangle[(side + 1) % 3]];
    must_hit(somewhere_inside(), a + draw.between(0.0, 1.0) * (b - a));
  }
}

TEST_CASE("with a triangle taken out, rays do leave", "[rt]") {
  TriMesh mesh = closed_room(4);
  mesh.triangles.erase(mesh.triangles.begin() + 20);
  const rt::Room room(std::span(&mesh, 1));
  Draw draw(32);
  int leaks = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = draw.inside({-2, -0.9, -1.5}, {2, 0.9, 1.5});
    leaks += room.first_hit(testing::ray_through(from, from + draw.direction()), 100.0F) ? 0 : 1;
  }
  CHECK(leaks > 20);
}
