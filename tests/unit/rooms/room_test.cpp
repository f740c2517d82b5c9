#include "pirsim/room.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <set>

#include "rooms/recipe.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::dataset;

namespace {

DrawnRoom drawn(const RoomSpec& spec, int number, std::uint64_t seed = 1) {
  return draw_room(spec, seed, number, test::shipped_sensors());
}

RoomSpec crowded_office() {
  RoomSpec spec;
  spec.width_m = {5.0, 8.0};
  spec.depth_m = {4.5, 7.0};
  spec.l_shaped = 0.3;
  spec.doors = {1, 2};
  spec.seats = {2, 6};
  return spec;
}

RoomSpec meeting_room() {
  RoomSpec spec;
  spec.kind = RoomKind::meeting;
  spec.width_m = {5.0, 8.0};
  spec.depth_m = {4.5, 6.0};
  spec.seats = {4, 10};
  return spec;
}

double distance(const Vec2& p, const Rectangle& r) {
  const double x = std::max({r.lower.x - p.x, 0.0, p.x - r.upper.x});
  const double z = std::max({r.lower.y - p.y, 0.0, p.y - r.upper.y});
  return std::hypot(x, z);
}

bool stands_on_floor(const Furnishing& furnishing) {
  return furnishing.kind != Fixture::structure && furnishing.kind != Fixture::screen;
}

/// Reachability by flooding a grid of 5 cm: a body as narrow as a person who turns sideways, between plain rectangles.
/// It shares nothing with pirsim's own way-finding.
class Flood {
 public:
  explicit Flood(const DrawnRoom& room) : room_(room) {
    columns_ = static_cast<int>(std::ceil(room.width_m / cell_m));
    rows_ = static_cast<int>(std::ceil(room.depth_m / cell_m));
    wet_.assign(static_cast<std::size_t>(columns_ * rows_), 0);
    const EntranceSpec& door = room.scene.entrances.front();
    const Vec2 inside = floor_point(door.world_from_entrance * Vec3(0.0, 0.0, -0.4));
    std::deque<std::pair<int, int>> front{{static_cast<int>(inside.x / cell_m), static_cast<int>(-inside.y / cell_m)}};
    while (!front.empty()) {
      const auto [column, row] = front.front();
      front.pop_front();
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
      auto& cell = wet_[static_cast<std::size_t>(row * columns_ + column)];
      if (cell != 0 || !is_open(centre(column, row))) continue;
      cell = 1;
      for (const auto& [dc, dr] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
        front.emplace_back(column + dc, row + dr);
    }
  }

  [[nodiscard]] double nearest_m(const Vec2& p) const {
    double nearest = 1e9;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        if (wet_[static_cast<std::size_t>(row * columns_ + column)] != 0)
          nearest = std::min(nearest, glm::distance(p, centre(column, row)));
      }
    }
    return nearest;
  }

 private:
  static constexpr double cell_m = 0.05, keep_m = 0.22;
  static Vec2 centre(int column, int row) { return {cell_m * (column + 0.5), -cell_m * (row + 0.5)}; }
  [[nodiscard]] bool is_open(const Vec2& p) const {
    for (const double angle : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) {
      const Vec2 rim = p + 0.9 * keep_m * Vec2(std::cos(angle), std::sin(angle));
      if (!room_.scene.floor.contains(rim)) return false;
    }
    return std::ranges::none_of(room_.furnishings, [&](const Furnishing& f) {
      return stands_on_floor(f) && distance(p, f.footprint) < keep_m;
    });
  }

  const DrawnRoom& room_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> wet_;
};

bool same_scene(const SceneSpec& a, const SceneSpec& b) {
  const auto same_mesh = [](const TriMesh& x, const TriMesh& y) {
    return x.name == y.name && x.positions == y.positions && x.triangles == y.triangles;
  };
  const auto same_sensor = [](const SensorSpec& x, const SensorSpec& y) {
    return x.id == y.id && x.model == y.model && x.world_from_sensor == y.world_from_sensor;
  };
  const auto same_seat = [](const SeatSpec& x, const SeatSpec& y) {
    return x.id == y.id && x.world_from_seat == y.world_from_seat;
  };
  return std::ranges::equal(a.meshes, b.meshes, same_mesh) && std::ranges::equal(a.sensors, b.sensors, same_sensor) &&
         std::ranges::equal(a.seats, b.seats, same_seat) && a.floor.loops() == b.floor.loops();
}

/// Of its triangles in order; readers number vertices anew.
std::vector<Vec3> corners_of(const TriMesh& mesh) {
  std::vector<Vec3> corners;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) corners.push_back(mesh.positions[vertex]);
  }
  return corners;
}

