// What the facts say of an action is what becomes of somebody who carries it out.
#include "model/schema/actions.hpp"

#include <glm/geometric.hpp>

#include <map>
#include <string>

#include "engine/sim/run_state.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;
using Course = ActionFacts::Course;
using Pose = ActionFacts::Pose;

namespace {

/// Somebody when an action has been carried out.
struct Outcome {
  std::int64_t ticks = 0;  ///< that the action took
  bool present = false;
  Vec2 place{0.0};
  body::Stage stage = body::Stage::standing;
  std::string seat;
};

/// One person who carries these out and waits a little after each, which shows what has become of them.
std::vector<Outcome> outcomes(const std::vector<ScriptedAction>& actions) {
  std::vector<Outcome> result(actions.size());
  std::vector<ScriptedAction> script;
  for (std::size_t i = 0; i < actions.size(); ++i) {
    script.insert(script.end(), {actions[i], act(action::Wait{0.5})});
    script[2 * i].phase = "does " + std::to_string(i);
    script[2 * i + 1].phase = "did " + std::to_string(i);
  }
  const Model model(compile(shipped_scene("meeting_room.gltf"), script_of({person("p", std::move(script))})));
  State state(model, 0);
  while (!state.finished()) {
    step_tick(model, state);
    const sim::Actor& actor = state.run_state().crowd.actors().front();
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i].ticks += actor.phase() == "does " + std::to_string(i) ? 1 : 0;
      if (actor.phase() != "did " + std::to_string(i)) continue;
      result[i].present = actor.present();
      result[i].seat = actor.seat();
      if (!actor.present()) continue;
      result[i].place = actor.motion().position();
      result[i].stage = actor.motion().stage();
    }
  }
  return result;
}

}  // namespace

TEST_CASE("an action ends where, how and no sooner than its facts say") {
  const std::vector<ScriptedAction> actions{act(action::Follow{{0.5, 2.5}, {{5.0, -0.6}, {3.0, -0.6}}, {}}),
                                            act(action::Wait{2.0}),
                                            act(action::Enter{"door"}),
                                            act(action::Sit{"S4"}),
                                            act(action::Work{20.0}),
                                            act(action::Wait{3.0}),
                                            act(action::Rise{}),
                                            act(action::Walk{{{1.0, -1.0}}}),
                                            act(action::Turn{90.0}),
                                            act(action::Leave{"door"}),
                                            act(action::Wait{1.5}),
                                            act(action::Appear{{1.0, -1.0}, 45.0})};
  const std::vector<Outcome> found = outcomes(actions);
  const double speed_m_s = PersonSpec{}.walking_speed_m_s, tick_s = 1.0 / SensingSpec{}.tick_rate_hz;
  Outcome before;
  for (std::size_t i = 0; i < actions.size(); ++i) {
    const ActionFacts facts = facts_of(actions[i].what);
    INFO("action " << i << ", " << facts.name);
    const Outcome& now = found[i];
    const bool is_there = facts.course == Course::comes || (facts.course != Course::goes && before.present);
    CHECK(now.present == is_there);
    Vec2 at = before.place;
    CHECK(static_cast<double>(now.ticks) * tick_s >= shortest_s(facts, speed_m_s, at) - tick_s);
    if (facts.walks()) CHECK(glm::distance(at, now.place) < 1e-6);
    if (facts.appears_at != nullptr) CHECK(now.place == *facts.appears_at);
    if (facts.seat != nullptr) CHECK(now.seat == *facts.seat);
    const body::Stage kept = facts.pose == Pose::kept ? before.stage : body::Stage::standing;
    if (is_there) CHECK(now.stage == (facts.pose == Pose::seated ? body::Stage::seated : kept));
    // What time ends takes that time and no longer.
    if (facts.lasts_s > 0.0) CHECK(std::abs(static_cast<double>(now.ticks) * tick_s - facts.lasts_s) <= tick_s);
    before = now;
  }
}

TEST_CASE("whoever isn't there yet can wait or come, and do nothing else") {
  const auto refused = [](Action what) {
    try {
      (void)compile(shipped_scene("meeting_room.gltf"), script_of({person("p", {act(std::move(what))})}));
    } catch (const Error& error) {
      return std::string(error.what()).find("is not in the room yet") != std::string::npos;
    }
    return false;
  };
  const std::vector<Action> all{action::Wait{1.0},     action::Appear{{1.0, -1.0}, 0.0},
                                action::Enter{"door"}, action::Walk{{{1.0, -1.0}}},
                                action::Sit{"S4"},     action::Work{},
                                action::Rise{},        action::Leave{"door"},
                                action::Turn{10.0},    action::Follow{{0.0, 1.0}, {{1.0, -1.0}, {2.0, -1.0}}, {}},
                                action::Lie{"bed"},    action::Stand{"stove"}};
  REQUIRE(all.size() == std::variant_size_v<Action>);
  for (const Action& what : all) {
    const ActionFacts facts = facts_of(what);
    INFO(facts.name);
    CHECK(refused(what) == (facts.needs != ActionFacts::Needs::nothing));
  }
}
