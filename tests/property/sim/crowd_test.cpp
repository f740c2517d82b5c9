// Crowds with random scripts: nobody stays stuck, nobody walks through anybody uncounted, bodies move as bodies do.
#include <glm/gtc/quaternion.hpp>
#include <map>

#include "support/body_checks.hpp"
#include "support/catch.hpp"
#include "support/crowd_watch.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

/// Trunks of a choreographed person who leans back just then; docs/physics/people.md tells how often.
constexpr double uncounted_overlap_m = 0.03;

CrowdRecord watch(const Model& model, std::uint32_t run) {
  return watch_crowd(model, run, 1, [](const sim::RunState&) {});
}

Model crowds(const std::string& scene_file, CrowdPlan plan, std::uint32_t n_trials, std::uint64_t seed) {
  const SceneSpec scene = shipped_scene(scene_file);
  return compile(scene, random_crowds(scene, plan, seed, 0, n_trials));
}

Trunk trunk_at(const Vec2& place, double heading) {
  static const body::Humanoid humanoid{PersonSpec{}};
  return trunk_of(humanoid, body::Motion(humanoid, place, heading, 0.0, 0.02).posture());
}

/// Two who sit where a third wants to sit.
PersonSpec newcomer(action::Sit sit) {
  return person("newcomer", {act(action::Wait{60.0}), act(action::Enter{"door"}), act(std::move(sit)),
                             act(action::Work{20.0}), act(action::Leave{"door"})});
}

}  // namespace

TEST_CASE("the watch sees trunks that overlap, and only those") {
  // Front to back: half a depth of 0.11 m each; side by side: the pelvises' half widths of 0.098 + 0.09 m each.
  const Trunk one = trunk_at({0, 0}, 0.0);
  for (const double apart : {0.05, 0.15, 0.21, 0.23, 0.3, 0.5}) {
    INFO(apart << " m");
    CHECK((trunk_gap(one, trunk_at({0, apart}, 0.0)) < 0.0) == (apart < 0.22));
    CHECK((trunk_gap(one, trunk_at({0, apart}, pi)) < 0.0) == (apart < 0.22));
  }
  for (const double apart : {0.3, 0.37, 0.38, 0.5}) {
    INFO(apart << " m");
    CHECK((trunk_gap(one, trunk_at({apart, 0}, 0.0)) < 0.0) == (apart < 2.0 * (0.5 * 0.105 * 1.86 + 0.09)));
  }
  CHECK(trunk_gap(one, trunk_at({0.5, 0}, 0.0)) > 0.1);
}

TEST_CASE("crowds of ten enter, sit and leave: everybody sits and has left, and passes through others are rare") {
  const Model model = crowds("meeting_room.gltf", {}, 10, 5);
  std::size_t n_passes = 0, n_entries = 0;
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    const CrowdRecord record = watch(model, run);
    INFO("run " << run << ": " << record.least_gap_m << " m at " << record.least_gap_at_s << " s");
    CHECK(record.least_gap_m > -uncounted_overlap_m);
    for (const Stay& stay : record.stays) {
      CHECK(stay.sat_s > 0.0);
      CHECK(stay.left_s > 0.0);
    }
    n_entries += record.stays.size();
    n_passes += record.count(IncidentKind::passed_through);
  }
  // 1 in 200 is the target; more than 4 of 100 would come in 0.2 % of such tests at that rate.
  CHECK(n_entries == 100);
  CHECK(n_passes <= 4);
}

