#include "dataset/boxes.hpp"

#include <array>
#include <utility>

namespace pirsim::dataset {
namespace {

/// Single precision, as a file holds it, so that a room in memory and one read back are the same.
using Sides = std::array<float, 2>;
Sides sides(double lower, double upper) { return {static_cast<float>(lower), static_cast<float>(upper)}; }

}  // namespace

TriMesh boxes(const std::string& name, const Spot& spot, std::span<const BoxPart> parts) {
  // Corner k has the upper x, y, z where bit 0, 1, 2 is set; outward, counter-clockwise.
  constexpr std::array<std::array<std::uint32_t, 4>, 6> quads{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  TriMesh mesh;
  mesh.name = name;
  for (const BoxPart& part : parts) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Rectangle r = spot * part.footprint;
    const Sides x = sides(r.lower.x, r.upper.x), y = sides(part.from_y_m, part.to_y_m), z = sides(r.lower.y, r.upper.y);
    for (std::size_t k = 0; k < 8; ++k) mesh.positions.emplace_back(x[k & 1], y[k >> 1 & 1], z[k >> 2 & 1]);
    for (const auto& q : quads) {
      mesh.triangles.push_back({first + q[0], first + q[1], first + q[2]});
      mesh.triangles.push_back({first + q[0], first + q[2], first + q[3]});
    }
  }
  return mesh;
}

TriMesh floor_mesh(const std::vector<Rectangle>& pieces) {
  TriMesh mesh;
  mesh.name = "floor";
  for (const Rectangle& r : pieces) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Sides x = sides(r.lower.x, r.upper.x), z = sides(r.lower.y, r.upper.y);
    for (const auto& [i, k] : {std::pair(0, 1), std::pair(1, 1), std::pair(1, 0), std::pair(0, 0)}) {
      mesh.positions.emplace_back(x[static_cast<std::size_t>(i)], 0.0F, z[static_cast<std::size_t>(k)]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

}  // namespace pirsim::dataset
