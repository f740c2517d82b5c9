// A whole person as meshes against the same person as primitives.
#include <algorithm>

#include "engine/body/skeleton.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/fine_mesh.hpp"
#include "support/shipped.hpp"
#include "surveys/sight.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

PersonSpec in_meshes(PersonSpec person, std::uint32_t n = testing::fine) {
  const body::Humanoid humanoid(person);
  for (std::size_t i = 0; i < body::n_parts; ++i) {
    const std::string part(body::name(static_cast<body::Part>(i)));
    person.body_meshes[part] = testing::meshed(humanoid.primitives()[i], n);
  }
  return person;
}

PersonSpec mesh_walker() {
  return person("walker", {act(action::Appear{{-4, -6}, 0}), act(action::Walk{{{4, -7}, {0, -9}}})});
}

struct Difference {
  std::size_t active = 0;  ///< zones that the first run has active, over all ticks
  std::size_t lost = 0, gained = 0;
};
Difference difference(const RunResult& first, const RunResult& second) {
  REQUIRE(first.zones.size() == second.zones.size());
  Difference result;
  for (std::size_t tick = 0; tick < first.zones.size(); ++tick) {
    for (std::size_t zone = 0; zone < first.zones[tick].size(); ++zone) {
      const auto before = first.zones[tick].test(zone), after = second.zones[tick].test(zone);
      result.active += before ? 1 : 0;
      result.lost += before > after ? 1 : 0;
      result.gained += before < after ? 1 : 0;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("a walker made of fine meshes is seen by the zones that see the exact walker, but for grazing rays",
          "[mesh_body]") {
  const auto run = [](const PersonSpec& person, TracerKind tracer) {
    return run_once(compile(shipped_scene("open_hall.gltf"), script_of({person}), {tracer}), 0,
                    Record::samples_and_zones);
  };
  const RunResult exact = run(mesh_walker(), CompileOptions{}.tracer);
  const RunResult meshed = run(in_meshes(mesh_walker()), CompileOptions{}.tracer);
  const auto [active, lost, gained] = difference(exact, meshed);
  WARN(active << " active zones in " << exact.zones.size() << " ticks; fine meshes lose " << lost << ", gain "
              << gained);
  CHECK(active > 1000);
  CHECK(lost < active / 500);
  CHECK(gained == 0);  // the meshes are inscribed

  const auto coarse = difference(exact, run(in_meshes(mesh_walker(), 2), CompileOptions{}.tracer));
  WARN("meshes of eight sectors lose " << coarse.lost << ", gain " << coarse.gained);
  CHECK(coarse.lost > active / 500);
  CHECK(coarse.gained == 0);

  const RunResult plainly = run(in_meshes(mesh_walker()), TracerKind::reference);
  CHECK(plainly.zones == meshed.zones);
  CHECK(plainly.samples == meshed.samples);

  PersonSpec headless = mesh_walker();  // and a mesh far away from its part does make a difference
  headless.body_meshes["torso"] = testing::mesh_solid(testing::box_mesh({-0.01, 2, -0.01}, {0.01, 2.1, 0.01}));
  CHECK(run(headless, CompileOptions{}.tracer).zones != exact.zones);
}

TEST_CASE("looking around sees a mesh body where it sees the exact one", "[mesh_body]") {
  const auto report = [](const PersonSpec& person) {
    return studies::look_around(compile(shipped_scene("meeting_room.gltf"), script_of({person})));
  };
  const SightReport exact = report(person("a", {}));
  const SightReport meshed = report(in_meshes(person("a", {})));
  PersonSpec tiny = person("a", {});
  for (const std::string_view part : {"torso", "head", "pelvis"}) {
    tiny.body_meshes[std::string(part)] = testing::mesh_solid(testing::box_mesh(Vec3(-0.001), Vec3(0.001)));
  }
  const SightReport slight = report(tiny);
  REQUIRE(exact.places > 20);
  std::size_t seen = 0, seen_slight = 0;
  for (std::size_t i = 0; i < exact.sensors.size(); ++i) {
    const auto difference = static_cast<long>(exact.sensors[i].places) - static_cast<long>(meshed.sensors[i].places);
    CHECK(std::abs(difference) <= 1);
    CHECK(meshed.sensors[i].seats == exact.sensors[i].seats);
    seen += exact.sensors[i].places;
    seen_slight += slight.sensors[i].places;
  }
  CHECK(seen_slight < seen);
}
