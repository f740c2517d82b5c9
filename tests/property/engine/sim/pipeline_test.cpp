// Whole runs against what must be true whatever the numbers.
#include <glm/geometric.hpp>

#include <algorithm>

#include "pirsim/geometry.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

int all_bits(const RunResult& result) {
  int total = 0;
  for (const Sample& sample : result.samples) {
    for (const auto bit : sample.bits) total += bit;
  }
  return total;
}

/// The scene as it stands after a rigid motion of everything.
SceneSpec moved(SceneSpec scene, const Frame& motion) {
  for (TriMesh& mesh : scene.meshes) {
    for (Vec3& p : mesh.positions) p = motion * p;
  }
  for (SensorSpec& sensor : scene.sensors) sensor.world_from_sensor = motion * sensor.world_from_sensor;
  for (SeatSpec& seat : scene.seats) seat.world_from_seat = motion * seat.world_from_seat;
  for (EntranceSpec& entrance : scene.entrances) entrance.world_from_entrance = motion * entrance.world_from_entrance;
  auto loops = scene.floor.loops();
  for (auto& loop : loops) {
    for (Vec2& p : loop) p = floor_point(motion * Vec3(p.x, 0.0, p.y));
  }
  scene.floor = FloorArea(loops, scene.floor.height_m() + motion.origin.y);
  return scene;
}

}  // namespace

TEST_CASE("an empty room gives zeros, and so does a person behind every beam, in front of them it doesn't") {
  const SceneSpec scene = shipped_scene("open_hall.gltf");
  const auto run = [&](std::vector<PersonSpec> people) {
    return run_once(compile(scene, script_of(std::move(people))), 0);
  };
  const RunResult empty = run({person("nobody", {act(action::Wait{20.0})})});
  CHECK(empty.samples.size() == 20);
  CHECK(all_bits(empty) == 0);
  const auto pace = [&](double z) {
    return run({person("walker", {act(action::Appear{{-4, z}, 0}), act(action::Walk{{{4, z}, {-4, z}}})})});
  };
  CHECK(all_bits(pace(-1.0)) == 0);  // the sensor hangs at z = -3 and looks along -Z
  CHECK(all_bits(pace(-7.0)) > 0);
}

TEST_CASE("an added occluder never adds an active zone, at no tick of a whole trial") {
  ScriptSpec script =
      shipped_script("studyA.yaml", {"trials.for_each.seat=[S3]", "people.0.actions.3.work.duration_s=20"});
  const Model open(compile(shipped_scene("meeting_room.gltf"), script));
  SceneSpec with_screen = shipped_scene("meeting_room.gltf");
  // A hanging screen, above everybody's head, between the sensors and the table.
  with_screen.meshes.push_back(
      {"screen", {{1, 2.1, -0.5}, {6, 2.1, -0.5}, {6, 2.6, -0.5}, {1, 2.6, -0.5}}, {{0, 1, 2}, {0, 2, 3}}});
  const Model screened(compile(with_screen, script));
  const RunResult a = run_once(open, 0, Record::samples_and_zones);
  const RunResult b = run_once(screened, 0, Record::samples_and_zones);
  REQUIRE(a.zones.size() == b.zones.size());
  std::size_t lost = 0, added = 0;
  for (std::size_t tick = 0; tick < a.zones.size(); ++tick) {
    for (std::size_t zone = 0; zone < a.zones[tick].size(); ++zone) {
      if (a.zones[tick].test(zone) > b.zones[tick].test(zone)) ++lost;
      if (a.zones[tick].test(zone) < b.zones[tick].test(zone)) ++added;
    }
  }
  CHECK(added == 0);
  CHECK(lost > 0);
}

TEST_CASE("moving and turning the whole scene changes no row") {
  const ScriptSpec script =
      shipped_script("studyA.yaml", {"trials.for_each.seat=[S2, S7]", "people.0.actions.3.work.duration_s=60"});
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const Model here(compile(scene, script));
  // A quarter turn and a shift by whole grid cells: way-finding sees the same grid.
  const Model there(compile(moved(scene, {rotation_from_heading(pi / 2), Vec3(16, 4, -8)}), script));
  for (std::uint32_t run = 0; run < 2; ++run) {
    const RunResult a = run_once(here, run), b = run_once(there, run);
    REQUIRE(a.samples.size() == b.samples.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.samples.size(); ++i) different += a.samples[i] == b.samples[i] ? 0 : 1;
    INFO("run " << run << ": " << different << " of " << a.samples.size() << " rows differ");
    CHECK(different == 0);
  }
}

TEST_CASE("a copied state goes on like the original, and a used tracer changes nothing") {
  const Model model(compile(shipped_scene("meeting_room.gltf"),
                            shipped_script("studyA.yaml", {"people.0.actions.3.work.duration_s=10"})));
  State original(model, 3);
  for (int i = 0; i < 15; ++i) step(model, original);
  State copy = original;
  while (step(model, original)) {
    REQUIRE(step(model, copy));
    REQUIRE(copy.sample() == original.sample());
  }
  CHECK_FALSE(step(model, copy));
  CHECK(run_once(model, 3).samples == run_once(model, 3).samples);
}
