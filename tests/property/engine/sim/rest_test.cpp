// Whoever is there when a run begins has been there for long: no motion until somebody moves.
#include <algorithm>

#include "engine/sim/recording_family.hpp"
#include "pirsim/recording.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

constexpr double walks_at_s = 6.0;
const Vec2 here(6.0, -1.0), there(6.0, -4.0);

PersonSpec standing(const std::string& id, const Vec2& at) {
  return person(id, {act(action::Appear{at, 90.0}), act(action::Wait{walks_at_s})});
}

ScriptSpec stands_then_walks() {
  PersonSpec walker = standing("walker", here);
  walker.actions.push_back(act(action::Walk{{there}}));
  return script_of({walker});
}

Model model_of(ScriptSpec script) { return compile(shipped_scene("meeting_room.gltf"), std::move(script)); }

int n_ones(const std::vector<Sample>& samples, double from_s, double to_s) {
  int n = 0;
  for (const Sample& row : samples) {
    if (row.time_s > from_s && row.time_s <= to_s) n += static_cast<int>(std::ranges::count(row.bits, 1));
  }
  return n;
}

void check_rests(const Model& model) {
  const std::vector<Sample> samples = run_once(model, 0).samples;
  REQUIRE(samples.front().people > 0);
  CHECK(n_ones(samples, 0.0, walks_at_s) == 0);
  CHECK(n_ones(samples, walks_at_s, 1e9) > 0);
}

}  // namespace

TEST_CASE("who stands still from the beginning is no motion until they walk, by any response", "[rest]") {
  ScriptSpec script = stands_then_walks();
  check_rests(model_of(script));
  for (const char* rule : {"drawn_edge", "covered_area", "swept_area"}) {
    INFO(rule);
    check_rests(model_of(with(script, {{"soft_zone_edges", {}, {{"rule", rule}}, {}}})));
  }
  check_rests(model_of(with(script, {{"dual_polarity", {{"threshold", 0.3}}, {}, {}}})));
  script.sensing.change_per = ChangePer::beam;
  check_rests(model_of(script));
  script.sensing.response = Response::analog;
  check_rests(model_of(script));
}

TEST_CASE("who is followed from the run's beginning on has stood there for long", "[rest]") {
  for (const Response response : {Response::zones, Response::analog}) {
    ScriptSpec script =
        script_of({person("a", {act(action::Follow{{0.0, walks_at_s, walks_at_s + 3.0}, {here, here, there}, {}})})});
    script.sensing.response = response;
    script.sensing.change_per = ChangePer::beam;
    check_rests(model_of(script));
  }
}

TEST_CASE("who stands there naturally from the beginning, on the phone too, is no motion in the first row", "[rest]") {
  for (const std::optional<Activity> activity : {std::optional<Activity>(), std::optional(Activity::phone)}) {
    ScriptSpec script =
        script_of({person("a", {act(action::Appear{{2.6, -1.4}, 90.0}), act(action::Wait{600.0, activity})})});
    script.trials.front().people.front().style = MotionStyle::natural;
    script.replicates = 10;
    script.trials.front().duration_s = 20.0;
    for (const Response response : {Response::zones, Response::analog}) {
      script.sensing.response = response;
      script.sensing.change_per = ChangePer::beam;
      int n_later = 0;
      for (const RunResult& run : results_of(model_of(script))) {
        INFO((activity ? "on the phone" : "idle") << (response == Response::zones ? ", zones" : ", analog"));
        CHECK(n_ones(run.samples, 0.0, 1.0) == 0);
        n_later += n_ones(run.samples, 1.0, 20.0);
      }
      CHECK(n_later > 0);
    }
  }
}

TEST_CASE("what somebody who stands still shares in a signal is nothing until they walk", "[rest]") {
  ScriptSpec script = stands_then_walks();
  script.sensing.response = Response::analog;
  SceneSpec scene = shipped_scene("meeting_room.gltf");
  for (auto& [id, model] : scene.sensor_models) model.detector.amplifier.noise_v_pp = 0.0;
  const RunResult result = run_once(compile(scene, script), 0, Record::samples, Trace::signals);
  double before = 0.0, after = 0.0;
  for (const TraceRow& row : result.trace) {
    double& greatest = row.tick <= static_cast<std::int64_t>(50 * walks_at_s) ? before : after;
    greatest = std::max(greatest, std::abs(row.share_v));
  }
  CHECK(before < 1e-6);
  CHECK(after > 0.01);
}

TEST_CASE("several who stand there, a bystander and a warm object are no motion either", "[rest]") {
  ScriptSpec script = stands_then_walks();
  script.trials.front().people.push_back(standing("other", Vec2(2.0, -4.0)));
  check_rests(model_of(script));
  check_rests(model_of(with(script, {{"second_person", {{"every_s", 30.0}}, {}, {}}})));
  check_rests(model_of(with(script, {{"warm_object", {{"every_s", 60.0}}, {}, {}}})));
}

TEST_CASE("recordings begin with who is there", "[rest]") {
  const Model model = model_of(with(stands_then_walks(), {{"dual_polarity", {{"threshold", 0.3}}, {}, {}}}));
  const auto rows = results_of(model);
  const Recording tracks = record(model, all_runs(model), 1);
  CHECK(tracks.zones(tracks.runs[0].rest) != ZoneSet(model.compiled().array().channels().n_zones()));
  sim::RecordingFamily family(model, all_runs(model));
  for (const Recording* recording : {&tracks, &family.first()}) {
    std::vector<RunResult> emitted;
    emit(model, *recording, {}, [&](const RunResult& run) { emitted.push_back(run); });
    CHECK(same_rows(emitted, rows));
  }
}

TEST_CASE("a state knows before the first tick what the zones see", "[rest]") {
  const Model model = model_of(stands_then_walks());
  State state(model, 0);
  const ZoneSet at_first = state.zones();
  CHECK(at_first != ZoneSet(at_first.size()));
  step_tick(model, state);
  CHECK(state.zones() == at_first);
}

TEST_CASE("who comes in by a door, or appears later, is motion", "[rest]") {
  const Model enters = model_of(script_of({person("a", {act(action::Enter{"door"}), act(action::Walk{{there}})})}));
  CHECK(n_ones(run_once(enters, 0).samples, 0.0, 1e9) > 0);
  const Model appears = model_of(
      script_of({person("a", {act(action::Wait{4.0}), act(action::Appear{here, 90.0}), act(action::Wait{4.0})})}));
  CHECK(n_ones(run_once(appears, 0).samples, 4.0, 5.0) > 0);
}

TEST_CASE("two who begin at one place don't stand in each other: the second waits for room", "[rest]") {
  PersonSpec walker = standing("walker", here);
  walker.actions.push_back(act(action::Walk{{there}}));
  const Model model = model_of(script_of({walker, standing("second", here)}));
  const std::vector<Sample> samples = run_once(model, 0).samples;
  CHECK(samples.front().people == 1);
  CHECK(samples.back().people == 2);
}
