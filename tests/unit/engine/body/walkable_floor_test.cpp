#include "engine/body/ground.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "engine/body/gait.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using pirsim::body::Disc;
using pirsim::body::WalkableFloor;
using Way = std::vector<Vec2>;

namespace {

constexpr double clearance = 0.3;

/// An upright block; what the tests know of obstacles besides their triangles.
struct Block {
  Vec2 lower;
  Vec2 upper;
  double bottom = 0.0;
  double top = 1.0;
};

TriMesh mesh_of(const Block& block) {
  TriMesh mesh{"block", {}, {}};
  for (unsigned i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1U) != 0 ? block.upper.x : block.lower.x, (i & 2U) != 0 ? block.top : block.bottom,
                                (i & 4U) != 0 ? block.upper.y : block.lower.y);
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

std::vector<TriMesh> meshes_of(const std::vector<Block>& blocks) {
  std::vector<TriMesh> meshes;
  for (const Block& block : blocks) meshes.push_back(mesh_of(block));
  return meshes;
}

double distance_to(const Block& block, const Vec2& p) {
  const Vec2 outside = glm::max(glm::max(block.lower - p, p - block.upper), Vec2(0.0));
  return glm::length(outside);
}

FloorArea rectangle(double width, double depth) {
  return FloorArea({{{0, 0}, {width, 0}, {width, depth}, {0, depth}}}, 0.0);
}

double length_of(const Way& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += glm::distance(way[i - 1], way[i]);
  return length;
}

template <typename Check>
void along(const Way& way, const Check& check) {
  for (std::size_t i = 1; i < way.size(); ++i) {
    const int n = 1 + static_cast<int>(glm::distance(way[i - 1], way[i]) / 0.005);
    for (int k = 0; k <= n; ++k) check(way[i - 1] + (way[i] - way[i - 1]) * (static_cast<double>(k) / n));
  }
}

void require_clear(const WalkableFloor& floor, const std::vector<Block>& blocks, const Way& way) {
  along(way, [&](const Vec2& p) {
    REQUIRE(floor.walkable(p));
    for (const Block& block : blocks) REQUIRE(distance_to(block, p) >= clearance - 1e-6);
  });
}

/// Least cost between two cells of a floor of 0.1 m cells from the origin, by relaxation; infinite for no way.
double brute_force_m(const WalkableFloor& floor, int columns, int rows, const Vec2& from, const Vec2& to) {
  struct Edge {
    std::size_t a, b;
    double cost;
  };
  const auto centre = [](int column, int row) { return Vec2(0.1 * column + 0.05, 0.1 * row + 0.05); };
  const auto index = [&](int column, int row) { return static_cast<std::size_t>(row * columns + column); };
  const auto index_at = [&](const Vec2& p) { return index(static_cast<int>(p.x * 10), static_cast<int>(p.y * 10)); };
  std::vector<Edge> edges;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      for (const auto& [dc, dr] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}}) {
        const int c = column + dc;
        const int r = row + dr;
        if (c < 0 || c >= columns || r >= rows || !floor.walkable(centre(column, row), centre(c, r))) continue;
        if (!floor.walkable(centre(c, row)) || !floor.walkable(centre(column, r))) continue;
        edges.push_back({index(column, row), index(c, r), 0.1 * std::hypot(dc, dr)});
      }
    }
  }
  std::vector<double> cost(static_cast<std::size_t>(columns * rows), std::numeric_limits<double>::infinity());
  cost[index_at(from)] = 0.0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b, step] : edges) {
      if (cost[a] + step < cost[b] - 1e-9) cost[b] = cost[a] + step, changed = true;
      if (cost[b] + step < cost[a] - 1e-9) cost[a] = cost[b] + step, changed = true;
    }
  }
  return cost[index_at(to)];
}

std::vector<Block> random_blocks(Stream& stream, double width, double depth) {
  std::vector<Block> blocks;
  for (std::uint32_t i = 0, n = 2 + stream.index(9); i < n; ++i) {
    const Vec2 corner(width * stream.uniform(), depth * stream.uniform());
    blocks.push_back({corner, corner + Vec2(0.02 + 1.2 * stream.uniform(), 0.02 + 1.2 * stream.uniform())});
  }
  return blocks;
}

Way mirrored(Way way, double width) {
  for (Vec2& p : way) p.x = width - p.x;
  return way;
}

}  // namespace

