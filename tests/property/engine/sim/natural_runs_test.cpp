// Whole runs with people of natural style: what sensors make of them, and what others don't notice.
#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/sim/run_state.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

PersonSpec worker(const std::string& id, const std::string& door, const std::string& seat, MotionStyle style,
                  std::optional<Activity> activity, double seconds) {
  action::Work work;
  work.duration_s = seconds;
  work.activity = activity;
  PersonSpec spec = person(id, {act(action::Enter{door}), act(action::Sit{seat}), act(work)});
  spec.style = style;
  spec.seat_scatter = {0.03, 3.0};
  return spec;
}

std::vector<body::Outline> outlines(const ScriptSpec& script, std::size_t who) {
  const Model model(compile(shipped_scene("open_office.gltf"), script));
  State state(model, 0);
  std::vector<body::Outline> seen;
  while (!state.finished()) {
    step_tick(model, state);
    const sim::Actor& actor = state.run_state().crowd.actors()[who];
    if (actor.present()) seen.push_back(actor.motion().outline());
  }
  return seen;
}

}  // namespace

TEST_CASE("how one person moves leaves the draws of the others where they were") {
  for (const MotionStyle style : {MotionStyle::choreographed, MotionStyle::natural}) {
    std::vector<std::vector<body::Outline>> seen;
    for (const MotionStyle other : {MotionStyle::choreographed, MotionStyle::natural}) {
      ScriptSpec script = script_of({worker("a", "front_door", "S1", style, std::nullopt, 150.0),
                                     worker("b", "side_door", "S6", other, std::nullopt, 150.0)});
      script.trials.front().duration_s = 150.0;
      seen.push_back(outlines(script, 0));
    }
    CHECK(seen[0].size() > 5000);
    CHECK(seen[0] == seen[1]);
  }
}

TEST_CASE("in a meeting one speaks and gestures, and the others look there") {
  std::vector<PersonSpec> people;
  for (const char* seat : {"S1", "S4", "S8"}) {
    people.push_back(worker(seat, "door", seat, MotionStyle::natural, Activity::meeting, 900.0));
  }
  ScriptSpec script = script_of(people);
  script.trials.front().duration_s = 600.0;
  const Model model(compile(shipped_scene("meeting_room.gltf"), script));
  State state(model, 0);
  int looking = 0, listening = 0;
  double highest = 0.0;
  while (!state.finished()) {
    step_tick(model, state);
    const auto& actors = state.run_state().crowd.actors();
    if (!std::ranges::all_of(actors, &sim::Actor::takes_part_in_meeting)) continue;
    for (const sim::Actor& listener : actors) {
      const body::Outline outline = listener.motion().outline();
      highest = std::max(highest, outline.hand_up_m[0]);
      ++listening;
      // At one of the others, as far as a head turns.
      looking += std::ranges::any_of(actors,
                                     [&](const sim::Actor& other) {
                                       if (&other == &listener) return false;
                                       const Vec2 way = other.motion().position() - listener.motion().position();
                                       const double turn =
                                           std::remainder(heading_of(way) - listener.motion().heading(), 2.0 * pi);
                                       return std::abs(std::clamp(turn, -0.873, 0.873) - outline.head_turn) < 0.1;
                                     })
                     ? 1
                     : 0;
    }
  }
  CHECK(highest > 0.08);
  REQUIRE(listening > 50000);
  CHECK(looking > 0.4 * listening);
}

TEST_CASE("an analog sensor receives the breathing of a still sitter, which hard zones mostly don't") {
  const auto model_of = [](Response response, MotionStyle style) {
    ScriptSpec script = script_of({worker("a", "door", "S8", style, std::nullopt, 900.0)});
    for (ScriptedAction& action : script.trials.front().people.front().actions) {
      if (auto* work = std::get_if<action::Work>(&action.what))
        work->arm_amplitude_m = 0.0, work->tilt_choices_deg = {};
    }
    script.trials.front().duration_s = 900.0;
    script.sensing.response = response;
    return compile(shipped_scene("meeting_room.gltf"), script);
  };
  struct Seen {
    int still_s = 0, changed_powers = 0, zones_with_motion = 0;
  };
  // Only seconds that come 3 s or more after the last movement of a joint, when amplifiers have come to rest.
  const auto watch = [](const Model& model) {
    Seen seen;
    State state(model, 0);
    body::Outline last;
    int still = 0;
    std::vector<sim::PowerSteps> powers;
    bool power_changed = false;
    while (!state.finished()) {
      step_tick(model, state);
      const sim::Actor& actor = state.run_state().crowd.actors().front();
      if (!actor.present() || actor.phase() != "working") continue;
      body::Outline now = actor.motion().outline();
      now.chest_m = 0.0;
      still = now == last ? still + 1 : 0;
      last = now;
      const auto& exposure = state.run_state().exposure();
      power_changed = power_changed || powers != exposure.powers;
      powers = exposure.powers;
      if (still < 200) power_changed = false;
      if (still < 200 || still % 50 != 0) continue;
      ++seen.still_s;
      seen.changed_powers += power_changed ? 1 : 0;
      power_changed = false;
      seen.zones_with_motion += std::ranges::any_of(state.sample().bits, [](auto bit) { return bit != 0; }) ? 1 : 0;
    }
    return seen;
  };
  const Seen natural = watch(Model(model_of(Response::analog, MotionStyle::natural)));
  const Seen rigid = watch(Model(model_of(Response::analog, MotionStyle::choreographed)));
  const Seen hard = watch(Model(model_of(Response::zones, MotionStyle::natural)));
  INFO(natural.still_s << " still seconds, powers changed in " << natural.changed_powers << ", zones in "
                       << hard.zones_with_motion << " of " << hard.still_s << ", rigid " << rigid.changed_powers
                       << " of " << rigid.still_s);
  REQUIRE(natural.still_s > 100);
  REQUIRE(rigid.still_s > 100);
  CHECK(natural.changed_powers > 0.5 * natural.still_s);  // half a millimetre of the chest doesn't reach every ray
  CHECK(rigid.changed_powers == 0);
  CHECK(hard.zones_with_motion < 0.2 * hard.still_s);
}
