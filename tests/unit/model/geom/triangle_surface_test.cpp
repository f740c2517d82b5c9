#include "model/geom/shapes.hpp"

#include <limits>

#include "pirsim/error.hpp"
#include "support/catch.hpp"
#include "support/fine_mesh.hpp"

using namespace pirsim;
using pirsim::testing::Draw;

namespace {

constexpr float beyond = 100.0F;

Frame anywhere(Draw& draw) { return {draw.rotation(), draw.inside({-5, 0, -5}, {5, 2, 5})}; }

/// From some metres off through the surroundings of a solid.
Ray scattered_ray(Draw& draw, const Frame& frame, double scatter) {
  const Vec3 from = frame.origin + draw.between(1.0, 12.0) * draw.direction();
  return testing::ray_through(from, frame.origin + scatter * draw.between(0.0, 1.0) * draw.direction());
}

/// The same mesh with every position in the world.
TriMesh moved(TriMesh mesh, const Frame& frame) {
  for (Vec3& p : mesh.positions) p = frame * p;
  return mesh;
}

}  // namespace

TEST_CASE("a posed mesh is hit where a loop over its triangles in the world hits it", "[triangle_surface]") {
  Draw draw(41);
  int hits = 0, grazed = 0;
  constexpr int n_meshes = 200, n_rays = 200;
  for (int i = 0; i < n_meshes; ++i) {
    const TriMesh mesh = testing::triangle_soup(draw, 1 + draw.index(80));
    const Frame frame = anywhere(draw);
    const MeshSolid solid = testing::mesh_solid(mesh);
    const PosedShape posed = place(solid, frame);
    const TriMesh world = moved(mesh, frame);
    for (int k = 0; k < n_rays; ++k) {
      const Ray ray = scattered_ray(draw, frame, 0.4);
      double expected = std::numeric_limits<double>::infinity();
      bool is_grazing = false;
      for (const auto& [a, b, c] : world.triangles) {
        const auto hit = testing::intersect(ray, {world.positions[a], world.positions[b], world.positions[c]});
        if (!hit || hit->distance < 0.0) continue;
        is_grazing |= std::abs(hit->inside) < 1e-5;
        if (hit->inside >= 0.0) expected = std::min(expected, hit->distance);
      }
      if (is_grazing) {
        ++grazed;
        continue;
      }
      const auto distance = entry_distance(ray, posed, beyond);
      INFO("mesh " << i << ", ray " << k << ", expected " << expected);
      REQUIRE(distance.has_value() == std::isfinite(expected));
      if (!distance) continue;
      ++hits;
      // Seen edge-on, 1e-6 m of the origin's rounding becomes more along the ray.
      REQUIRE(*distance == Approx(expected).margin(1e-3));
      REQUIRE_FALSE(entry_distance(ray, posed, *distance).has_value());
      const float just_beyond = std::nextafter(*distance, beyond);
      REQUIRE(entry_distance(ray, posed, just_beyond) == distance);
    }
  }
  CHECK(hits > n_meshes * n_rays / 5);
  CHECK(grazed < n_meshes * n_rays / 100);
  WARN(hits << " hits; " << grazed << " of " << n_meshes * n_rays << " rays within 1e-5 m of an edge left out");
}

TEST_CASE("a fine mesh of a sphere, capsule or box is hit as the exact solid is, but for a grazing ray",
          "[triangle_surface][seconds]") {
  Draw draw(42);
  int hits = 0, different = 0;
  constexpr int n_solids = 150, n_rays = 400;
  constexpr double rounding = 1e-5;  // metres; as between the solids' tests and a search in double precision
  for (int i = 0; i < n_solids; ++i) {
    const Shape shape = draw.shape();
    const double fineness = testing::fineness(shape);
    const Frame frame = anywhere(draw);
    const MeshSolid mesh = testing::fine_mesh(shape);
    const PosedShape exact = place(shape, frame), meshed = place(mesh, frame);
    for (int k = 0; k < n_rays; ++k) {
      const Ray ray = scattered_ray(draw, frame, 0.5);
      if (testing::signed_distance(exact, Vec3(ray.origin)) < 0.01) continue;  // starts inside
      const auto expected = entry_distance(ray, exact, beyond), given = entry_distance(ray, meshed, beyond);
      INFO("solid " << i << ", shape " << shape.index() << ", ray " << k << ", fineness " << fineness);
      hits += expected ? 1 : 0;
      if (expected.has_value() != given.has_value()) {
        ++different;
        const double depth = testing::search(ray, exact, 20.0).depth;
        INFO("depth " << depth);
        REQUIRE(depth < rounding);
        REQUIRE(depth > -fineness - rounding);
      } else if (given) {
        const Vec3 point = Vec3(ray.origin) + double(*given) * Vec3(ray.direction);
        REQUIRE(testing::signed_distance(exact, point) < rounding);
        REQUIRE(testing::signed_distance(exact, point) > -fineness - rounding);
      }
    }
  }
  WARN(different << " of " << n_solids * n_rays << " rays differ (" << hits << " hits), all of them within "
                 << "0.11 % of the radius of grazing");
  CHECK(hits > n_solids * n_rays / 5);
  // Band of 1e-3 x 0.1 m round a silhouette of a metre, over a disc of half a metre: 1e-4 at most.
  CHECK(different < n_solids * n_rays / 5000);
}

