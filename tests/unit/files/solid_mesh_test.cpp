#include "files/write/gltf_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <utility>

#include "support/catch.hpp"

using namespace pirsim;
using pirsim::io::SolidMesh;
using pirsim::io::tessellated;

namespace {

/// Positive if triangles are counter-clockwise seen from outside.
double volume(const SolidMesh& mesh) {
  double six_fold = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3& a = mesh.positions[mesh.indices[i]];
    const Vec3& b = mesh.positions[mesh.indices[i + 1]];
    const Vec3& c = mesh.positions[mesh.indices[i + 2]];
    six_fold += glm::dot(a, glm::cross(b, c));
    const Vec3 facing = glm::cross(b - a, c - a);
    CHECK(glm::length(facing) > 0.0);
    for (std::size_t k = 0; k < 3; ++k) CHECK(glm::dot(facing, mesh.normals[mesh.indices[i + k]]) > 0.0);
  }
  return six_fold / 6.0;
}

/// Every edge is there as often one way as the other. Vertices are told apart by their place.
bool closed(const SolidMesh& mesh) {
  const auto place = [&](std::size_t i) {
    const Vec3& p = mesh.positions[mesh.indices[i]];
    return std::array{std::lround(p.x * 1e9), std::lround(p.y * 1e9), std::lround(p.z * 1e9)};
  };
  std::map<std::pair<std::array<long, 3>, std::array<long, 3>>, int> balance;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = place(i + k);
      const auto b = place(i + (k + 1) % 3);
      ++balance[{a, b}];
      --balance[{b, a}];
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

TEST_CASE("tessellated solids are closed, face outward and have nearly the solid's volume", "[solid_mesh]") {
  const double r = 0.1;
  const double h = 0.25;
  const auto [shape, exact] = GENERATE_COPY(table<Shape, double>({{Sphere{r}, 4.0 / 3.0 * pi * r * r * r},
                                                                  {Capsule{r, h}, pi * r * r * (4.0 / 3.0 * r + 2 * h)},
                                                                  {Box{{0.1, 0.2, 0.3}}, 8 * 0.1 * 0.2 * 0.3}}));
  const SolidMesh mesh = tessellated(shape);
  REQUIRE(mesh.normals.size() == mesh.positions.size());
  for (const Vec3& normal : mesh.normals) CHECK(glm::length(normal) == Approx(1.0).epsilon(1e-12));
  CHECK(closed(mesh));
  const double found = volume(mesh);
  CHECK(found <= exact * (1 + 1e-12));
  CHECK(found >= 0.94 * exact);
  CHECK(mesh.indices.size() / 3 < 600);
}

TEST_CASE("no face of a tessellated sphere is further from it than a fiftieth of its radius", "[solid_mesh]") {
  const SolidMesh mesh = tessellated(Sphere{1.0});
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3 middle =
        (mesh.positions[mesh.indices[i]] + mesh.positions[mesh.indices[i + 1]] + mesh.positions[mesh.indices[i + 2]]) /
        3.0;
    const Vec3 edge = 0.5 * (mesh.positions[mesh.indices[i]] + mesh.positions[mesh.indices[i + 1]]);
    CHECK(glm::length(middle) > 0.98);
    CHECK(glm::length(edge) > 0.98);
  }
}
