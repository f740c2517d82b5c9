// What a table of simulated datasets was made from decides its name.
#include <functional>
#include <set>

#include "reconcile/ensemble/reference_table.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

TEST_CASE("whatever a room is changed in, its table is another", "[reconcile]") {
  const SceneSpec room = test::shipped_scene("meeting_room.gltf");
  const ScriptSpec script = test::short_study_a();
  const auto key_of = [&](const SceneSpec& scene) {
    const RealizationSource source{scene, script, {}, 1};
    return table_key(source, frame_of(room, script), 1, {});
  };
  const std::vector<std::function<void(SceneSpec&)>> changes{
      [](SceneSpec& scene) { scene.meshes.front().positions.front().x += 1e-9; },
      [](SceneSpec& scene) { scene.meshes.front().solidity = Solidity::screen; },
      [](SceneSpec& scene) { scene.meshes.front().temperature_c = 30.0; },
      [](SceneSpec& scene) { scene.meshes.pop_back(); },
      [](SceneSpec& scene) { scene.sensors.front().world_from_sensor.origin.y += 0.1; },
      [](SceneSpec& scene) { scene.seats.front().world_from_seat.origin.x += 0.1; },
      [](SceneSpec& scene) { scene.entrances.front().width_m += 0.1; },
      [](SceneSpec& scene) { scene.floor = FloorArea(scene.floor.loops(), scene.floor.height_m() - 0.25); },
      [](SceneSpec& scene) { scene.sensor_models.begin()->second.clusters.front().range_m += 1.0; }};
  std::set<std::string> keys{key_of(room)};
  for (const auto& change : changes) {
    SceneSpec changed = room;
    change(changed);
    keys.insert(key_of(changed));
  }
  CHECK(keys.size() == changes.size() + 1);
  CHECK(key_of(room) == *keys.find(key_of(room)));
}
