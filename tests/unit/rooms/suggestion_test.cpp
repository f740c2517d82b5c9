// Proposals for models whose rooms are known.
#include "rooms/suggested_marks.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/geometric.hpp>
#include <set>

#include "model/geom/floor.hpp"
#include "model/schema/checks.hpp"
#include "support/catch.hpp"

using namespace pirsim;

namespace {

TriMesh small_box(const Vec3& least, const Vec3& most) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back((i & 1) != 0 ? most.x : least.x, (i & 2) != 0 ? most.y : least.y,
                                (i & 4) != 0 ? most.z : least.z);
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

struct ModelBuilder {
  io::ModelParts model;
  int add(const std::string& name, const Vec3& least, const Vec3& most, int parent = -1) {
    const int node = static_cast<int>(model.nodes.size());
    model.nodes.push_back({name, parent});
    model.parts.push_back({node, small_box(least, most)});
    return node;
  }
  int group(const std::string& name) {
    model.nodes.push_back({name, -1});
    return static_cast<int>(model.nodes.size()) - 1;
  }
};

/// 8 m x 6 m inside walls of 0.2 m, 2.5 m high. A wall at x = 5 has a gap of 0.9 m at z = 1; east of it a wall at z = 3
/// has one of 0.8 m at x = 7. The way in is 1 m wide, at z = 3 in the wall at x = 0.
ModelBuilder flat() {
  ModelBuilder b;
  b.add("Slab", {-0.2, -0.2, -0.2}, {8.2, 0.0, 6.2});
  b.add("Ceiling", {-0.2, 2.5, -0.2}, {8.2, 2.7, 6.2});
  b.add("W1", {-0.2, 0, -0.2}, {8.2, 2.5, 0});
  b.add("W2", {-0.2, 0, 6}, {8.2, 2.5, 6.2});
  b.add("W3", {8, 0, 0}, {8.2, 2.5, 6});
  b.add("W4", {-0.2, 0, 0}, {0, 2.5, 2.5});
  b.add("W5", {-0.2, 0, 3.5}, {0, 2.5, 6});
  b.add("I1", {5, 0, 0}, {5.1, 2.5, 0.55});
  b.add("I2", {5, 0, 1.45}, {5.1, 2.5, 6});
  b.add("I3", {5.1, 0, 3}, {6.6, 2.5, 3.1});
  b.add("I4", {7.4, 0, 3}, {8, 2.5, 3.1});
  return b;
}

void furnish(ModelBuilder& b) {
  const auto chair = [&](const std::string& name, double x, double z) {  // its back is towards +Z
    const int group = b.group(name);
    b.add("seat", {x - 0.2, 0.42, z - 0.2}, {x + 0.2, 0.46, z + 0.2}, group);
    b.add("back", {x - 0.2, 0.46, z + 0.16}, {x + 0.2, 0.95, z + 0.2}, group);
    for (const double dx : {-0.2, 0.16}) {
      for (const double dz : {-0.2, 0.16})
        b.add("leg", {x + dx, 0, z + dz}, {x + dx + 0.04, 0.42, z + dz + 0.04}, group);
    }
  };
  chair("Chair.001", 2, 2);
  const int sofa = b.group("Big_Sofa");
  b.add("cushions", {1, 0.0, 5.2}, {3, 0.42, 5.9}, sofa);
  b.add("rest", {1, 0.0, 5.9}, {3, 0.8, 6.0}, sofa);
  b.add("Table", {1.4, 0.7, 0.6}, {2.6, 0.75, 1.4});
  b.add("Bed", {6, 0, 3.9}, {7.9, 0.5, 5.3});
  b.add("wardrobe", {7.4, 0, 0}, {8, 2.0, 1.5});
}

double square_metres(const std::vector<Vec2>& outline) { return FloorArea({outline}, 0.0).area_m2(); }
bool is_near(const Vec2& a, const Vec2& b, double within_m) { return glm::distance(a, b) <= within_m; }

/// The model in another unit and with another axis up.
io::ModelParts given_as(io::ModelParts model, double metres, const std::function<Vec3(const Vec3&)>& turned) {
  for (io::ModelPart& part : model.parts) {
    for (Vec3& p : part.mesh.positions) p = turned(p) / metres;
  }
  return model;
}

}  // namespace