/// Between equal corners of equal triangles.
double farthest_m(const TriMesh& a, const TriMesh& b) {
  const std::vector<Vec3> p = corners_of(a), q = corners_of(b);
  if (p.size() != q.size()) return 1e9;
  double farthest = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) farthest = std::max(farthest, glm::distance(p[i], q[i]));
  return farthest;
}

}  // namespace

TEST_CASE("a room has the size, the seats and the sensors that were asked for", "[room]") {
  RoomSpec spec;
  spec.width_m = {6.0, 6.0};
  spec.depth_m = {4.6, 4.6};
  spec.height_m = {2.7, 2.7};
  spec.seats = {4, 4};
  spec.sensors = {{.mount = Mount::ceiling, .models = {"EKMC1603111"}, .count = {2, 2}, .where = {}},
                  {.mount = Mount::corner, .models = {}, .count = {1, 1}, .where = {}}};
  const DrawnRoom room = drawn(spec, 1);
  CHECK(room.scene.floor.area_m2() == Approx(6.0 * 4.6));
  CHECK(room.height_m == 2.7);
  CHECK(room.scene.seats.size() == 4);
  REQUIRE(room.scene.sensors.size() == 3);
  CHECK(room.scene.sensors[0].model == "EKMC1603111");
  CHECK(room.scene.sensors[2].model == "EKMC1604111");
  CHECK(room.scene.sensors[0].world_from_sensor.forward().y == Approx(-1.0));
  // From a corner into the room: away from both walls that meet there.
  const Frame& corner = room.scene.sensors[2].world_from_sensor;
  CHECK(room.scene.floor.contains(floor_point(corner.origin)));
  CHECK(room.scene.floor.contains(floor_point(corner.origin + 2.0 * corner.forward())));
}

