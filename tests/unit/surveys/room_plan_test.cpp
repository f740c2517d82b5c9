#include "surveys/picture.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "pirsim/geometry.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::studies;
using namespace pirsim::test;

namespace {

double area_of(const std::vector<Vec2>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(0.5 * twice);
}

/// A box whose corners are (x0, y0, z0) and (x1, y1, z1).
TriMesh box(const std::string& name, const Vec3& lower, const Vec3& upper) {
  TriMesh mesh;
  mesh.name = name;
  for (unsigned corner = 0; corner < 8; ++corner)
    mesh.positions.emplace_back((corner & 1U) != 0 ? upper.x : lower.x, (corner & 2U) != 0 ? upper.y : lower.y,
                                (corner & 4U) != 0 ? upper.z : lower.z);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

}  // namespace

TEST_CASE("a mesh is a wall, a ceiling, a floor or furniture by its size and height") {
  CHECK(role_of(box("wall", {0, 0, 0}, {4, 2.6, 0.1}), 0.0) == MeshRole::wall);
  CHECK(role_of(box("ceiling", {0, 2.6, -4}, {4, 2.7, 0}), 0.0) == MeshRole::ceiling);
  CHECK(role_of(box("lintel", {0, 2.1, 0}, {0.1, 2.6, 0.1}), 0.0) == MeshRole::wall);
  CHECK(role_of(box("carpet", {0, -0.1, -4}, {4, 0.01, 0}), 0.0) == MeshRole::floor);
  CHECK(role_of(box("desk", {0, 0, -1}, {1.6, 0.74, 0}), 0.0) == MeshRole::furniture);
  CHECK(role_of(box("desk upstairs", {0, 3, -1}, {1.6, 3.74, 0}), 3.0) == MeshRole::furniture);
}

TEST_CASE("a plan outlines each connected piece of furniture by its convex hull") {
  SceneSpec scene;
  scene.floor = FloorArea({{{0, 0}, {5, 0}, {5, -4}, {0, -4}}}, 0.0);
  TriMesh desks = box("desks", {1, 0, -2}, {2.5, 0.74, -1.2});
  const TriMesh other = box("", {3, 0, -3}, {4, 0.74, -2.5});
  for (const auto& triangle : other.triangles) {
    desks.triangles.push_back({triangle[0] + 8, triangle[1] + 8, triangle[2] + 8});
  }
  desks.positions.insert(desks.positions.end(), other.positions.begin(), other.positions.end());
  scene.meshes = {desks, box("wall", {0, 0, 0}, {5, 2.6, 0.1})};
  const io::RoomPlan plan = plan_of(scene);
  REQUIRE(plan.furniture.size() == 2);
  CHECK(area_of(plan.furniture[0]) == Approx(1.5 * 0.8));
  CHECK(area_of(plan.furniture[1]) == Approx(1.0 * 0.5));
  for (const auto& polygon : plan.furniture) CHECK(polygon.size() == 4);
}

TEST_CASE("a plan shows walls where they are a metre above the floor, whole ones as areas and shells as lines") {
  SceneSpec scene;
  scene.floor = FloorArea({{{0, 0}, {8, 0}, {8, -6}, {0, -6}}}, 1.0);
  TriMesh shell = box("shell", {0, 1, -6}, {8, 3.6, 0});
  scene.meshes = {box("inner wall", {3, 1, -6}, {3.1, 3.6, -1}), box("lintel", {3, 3.1, -1}, {3.1, 3.6, 0}), shell,
                  box("desk", {1, 1, -2}, {2, 1.74, -1})};
  const io::RoomPlan plan = plan_of(scene);
  REQUIRE(plan.walls.size() == 1);
  REQUIRE(plan.walls[0].size() == 1);
  CHECK(area_of(plan.walls[0][0]) == Approx(0.1 * 5.0));
  for (const Vec2& corner : plan.walls[0][0]) CHECK((corner.x >= 3.0 && corner.x <= 3.1 && corner.y <= -1.0));
  REQUIRE(plan.wall_lines.size() == 1);
  CHECK(plan.wall_lines[0].front() == plan.wall_lines[0].back());
  CHECK(area_of(plan.wall_lines[0]) == Approx(8.0 * 6.0));
  CHECK(plan.furniture.size() == 1);
}

TEST_CASE("a plan takes the corners of a single triangle for one piece") {
  SceneSpec scene;
  scene.floor = FloorArea({{{0, 0}, {5, 0}, {5, -4}, {0, -4}}}, 0.0);
  TriMesh shelf;
  shelf.positions = {{1, 1, -1}, {2, 1, -1}, {1, 1, -2}};
  shelf.triangles = {{0, 1, 2}};
  scene.meshes = {shelf};
  const io::RoomPlan plan = plan_of(scene);
  REQUIRE(plan.furniture.size() == 1);
  CHECK(area_of(plan.furniture[0]) == Approx(0.5));
}

TEST_CASE("a plan has every seat and door of the scene, doors as wide as they are") {
  const SceneSpec scene = shipped_scene("open_office.gltf");
  const io::RoomPlan plan = plan_of(scene);
  REQUIRE(plan.seats.size() == scene.seats.size());
  REQUIRE(plan.doors.size() == scene.entrances.size());
  for (std::size_t i = 0; i < plan.doors.size(); ++i) {
    CHECK(plan.doors[i].label == scene.entrances[i].id);
    CHECK(glm::distance(plan.doors[i].from, plan.doors[i].to) == Approx(scene.entrances[i].width_m));
    const Vec2 middle = 0.5 * (plan.doors[i].from + plan.doors[i].to);
    CHECK(glm::distance(middle, floor_point(scene.entrances[i].world_from_entrance.origin)) < 1e-9);
  }
  CHECK(plan.outline == scene.floor.loops());
}
