#include "model/geom/mesh.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/meeting_room.hpp"

using namespace pirsim;
using testing::box_mesh;

namespace {

double signed_area(const std::vector<Vec2>& loop) {
  double twice = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 a = loop[i], b = loop[(i + 1) % loop.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

/// Both as one mesh.
TriMesh together(TriMesh a, const TriMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

}  // namespace

TEST_CASE("a closed mesh is cut in loops, whatever the height", "[geom][section]") {
  const TriMesh box = box_mesh({1, 0, -2}, {1.2, 2, 3});
  for (const double height : {0.0, 0.3, 1.0, 1.999}) {
    const MeshSection section = section_of(box, height);
    REQUIRE(section.loops.size() == 1);
    CHECK(section.lines.empty());
    CHECK(std::abs(signed_area(section.loops[0])) == Approx(0.2 * 5.0));
    CHECK(mean_thickness_m(section.loops) == Approx(1.0 / 5.2));
  }
  for (const double height : {-0.1, 2.0, 2.1}) CHECK(section_of(box, height).loops.empty());
}

TEST_CASE("an open mesh is cut in lines, and a hole runs the other way round", "[geom][section]") {
  TriMesh sheet;
  sheet.positions = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const MeshSection section = section_of(sheet, 1.0);
  CHECK(section.loops.empty());
  REQUIRE(section.lines.size() == 1);
  CHECK(section.lines[0].size() == 3);  // both triangles and the point between them
  CHECK(mean_thickness_m(section.loops) == 0.0);

  TriMesh inside = box_mesh({-2, 0, -2}, {2, 3, 2});
  for (auto& t : inside.triangles) std::swap(t[1], t[2]);
  const MeshSection ring = section_of(together(box_mesh({-2.2, 0, -2.2}, {2.2, 3, 2.2}), inside), 1.0);
  REQUIRE(ring.loops.size() == 2);
  CHECK(signed_area(ring.loops[0]) * signed_area(ring.loops[1]) < 0.0);
  CHECK(mean_thickness_m(ring.loops) == Approx(0.2).epsilon(0.01));
}
