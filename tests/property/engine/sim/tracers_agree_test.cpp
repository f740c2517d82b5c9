// Every tracer gives the reference's bits on every shipped study: every zone at every tick.
#include <filesystem>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/state.hpp"
#include "pirsim/study.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/zone_bytes.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

struct Comparison {
  std::size_t n_ticks = 0, n_different = 0, n_active = 0;
};

/// Runs one run with both tracers, tick by tick; of the slow tracers only every `stride`-th tick is traced, on a copy
/// of the state, so that all of a study's trials can be covered.
Comparison compare(const Model& fast, const Model& slow, std::uint32_t run, std::int64_t stride) {
  Comparison result;
  const auto tracer = slow.compiled().array().make_tracer(slow.compiled().tracer(), sim::ZonesOf::all_sensors);
  const std::size_t n_zones = slow.compiled().array().rated().n_zones();
  std::vector<PosedShape> solids;
  State state(fast, run);
  while (!state.finished()) {
    step_tick(fast, state);
    if ((state.tick() + run) % stride != 0) continue;
    solids.clear();
    for (const sim::Actor& actor : state.run_state().crowd.actors()) sim::append_solids(actor, solids);
    const ZoneBytes expected = seen_by(*tracer, solids, n_zones);
    ++result.n_ticks;
    bool differs = false;
    for (std::size_t zone = 0; zone < expected.size(); ++zone) {
      differs |= state.zones().test(zone) != (expected[zone] != 0);
      result.n_active += expected[zone];
    }
    result.n_different += differs ? 1 : 0;
  }
  return result;
}

Comparison compare_study(const std::string& room, const ScriptSpec& script, TracerKind kind, std::int64_t stride) {
  const Model fast = compile(shipped_scene(room), script, {TracerKind::direct});
  const Model slow = compile(shipped_scene(room), script, {kind});
  Comparison all;
  for (std::uint32_t run = 0; run < fast.n_runs(); ++run) {
    const Comparison one = compare(fast, slow, run, stride);
    all.n_ticks += one.n_ticks;
    all.n_different += one.n_different;
    all.n_active += one.n_active;
  }
  WARN(script.name << " against " << rt::name(kind) << ": " << all.n_ticks << " ticks of " << fast.n_runs()
                   << " runs compared, " << all.n_different << " differ");
  return all;
}

/// The rooms that a study goes with.
std::string room_of(const std::string& study) {
  if (study == "density.yaml") return "open_hall.gltf";
  return study == "studyA.yaml" ? "meeting_room.gltf" : "open_office.gltf";
}

}  // namespace

TEST_CASE("the direct tracer with its memory gives embree's zones at every tick of every shipped study's trials",
          "[seconds]") {
  for (const std::string study : {"studyA.yaml", "office.yaml", "density.yaml"}) {
    INFO(study);
    const Comparison c = compare_study(
        room_of(study), shipped_script(study, {"replicates=1", "sensing.response=zones"}), TracerKind::embree, 1);
    CHECK(c.n_different == 0);
    CHECK(c.n_ticks > 1000);
    CHECK(c.n_active > 0);
  }
}

TEST_CASE("and the reference's zones, sampled through all of them and with scattered seats", "[seconds]") {
  for (const std::string study : {"studyA.yaml", "office.yaml", "density.yaml"}) {
    INFO(study);
    CHECK(compare_study(room_of(study), shipped_script(study, {"replicates=1", "sensing.response=zones"}),
                        TracerKind::reference, 23)
              .n_different == 0);
  }
  const ScriptSpec scattered = shipped_script(
      "studyA.yaml",
      {"replicates=2", "people.0.seat_scatter.position_sd_m=0.05", "people.0.seat_scatter.heading_sd_deg=4.3"});
  CHECK(compare_study("meeting_room.gltf", scattered, TracerKind::reference, 211).n_different == 0);
}
