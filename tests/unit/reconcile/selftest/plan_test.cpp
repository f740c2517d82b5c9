// Planning, on one seat and half a minute of work, with three effects that differ plainly.
#include "reconcile/selftest/plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "pirsim/io.hpp"
#include "reconcile/report/pages.hpp"
#include "reconcile/report/sentences.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/short_study.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

ScriptSpec planned_seat() { return test::short_study({"S4"}, 30.0); }

PlanResult planned(const std::filesystem::path& table, unsigned threads) {
  PlanSettings settings;
  settings.analysis.table.effects = {"false_triggers", "missed_triggers", "dead_sensor"};
  settings.analysis.table_folder = table;
  settings.analysis.trees = 60;
  return plan(test::shipped_scene("meeting_room.gltf"), planned_seat(), settings, {1, threads});
}

}  // namespace

TEST_CASE("a longer study repeats every trial and adds a slow walk and the empty room", "[plan]") {
  const SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  const LongerStudy study = longer_study(scene, test::shipped_script("studyA.yaml"));
  CHECK(study.n_planned == 10);
  REQUIRE(study.script.trials.size() == 22);
  CHECK(study.script.trials[13].id == "S4 again");
  CHECK(study.walk == std::vector<std::size_t>{20});
  CHECK(study.empty == std::vector<std::size_t>{21});
  CHECK(study.left_out.empty());
  for (const ScriptedAction& action : study.script.trials[20].people.front().actions) CHECK(action.phase == "working");
}

TEST_CASE("the walker of a longer study is the first person of any trial", "[plan]") {
  const SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  ScriptSpec script = planned_seat();
  script.trials.insert(script.trials.begin(), TrialSpec{"empty", {}});
  CHECK(longer_study(scene, script).left_out.empty());
  script.trials.resize(1);
  const LongerStudy nobody = longer_study(scene, script);
  REQUIRE(nobody.left_out.size() == 2);
  CHECK_THAT(nobody.left_out.front(), contains("nobody is in any trial"));
}

TEST_CASE("a room without an entrance has no slow walk and the plan says so", "[plan]") {
  SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  ScriptSpec script = planned_seat();
  scene.entrances.clear();
  script.trials.front().people.front().actions = {{action::Appear{{0.0, 0.0}, 0.0}, {}, {}, {}},
                                                  {action::Wait{30.0}, {}, "working", {}}};
  const LongerStudy study = longer_study(scene, script);
  CHECK(study.walk.empty());
  REQUIRE(study.left_out.size() == 1);
  CHECK_THAT(study.left_out.front(), contains("a slow walk is left out"));
}

TEST_CASE("a plan is the same for any number of threads and its numbers hold together", "[plan][seconds]") {
  const TemporaryFolder folder;
  const PlanResult result = planned(folder.path() / "t", 2);
  CHECK(to_json(result) == to_json(planned(folder.path() / "t", 1)));
  CHECK(result.hypotheses == std::vector<std::string>{"nothing", "false_triggers", "missed_triggers", "dead_sensor"});
  REQUIRE(result.designs.size() == 4);  // one trial: repeating it and repeating all are one and the same
  CHECK(result.designs[0].minutes == Approx(0.5).margin(0.04));
  CHECK(result.designs[1].minutes == result.designs[0].minutes);
  CHECK(result.designs[3].minutes == Approx(empty_room_min).margin(0.04));
  for (const Design& design : result.designs) {
    CHECK(design.bits <= 2.0);  // two bits: log2 of four hypotheses
    CHECK(design.right <= 1.0);
  }
  for (const auto& row : result.confusion) CHECK(std::accumulate(row.begin(), row.end(), 0.0) == Approx(1.0));
  // Ten minutes of an empty room show a rate of false triggers as half a minute of work can't, whatever else they tell.
  CHECK(result.designs[3].more_bits_95.low > 0.0);
  CHECK(sentence(result).find("The best next measurement is ") == 0);
  const std::string page = to_html(plan_page(result));
  for (const char* kind : {"bars", "grid"})
    CHECK_THAT(page, contains("<div class=\"charts " + std::string(kind) + "\">"));
}

TEST_CASE("trials of a longer study have names of their own", "[plan]") {
  const SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  ScriptSpec script = planned_seat();
  for (const char* id : {"S4 again", "slow walk", "empty room"}) {
    script.trials.push_back(script.trials.front());
    script.trials.back().id = id;
  }
  std::set<std::string> names;
  const LongerStudy study = longer_study(scene, script);
  for (const TrialSpec& trial : study.script.trials) names.insert(trial.id);
  CHECK(study.script.trials.size() == 10);
  CHECK(names.size() == study.script.trials.size());
}
