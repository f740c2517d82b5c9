// Several people with scripts of their own.
#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

#include "engine/sim/run_state.hpp"
#include "pirsim/random.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

/// Least distance between any two people's pelvises over a run, metres, and whether all came to the end.
struct Encounter {
  double nearest_m = 1e9;
  std::size_t ticks = 0;
  std::size_t most_people = 0;
};

Encounter watch_pair(const Model& model) {
  Encounter result;
  State state(model, 0);
  while (!state.finished()) {
    step_tick(model, state);
    ++result.ticks;
    std::vector<Vec2> places;
    for (const sim::Actor& actor : state.run_state().crowd.actors()) {
      if (actor.present()) places.push_back(actor.motion().position());
    }
    result.most_people = std::max(result.most_people, places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        result.nearest_m = std::min(result.nearest_m, glm::distance(places[i], places[j]));
    }
  }
  return result;
}

}  // namespace

TEST_CASE("two people who walk towards each other in an open hall pass without touching") {
  const SceneSpec scene = shipped_scene("open_hall.gltf");
  const Model model(compile(scene, script_of({
                                       person("a", {act(action::Appear{{-5, -10}, 0}), act(action::Walk{{{5, -10}}})}),
                                       person("b", {act(action::Appear{{5, -10}, 0}), act(action::Walk{{{-5, -10}}})}),
                                   })));
  const Encounter encounter = watch_pair(model);
  CHECK(encounter.most_people == 2);
  // Trunks are at most half a body breadth wide each: 0.36 m between pelvises is shoulder past shoulder at an angle.
  CHECK(encounter.nearest_m > 0.36);
  CHECK(encounter.ticks < 60 * 50);
}

TEST_CASE("six people cross a hall on random ways: nobody is walked through and everybody arrives") {
  const SceneSpec scene = shipped_scene("open_hall.gltf");
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    Stream stream({seed, 0, 0, Purpose::test});
    const auto point = [&] { return Vec2(-6.0 + 12.0 * stream.uniform(), -6.0 - 12.0 * stream.uniform()); };
    std::vector<PersonSpec> people;
    for (int i = 0; i < 6; ++i) {
      // A start of one's own in a row; targets anywhere.
      people.push_back(person("p" + std::to_string(i),
                              {act(action::Appear{{-5.0 + 2.0 * i, -3.0}, 0}), act(action::Walk{{point(), point()}}),
                               act(action::Walk{{{-5.0 + 2.0 * i, -20.0}}})}));
    }
    const Encounter encounter = watch_pair(Model(compile(scene, script_of(people))));
    INFO("seed " << seed << ", nearest " << encounter.nearest_m);
    CHECK(encounter.most_people == 6);
    CHECK(encounter.nearest_m > 0.36);
  }
}

TEST_CASE("a meeting of five: all come in through one door, sit side by side, and leave, people are counted") {
  std::vector<PersonSpec> people;
  for (int i = 1; i <= 5; ++i) {
    people.push_back(
        person("p" + std::to_string(i),
               {act(action::Wait{2.0 * i}), act(action::Enter{"door"}), act(action::Sit{"S" + std::to_string(i)}),
                act(action::Work{30.0}), act(action::Rise{}), act(action::Leave{"door"})}));
  }
  const Model model(compile(shipped_scene("meeting_room.gltf"), script_of(people)));
  const Encounter encounter = watch_pair(model);
  CHECK(encounter.most_people == 5);
  CHECK(encounter.nearest_m > 0.36);
  const RunResult result = run_once(model, 0);
  CHECK(std::ranges::max(result.samples, {}, &Sample::people).people == 5);
  CHECK(result.samples.back().people == 0);
}