TEST_CASE("a lintel at 2.00 m leaves its doorway open, one below it closes it") {
  const auto leads_through = [](double lintel_m, double floor_m) {
    std::vector<Block> blocks{{{1.9, 0.0}, {2.1, 1.0}, 0.0, 2.6}, {{1.9, 1.9}, {2.1, 3.0}, 0.0, 2.6}};
    blocks.push_back({{1.9, 1.0}, {2.1, 1.9}, lintel_m, 2.6});
    std::vector<TriMesh> meshes = meshes_of(blocks);
    for (TriMesh& mesh : meshes) {
      for (Vec3& corner : mesh.positions) corner.y = static_cast<float>(corner.y + floor_m);  // as files keep it
    }
    const FloorArea floor({{{0, 0}, {4, 0}, {4, 3}, {0, 3}}}, static_cast<float>(floor_m));
    return WalkableFloor(floor, {}, meshes, clearance).find_way({1, 1.5}, {3, 1.5}).has_value();
  };
  for (const double floor_m : {0.0, 0.1, -3.3, 7.7, 100.3}) {
    CHECK(leads_through(2.0, floor_m));
    CHECK(leads_through(2.3, floor_m));
    CHECK_FALSE(leads_through(1.98, floor_m));
  }
}

TEST_CASE("a point is walkable exactly where it keeps the clearance from a block", "[walkable_floor]") {
  const Block block{{1.013, 1.27}, {2.1, 1.9}};
  const WalkableFloor floor(rectangle(4, 3), {}, meshes_of({block}), clearance);
  Stream stream({.seed = 21});
  for (int i = 0; i < 20000; ++i) {
    const Vec2 p(4 * stream.uniform(), 3 * stream.uniform());
    REQUIRE(floor.walkable(p) == (distance_to(block, p) >= clearance));
  }
}

TEST_CASE("only what is between 0.1 m and 2 m above the floor is in the way", "[walkable_floor]") {
  const auto blocked = [](double bottom, double top) {
    const Block block{{1, 1}, {2, 2}, bottom, top};
    return !WalkableFloor(FloorArea({{{0, 0}, {3, 0}, {3, 3}, {0, 3}}}, 5.0), {}, meshes_of({block}), clearance)
                .walkable({1.55, 1.55});
  };
  CHECK_FALSE(blocked(5.0, 5.09));
  CHECK(blocked(5.0, 5.11));
  CHECK(blocked(6.9, 7.2));
  CHECK_FALSE(blocked(7.01, 7.2));
  CHECK_FALSE(blocked(0.0, 2.0));  // a storey below
}

TEST_CASE("a leaning triangle blocks with its part between the heights only", "[walkable_floor]") {
  // Rises from y = 0 at x = 0 to y = 4 at x = 4: in the slab for x in [0.1, 2].
  const std::vector<TriMesh> roof{{"roof", {{0, 0, 0}, {4, 4, -3}, {4, 4, 3}}, {{0, 1, 2}}}};
  const WalkableFloor floor(FloorArea({{{-2, -2}, {4, -2}, {4, 2}, {-2, 2}}}, 0.0), {}, roof, clearance);
  CHECK(floor.walkable({2.0 + clearance + 1e-6, 0.0}));
  CHECK_FALSE(floor.walkable({2.0 + clearance - 1e-6, 0.0}));
  CHECK(floor.walkable({0.0 - clearance, 0.0}));
  CHECK_FALSE(floor.walkable({0.1 - clearance + 0.02, 0.0}));
}

TEST_CASE("a wall without thickness blocks on both of its sides", "[walkable_floor]") {
  const std::vector<TriMesh> wall{{"wall", {{2, 0, -1}, {2, 3, -1}, {2, 3, 4}, {2, 0, 4}}, {{0, 1, 2}, {0, 2, 3}}}};
  const WalkableFloor floor(rectangle(4, 3), {}, wall, clearance);
  for (const double side : {-1.0, 1.0}) {
    CHECK_FALSE(floor.walkable({2 + side * (clearance - 1e-6), 1.5}));
    CHECK(floor.walkable({2 + side * (clearance + 1e-6), 1.5}));
  }
  CHECK_FALSE(floor.find_way({1, 1}, {3, 1}).has_value());
  // Even a body much thinner than a cell doesn't slip through.
  CHECK_FALSE(WalkableFloor(rectangle(4, 3), {}, wall, 0.001).find_way({1, 1}, {3, 1}).has_value());
}