TEST_CASE("a flat of three rooms has three areas, two gaps and a way in", "[suggestion]") {
  ModelBuilder b = flat();
  const bool is_furnished = GENERATE(false, true);
  if (is_furnished) furnish(b);
  const studies::Suggestion found = studies::suggest(b.model, {}, "flat");
  CHECK(found.frame.unit == "m");
  CHECK(found.frame.up == 'y');
  CHECK(found.floor_m == Approx(0.0).margin(0.01));
  REQUIRE(found.areas.size() == 3);
  std::vector<double> sizes;
  for (const auto& area : found.areas) sizes.push_back(square_metres(area.outline));
  std::ranges::sort(sizes);
  // Less a square of 0.05 m or two along each wall, and along the wardrobe, which is as high as a wall.
  CHECK(sizes[0] == Approx(is_furnished ? 2.9 * 3.0 - 0.6 * 1.5 : 2.9 * 2.9).epsilon(0.12));
  CHECK(sizes[1] == Approx(is_furnished ? 2.9 * 2.9 : 2.9 * 3.0).epsilon(0.12));
  CHECK(sizes[2] == Approx(5.0 * 6.0).epsilon(0.06));
  REQUIRE(found.doors.size() == 2);
  for (const auto& door : found.doors) {
    const bool is_first = is_near(door.at, {5.05, 1.0}, 0.15), is_second = is_near(door.at, {7.0, 3.05}, 0.15);
    CHECK((is_first || is_second));
    CHECK(door.width_m == Approx(is_first ? 0.9 : 0.8).margin(0.11));
  }
  REQUIRE(found.entrances.size() == 1);
  CHECK(is_near(found.entrances[0].at, {-0.1, 3.0}, 0.2));
  CHECK(glm::dot(found.entrances[0].inwards, Vec2(1, 0)) > 0.99);
  CHECK(found.entrances[0].width_m == Approx(1.0).margin(0.11));
  REQUIRE(found.floors.size() == 1);
  CHECK(square_metres(found.floors[0]) == Approx(8.0 * 6.0).epsilon(0.03));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < i; ++k) CHECK_FALSE(outlines_cross(found.areas[i].outline, found.areas[k].outline));
  }
}

TEST_CASE("unit and axis of a model are found", "[suggestion]") {
  ModelBuilder b = flat();
  furnish(b);
  const studies::Suggestion expected = studies::suggest(b.model, {}, "flat");
  const auto same = [](const Vec3& p) { return p; };
  const auto z_up = [](const Vec3& p) { return Vec3(p.x, -p.z, p.y); };
  const auto x_up = [](const Vec3& p) { return Vec3(p.y, -p.x, p.z); };
  struct Given {
    const char* unit;
    double metres;
    char up;
    std::function<Vec3(const Vec3&)> turned;
  };
  for (const Given& given :
       {Given{"mm", 0.001, 'y', same}, Given{"cm", 0.01, 'y', same}, Given{"in", 0.0254, 'y', same},
        Given{"m", 1.0, 'z', z_up}, Given{"mm", 0.001, 'z', z_up}, Given{"m", 1.0, 'x', x_up}}) {
    const studies::Suggestion found = studies::suggest(given_as(b.model, given.metres, given.turned), {}, "flat");
    INFO(given.unit << ' ' << given.up);
    CHECK(found.frame.unit == given.unit);
    CHECK(found.frame.up == given.up);
    CHECK(found.floor_m == Approx(0.0).margin(0.01));
    CHECK(found.areas.size() == 3);
    CHECK(found.doors.size() == 2);
    REQUIRE(found.entrances.size() == 1);
    CHECK(is_near(found.entrances[0].at, expected.entrances[0].at, 0.1));
    REQUIRE(found.seats.size() == expected.seats.size());
    for (std::size_t i = 0; i < found.seats.size(); ++i)
      CHECK(glm::distance(found.seats[i].pelvis, expected.seats[i].pelvis) < 0.03);
  }
}

TEST_CASE("what people sit on is found by names and shapes, with its direction", "[suggestion]") {
  ModelBuilder b = flat();
  furnish(b);
  const studies::Suggestion found = studies::suggest(b.model, {}, "flat");
  REQUIRE(found.seats.size() == 4);  // a chair, three on the sofa
  CHECK(found.seats[0].node == "Chair.001");
  CHECK(is_near(floor_point(found.seats[0].pelvis), {2.0, 2.0}, 0.05));
  CHECK(found.seats[0].pelvis.y == Approx(0.54).margin(0.01));
  for (const auto& seat : found.seats) CHECK(glm::dot(seat.facing, Vec2(0, -1)) > 0.99);
  CHECK(found.seats[1].node == "Big_Sofa");
  CHECK(found.beds == std::vector<std::string>{"Bed"});
}

