#include <cstdlib>

#include "gltf_builder.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

using pirsim::SceneSpec;
using pirsim::io::read_scene;

namespace {

SceneSpec shipped(const std::string& name) {
  const std::filesystem::path data = pirsim::test::data_dir();
  return read_scene(data / "rooms" / name, {{data / "sensors"}});
}

void check_point(const pirsim::Vec3& given, const pirsim::Vec3& expected) {
  for (int i = 0; i < 3; ++i) CHECK(given[i] == Approx(expected[i]).margin(1e-6));
}

}  // namespace

TEST_CASE("the meeting room has the paper's 30.7 m2, five sensors and ten seats", "[scene][rooms]") {
  const SceneSpec room = shipped("meeting_room.gltf");
  CHECK(room.floor.area_m2() == Approx(30.7).margin(0.1));
  CHECK(room.floor.height_m() == 0.0);
  REQUIRE(room.sensors.size() == 5);
  REQUIRE(room.seats.size() == 10);
  REQUIRE(room.entrances.size() == 1);
  CHECK(room.warnings.empty());
  CHECK(room.sensors[0].id == "PIR1");
  CHECK(room.sensor_models.count("EKMC1604111") == 1);
  check_point(room.sensors[4].world_from_sensor.origin, {4.316, 2.65, -0.03});
  const double tilt = 20.0 * 3.14159265358979 / 180.0;
  check_point(room.sensors[0].world_from_sensor.forward(), {0.0, -std::sin(tilt), -std::cos(tilt)});
  check_point(room.sensors[0].world_from_sensor.right(), {1.0, 0.0, 0.0});
  CHECK(room.seats[9].id == "S10");
  check_point(room.seats[0].world_from_seat.origin, {4.334, 0.531, -3.168});
  check_point(room.seats[0].world_from_seat.forward(), {-1.0, 0.0, 0.0});
  check_point(room.seats[9].world_from_seat.forward(), {1.0, 0.0, 0.0});
  check_point(room.entrances[0].world_from_entrance.origin, {6.5, 0.0, 0.0});
  check_point(room.entrances[0].world_from_entrance.forward(), {0.0, 0.0, -1.0});
}

TEST_CASE("the open office is L-shaped, has two doors and two kinds of sensors", "[scene][rooms]") {
  const SceneSpec office = shipped("open_office.gltf");
  CHECK(office.floor.area_m2() == Approx(12.0 * 8.0 - 4.0 * 3.0));
  CHECK(office.warnings.empty());
  CHECK(office.entrances.size() == 2);
  CHECK(office.seats.size() == 9);
  CHECK(office.sensor_models.size() == 2);
  REQUIRE(office.sensors.size() == 4);
  check_point(office.sensors[0].world_from_sensor.forward(), {0.0, -1.0, 0.0});
  check_point(office.sensors[0].world_from_sensor.up(), {0.0, 0.0, -1.0});
  check_point(office.sensors[2].world_from_sensor.up(), {-1.0, 0.0, 0.0});
  CHECK(office.sensors[3].world_from_sensor.forward().x > 0.98);
}

TEST_CASE("the open hall is a bare floor of 20 by 30 m with one sensor 3 m up", "[scene][rooms]") {
  const SceneSpec hall = shipped("open_hall.gltf");
  CHECK(hall.floor.area_m2() == Approx(600.0));
  CHECK(hall.meshes.empty());
  REQUIRE(hall.sensors.size() == 1);
  check_point(hall.sensors[0].world_from_sensor.origin, {0.0, 3.0, -3.0});
}

TEST_CASE("all eight alternative meeting rooms are read without a remark", "[scene][rooms]") {
  for (int n = 1; n <= 8; ++n) {
    const SceneSpec room = shipped("meeting_room_alt" + std::to_string(n) + ".gltf");
    CHECK(room.warnings.empty());
    CHECK(room.floor.area_m2() == Approx(30.7).margin(0.1));
    CHECK(room.sensors.size() == 5);
    CHECK(room.seats.size() == 10);
    for (const auto& seat : room.seats) CHECK(room.floor.contains(pirsim::floor_point(seat.world_from_seat.origin)));
  }
}

TEST_CASE("closed parts of the shipped rooms have no boundary and nothing needs repair", "[scene][rooms]") {
  for (const char* name : {"meeting_room.gltf", "open_office.gltf"}) {
    for (const auto& mesh : shipped(name).meshes) {
      const auto audit = pirsim::clean(mesh).audit;
      INFO(name << ": " << mesh.name);
      CHECK(audit.non_manifold_triangles == 0);
      CHECK((audit.boundary_edges == 0) == (mesh.name != "floor"));
    }
  }
}

TEST_CASE("the shipped rooms are what the generator writes", "[scene][rooms]") {
  if (std::system("python3 -c pass > /dev/null 2>&1") != 0) {
    WARN("skipped: python3 is not installed");
    return;
  }
  const std::filesystem::path data = pirsim::test::data_dir();
  const pirsim::test::TemporaryFolder folder;
  const std::string command =
      "python3 '" + (data / ".." / "tools" / "make_rooms.py").string() + "' -o '" + folder.path().string() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  REQUIRE(std::system((command + " --alternative all").c_str()) == 0);
  const auto content = [](const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  int compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    INFO(entry.path().filename());
    CHECK((content(entry.path()) == content(data / "rooms" / entry.path().filename())));
    ++compared;
  }
  CHECK(compared == 14);
}
