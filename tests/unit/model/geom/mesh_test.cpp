#include "pirsim/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

#include "model/geom/mesh.hpp"
#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"
#include "support/meeting_room.hpp"

using namespace pirsim;
using testing::box_mesh;

namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Unit cube as exporters write it: four vertices a face. The last face is the top.
TriMesh cube() {
  TriMesh mesh;
  mesh.name = "cube";
  const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}};
  for (const auto& face : faces) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const int corner : face) mesh.positions.emplace_back(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    mesh.triangles.push_back({base, base + 1, base + 2});
    mesh.triangles.push_back({base, base + 2, base + 3});
  }
  return mesh;
}

/// A band of n quads whose end is joined to its beginning after half a turn.
TriMesh moebius(std::uint32_t n) {
  TriMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / n;
    for (const double s : {-0.2, 0.2}) {
      const double r = 1.0 + s * std::cos(angle / 2.0);
      mesh.positions.emplace_back(r * std::cos(angle), s * std::sin(angle / 2.0), r * std::sin(angle));
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const bool last = i + 1 == n;
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back({a, d, c});
  }
  return mesh;
}

/// Squares of a grid as a mesh of their own vertices each, cell (i, j) at [i, i + 1] x [j, j + 1].
TriMesh tiles(const std::vector<std::array<int, 2>>& cells) {
  TriMesh mesh;
  mesh.name = "tiles";
  for (const auto& [i, j] : cells) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [x, z] : {std::array{i, j}, {i, j + 1}, {i + 1, j + 1}, {i + 1, j}})
      mesh.positions.emplace_back(x, 0.0, z);
    mesh.triangles.push_back({base, base + 1, base + 2});
    mesh.triangles.push_back({base, base + 2, base + 3});
  }
  return mesh;
}

double shoelace(const std::vector<Vec2>& loop) {
  double twice = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &a = loop[i], &b = loop[(i + 1) % loop.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return 0.5 * twice;
}

/// What anything writes to the error stream meanwhile.
class CapturedErrors {
 public:
  CapturedErrors() : before_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~CapturedErrors() { std::cerr.rdbuf(before_); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::streambuf* before_;
};

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

TEST_CASE("a closed cube of separate faces is welded to eight vertices without a boundary", "[mesh]") {
  const CleanMesh result = clean(cube());
  CHECK(result.mesh.name == "cube");
  CHECK(result.mesh.positions.size() == 8);
  CHECK(result.mesh.triangles.size() == 12);
  CHECK(result.audit.welded_vertices == 16);
  CHECK(result.audit.boundary_edges == 0);
  CHECK(result.audit.non_manifold_triangles == 0);
}

TEST_CASE("a box without a lid has the four boundary edges of its rim", "[mesh]") {
  TriMesh box = cube();
  box.triangles.resize(10);
  const CleanMesh result = clean(box);
  CHECK(result.audit.boundary_edges == 4);
  CHECK(result.mesh.triangles.size() == 10);
  CHECK(result.audit.non_manifold_triangles == 0);
}

TEST_CASE("vertices are welded up to the tolerance and not beyond, also across grid cells", "[mesh]") {
  for (const double at : {0.0, 8e-3, -8e-3, 1.2345, 1e4}) {
    TriMesh mesh;
    mesh.positions = {{at, 0, 0}, {at + 1, 0, 0}, {at, 1, 0}, {at - 0.9e-3, 0, 0}, {at + 1, 0, 1.1e-3}, {at, 1, 2}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    CHECK(clean(mesh, 1e-3).audit.welded_vertices == 1);
    CHECK(clean(mesh, 1e-6).audit.welded_vertices == 0);
  }
}

TEST_CASE("triangles without area and triangles given twice are dropped and counted", "[mesh]") {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {2, 0, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {2, 0, 1}, {0, 2, 1}, {0, 1, 4}, {0, 1, 3}, {1, 1, 2}};
  const CleanMesh result = clean(mesh);
  CHECK(result.mesh.triangles.size() == 1);
  CHECK(result.audit.duplicate_triangles == 3);
  CHECK(result.audit.degenerate_triangles == 2);
  CHECK(result.mesh.positions.size() == 3);
}

TEST_CASE("three triangles on an edge are all kept and one is reported", "[mesh]") {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const CleanMesh result = clean(mesh);
  CHECK(result.mesh.triangles.size() == 3);
  CHECK(result.audit.non_manifold_triangles == 1);
  CHECK(result.audit.boundary_edges == 6);
}

TEST_CASE("a Moebius strip can't be wound consistently and is kept whole", "[mesh]") {
  const CleanMesh result = clean(moebius(12));
  CHECK(result.mesh.triangles.size() == 24);
  CHECK(result.audit.non_manifold_triangles > 0);
  CHECK(result.audit.boundary_edges == 24);
}

TEST_CASE("a T-junction leaves its three edges on the boundary and is no fault", "[mesh]") {
  TriMesh mesh;  // one triangle below the edge from 0 to 2, two above it that meet in its middle, 1
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 1}, {0, 0, -1}, {2, 0, -1}};
  mesh.triangles = {{0, 2, 3}, {0, 4, 1}, {1, 5, 2}, {1, 4, 5}};
  const CleanMesh result = clean(mesh);
  CHECK(result.audit.boundary_edges == 8);
  CHECK(result.audit.non_manifold_triangles == 0);
}

TEST_CASE("a cube is manifold whichever of its triangles are wound the wrong way", "[mesh]") {
  for (unsigned flipped = 0; flipped < (1U << 12U); ++flipped) {
    TriMesh mesh = cube();
    for (unsigned t = 0; t < 12; ++t) {
      if ((flipped >> t & 1U) != 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    }
    if (clean(mesh).audit.non_manifold_triangles != 0) FAIL("flipped " << flipped);
  }
}

TEST_CASE("random triangle soups lose nothing that has an area and print nothing", "[mesh]") {
  const CapturedErrors errors;
  pirsim::Stream stream({.seed = 3});
  for (int trial = 0; trial < 2000; ++trial) {
    TriMesh soup;
    for (int i = 0; i < 7; ++i) soup.positions.emplace_back(stream.uniform(), stream.uniform(), stream.uniform());
    const std::uint32_t n = 1 + stream.index(30);
    for (std::uint32_t t = 0; t < n; ++t) soup.triangles.push_back({stream.index(7), stream.index(7), stream.index(7)});
    const CleanMesh result = clean(soup);

    std::set<Triangle> distinct;
    std::map<std::set<std::uint32_t>, int> uses;
    for (Triangle t : soup.triangles) {
      std::sort(t.begin(), t.end());
      if (t[0] == t[1] || t[1] == t[2] || !distinct.insert(t).second) continue;
      for (const auto& [a, b] : {std::pair{t[0], t[1]}, {t[1], t[2]}, {t[0], t[2]}}) ++uses[{a, b}];
    }
    const auto rim = std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second == 1; });
    const bool crowded = std::any_of(uses.begin(), uses.end(), [](const auto& use) { return use.second > 2; });
    if (result.mesh.triangles.size() != distinct.size()) FAIL("lost triangles in trial " << trial);
    if (result.audit.boundary_edges != static_cast<std::size_t>(rim)) FAIL("wrong rim in trial " << trial);
    if (crowded && result.audit.non_manifold_triangles == 0) FAIL("a crowded edge passed in trial " << trial);
  }
  CHECK(errors.text().empty());
}

