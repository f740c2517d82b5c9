#include "pirsim/flat.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <set>

#include "files/write/gltf_writer.hpp"
#include "rooms/recipe.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::dataset;

namespace {

DrawnFlat drawn_flat(const FlatSpec& spec, int number, std::uint64_t seed = 1) {
  return draw_flat(spec, seed, number, test::shipped_sensors());
}

FlatSpec any_flat() {
  FlatSpec spec;
  spec.residents = {1, 3};
  spec.sensors_at = {SensorsAt::rooms, SensorsAt::doorways};
  spec.mounts = {Mount::corner, Mount::ceiling};
  return spec;
}

/// Of all boxes that reach into what a body takes, seen from above. Boxes have eight corners each, one behind the
/// other.
std::vector<Rectangle> obstacles(const SceneSpec& scene) {
  std::vector<Rectangle> found;
  for (const TriMesh& mesh : scene.meshes) {
    for (std::size_t first = 0; first + 8 <= mesh.positions.size(); first += 8) {
      const Vec3 a(mesh.positions[first]), b(mesh.positions[first + 7]);
      if (std::min(a.y, b.y) < 1.9 && std::max(a.y, b.y) > 0.1)
        found.push_back({{std::min(a.x, b.x), std::min(a.z, b.z)}, {std::max(a.x, b.x), std::max(a.z, b.z)}});
    }
  }
  return found;
}

double gap_m(const Vec2& p, const Rectangle& r) {
  const double x = std::max({r.lower.x - p.x, 0.0, p.x - r.upper.x});
  const double z = std::max({r.lower.y - p.y, 0.0, p.y - r.upper.y});
  return std::hypot(x, z);
}

/// Reachability by flooding a grid of 5 cm from the front door, through open doors: shares nothing with pirsim's ways.
class FlatFlood {
 public:
  explicit FlatFlood(const DrawnFlat& flat) : columns_(cells(flat.width_m)), rows_(cells(flat.depth_m)) {
    const std::vector<Rectangle> solids = obstacles(flat.scene);
    open_.assign(static_cast<std::size_t>(columns_ * rows_), 1);
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const Vec2 p = centre(column, row);
        if (std::ranges::any_of(solids, [&](const Rectangle& r) { return gap_m(p, r) < keep_m; }))
          open_[index(column, row)] = 0;
      }
    }
    wet_.assign(open_.size(), 0);
    const Vec2 inside = floor_point(flat.scene.entrances.front().world_from_entrance * Vec3(0.0, 0.0, -0.4));
    std::deque<std::pair<int, int>> front{{static_cast<int>(inside.x / cell_m), static_cast<int>(-inside.y / cell_m)}};
    while (!front.empty()) {
      const auto [column, row] = front.front();
      front.pop_front();
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
      const std::size_t at = index(column, row);
      if (wet_[at] != 0 || open_[at] == 0) continue;
      wet_[at] = 1;
      for (const auto& [dc, dr] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
        front.emplace_back(column + dc, row + dr);
    }
  }

  [[nodiscard]] double nearest_m(const Vec2& p) const {
    double nearest = 1e9;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        if (wet_[index(column, row)] != 0) nearest = std::min(nearest, glm::distance(p, centre(column, row)));
      }
    }
    return nearest;
  }

 private:
  static constexpr double cell_m = 0.05, keep_m = 0.22;
  static int cells(double length) { return static_cast<int>(std::ceil(length / cell_m)); }
  static Vec2 centre(int column, int row) { return {cell_m * (column + 0.5), -cell_m * (row + 0.5)}; }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }
  int columns_, rows_;
  std::vector<std::uint8_t> open_, wet_;
};

bool is_inside(const Vec2& p, const Rectangle& r) {
  return p.x > r.lower.x && p.x < r.upper.x && p.y > r.lower.y && p.y < r.upper.y;
}

/// Index of the room below, or none.
std::optional<std::size_t> room_at(const DrawnFlat& flat, const Vec2& p) {
  for (std::size_t i = 0; i < flat.rooms.size(); ++i)
    if (is_inside(p, flat.rooms[i].area)) return i;
  return std::nullopt;
}

std::size_t beds_of(const SceneSpec& scene) {
  return static_cast<std::size_t>(std::ranges::count_if(
      scene.places, [](const PlaceSpec& place) { return place.uses == std::vector<std::string>{"sleep"}; }));
}