TEST_CASE("two who use one door in opposite directions wait for each other, and a taken seat is waited for") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const PersonSpec first = person("first", {act(action::Enter{"door"}), act(action::Sit{"S4"}), act(action::Work{20.0}),
                                            act(action::Leave{"door"})});
  for (const double delay : {1.0, 20.0, 31.0, 33.0, 35.0, 37.0}) {
    const PersonSpec second = person("second", {act(action::Wait{delay}), act(action::Enter{"door"}),
                                                act(action::Sit{"S4"}), act(action::Leave{"door"})});
    const Encounter encounter = watch_pair(Model(compile(scene, script_of({first, second}))));
    INFO("the second comes after " << delay << " s; nearest " << encounter.nearest_m << " m");
    CHECK(encounter.nearest_m > 0.36);
  }
}

TEST_CASE("one who leaves and one who comes in pass a door one after the other, whoever the script names first") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  for (const double delay : {0.0, 1.0, 2.5, 4.0}) {
    for (const Vec2 target : {Vec2(6.5, -2.0), Vec2(5.5, -2.5)}) {
      std::vector<PersonSpec> people{
          person("out", {act(action::Appear{{6.5, -2.0}, 0}), act(action::Leave{"door"})}),
          person("in", {act(action::Wait{delay}), act(action::Enter{"door"}), act(action::Walk{{target}})})};
      for (int order = 0; order < 2; ++order) {
        INFO("delay " << delay << ", target x " << target.x << ", order " << order);
        CHECK(watch_pair(Model(compile(scene, script_of(people)))).nearest_m > 0.36);
        std::swap(people[0], people[1]);
      }
    }
  }
}

TEST_CASE("waiting for good ends after 20 s by passing through, or without the seat, and no run is endless") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const auto kinds = [&](std::vector<PersonSpec> people) {
    const RunResult result = run_once(compile(scene, script_of(std::move(people))), 0);
    CHECK_FALSE(result.fault);
    CHECK(result.samples.back().time_s < 300.0);
    std::vector<IncidentKind> found;
    for (const RunIncident& incident : result.incidents) found.push_back(incident.kind);
    return found;
  };
  const PersonSpec stays = person("stays", {act(action::Appear{{6, -2}, 0}), act(action::Wait{60.0})});
  const PersonSpec sits = person("sits", {act(action::Enter{"door"}), act(action::Sit{"S4"})});
  CHECK(kinds({stays, person("b", {act(action::Appear{{6, -2}, 0})})}) == std::vector{IncidentKind::passed_through});
  CHECK(kinds({sits, person("b", {act(action::Wait{5.0}), act(action::Enter{"door"}), act(action::Sit{"S4"})})}) ==
        std::vector{IncidentKind::seat_missed});
  // Who stands close behind a chair and has nothing left to do makes way for its sitter, if there is room.
  const SeatSpec& seat = *std::ranges::find(scene.seats, "S4", &SeatSpec::id);
  const Vec2 behind = floor_point(seat.world_from_seat.origin) - 0.75 * floor_point(seat.world_from_seat.forward());
  CHECK(kinds({person("a", {act(action::Enter{"door"}), act(action::Sit{"S4"}), act(action::Work{30.0}),
                            act(action::Rise{})}),
               person("b", {act_at(30.0, action::Appear{behind, 0})})})
            .empty());
}

TEST_CASE("at_s starts its action at its moment and skips what was to come before") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const auto run = [&](std::vector<ScriptedAction> actions) {
    return run_once(compile(scene, script_of({person("a", std::move(actions))})), 0).samples;
  };
  const auto samples = run({act(action::Enter{"door"}), act(action::Sit{"S3"}), act(action::Work{100.0}),
                            act(action::Rise{}), act_at(40.0, action::Leave{"door"})});
  for (const Sample& sample : samples) {
    if (sample.time_s > 20.0 && sample.time_s <= 40.0) CHECK(sample.phase == "working");
    if (sample.time_s > 40.0) CHECK(sample.phase != "working");
  }
  CHECK(samples.back().time_s < 60.0);
  const auto never = run({act(action::Wait{5.0}), act(action::Enter{"door"}), act_at(2.0, action::Leave{"door"})});
  CHECK(never.size() <= 3);
  for (const Sample& sample : never) CHECK(sample.phase == "outside");
}