namespace {

/// A box whose faces are cut otherwise: along their other diagonals, or into strips with either of the two.
struct Cut {
  bool is_other_diagonal = false;
  int strips = 1;
};
void add_cut_box(TriMesh& mesh, const Vec3& least, const Vec3& most, const Cut& cut) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {least[axis], most[axis]}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int strip = 0; strip < cut.strips; ++strip) {
        const auto along = [&](int i) { return least[u] + (most[u] - least[u]) * i / cut.strips; };
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const auto& [pu, pv] : {std::pair(along(strip), least[v]), std::pair(along(strip + 1), least[v]),
                                     std::pair(along(strip + 1), most[v]), std::pair(along(strip), most[v])}) {
          Vec3 p(0.0);
          p[axis] = at, p[u] = pu, p[v] = pv;
          mesh.positions.push_back(p);
        }
        const std::uint32_t turn = cut.is_other_diagonal ? 1 : 0;
        const auto corner = [&](std::uint32_t k) { return first + (k + turn) % 4; };
        mesh.triangles.push_back({corner(0), corner(1), corner(2)});
        mesh.triangles.push_back({corner(0), corner(2), corner(3)});
      }
    }
  }
}

struct Furniture {
  const char* name;
  std::vector<std::pair<Vec3, Vec3>> boxes;  ///< round (0, 0, 0), its back towards -Z
  std::size_t seats;
};
const std::vector<Furniture>& furniture_with_backs() {
  static const std::vector<Furniture> all{
      {"Sofa_1", {{{-0.9, 0, -0.45}, {0.9, 0.42, 0.45}}, {{-0.9, 0.42, -0.45}, {0.9, 0.85, -0.25}}}, 2},
      {"Sofa_with_arms",
       {{{-1.2, 0, -0.45}, {1.2, 0.42, 0.45}},
        {{-1.2, 0.42, -0.45}, {1.2, 0.85, -0.25}},
        {{-1.2, 0.42, -0.25}, {-1.0, 0.62, 0.45}},
        {{1.0, 0.42, -0.25}, {1.2, 0.62, 0.45}}},
       3},
      {"Chair",
       {{{-0.23, 0.43, -0.23}, {0.23, 0.47, 0.23}},
        {{-0.23, 0.47, -0.23}, {0.23, 0.92, -0.18}},
        {{-0.2, 0, -0.2}, {-0.16, 0.43, 0.2}},
        {{0.16, 0, -0.2}, {0.2, 0.43, 0.2}}},
       1},
      {"Bench", {{{-0.6, 0, -0.3}, {0.6, 0.45, 0.3}}, {{-0.6, 0.45, -0.3}, {0.6, 0.9, -0.24}}}, 1}};
  return all;
}

}  // namespace

TEST_CASE("seats face away from their backs however furniture is mirrored, turned and cut into triangles",
          "[suggestion][seconds]") {
  for (const Furniture& piece : furniture_with_backs()) {
    for (const Cut& cut : {Cut{}, Cut{true, 1}, Cut{true, 5}}) {
      for (const double mirror : {1.0, -1.0}) {
        for (const int quarter : {0, 1}) {
          INFO(piece.name << ", strips " << cut.strips << ", other " << cut.is_other_diagonal << ", mirror " << mirror
                          << ", quarter " << quarter);
          ModelBuilder b;
          b.add("Slab", {0, -0.2, 0}, {4.8, 0, 4.8});
          b.add("Wall", {0, 0, -0.1}, {4.8, 2.5, 0});
          b.add("Wall", {-0.1, 0, 0}, {0, 2.5, 4.8});
          TriMesh mesh;
          for (const auto& [least, most] : piece.boxes) add_cut_box(mesh, least, most, cut);
          const Quat turned = rotation_from_heading(0.5 * pi * quarter);
          for (Vec3& p : mesh.positions) p = turned * Vec3(mirror * p.x, p.y, p.z) + Vec3(2.4, 0.0, 2.4);
          b.model.nodes.push_back({piece.name, -1});
          b.model.parts.push_back({static_cast<int>(b.model.nodes.size()) - 1, mesh});
          const studies::Suggestion found = studies::suggest(b.model, {}, "flat");
          CHECK(found.seats.size() == piece.seats);
          const Vec2 away = floor_point(turned * Vec3(0, 0, 1));
          Vec2 middle(0.0);
          for (const auto& seat : found.seats) {
            CHECK(glm::dot(seat.facing, away) > 0.999);
            middle += floor_point(seat.pelvis) / static_cast<double>(found.seats.size());
          }
          CHECK(std::abs(glm::dot(middle - Vec2(2.4, 2.4), Vec2(-away.y, away.x))) < 0.01);
        }
      }
    }
  }
}