void check_areas(const DrawnFlat& flat) {
  double sum = 0.0;
  for (std::size_t i = 0; i < flat.rooms.size(); ++i) {
    const Rectangle& a = flat.rooms[i].area;
    sum += a.area_m2();
    CHECK(flat.scene.areas[i].id == flat.rooms[i].id);
    CHECK(flat.scene.areas[i].outline.area_m2() == Approx(a.area_m2()));
    for (std::size_t k = 0; k < i; ++k) {
      const Rectangle& b = flat.rooms[k].area;
      const Vec2 lower = glm::max(a.lower, b.lower), upper = glm::min(a.upper, b.upper);
      CHECK((upper.x <= lower.x || upper.y <= lower.y));
    }
  }
  CHECK(sum == Approx(flat.width_m * flat.depth_m));
  CHECK(flat.scene.floor.area_m2() == Approx(sum));
}

void check_doors(const DrawnFlat& flat) {
  for (const DoorSpec& door : flat.scene.doors) {
    INFO(door.id);
    const auto before = room_at(flat, floor_point(door.world_from_door * Vec3(0.0, 0.0, 0.5)));
    const auto behind = room_at(flat, floor_point(door.world_from_door * Vec3(0.0, 0.0, -0.5)));
    REQUIRE(behind);
    CHECK(before != behind);
    CHECK(before.has_value() == (door.id != "front"));
    CHECK(door.state == (door.id == "front" ? DoorState::shut : DoorState::habit));
    if (before) CHECK(door.id == flat.rooms[*behind].id);
    // The gap is free from the floor to the leaf's top, and the walls are hit beside it.
    for (const Rectangle& r : obstacles(flat.scene)) CHECK(gap_m(floor_point(door.world_from_door.origin), r) > 0.44);
  }
}

/// Inner doors hang on the side of the nearer wall, if one is nearer by far. Gives how many were looked at.
int check_hinges(const DrawnFlat& flat) {
  int looked_at = 0;
  for (const DoorSpec& door : flat.scene.doors) {
    const auto before = room_at(flat, floor_point(door.world_from_door * Vec3(0.0, 0.0, 0.5)));
    const auto behind = room_at(flat, floor_point(door.world_from_door * Vec3(0.0, 0.0, -0.5)));
    if (!before || !behind) continue;
    const auto from_wall_m = [&](double aside_m) {  // along the wall that the door is in, which follows x
      const double x = (door.world_from_door * Vec3(aside_m, 0.0, 0.0)).x;
      double nearest = 1e9;
      for (const std::size_t room : {*before, *behind}) {
        const Rectangle& area = flat.rooms[room].area;
        nearest = std::min({nearest, std::abs(x - area.lower.x), std::abs(x - area.upper.x)});
      }
      return nearest;
    };
    const double left_m = from_wall_m(-0.5 * door.width_m), right_m = from_wall_m(0.5 * door.width_m);
    if (std::abs(left_m - right_m) < 0.31) continue;
    INFO(door.id << ": " << left_m << " m to the left, " << right_m << " m to the right");
    CHECK(door.hinge == (left_m < right_m ? DoorHinge::left : DoorHinge::right));
    ++looked_at;
  }
  return looked_at;
}

void check_reach(const DrawnFlat& flat) {
  const FlatFlood flood(flat);
  for (const SeatSpec& seat : flat.scene.seats) {
    INFO(seat.id);
    CHECK(flood.nearest_m(floor_point(seat.world_from_seat.origin)) < 0.9);
  }
  for (const PlaceSpec& place : flat.scene.places) {
    INFO(place.id);
    const double far_m = place.posture == PlacePosture::lie ? 1.4 : 0.1;  // from the foot
    CHECK(flood.nearest_m(floor_point(place.world_from_place.origin)) < far_m);
  }
  for (const FlatRoom& room : flat.rooms) CHECK(flood.nearest_m(0.5 * (room.area.lower + room.area.upper)) < 1.2);
}

bool has_use(const SceneSpec& scene, const std::string& use) {
  const auto is_for = [&](const auto& spot) { return std::ranges::find(spot.uses, use) != spot.uses.end(); };
  return std::ranges::any_of(scene.seats, is_for) || std::ranges::any_of(scene.places, is_for);
}

std::string text_of(const FlatSpec& spec, int number, std::uint64_t seed = 1) {
  return io::scene_text(drawn_flat(spec, number, seed).scene, {});
}

