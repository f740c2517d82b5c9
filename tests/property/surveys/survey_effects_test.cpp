// Coverage studies and walk tests share sensors, detectors and effects with runs: what must then be true of them.
#include <algorithm>
#include <cmath>
#include <set>

#include "engine/effects/catalogue.hpp"
#include "pirsim/io.hpp"
#include "pirsim/study.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"
#include "surveys/coverage.hpp"
#include "surveys/walk_test.hpp"

using namespace pirsim;
using namespace pirsim::studies;
using namespace pirsim::test;

namespace {

SceneSpec silent_meeting_room() {
  SceneSpec scene = shipped_scene("meeting_room.gltf");
  for (auto& [id, model] : scene.sensor_models) model.detector.amplifier.noise_v_pp = 0.0;
  return scene;
}

CoverageSpec coarse_coverage(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"spacing_m=0.9", "duration_s=20"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return io::read_coverage(test::data("studies/studyB.yaml"), overrides);
}

std::vector<MotionCount> counts_with(const std::vector<EffectSpec>& effects, CoverageSpec spec = coarse_coverage()) {
  spec.effects = effects;
  return run_coverage(CoverageStudy(shipped_scene("meeting_room.gltf"), spec)).counts;
}

double sum(const std::vector<MotionCount>& counts) { return std::accumulate(counts.begin(), counts.end(), 0.0); }

EffectSpec effect(const std::string& name, std::map<std::string, double, std::less<>> parameters) {
  return {name, std::move(parameters), {}, {}};
}

WalkTestSpec coarse_walk_test(Response response) {
  WalkTestSpec spec = io::read_walk_test(test::data("studies/walk_test.yaml"));
  spec.spacing_m = 1.2;
  spec.sensing.response = response;
  return spec;
}

/// Does any sensor report motion while a study's person makes the walk that a walk test tries?
bool noticed_in_study(const SceneSpec& scene, const WalkTestSpec& spec, const Vec2& point, double heading_deg) {
  constexpr double still_s = 20.0;  // so that appearing is over
  const Vec2 half_path = spec.path_m / 2 * direction_of(radians(heading_deg));
  PersonSpec walker = spec.person;
  walker.id = "walker";
  walker.actions = {act(action::Appear{point - half_path, heading_deg}), act(action::Wait{still_s}),
                    act(action::Walk{{point + half_path}}), act(action::Wait{spec.major.within_s})};
  ScriptSpec script = script_of({walker});
  script.sensing = spec.sensing;
  const RunResult run = run_once(compile(scene, script), 0);
  return std::ranges::any_of(run.samples, [&](const Sample& row) {
    const bool in_time = row.time_s > still_s && row.time_s <= still_s + spec.major.within_s;
    return in_time && std::ranges::find(row.bits, 1) != row.bits.end();
  });
}

std::set<std::string> names_in(const std::vector<Issue>& warnings) {
  std::set<std::string> names;
  for (const Issue& issue : warnings) names.insert(issue.message.substr(0, issue.message.find(' ')));
  return names;
}

}  // namespace

TEST_CASE("a walk is noticed in a walk test where it is noticed in a study: hard zones and analog", "[walk][seconds]") {
  const SceneSpec scene = silent_meeting_room();
  for (const Response response : {Response::zones, Response::analog}) {
    WalkTestSpec spec = coarse_walk_test(response);
    spec.major = {1.0, 0.9, 4};
    spec.minor.directions = 1;
    spec.path_m = 1.0;
    const WalkTest test(scene, spec);
    WalkTester tester(test);
    int made = 0, noticed = 0, in_study = 0;
    for (std::size_t row = 0; row < test.grid().n_rows(); ++row) {
      for (std::size_t column = 0; column < test.grid().n_columns(); ++column) {
        if (!test.grid().on_floor(column, row)) continue;
        const Vec2 point = test.grid().centre(column, row);
        const Tries tries = tester.try_point(point, 0).major;
        if (tries.made < 4) continue;  // so that both made the same walks
        made += tries.made;
        noticed += tries.noticed;
        for (const double heading : {0.0, 90.0, 180.0, 270.0}) {
          in_study += noticed_in_study(scene, spec, point, heading) ? 1 : 0;
        }
      }
    }
    INFO((response == Response::zones ? "zones: " : "analog: ") << noticed << " of " << made);
    CHECK(made >= 12);
    CHECK(noticed > 0);
    CHECK(noticed == in_study);
  }
}

TEST_CASE("a sensor that an effect turns covers what one covers that hangs so", "[coverage]") {
  SceneSpec turned = shipped_scene("meeting_room.gltf");
  Quat& rotation = turned.sensors[1].world_from_sensor.rotation;
  rotation = glm::normalize(rotation_from_heading(radians(25.0)) * rotation);
  const auto by_hand = run_coverage(CoverageStudy(turned, coarse_coverage())).counts;
  EffectSpec yaw = effect("sensor_yaw", {{"yaw_deg", 25.0}});
  yaw.choices["sensor"] = turned.sensors[1].id;
  CHECK(counts_with({yaw}) == by_hand);
  CHECK(counts_with({}) != by_hand);
}