TEST_CASE("a model in the coordinates of a map gets an origin, and is then the model at the origin", "[suggestion]") {
  ModelBuilder b = flat();
  furnish(b);
  const studies::Suggestion near = studies::suggest(b.model, {}, "flat");
  CHECK(near.frame.origin_m == Vec3(0.0));
  const Vec3 there(451234.0, 120.0, -5412346.0);
  for (io::ModelPart& part : b.model.parts)
    for (Vec3& p : part.mesh.positions) p += there;
  const studies::Suggestion far = studies::suggest(b.model, {}, "flat");
  const Vec3 moved = far.frame.origin_m - there;
  CHECK(glm::length(moved) < 2.0);
  CHECK(far.floor_m + moved.y == Approx(near.floor_m).margin(1e-6));
  REQUIRE(far.floors.size() == 1);
  CHECK(square_metres(far.floors[0]) == Approx(square_metres(near.floors[0])).epsilon(0.01));
  REQUIRE(far.seats.size() == near.seats.size());
  for (std::size_t i = 0; i < near.seats.size(); ++i)
    CHECK(glm::distance(far.seats[i].pelvis + moved, near.seats[i].pelvis) < 1e-6);
  CHECK_THAT(studies::to_yaml(far, "flat"), contains("origin_m: [4512"));
  CHECK_THAT(studies::to_yaml(near, "flat"), !contains("origin_m"));
  CHECK(studies::suggest(b.model, {120.0, {}}, "flat").floors.size() == 1);  // a height as the model has it
}

TEST_CASE("the sensor in a corner hangs over the found floor and looks into the room", "[suggestion]") {
  ModelBuilder b = flat();
  for (io::ModelPart& part : b.model.parts)
    for (Vec3& p : part.mesh.positions) p += Vec3(20.0, 0.0, -30.0);
  const studies::Suggestion found = studies::suggest(b.model, {}, "flat");
  const std::string text = studies::to_yaml(found, "flat");
  double x = 0.0, y = 0.0, z = 0.0, yaw_deg = 0.0;
  REQUIRE(std::sscanf(text.c_str() + text.find("{id: PIR1"),
                      "{id: PIR1, model: EKMC1604111, position_m: [%lf, %lf, %lf], yaw_deg: %lf", &x, &y, &z,
                      &yaw_deg) == 4);
  const FloorArea floor(found.floors, 0.0);
  CHECK(floor.contains({x, z}));
  CHECK(distance_to_edge_m(floor, {x, z}) < 0.4);
  CHECK(y == Approx(found.floor_m + 2.3));
  CHECK(floor.contains(Vec2(x, z) + 3.0 * direction_of(radians(yaw_deg))));
}

TEST_CASE("a room of walls without a floor has what the walls enclose, with the gap of its door", "[suggestion]") {
  ModelBuilder b;
  b.add("Wall0", {-0.1, 0, -4.1}, {5.1, 2.5, -4});
  b.add("Wall1", {-0.1, 0, -4}, {0, 2.5, 0});
  b.add("Wall2", {5, 0, -4}, {5.1, 2.5, 0});
  b.add("Wall3", {-0.1, 0, 0}, {3, 2.5, 0.1});
  b.add("Wall4", {3.9, 0, 0}, {5.1, 2.5, 0.1});
  b.add("Table0", {1.2, 0.7, -2.6}, {2.6, 0.74, -1.8});
  for (const std::optional<double> floor_m : {std::optional<double>(), std::optional(0.0)}) {
    const studies::Suggestion found = studies::suggest(b.model, {floor_m, {}}, "scan");
    CHECK(found.is_between_walls);
    CHECK(found.floor_m == Approx(0.0).margin(0.01));
    REQUIRE(found.floors.size() == 1);
    CHECK(square_metres(found.floors[0]) == Approx(5.0 * 4.0).epsilon(0.05));
    REQUIRE(found.entrances.size() == 1);
    CHECK(is_near(found.entrances[0].at, {3.45, 0.0}, 0.25));
    CHECK(found.entrances[0].width_m == Approx(0.9).margin(0.15));
    CHECK_THAT(studies::to_yaml(found, "scan"), contains("# No surface is a floor"));
  }
}