TEST_CASE("in an empty room one goes straight", "[walkable_floor]") {
  const WalkableFloor floor(rectangle(5, 4), {}, {}, clearance);
  CHECK(*floor.find_way({0.52, 0.57}, {4.31, 3.13}) == Way{{0.52, 0.57}, {4.31, 3.13}});
  CHECK(*floor.find_way({1, 1}, {1, 1}) == Way{{1, 1}, {1, 1}});
  CHECK_FALSE(floor.walkable({5.05, 1}));
  CHECK_FALSE(floor.find_way({1, 1}, {7, 1}).has_value());
  CHECK_FALSE(floor.find_way({1, 1}, {std::numeric_limits<double>::quiet_NaN(), 1}).has_value());
  CHECK_FALSE(floor.walkable({std::numeric_limits<double>::infinity(), 1}));
}

TEST_CASE("the way round a table is as long as a string round its margin, within the grid's error",
          "[walkable_floor]") {
  const Block table{{3, 1}, {4, 3}, 0.7, 0.75};
  const WalkableFloor floor(rectangle(7, 5), {}, meshes_of({table}), clearance);
  // From the middle of one side to the middle of the other: tangent, arc, the table's short edge, arc, tangent.
  const Vec2 from(2.0, 2.4);
  const Vec2 to(5.0, 2.4);
  const Vec2 corner(3.0, 3.0);
  const double reach = glm::distance(from, corner);
  const double tangent = std::sqrt(reach * reach - clearance * clearance);
  const double bearing = std::atan2(corner.y - from.y, corner.x - from.x) + std::asin(clearance / reach);
  const double taut = 2 * tangent + 2 * clearance * bearing + 1.0;
  const Way way = *floor.find_way(from, to);
  require_clear(floor, {table}, way);
  CHECK(length_of(way) >= taut - 1e-6);
  CHECK(length_of(way) <= taut + 0.05);
  CHECK(way.front() == from);
  CHECK(way.back() == to);
  // Nobody walks a staircase: a few gentle corners, all of them turning the same way.
  CHECK(way.size() <= 6);
  for (std::size_t i = 2; i < way.size(); ++i) {
    const Vec2 in = way[i - 1] - way[i - 2];
    const Vec2 out = way[i] - way[i - 1];
    CHECK(in.x * out.y - in.y * out.x < 0.0);
  }
}

TEST_CASE("rounded corners keep the clearance but for the corner cut", "[walkable_floor]") {
  Stream stream({.seed = 22});
  for (int round = 0; round < 100; ++round) {
    const std::vector<Block> blocks = random_blocks(stream, 5, 4);
    const WalkableFloor floor(rectangle(5, 4), {}, meshes_of(blocks), clearance);
    const auto way = floor.find_way({0.25, 0.25}, {4.75, 3.75});
    if (!way || !floor.walkable(way->front()) || !floor.walkable(way->back())) continue;
    const body::Route route(*way);
    for (double s = 0.0; s < route.length_m(); s += 0.01) {
      for (const Block& block : blocks) {
        REQUIRE(distance_to(block, route.position(s)) >= clearance - body::Route::max_corner_cut_m - 1e-6);
      }
    }
  }
}

TEST_CASE("ways in random rooms exist as by brute force, are no longer, and every leg is walkable",
          "[walkable_floor]") {
  Stream stream({.seed = 23});
  int found = 0;
  int none = 0;
  for (int round = 0; round < 300; ++round) {
    const std::vector<Block> blocks = random_blocks(stream, 4, 3);
    const WalkableFloor floor(rectangle(4, 3), {}, meshes_of(blocks), clearance);
    const auto cell = [&] { return Vec2(0.1 * stream.index(40) + 0.05, 0.1 * stream.index(30) + 0.05); };
    const Vec2 from = cell();
    const Vec2 to = cell();
    if (!floor.walkable(from) || !floor.walkable(to)) continue;
    const double best = brute_force_m(floor, 40, 30, from, to);
    const auto way = floor.find_way(from, to);
    REQUIRE(way.has_value() == std::isfinite(best));
    REQUIRE(floor.has_way(from, to) == way.has_value());
    if (!way) {
      ++none;
      continue;
    }
    ++found;
    REQUIRE(length_of(*way) <= best + 1e-9);
    REQUIRE(length_of(*way) >= glm::distance(from, to) - 1e-9);
    REQUIRE(way->front() == from);
    REQUIRE(way->back() == to);
    require_clear(floor, blocks, *way);
    REQUIRE(*floor.find_way(from, to) == *way);
  }
  CHECK(found > 30);
  CHECK(none > 3);
}