TEST_CASE("bounds hold every vertex of a posed mesh, and its box is the tightest along its axes",
          "[triangle_surface]") {
  Draw draw(43);
  for (int i = 0; i < 300; ++i) {
    const TriMesh mesh = testing::triangle_soup(draw, 1 + draw.index(20));
    const MeshSolid solid = testing::mesh_solid(mesh);
    const Frame frame = anywhere(draw);
    const auto posed = std::get<PosedMesh>(place(solid, frame));
    const Bounds world = bounds(posed);
    const PosedBox box = box_around(posed);
    Vec3 widest(0.0);
    for (const Vec3& position : mesh.positions) {
      const Vec3 p = frame * position;
      const Vec3 local = glm::abs(glm::transpose(glm::dmat3(box.axes)) * (p - Vec3(box.centre)));
      widest = glm::max(widest, local);
      for (int axis = 0; axis < 3; ++axis) {
        REQUIRE(p[axis] > double(world.lower[axis]) - 1e-5);
        REQUIRE(p[axis] < double(world.upper[axis]) + 1e-5);
      }
    }
    REQUIRE(glm::distance(widest, Vec3(box.half_extents)) < 1e-5);
  }
}

TEST_CASE("the normal of a meshed sphere is the sphere's to within a face's tilt", "[triangle_surface]") {
  Draw draw(44);
  const MeshSolid mesh = testing::fine_mesh(Sphere{0.12});
  for (int i = 0; i < 2000; ++i) {
    const Frame frame = anywhere(draw);
    const PosedShape posed = place(mesh, frame);
    const Vec3 outward = draw.direction();
    const Vec3f normal = surface_normal(posed, Vec3f(frame.origin + 0.12 * outward));
    REQUIRE(glm::length(normal) == Approx(1.0).margin(1e-5));
    // Half a face is pi / 96 across either way: together 0.046 rad.
    REQUIRE(glm::length(glm::cross(Vec3(normal), outward)) < 0.047);
    REQUIRE(glm::dot(Vec3(normal), outward) > 0.0);
  }
}

TEST_CASE("in the mirror x -> -x a mesh is hit at a distance of the same bits", "[triangle_surface]") {
  Draw draw(45);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const TriMesh mesh = testing::triangle_soup(draw, 20);
    const MeshSolid solid = testing::mesh_solid(mesh), mirror = testing::mesh_solid(testing::mirrored(mesh));
    const Frame frame = anywhere(draw);
    for (int k = 0; k < 100; ++k) {
      const Ray ray = scattered_ray(draw, frame, 0.4);
      const auto here = entry_distance(ray, place(solid, frame), beyond);
      REQUIRE(entry_distance(testing::mirrored(ray), place(mirror, testing::mirrored(frame)), beyond) == here);
      hits += here ? 1 : 0;
    }
  }
  CHECK(hits > 5000);
}

TEST_CASE("a surface of nothing, of vertices that aren't finite or of none is refused", "[triangle_surface]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(TriangleSurface(TriMesh{"hand", {}, {}}), Error);
  CHECK_THROWS_AS(TriangleSurface(TriMesh{"hand", {{0, 0, 0}, {1, 0, 0}, {0, nan, 0}}, {{0, 1, 2}}}), Error);
  CHECK_THROWS_AS(TriangleSurface(TriMesh{"hand", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}), Error);
  CHECK_NOTHROW(TriangleSurface(TriMesh{"hand", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}));
}