std::string flat_faults(const std::string& text) {
  Diagnostics faults;
  io::YamlMap map(io::YamlNode::parse(text, "flat.yaml"), faults, "home");
  static_cast<void>(read_flat_keys(map));
  map.finish();
  std::string told;
  for (const Issue& issue : faults.issues()) told += to_string(issue) + "\n";
  return told;
}

}  // namespace

TEST_CASE("fifty flats: all places are reached, areas share the floor out, doors join rooms", "[flat][seconds]") {
  std::set<int> tries;
  std::set<std::size_t> sizes;
  int hinges = 0;
  for (int number = 1; number <= 50; ++number) {
    const DrawnFlat flat = drawn_flat(any_flat(), number);
    hinges += check_hinges(flat);
    INFO("flat " << number << ", try " << flat.tries);
    tries.insert(flat.tries);
    sizes.insert(flat.rooms.size());
    check_areas(flat);
    check_doors(flat);
    check_reach(flat);
    CHECK(beds_of(flat.scene) == static_cast<std::size_t>(flat.residents));
    for (const char* use : {"sleep", "toilet", "wash", "shower", "cook", "eat", "tv", "rest", "chores"})
      CHECK(has_use(flat.scene, use));
    for (const SensorSpec& sensor : flat.scene.sensors) {
      INFO(sensor.id);
      const auto below =
          room_at(flat, floor_point(sensor.world_from_sensor.origin + 0.1 * sensor.world_from_sensor.forward()));
      REQUIRE(below);
      CHECK(flat.rooms[*below].id == sensor.area);
    }
  }
  CHECK(tries.size() > 1);  // the checks do refuse some
  CHECK(sizes.size() > 3);
  CHECK(hinges > 25);
}

TEST_CASE("a flat depends on its seed and number and on nothing else", "[flat]") {
  const std::string seventh = text_of(any_flat(), 7);
  static_cast<void>(drawn_flat(any_flat(), 3));
  CHECK(text_of(any_flat(), 7) == seventh);
  CHECK(text_of(any_flat(), 8) != seventh);
  CHECK(text_of(any_flat(), 7, 2) != seventh);
}

TEST_CASE("a flat is what was asked for", "[flat]") {
  FlatSpec spec;
  spec.rooms = {3, 3};
  spec.residents = {4, 4};
  spec.size_m2 = Range{80.0, 80.0};
  spec.height_m = {2.55, 2.55};
  spec.own_kitchen = 1.0;
  spec.layouts = {FlatLayout::corridor};
  spec.sensors_at = {SensorsAt::doorways};
  spec.models = {"EKMC1603111"};
  const DrawnFlat flat = drawn_flat(spec, 1);
  CHECK(flat.width_m * flat.depth_m == Approx(80.0).epsilon(0.01));
  CHECK(flat.height_m == 2.55);
  std::vector<std::string> ids;
  for (const FlatRoom& room : flat.rooms) ids.push_back(room.id);
  // Two a room: no bedroom is left for a study.
  CHECK(ids == std::vector<std::string>{"living_room", "kitchen", "bedroom", "bedroom_2", "bath", "corridor"});
  CHECK(beds_of(flat.scene) == 4);
  CHECK(flat.scene.sensors.size() == 6);  // the front door, and a doorway of each room but the corridor
  for (const SensorSpec& sensor : flat.scene.sensors) CHECK(sensor.model == "EKMC1603111");
}

TEST_CASE("a flat that was written is read back without a warning", "[flat]") {
  const TemporaryFolder folder;
  for (int number = 1; number <= 12; ++number) {
    const DrawnFlat flat = drawn_flat(any_flat(), number);
    INFO("flat " << number);
    io::write_scene(folder.path() / "flat.gltf", flat.scene);
    const SceneSpec read = io::read_scene(folder.path() / "flat.gltf", test::shipped_sensors());
    for (const Issue& warning : read.warnings) UNSCOPED_INFO(to_string(warning));
    CHECK(read.warnings.empty());
    CHECK(read.doors.size() == flat.scene.doors.size());
    CHECK(read.places.size() == flat.scene.places.size());
    CHECK(read.areas.size() == flat.rooms.size());
  }
}