TEST_CASE("windows counted tick by tick are those counted by the target's turn", "[coverage]") {
  // A chance that never comes true puts a stage into the electronics, so that every tick is gone through.
  CHECK(counts_with({effect("missed_triggers", {{"probability", 1e-12}})}) == counts_with({}));
}

TEST_CASE("missed triggers cost a coverage study their share of the windows", "[coverage]") {
  const double plain = sum(counts_with({})), missed = 0.3;
  const double left = sum(counts_with({effect("missed_triggers", {{"probability", missed}})}));
  const double standard_error = std::sqrt(plain * missed * (1.0 - missed));
  INFO(plain << " windows with motion, " << left << " left, standard error " << standard_error);
  CHECK(std::abs(left - (1.0 - missed) * plain) < 4.0 * standard_error);
  CHECK_FALSE(std::abs(left - plain) < 4.0 * standard_error);  // must fail: nothing is missed
}

TEST_CASE("what effects draw in a coverage study depends on the seed and not on threads", "[coverage]") {
  CoverageSpec spec = coarse_coverage();
  spec.effects = {effect("soft_zone_edges", {{"sigma_deg", 1.5}})};
  const CoverageStudy study(shipped_scene("meeting_room.gltf"), spec);
  const auto one = run_coverage(study, 1).counts;
  CHECK(run_coverage(study, 2).counts == one);
  spec.seed = 2;
  CHECK(run_coverage(CoverageStudy(shipped_scene("meeting_room.gltf"), spec)).counts != one);
}

TEST_CASE("a coverage study warns of exactly those effects that change no count", "[coverage]") {
  std::set<std::string> acting, warned;
  for (const std::string room : {"meeting_room.gltf", "open_office.gltf"}) {  // one of which is symmetric
    CoverageSpec spec = coarse_coverage({"without=[]"});
    const auto plain = run_coverage(CoverageStudy(shipped_scene(room), spec)).counts;
    for (const effects::Effect* entry : effects::catalogue()) {
      spec.effects = {strong(*entry)};
      const CoverageStudy study(shipped_scene(room), spec);
      if (run_coverage(study).counts != plain) acting.insert(entry->info.name);
      warned.merge(names_in(study.warnings()));
    }
  }
  for (const effects::Effect* entry : effects::catalogue()) {
    INFO(entry->info.name);
    CHECK(acting.contains(entry->info.name) != warned.contains(entry->info.name));
  }
}

TEST_CASE("a walk test warns of exactly those effects that change no try", "[walk]") {
  WalkTestSpec spec = coarse_walk_test(Response::zones);
  spec.major.within_s = 1.0;
  spec.minor.within_s = 3.0;
  const auto tries_of = [](const WalkTest& test) {
    const WalkTestResult result = run_walk_test(test);
    std::vector<int> tries;
    for (const PointResult& p : result.points)
      tries.insert(tries.end(), {p.major.made, p.major.noticed, p.minor.made, p.minor.noticed});
    for (const SeatResult& seat : result.seats) tries.push_back(seat.noticed ? 1 : 0);
    return tries;
  };
  const auto plain = tries_of(WalkTest(shipped_scene("meeting_room.gltf"), spec));
  for (const effects::Effect* entry : effects::catalogue()) {
    WalkTestSpec with_effect = spec;
    with_effect.effects = {strong(*entry)};
    const WalkTest test(shipped_scene("meeting_room.gltf"), with_effect);
    INFO(entry->info.name);
    CHECK((tries_of(test) == plain) == !test.warnings().empty());
  }
}

TEST_CASE("an effect is called idle exactly where it does nothing to sensors of that response", "[effects][seconds]") {
  std::set<std::string> acting;
  for (const auto& [scene, written] : {std::pair{shipped_scene("meeting_room.gltf"), short_study_a()},
                                       std::pair{shipped_scene("open_office.gltf"), short_office()}}) {
    ScriptSpec script = written;
    script.sensing.response = Response::analog;
    const auto plain = results_of(compile(scene, script));
    for (const effects::Effect* entry : effects::catalogue()) {
      if (acting.contains(entry->info.name)) continue;
      script.effects = {strong(*entry)};
      if (!same_rows(results_of(compile(scene, script)), plain)) acting.insert(entry->info.name);
    }
  }
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  SensingSpec sensing;
  for (const effects::Effect* entry : effects::catalogue()) {
    if (entry->info.needs != effects::Needs::nothing) continue;  // of the script, which these two lack
    INFO(entry->info.name);
    const std::vector<EffectSpec> one{strong(*entry)};
    sensing.response = Response::analog;
    CHECK(names_in(effects::idle(one, scene, sensing)).contains(entry->info.name) ==
          !acting.contains(entry->info.name));
    sensing.response = Response::zones;
    CHECK(effects::idle(one, scene, sensing).empty());
  }
}