TEST_CASE("leaves of doors shut nothing, and go to what is ignored", "[suggestion]") {
  ModelBuilder b = flat();
  b.add("Door_bath", {6.6, 0, 3.03}, {7.4, 2.0, 3.07});
  b.add("Front door", {-0.12, 0, 2.5}, {-0.08, 2.1, 3.5});
  b.add("cupboard door", {1, 0, 0.1}, {1.3, 0.6, 0.12});
  b.add("wall left of the door", {-0.2, 0, 2.0}, {-0.1, 2.5, 2.5});
  const studies::Suggestion found = studies::suggest(b.model, {}, "flat");
  CHECK(found.door_leaves == std::vector<std::string>{"Door_bath", "Front door"});
  CHECK(found.doors.size() == 2);
  CHECK(found.entrances.size() == 1);
}

TEST_CASE("volumes of spaces name areas and are ignored, and the upper of two storeys is asked for", "[suggestion]") {
  ModelBuilder b = flat();
  b.add("IfcSpace/Bath", {5.1, 0, 3.1}, {8, 2.5, 6});
  const studies::Suggestion named = studies::suggest(b.model, {}, "flat");
  CHECK(named.spaces == std::vector<std::string>{"IfcSpace/Bath"});
  CHECK(std::ranges::count(named.areas, "IfcSpace_Bath", &studies::SuggestedArea::id) == 1);

  ModelBuilder two = flat();
  const ModelBuilder above = flat();
  for (io::ModelPart part : above.model.parts) {
    for (Vec3& p : part.mesh.positions) p.y += 2.7;
    two.model.parts.push_back(part);
  }
  const studies::Suggestion lower = studies::suggest(two.model, {}, "house");
  CHECK(lower.floor_m == Approx(0.0).margin(0.01));
  REQUIRE(lower.other_floors_m.size() == 1);
  CHECK(lower.other_floors_m[0] == Approx(2.7).margin(0.02));
  const studies::Suggestion upper = studies::suggest(two.model, {2.7, {}}, "house");
  CHECK(upper.floor_m == 2.7);
  CHECK(upper.areas.size() == 3);
}

TEST_CASE("the floor of a model is that of its rooms, whatever ground it stands on and sky it stands under",
          "[suggestion]") {
  ModelBuilder plain = flat();
  furnish(plain);
  const studies::Suggestion expected = studies::suggest(plain.model, {}, "flat");
  const auto check = [&](const ModelBuilder& b, const std::vector<std::string>& around) {
    const studies::Suggestion found = studies::suggest(b.model, {}, "flat");
    CHECK(found.frame.unit == "m");
    CHECK(found.frame.up == 'y');
    CHECK(found.floor_m == Approx(0.0).margin(0.01));
    CHECK(std::set(found.around.begin(), found.around.end()) == std::set(around.begin(), around.end()));
    CHECK(found.seats.size() == expected.seats.size());
    REQUIRE(found.areas.size() == expected.areas.size());
    for (std::size_t i = 0; i < found.areas.size(); ++i)
      CHECK(found.areas[i].square_metres == Approx(expected.areas[i].square_metres).epsilon(0.1));
    REQUIRE(found.entrances.size() == 1);
    CHECK(is_near(found.entrances[0].at, expected.entrances[0].at, 0.15));
  };
  const bool has_ceiling = GENERATE(true, false);
  if (!has_ceiling) std::erase_if(plain.model.parts, [](const io::ModelPart& part) { return part.node == 1; });
  for (const double side : {16.0, 20.0, 40.0, 100.0}) {
    for (const double below : {0.02, 0.15, 0.5, 1.0}) {
      INFO(side << " m, " << below << " m below, ceiling " << has_ceiling);
      ModelBuilder b = plain;
      b.add("Ground", {4 - side / 2, -below - 0.001, 3 - side / 2}, {4 + side / 2, -below, 3 + side / 2});
      check(b, {"Ground"});
    }
  }
  const auto [radius, is_dome] = GENERATE(table<double, bool>({{30.0, false}, {500.0, false}, {50.0, true}}));
  {
    INFO((is_dome ? "dome of " : "sky of ") << radius << " m");
    ModelBuilder b = plain;
    b.add("Ground", {-26, -0.151, -27}, {34, -0.15, 33});
    TriMesh sky;
    constexpr int around = 24, up = 12;
    for (int i = 0; i <= up; ++i) {
      for (int k = 0; k < around; ++k) {
        const double height = 3.14159265 * i / (is_dome ? 2 * up : up), turn = 2.0 * 3.14159265 * k / around;
        sky.positions.emplace_back(4 + radius * std::sin(height) * std::cos(turn), radius * std::cos(height),
                                   3 + radius * std::sin(height) * std::sin(turn));
      }
    }
    for (std::uint32_t i = 0; i < up; ++i) {
      for (std::uint32_t k = 0; k < around; ++k) {
        const std::uint32_t next = (k + 1) % around;
        sky.triangles.push_back({i * around + k, (i + 1) * around + k, i * around + next});
        sky.triangles.push_back({i * around + next, (i + 1) * around + k, (i + 1) * around + next});
      }
    }
    b.model.nodes.push_back({"Sky", -1});
    b.model.parts.push_back({static_cast<int>(b.model.nodes.size()) - 1, sky});
    check(b, {"Sky", "Ground"});
  }
}