TEST_CASE("a mirrored room has ways of the mirrored length", "[walkable_floor]") {
  const double width = 5.03;  // not a whole number of cells
  const std::vector<Block> blocks{{{1.2, 0.4}, {1.7, 3.1}}, {{2.6, 1.5}, {3.4, 4.0}}};
  std::vector<Block> others;
  for (const Block& b : blocks) others.push_back({{width - b.upper.x, b.lower.y}, {width - b.lower.x, b.upper.y}});
  const WalkableFloor floor(rectangle(width, 4), {}, meshes_of(blocks), clearance);
  const WalkableFloor twin(rectangle(width, 4), {}, meshes_of(others), clearance);
  Stream stream({.seed = 24});
  int compared = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec2 from(width * stream.uniform(), 4 * stream.uniform());
    const Vec2 to(width * stream.uniform(), 4 * stream.uniform());
    const auto way = floor.find_way(from, to);
    const auto twin_way = twin.find_way(mirrored({from}, width).front(), mirrored({to}, width).front());
    REQUIRE(way.has_value() == twin_way.has_value());
    if (!way) continue;
    ++compared;
    // Ties between equally long cell ways are not mirrored, so that strings may settle in slightly other places.
    CHECK(length_of(*way) == Approx(length_of(*twin_way)).margin(0.02));
  }
  CHECK(compared > 50);
}

TEST_CASE("in a symmetric room both ways round the table are as long for a mirrored start", "[walkable_floor]") {
  const WalkableFloor floor(rectangle(6, 4), {}, meshes_of({{{2.5, 1.0}, {3.5, 3.0}}}), clearance);
  const double left = length_of(*floor.find_way({3.0, 0.5}, {1.5, 2.5}));
  const double right = length_of(*floor.find_way({3.0, 0.5}, {4.5, 2.5}));
  CHECK(left == Approx(right).margin(1e-3));
}

TEST_CASE("one gets in from behind an entrance and nowhere else", "[walkable_floor]") {
  // A door of 1 m in a wall of 0.2 m at z = 0; the room is at z < -0.1, the threshold in the middle of the wall.
  const FloorArea area({{{0, -0.1}, {4, -0.1}, {4, -3}, {0, -3}}}, 0.0);
  const std::vector<Block> walls{{{-0.5, -0.1}, {1.5, 0.1}, 0, 2.5}, {{2.5, -0.1}, {4.5, 0.1}, 0, 2.5}};
  const std::vector<EntranceSpec> door{{"door", Frame{Quat(1, 0, 0, 0), Vec3(2, 0, 0)}, 1.0, 1.5}};
  const WalkableFloor floor(area, door, meshes_of(walls), clearance);
  CHECK(floor.walkable({2, 1.9}));
  CHECK_FALSE(floor.walkable({2, 2.1}));
  CHECK_FALSE(floor.walkable({2.6, 1.5}));
  const auto way = floor.find_way({2, 1.5}, {0.5, -0.6});
  REQUIRE(way.has_value());
  require_clear(floor, walls, *way);
  CHECK_FALSE(WalkableFloor(area, {}, meshes_of(walls), clearance).find_way({2, 1.5}, {0.5, -0.6}).has_value());
}

TEST_CASE("an entrance turned by any angle leads in", "[walkable_floor]") {
  for (const double heading : {0.0, 0.3, pi / 4, 1.9, -2.2}) {
    const Vec2 in = direction_of(heading);
    const Vec2 side(-in.y, in.x);
    const FloorArea area({{-side * 2.0, side * 2.0, side * 2.0 + in * 4.0, -side * 2.0 + in * 4.0}}, 0.0);
    const std::vector<EntranceSpec> door{{"door", Frame{rotation_from_heading(heading), Vec3(0)}, 0.9, 1.5}};
    const WalkableFloor floor(area, door, {}, clearance);
    CHECK(floor.find_way(-in * 1.5, in * 2.0 + side) != std::nullopt);
    CHECK(floor.walkable(-in * 1.85));
    CHECK_FALSE(floor.walkable(-in * 2.15));
  }
}

TEST_CASE("other people are walked around and can close a passage", "[walkable_floor]") {
  const WalkableFloor floor(rectangle(5, 3), {}, {}, clearance);
  const std::vector<Disc> one{{{2.5, 1.5}, 0.3}};
  const Way way = *floor.find_way({1, 1.5}, {4, 1.5}, one);
  along(way, [&](const Vec2& p) { REQUIRE(glm::distance(p, one[0].centre) >= 0.6 - 1e-6); });
  // Tangent, arc, tangent round a circle of 0.6 m.
  const double taut = 2 * std::sqrt(1.5 * 1.5 - 0.6 * 0.6) + 2 * 0.6 * std::asin(0.6 / 1.5);
  CHECK(length_of(way) >= taut - 1e-6);
  CHECK(length_of(way) <= taut + 0.05);
  const std::vector<Disc> row{{{2.5, 0.4}, 0.3}, {{2.5, 1.5}, 0.3}, {{2.5, 2.6}, 0.3}};
  CHECK_FALSE(floor.find_way({1, 1.5}, {4, 1.5}, row).has_value());
}