TEST_CASE("ranges that no flat fits into are told with what was lacking", "[flat]") {
  FlatSpec spec;
  spec.rooms = {1, 1};
  spec.residents = {5, 5};
  spec.size_m2 = Range{25.0, 25.0};
  spec.where = {"recipe.yaml", 4, 5};
  CHECK_THROWS_WITH(drawn_flat(spec, 2), contains("recipe.yaml:4:5") && contains("flat 2: none of 300 flats"));
}

TEST_CASE("faults of a flat's ranges are told with their place and the nearest name", "[flat]") {
  CHECK(flat_faults("rooms: [1, 4]\nresidents: 5\nlayout: [hall, open]\nmodel: EKMC1601111\n").empty());
  CHECK_THAT(flat_faults("rooms: 5\n"), contains("flat.yaml:1:8") && contains("4"));
  CHECK_THAT(flat_faults("rooms: 0\n"), contains("flat.yaml:1:8"));
  CHECK_THAT(flat_faults("residents: 6\n"), contains("flat.yaml:1:12") && contains("5"));
  CHECK_THAT(flat_faults("residents: [2, 1]\n"), contains("flat.yaml:1:16") && contains("less than the first"));
  CHECK_THAT(flat_faults("residnts: 2\n"), contains("flat.yaml:1:1") && contains("residents"));
  CHECK_THAT(flat_faults("size_m2: .nan\n"), contains("flat.yaml:1:10"));
  CHECK_THAT(flat_faults("size_m2: [1, 1e9]\n"), contains("flat.yaml:1:11"));
  CHECK_THAT(flat_faults("layout: []\n"), contains("flat.yaml:1:9") && contains("isn't empty"));
  CHECK_THAT(flat_faults("layout: corridr\n"), contains("flat.yaml:1:9") && contains("corridor"));
  CHECK_THAT(flat_faults("sensors_at: wall\n"), contains("flat.yaml:1:13") && contains("doorway"));
  CHECK_THAT(flat_faults("own_kitchen: 2\n"), contains("flat.yaml:1:14"));
  CHECK_THAT(flat_faults("rooms: {a: 1}\n"), contains("flat.yaml:1:8"));
}

TEST_CASE("what is asked for and no flat of these ranges can have is refused with what it needs", "[flat]") {
  CHECK_THAT(flat_faults("rooms: 2\nstudy: 1\n"),
             contains("flat.yaml:2:8") && contains("`rooms: 3` on") && contains("2 at most"));
  CHECK_THAT(flat_faults("rooms: 3\nresidents: 3\nstudy: 1\n"), contains("`rooms: 4` on"));
  for (const char* fine : {"rooms: 3\nresidents: 2\nstudy: 1\n", "rooms: [1, 3]\nstudy: 1\n", "rooms: 2\nstudy: 0\n",
                           "rooms: 4\nresidents: 4\nstudy: 1\n"})
    CHECK(flat_faults(fine).empty());
  CHECK_THAT(flat_faults("sensors_at: doorway\nmount: ceiling\n"), contains("flat.yaml:2:8") && contains("doorways"));
  CHECK_THAT(flat_faults("mount: ceiling\nsensor_height_m: 2\n"), contains("ceilings"));
  CHECK_THAT(flat_faults("sensors_at: doorway\nsensor_tilt_deg: 5\n"), contains("doorways"));
  CHECK(flat_faults("sensors_at: [room, doorway]\nmount: [corner, ceiling]\nsensor_tilt_deg: 5\n").empty());
  // What the bounds say is so: flats with a study from there on, none below.
  const auto has_study = [](int rooms, int residents) {
    FlatSpec spec;
    spec.rooms = {rooms, rooms}, spec.residents = {residents, residents}, spec.study = 1.0;
    const DrawnFlat flat = drawn_flat(spec, 1);
    return std::ranges::find(flat.rooms, FlatRoomKind::study, &FlatRoom::kind) != flat.rooms.end();
  };
  CHECK((!has_study(2, 1) && !has_study(3, 3) && has_study(3, 2) && has_study(4, 3) && has_study(4, 4)));
}

TEST_CASE("an unknown model of a flat's sensors is told where it stands", "[flat]") {
  FlatSpec spec;
  spec.models = {"EKMC160111"};
  spec.models_where = {"r.yaml", 9, 3};
  CHECK_THROWS_WITH(drawn_flat(spec, 1), contains("r.yaml:9:3") && contains("EKMC1601111"));
}