TEST_CASE("a garden full of things on the ground is no room, and a hall around a few things is no sky",
          "[suggestion]") {
  ModelBuilder b = flat();
  furnish(b);
  b.add("Ground", {-40, -0.151, -40}, {40, -0.15, 40});
  for (int i = 0; i < 60; ++i) {
    const double x = -38.0 + 8.0 * (i % 10), z = i < 30 ? -38.0 + 8.0 * (i / 10) : 14.0 + 8.0 * (i / 10 - 3);
    b.add("Tree", {x, -0.15, z}, {x + 0.4, 4.0, z + 0.4});
  }
  const studies::Suggestion found = studies::suggest(b.model, {}, "garden");
  CHECK(found.floor_m == Approx(0.0).margin(0.01));
  CHECK(found.areas.size() == 3);

  ModelBuilder hall;
  TriMesh shell = small_box({0, 0, 0}, {12, 4, 10});
  hall.model.nodes.push_back({"Hall", -1});
  hall.model.parts.push_back({0, shell});
  hall.add("Carpet", {4, 0.0, 4}, {7, 0.01, 6});
  hall.add("Chair", {4.5, 0, 4.5}, {5, 0.45, 5});
  hall.add("Desk", {5.2, 0, 4.5}, {6.6, 0.74, 5.3});
  const studies::Suggestion inside = studies::suggest(hall.model, {}, "hall");
  CHECK(inside.around.empty());
  REQUIRE(inside.areas.size() == 1);
  CHECK(inside.areas[0].square_metres > 100.0);
}

TEST_CASE("what is in the way of a floor is named, and can be left out", "[suggestion]") {
  ModelBuilder b;
  b.add("post", {0, 0, 0}, {0.1, 3, 0.1});
  b.add("Cliff/rock", {-5, -1, -5}, {5, 6, 5}, -1);
  b.model.parts.back().mesh.triangles.resize(4);  // no level part of it
  // Without the cliff there is no floor either, so that leaving it out is no remedy.
  CHECK_THROWS_WITH(studies::suggest(b.model, {}, "rocks"), contains("polygon_xz_m") && !contains("--ignore"));
  ModelBuilder clean = flat();
  ModelBuilder covered = clean;
  covered.add("Plinth", {1, 0.1, 1}, {4, 0.9, 5});
  const auto area = [](const ModelBuilder& model, const std::vector<std::string>& ignored) {
    return studies::suggest(model.model, {0.0, ignored}, "flat").floors.size();
  };
  CHECK(area(covered, {"Plin*"}) == area(clean, {}));
  const studies::Suggestion found = studies::suggest(covered.model, {{}, {"Plin*"}}, "flat");
  CHECK_THAT(studies::to_yaml(found, "flat"), contains("ignore:\n- 'Plin*'"));
  CHECK_THROWS_WITH(studies::suggest(covered.model, {{}, {"Plinht"}}, "flat"), contains("did you mean 'Plinth'"));
}

TEST_CASE("a model without a floor is refused", "[suggestion]") {
  CHECK_THROWS_AS(studies::suggest({}, {}, "nothing"), Error);
  ModelBuilder b;
  b.add("post", {0, 0, 0}, {0.1, 3, 0.1});
  CHECK_THROWS_AS(studies::suggest(b.model, {}, "post"), Error);
}