TEST_CASE("the outline of an L-shaped floor with a hole encloses its area, outer loop counter-clockwise from above",
          "[mesh]") {
  std::vector<std::array<int, 2>> cells;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 5; ++j) {
      const bool in_cut = i >= 4 && j >= 3;
      const bool in_hole = i >= 1 && i <= 2 && j == 1;
      if (!in_cut && !in_hole) cells.push_back({i, j});
    }
  }
  TriMesh floor = tiles(cells);
  const bool upside_down = GENERATE(false, true);
  if (upside_down) {
    for (Triangle& t : floor.triangles) std::swap(t[0], t[1]);
  }
  const auto loops = boundary_loops_xz(floor);
  REQUIRE(loops.size() == 2);
  std::vector<double> areas{shoelace(loops[0]), shoelace(loops[1])};
  std::sort(areas.begin(), areas.end());
  // z runs down where x runs right as seen from above, so counter-clockwise is negative in (x, z).
  CHECK(areas[0] == Approx(-(6.0 * 5.0 - 2.0 * 2.0)));
  CHECK(areas[1] == Approx(2.0));
  CHECK(pirsim::FloorArea(loops, 0.0).area_m2() == Approx(24.0));
}

TEST_CASE("two floors side by side have the sum of their areas wherever their outlines begin", "[mesh]") {
  std::vector<Vec2> left{{0, 0}, {2, 0}, {2, 3}, {0, 3}}, right{{2, 0}, {4, 0}, {4, 3}, {2, 3}};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      CHECK(pirsim::FloorArea({left, right}, 0.0).area_m2() == Approx(12.0));
      std::rotate(right.begin(), right.begin() + 1, right.end());
    }
    std::rotate(left.begin(), left.begin() + 1, left.end());
  }
}

TEST_CASE("a closed or overlapping mesh has no outline and is refused by name", "[mesh]") {
  const auto message_of = [](const TriMesh& mesh) {
    try {
      static_cast<void>(boundary_loops_xz(mesh));
    } catch (const pirsim::Error& error) {
      CHECK(error.code() == pirsim::ErrorCode::input);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(message_of(cube()).find("'cube'") != std::string::npos);
  CHECK(message_of(cube()).find("closed") != std::string::npos);
  CHECK(message_of(tiles({{0, 0}, {1, 1}})).find("touches itself") != std::string::npos);
  CHECK(message_of(TriMesh{}).find("no triangles") != std::string::npos);
}

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