TEST_CASE("in a crowd joints keep to their limits, places are continuous and feet that stand don't slide") {
  const Model model = crowds("meeting_room.gltf", {}, 2, 9);
  struct Before {
    Vec2 place{0.0};
    std::array<Vec3, 4> feet{};  ///< heels and toes
    bool known = false;
  };
  double fastest_m_s = 0.0, least_step_m = 0.0;
  body::test::Soundness soundness;
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    std::map<std::string, Before> before;
    (void)watch_crowd(model, run, 1000, [&](const sim::RunState& state) {
      if (state.tick % 10 > 1) return;  // two ticks that follow each other, five times a second
      for (const sim::Actor& actor : state.crowd.actors()) {
        Before& last = before[actor.person().spec.id];
        if (!actor.present()) {
          last.known = false;
          continue;
        }
        const body::Posture posture = actor.motion().posture();
        std::array<Vec3, 4> feet{};
        for (std::size_t i = 0; i < 4; ++i) {
          const std::size_t part = std::size_t(body::Part::left_foot) + i / 2;
          const Vec3 half = std::get<Box>(actor.person().humanoid.primitives()[part]).half_extents;
          feet[i] = posture[part] * Vec3(0.0, -half.y, i % 2 == 0 ? half.z : -half.z);
        }
        soundness.add(actor.person().humanoid, posture);
        if (last.known && state.tick % 10 == 1) {
          fastest_m_s = std::max(fastest_m_s, glm::distance(actor.motion().position(), last.place) / 0.02);
          // On foot one foot stands at any time, flat, on its heel or on its toes.
          const body::Stage stage = actor.motion().stage();
          if (stage == body::Stage::walking || stage == body::Stage::standing) {
            double moved_m = 1.0;
            for (std::size_t i = 0; i < 4; ++i) moved_m = std::min(moved_m, glm::distance(feet[i], last.feet[i]));
            least_step_m = std::max(least_step_m, moved_m);
          }
        }
        last = {actor.motion().position(), feet, true};
      }
    });
  }
  soundness.check();
  CHECK(fastest_m_s < 1.3);     // walking at 1 m/s, and the hips' sway
  CHECK(fastest_m_s > 0.9);     // somebody walked
  CHECK(least_step_m < 0.005);
}

TEST_CASE("who stays in a doorway for good is walked through after 20 s, which is counted with person and place") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const EntranceSpec& door = scene.entrances.front();
  const Vec2 sill = floor_point(door.world_from_entrance * Vec3(0, 0, -0.3));
  const Model model = compile(
      scene, script_of({person("stands", {act(action::Appear{sill, 0.0}), act(action::Wait{300.0})}),
                        person("comes", {act(action::Enter{door.id}), act(action::Walk{{Vec2(6.0, -2.0)}})})}));
  const CrowdRecord record = watch(model, 0);
  const RunResult result = run_once(model, 0);
  CHECK_FALSE(result.fault);
  REQUIRE(result.incidents.size() >= 1);
  const RunIncident& first = result.incidents.front();
  CHECK(first.kind == IncidentKind::passed_through);
  CHECK(first.time_s > 19.0);
  CHECK(first.time_s < 60.0);
  CHECK(glm::distance(first.place_m, sill) < 1.5);
  CHECK(record.count(IncidentKind::passed_through) == result.incidents.size());
}

TEST_CASE("a taken seat is waited for, then another is taken or the next action begins, and each is counted") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const PersonSpec sitter = person("sitter", {act(action::Enter{"door"}), act(action::Sit{"S4"}),
                                              act(action::Work{400.0}), act(action::Leave{"door"})});
  const auto outcome = [&](action::Sit sit) {
    return run_once(compile(scene, script_of({sitter, newcomer(std::move(sit))})), 0);
  };
  const RunResult waits = outcome({.seat = "S4", .wait_s = 600.0, .if_taken = {}});
  CHECK(waits.incidents.empty());
  CHECK(waits.samples.back().time_s > 430.0);

  const RunResult changes = outcome({.seat = "S4", .wait_s = 30.0, .if_taken = action::IfTaken::other_seat});
  REQUIRE(changes.incidents.size() == 1);
  CHECK(changes.incidents.front().kind == IncidentKind::seat_changed);
  CHECK(changes.incidents.front().person == "newcomer");

  const RunResult misses = outcome({.seat = "S4", .wait_s = 30.0, .if_taken = action::IfTaken::next_action});
  REQUIRE(misses.incidents.size() == 1);
  CHECK(misses.incidents.front().kind == IncidentKind::seat_missed);
}

TEST_CASE("crowds are the same on one thread and on three, and one by one") {
  const Model model = crowds("meeting_room.gltf", {.kind = {}, .n_people = 6, .seats = {}, .statures = {}}, 4, 3);
  std::vector<std::vector<Sample>> rows;
  for (const unsigned threads : {1U, 3U}) {
    std::size_t run = 0;
    run_study(model, {.threads = threads}, [&](const RunResult& result) {
      if (threads == 1) rows.push_back(result.samples);
      CHECK(result.samples == rows[run++]);
    });
  }
  CHECK(run_once(model, 2).samples == rows[2]);
}