TEST_CASE("the floor of an L is the rectangle without its corner", "[room]") {
  RoomSpec spec;
  spec.width_m = {8.0, 8.0};
  spec.depth_m = {6.0, 6.0};
  spec.l_shaped = 1.0;
  spec.cut_share = {0.4, 0.4};
  for (int number = 1; number <= 6; ++number) {
    const DrawnRoom room = drawn(spec, number);
    CHECK(room.outline.size() == 6);
    CHECK(room.scene.floor.area_m2() == Approx(8.0 * 6.0 - 3.2 * 2.4));
    double mesh_area = 0.0;
    for (const auto& t : room.furnishings.front().mesh.triangles) {
      const auto& p = room.furnishings.front().mesh.positions;
      mesh_area += 0.5 * glm::length(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
    }
    CHECK(mesh_area == Approx(room.scene.floor.area_m2()).epsilon(1e-6));
  }
}

TEST_CASE("fifty rooms: seats can be reached, and nothing stands in anything else", "[room][seconds]") {
  std::set<int> tries;
  for (int number = 1; number <= 50; ++number) {
    const DrawnRoom room = drawn(number % 2 == 0 ? meeting_room() : crowded_office(), number);
    INFO("room " << number << ", try " << room.tries);
    tries.insert(room.tries);
    const Flood flood(room);
    for (const SeatSpec& seat : room.scene.seats) {
      const Vec2 pelvis = floor_point(seat.world_from_seat.origin);
      CHECK(flood.nearest_m(pelvis) < 1.2);
      CHECK(room.scene.floor.contains(pelvis));
      for (const Furnishing& f : room.furnishings) {
        if (stands_on_floor(f)) CHECK(distance(pelvis, f.footprint) > 0.1);
      }
      for (const SeatSpec& other : room.scene.seats) {
        if (&other != &seat) CHECK(glm::distance(seat.world_from_seat.origin, other.world_from_seat.origin) > 0.5);
      }
    }
    for (std::size_t i = 0; i < room.furnishings.size(); ++i) {
      const Furnishing& a = room.furnishings[i];
      if (!stands_on_floor(a)) continue;
      CHECK(room.scene.floor.contains(0.5 * (a.footprint.lower + a.footprint.upper)));
      for (std::size_t k = 0; k < i; ++k) {
        const Furnishing& b = room.furnishings[k];
        const bool is_desk_screen = a.mesh.name == "desk screen" || b.mesh.name == "desk screen";
        if (!stands_on_floor(b) || is_desk_screen) continue;
        const Vec2 lower = glm::max(a.footprint.lower, b.footprint.lower);
        const Vec2 upper = glm::min(a.footprint.upper, b.footprint.upper);
        CHECK((upper.x - lower.x < 1e-6 || upper.y - lower.y < 1e-6));
      }
    }
  }
  CHECK(tries.size() > 1);  // the checks do refuse some
}

TEST_CASE("a room depends on its seed and number and on nothing else", "[room]") {
  const RoomSpec spec = crowded_office();
  const DrawnRoom seventh = drawn(spec, 7);
  static_cast<void>(drawn(spec, 3));
  CHECK(same_scene(drawn(spec, 7).scene, seventh.scene));
  CHECK_FALSE(same_scene(drawn(spec, 8).scene, seventh.scene));
  CHECK_FALSE(same_scene(drawn(spec, 7, 2).scene, seventh.scene));
}

TEST_CASE("a room that was written is read back as it was", "[room]") {
  const TemporaryFolder folder;
  for (const std::string name : {"room.gltf", "room.glb"}) {
    for (int number = 1; number <= 3; ++number) {
      const DrawnRoom room = drawn(number == 3 ? meeting_room() : crowded_office(), number);
      io::write_scene(folder.path() / name, room.scene);
      const SceneSpec read = io::read_scene(folder.path() / name, test::shipped_sensors());
      CHECK(read.warnings.empty());
      REQUIRE(read.meshes.size() == room.scene.meshes.size());
      for (std::size_t i = 0; i < read.meshes.size(); ++i) {
        CHECK(read.meshes[i].name == room.scene.meshes[i].name);
        INFO(read.meshes[i].name);
        CHECK(farthest_m(read.meshes[i], room.scene.meshes[i]) == 0.0);
      }
      CHECK(read.floor.loops() == room.scene.floor.loops());
      REQUIRE(read.sensors.size() == room.scene.sensors.size());
      for (std::size_t i = 0; i < read.sensors.size(); ++i) {
        const Frame &a = read.sensors[i].world_from_sensor, &b = room.scene.sensors[i].world_from_sensor;
        CHECK(read.sensors[i].id == room.scene.sensors[i].id);
        CHECK(read.sensors[i].model == room.scene.sensors[i].model);
        CHECK(a.origin == b.origin);
        CHECK(std::abs(glm::dot(a.rotation, b.rotation)) == Approx(1.0).epsilon(1e-12));
      }
      REQUIRE(read.seats.size() == room.scene.seats.size());
      for (std::size_t i = 0; i < read.seats.size(); ++i) {
        CHECK(read.seats[i].id == room.scene.seats[i].id);
        CHECK(read.seats[i].world_from_seat.origin == room.scene.seats[i].world_from_seat.origin);
      }
      REQUIRE(read.entrances.size() == room.scene.entrances.size());
      CHECK(read.entrances[0].width_m == room.scene.entrances[0].width_m);
    }
  }
}

TEST_CASE("ranges that no room fits into are told with what was lacking", "[room]") {
  RoomSpec spec;
  spec.width_m = spec.depth_m = {3.0, 3.0};
  spec.seats = {8, 8};
  spec.where = {"recipe.yaml", 4, 5};
  CHECK_THROWS_WITH(drawn(spec, 2),
                    contains("recipe.yaml:4:5") && contains("room 2") && contains("300") && contains("no place for"));
}

TEST_CASE("meeting rooms for two are drawn from 2.8 to 4 m square", "[room]") {
  for (const double side_m : {2.8, 3.0, 3.4, 4.0}) {
    RoomSpec spec;
    spec.kind = RoomKind::meeting;
    spec.width_m = spec.depth_m = {side_m, side_m};
    spec.seats = {2, 2};
    spec.cupboards = spec.partitions = {0, 0};
    for (int number = 1; number <= 3; ++number) {
      INFO(side_m << " m, room " << number);
      CHECK(drawn(spec, number).scene.seats.size() == 2);
    }
  }
}

TEST_CASE("faults of a room's ranges are told with their place and the nearest name", "[room]") {
  Diagnostics faults;
  io::YamlMap map(io::YamlNode::parse("kind: ofice\n"
                                      "widht_m: 5\n"
                                      "depth_m: [5, 4]\n"
                                      "sensors:\n"
                                      "  - {mount: celing}\n",
                                      "room.yaml"),
                  faults, "room");
  static_cast<void>(read_room_keys(map));
  map.finish();
  std::string told;
  for (const Issue& issue : faults.issues()) told += to_string(issue) + "\n";
  CHECK_THAT(told, contains("room.yaml:1:7") && contains("office"));
  CHECK_THAT(told, contains("room.yaml:2:1") && contains("width_m"));
  CHECK_THAT(told, contains("room.yaml:3:14"));
  CHECK_THAT(told, contains("room.yaml:5:13") && contains("ceiling"));
}

TEST_CASE("an unknown sensor model is told where it stands", "[room]") {
  RoomSpec spec;
  spec.sensors = {{.mount = Mount::ceiling, .models = {"EKMC160111"}, .count = {1, 1}, .where = {"r.yaml", 9, 3}}};
  CHECK_THROWS_WITH(drawn(spec, 1), contains("r.yaml:9:3") && contains("EKMC1601111"));
}