TEST_CASE("who stands too near to a table is led away from it, never through it", "[walkable_floor]") {
  const Block table{{2, 0.8}, {2.2, 5.0}, 0.7, 0.75};
  const WalkableFloor floor(rectangle(5, 4), {}, meshes_of({table}), clearance);
  const Vec2 seat(1.9, 2.0);
  REQUIRE_FALSE(floor.walkable(seat));
  const Way way = *floor.find_way(seat, {4.0, 2.0});
  CHECK(way.front() == seat);
  along(way, [&](const Vec2& p) { REQUIRE(distance_to(table, p) >= 0.1 - 1e-6); });
  along(Way(way.begin() + 1, way.end()), [&](const Vec2& p) { REQUIRE(distance_to(table, p) >= clearance - 1e-6); });
  CHECK(glm::distance(way[0], way[1]) <= 0.5);
  Way back = *floor.find_way({4.0, 2.0}, seat);
  CHECK(length_of(back) == Approx(length_of(way)).margin(0.02));

  const WalkableFloor split(rectangle(5, 4), {}, meshes_of({{{2, -1}, {2.05, 5}}}), clearance);
  CHECK_FALSE(split.find_way({1.95, 2.0}, {4.0, 2.0}).has_value());
  CHECK(split.find_way({1.95, 2.0}, {1.0, 1.0}).has_value());
}

TEST_CASE("a lead crosses neither another person nor a gap in the floor", "[walkable_floor]") {
  // Against a wall, with somebody on the other side: the only free cells are behind that person.
  const WalkableFloor floor(rectangle(3, 2), {}, meshes_of({{{-0.2, -1}, {0, 3}}}), clearance);
  const Vec2 start(0.1, 1.0);
  CHECK(floor.find_way(start, {2, 1}).has_value());
  CHECK_FALSE(floor.find_way(start, {2, 1}, std::vector<Disc>{{{0.2, 1.0}, 0.05}}).has_value());

  // An island too narrow to walk on, across a gap from a floor that one can walk on.
  const std::vector<std::vector<Vec2>> islands{{{0, 0}, {0.4, 0}, {0.4, 2}, {0, 2}},
                                               {{0.6, 0}, {3, 0}, {3, 2}, {0.6, 2}}};
  const WalkableFloor split(FloorArea(islands, 0.0), {}, meshes_of({{{-0.2, -1}, {0, 3}}}), 0.45);
  CHECK(split.walkable({0.65, 1.05}));
  CHECK_FALSE(split.find_way({0.2, 1.05}, {2, 1}).has_value());
}

TEST_CASE("a floor without walls isn't left at its inner corner", "[walkable_floor]") {
  const FloorArea area({{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}}, 0.0);
  const WalkableFloor floor(area, {}, {}, clearance);
  const Way way = *floor.find_way({0.5, 3.5}, {3.5, 0.5});
  along(way, [&](const Vec2& p) { REQUIRE(floor.walkable(p)); });
  CHECK(length_of(way) == Approx(2 * std::hypot(0.5, 2.5)).margin(0.05));
}

TEST_CASE("who is more than half a metre from anywhere walkable has no way", "[walkable_floor]") {
  const WalkableFloor floor(rectangle(5, 4), {}, meshes_of({{{1, 1}, {4, 3}}}), clearance);
  CHECK(floor.find_way({1.1, 2.0}, {0.4, 0.4}).has_value());
  CHECK_FALSE(floor.find_way({2.5, 2.0}, {0.4, 0.4}).has_value());
}

TEST_CASE("without floor there is no way", "[walkable_floor]") {
  const WalkableFloor floor(FloorArea(), {}, {}, clearance);
  CHECK_FALSE(floor.walkable({0, 0}));
  CHECK_FALSE(floor.find_way({0, 0}, {1, 1}).has_value());
}

TEST_CASE("nobody minds what only hides", "[floor]") {
  const FloorArea floor(std::vector<std::vector<Vec2>>{{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}}, 0.0);
  std::vector<TriMesh> block{mesh_of({{-0.5, -0.5}, {0.5, 0.5}})};
  CHECK_FALSE(WalkableFloor(floor, {}, block, clearance).walkable(Vec2(0.0)));
  block.front().solidity = Solidity::screen;
  CHECK(WalkableFloor(floor, {}, block, clearance).walkable(Vec2(0.0)));
}