TEST_CASE("at work the forearms lie on the table") {
  const Model model(
      compile(shipped_scene("meeting_room.gltf"),
              script_of({person("a", {act(action::Enter{"door"}), act(action::Sit{"S8"}), act(action::Work{20.0})})})));
  State state(model, 0);
  double lowest = 1e9, highest = -1e9;
  while (!state.finished()) {
    step_tick(model, state);
    const sim::Actor& actor = state.run_state().crowd.actors().front();
    if (actor.phase() != "working" || state.tick() < 20 * 50) continue;  // hands are on the table by then
    const auto part = static_cast<std::size_t>(body::Part::left_forearm);
    const auto& forearm = std::get<Capsule>(actor.person().humanoid.solids()[part]);
    const Frame frame = actor.motion().posture()[part];
    const double one_end = (frame * Vec3(0, forearm.half_length, 0)).y,
                 other_end = (frame * Vec3(0, -forearm.half_length, 0)).y;
    lowest = std::min(lowest, std::min(one_end, other_end) - forearm.radius);    // no end in the table
    highest = std::max(highest, std::min(one_end, other_end) - forearm.radius);  // the hand on it
  }
  constexpr double table_top_m = 0.74;  // data/rooms/room_layouts.json
  CHECK(lowest > table_top_m - 1e-3);
  CHECK(highest < table_top_m + 0.02);
}

TEST_CASE("ten people fill the meeting room and leave it when the meeting is over") {
  std::vector<PersonSpec> people;
  for (int i = 1; i <= 10; ++i) {
    // Those who sit farthest from the door come first and leave last.
    const int seat = i <= 5 ? i + 5 : i - 5;
    people.push_back(
        person("p" + std::to_string(i),
               {act(action::Wait{4.0 * i}), act(action::Enter{"door"}), act(action::Sit{"S" + std::to_string(seat)}),
                act_at(70.0 + 4.0 * (10 - i), action::Rise{}), act(action::Leave{"door"})}));
  }
  const Encounter encounter = watch_pair(Model(compile(shipped_scene("meeting_room.gltf"), script_of(people))));
  CHECK(encounter.most_people == 10);
  CHECK(encounter.nearest_m > 0.36);
}

TEST_CASE("the script can interrupt anything: a person called away in mid-walk, mid-fall and mid-work leaves") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  for (const double moment : {3.0, 5.3, 7.1, 8.0, 9.4, 11.0, 20.0}) {
    PersonSpec spec = person("a", {act(action::Enter{"door"}), act(action::Sit{"S4"}), act(action::Work{60.0})});
    spec.actions.push_back(act_at(moment, action::Leave{"door"}));
    if (moment < 12.0) spec.actions.erase(spec.actions.begin() + 2);
    const RunResult result = run_once(compile(scene, script_of({spec})), 0);
    INFO("called away at " << moment << " s");
    CHECK(result.samples.back().people == 0);
    CHECK(result.samples.back().time_s < moment + 30.0);
  }
}

TEST_CASE("people are counted from geometry: 0 outside the door, 1 inside, whatever the script is doing") {
  const Model model(compile(shipped_scene("meeting_room.gltf"),
                            script_of({person("a", {act(action::Enter{"door"}), act(action::Sit{"S5"}),
                                                    act(action::Rise{}), act(action::Leave{"door"})})})));
  State state(model, 0);
  while (step(model, state)) {
    const sim::Actor& actor = state.run_state().crowd.actors().front();
    const int inside = actor.present() && actor.motion().position().y < 0.0 ? 1 : 0;  // the room extends to -Z
    REQUIRE(state.sample().people == inside);
  }
}
