// People and doors: who goes through opens, nobody is ever in a leaf that rests, and sensors see past it what is to be
// seen.
#include "engine/sim/pedestrian.hpp"

#include <set>
#include <span>
#include <sstream>

#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "model/schema/words.hpp"
#include "pirsim/look.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/door_scene.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

/// How deep any part of a body is in the box, metres; negative: how far it keeps off.
double depth_in(const PosedBox& box, const std::vector<PosedShape>& solids) {
  using pirsim::testing::signed_distance;
  double deepest = -1e30;
  for (const PosedShape& solid : solids) {
    if (const auto* sphere = std::get_if<PosedSphere>(&solid)) {
      deepest = std::max(deepest, sphere->radius - signed_distance(box, Vec3(sphere->centre)));
    } else if (const auto* capsule = std::get_if<PosedCapsule>(&solid)) {
      for (int i = 0; i <= 10; ++i) {
        const Vec3 at = glm::mix(Vec3(capsule->a), Vec3(capsule->b), 0.1 * i);
        deepest = std::max(deepest, capsule->radius - signed_distance(box, at));
      }
    } else if (const auto* part = std::get_if<PosedBox>(&solid)) {
      for (int i = 0; i < 27; ++i) {
        const Vec3f of(static_cast<float>(i % 3 - 1), static_cast<float>(i / 3 % 3 - 1), static_cast<float>(i / 9 - 1));
        const Vec3 at(part->centre + part->axes * (of * part->half_extents));
        deepest = std::max(deepest, -signed_distance(box, at));
      }
    }
  }
  return deepest;
}

constexpr std::size_t n_trunk_parts = 3;  // pelvis, torso, head

struct Watched {
  double deepest_at_rest_m = -1e30, deepest_m = -1e30;  ///< any part of anybody in a leaf
  double trunk_m = -1e30;                               ///< the same of pelvis, torso and head
  double in_jambs_m = -1e30;                            ///< any part in the walls beside the opening between the rooms
  std::vector<int> openings;                            ///< (n_doors)
  std::string deepest;                                  ///< who, with what part, where
  int n_passes = 0;                                     ///< of people through each other
  double end_s = 0.0;
  bool all_done = true;
};

Watched watch_doors(const Model& model, std::uint32_t run) {
  const sim::CompiledStudy& study = model.compiled();
  const std::vector<DoorLeaf>& leaves = study.array().leaves();
  sim::RunState state(study, run);
  Watched result;
  result.openings.resize(leaves.size());
  std::vector<LeafStep> before(state.crowd.doors().steps().begin(), state.crowd.doors().steps().end());
  const std::vector<PosedShape> jambs{place(Box{{0.05, 1.3, 0.775}}, {{1, 0, 0, 0}, {3, 1.3, -1.225}}),
                                      place(Box{{0.05, 1.3, 0.775}}, {{1, 0, 0, 0}, {3, 1.3, 1.225}})};
  while (!state.finished && state.tick < 20000 * 10) {
    sim::move_tick(study, state);
    const auto steps = state.crowd.doors().steps();
    for (const sim::Actor& actor : state.crowd.actors()) {
      result.n_passes += static_cast<int>(actor.incidents().size());
      std::vector<PosedShape> solids;
      sim::append_solids(actor, solids);
      if (solids.empty()) continue;
      const std::vector<PosedShape> trunk(solids.begin(), solids.begin() + n_trunk_parts);
      for (const PosedShape& jamb : jambs)
        result.in_jambs_m = std::max(result.in_jambs_m, depth_in(std::get<PosedBox>(jamb), solids));
      for (std::size_t i = 0; i < leaves.size(); ++i) {
        const double depth = depth_in(leaves[i].at(steps[i]), solids);
        result.trunk_m = std::max(result.trunk_m, depth_in(leaves[i].at(steps[i]), trunk));
        if (depth > result.deepest_m && depth > 0.0) {
          std::ostringstream text;
          for (std::size_t part = 0; part < solids.size(); ++part) {
            if (depth_in(leaves[i].at(steps[i]), {solids[part]}) == depth)
              text << actor.person().spec.id << "'s " << body::name(static_cast<body::Part>(part));
          }
          const Vec2 at = actor.motion().position();
          text << " at (" << at.x << ", " << at.y << ") after " << static_cast<double>(state.tick) * model.tick_s()
               << " s, door " << i << " at step " << steps[i];
          result.deepest = text.str();
        }
        result.deepest_m = std::max(result.deepest_m, depth);
        if (leaves[i].rests(steps[i])) result.deepest_at_rest_m = std::max(result.deepest_at_rest_m, depth);
      }
    }
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (before[i] == 0 && steps[i] != 0) ++result.openings[i];
    }
    before.assign(steps.begin(), steps.end());
  }
  result.all_done = state.finished;
  result.end_s = static_cast<double>(state.tick) * model.tick_s();
  return result;
}

/// Goes to and fro between the rooms.
PersonSpec walker(const std::string& id, double wait_s, int n_rounds, double z) {
  std::vector<ScriptedAction> actions{act(action::Wait{wait_s}), act(action::Enter{"in"})};
  for (int i = 0; i < n_rounds; ++i) {
    actions.push_back(act(action::Walk{{{4.8, z}}}));
    actions.push_back(act(action::Wait{3.0}));
    actions.push_back(act(action::Walk{{{1.4, z}}}));
    actions.push_back(act(action::Wait{2.0}));
  }
  actions.push_back(act(action::Leave{"in"}));
  return person(id, std::move(actions));
}

}  // namespace

TEST_CASE("one who comes in, goes to and fro and leaves opens each door, and both are shut behind them") {
  for (const DoorOpens opens : {DoorOpens::inward, DoorOpens::outward}) {
    for (const DoorHinge hinge : {DoorHinge::left, DoorHinge::right}) {
      DoorSpec inner = inner_door(DoorState::shut), front = front_door(DoorState::shut);
      inner.opens = front.opens = opens;
      inner.hinge = front.hinge = hinge;
      const Model model = compile(two_rooms({front, inner}), script_of({walker("W", 1.0, 2, 0.3)}));
      const Watched seen = watch_doors(model, 0);
      INFO(seen.end_s << " s; deepest: " << seen.deepest);
      CHECK(seen.all_done);
      CHECK(seen.end_s < 90.0);
      CHECK(seen.openings == std::vector<int>{2, 4});
      CHECK(seen.deepest_at_rest_m < 0.0);
      CHECK(seen.deepest_m < 0.0);
    }
  }
}

TEST_CASE("who is stopped in an open doorway by the next door, round the corner, opens that one") {
  for (const DoorHinge hinge : {DoorHinge::left, DoorHinge::right}) {
    SceneSpec scene = two_rooms({front_door(DoorState::shut), inner_door(DoorState::habit)});
    // The way in lies south, its leaf sweeps up to 0.3 m before the opening between the rooms.
    scene.floor = FloorArea({{{0, -1.05}, {6, -1.05}, {6, 2}, {0, 2}}}, 0.0);
    scene.meshes.erase(scene.meshes.begin());  // the wall behind
    const Frame south{rotation_from_heading(heading_of(Vec2(0, 1))), Vec3(2.2, 0, -1.05)};
    scene.entrances.front().world_from_entrance = scene.doors.front().world_from_door = south;
    scene.doors.front().hinge = hinge;
    const PersonSpec leaver = person("L", {act(action::Enter{"in"}), act(action::Walk{{{4.8, 0.3}}}),
                                           act(action::Wait{3.0}), act(action::Leave{"in"})});
    const Model model = compile(scene, script_of({leaver}));
    const Watched seen = watch_doors(model, 0);
    INFO(seen.end_s << " s; deepest: " << seen.deepest);
    CHECK(seen.all_done);
    CHECK(seen.end_s < 40.0);
  }
}

TEST_CASE("crowds go through a door in both directions: all finish, leaves keep off people's trunks", "[seconds]") {
  std::vector<PersonSpec> people;
  for (int i = 0; i < 6; ++i) people.push_back(walker("W" + std::to_string(i), 4.0 * i, 3, -1.2 + 0.48 * i));
  const ScriptSpec script = script_of(people);
  const Watched without = watch_doors(compile(two_rooms({}), script), 0);
  for (const DoorState state : {DoorState::shut, DoorState::habit, DoorState::open}) {
    DoorSpec inner = inner_door(state);
    inner.stands_open_s = 5.0;
    inner.shut_share = 0.5;
    const Watched seen = watch_doors(compile(two_rooms({front_door(DoorState::shut), inner}), script), 0);
    INFO(word_of(state) << ": " << seen.end_s << " s (without doors " << without.end_s << "), openings "
                        << seen.openings[0] << " and " << seen.openings[1] << ", incidents " << seen.n_passes << " ("
                        << without.n_passes << "), trunk " << seen.trunk_m << " m, deepest " << seen.deepest_m
                        << " m: " << seen.deepest);
    CHECK(seen.all_done);
    CHECK(seen.end_s < 2.0 * without.end_s);
    CHECK(seen.trunk_m < -0.05);
    // Arms and legs of who squeezes past somebody reach into walls, and no farther into leaves.
    CHECK(seen.deepest_m < without.in_jambs_m);
    CHECK((seen.openings[1] == 0) == (state == DoorState::open));
  }
}

namespace {

/// Until the leaf of the only door is open: how far the first person goes from where they stood, and from what it
/// sweeps at most.
struct WaitSeen {
  double opens_s = 0.0, strays_m = 0.0, farthest_m = 0.0, trunk_m = -1e30;
};
WaitSeen wait_for_leaf(const std::vector<PersonSpec>& people) {
  const Model model = compile(two_rooms({inner_door(DoorState::shut)}), script_of(people));
  const DoorLeaf& leaf = model.compiled().array().leaves().front();
  sim::RunState state(model.compiled(), 0);
  const auto place = [&] { return state.crowd.actors().front().motion().position(); };
  sim::move_tick(model.compiled(), state);
  const Vec2 stood = place();
  WaitSeen seen;
  while (!state.finished && state.crowd.doors().steps()[0] != leaf.open_step()) {
    sim::move_tick(model.compiled(), state);
    seen.strays_m = std::max(seen.strays_m, glm::distance(place(), stood));
    seen.farthest_m = std::max(seen.farthest_m, leaf.distance_to_sweep_m(place()));
    std::vector<PosedShape> solids;
    sim::append_solids(state.crowd.actors().front(), solids);
    solids.resize(n_trunk_parts);
    seen.trunk_m = std::max(seen.trunk_m, depth_in(leaf.at(state.crowd.doors().steps()[0]), solids));
  }
  seen.opens_s = static_cast<double>(state.tick) * model.tick_s();
  return seen;
}
PersonSpec goes_west(const Vec2& from) {
  return person("P", {act(action::Appear{from, 90.0}), act(action::Walk{{{1.0, 0.0}}})});
}

}  // namespace

TEST_CASE("who stands near a leaf but outside what it sweeps holds there while it turns") {
  for (const Vec2& from : {Vec2(4.1, 0.3), Vec2(3.3, 0.85), Vec2(3.0 + 0.9 + 0.45, -0.4)}) {
    const WaitSeen seen = wait_for_leaf({goes_west(from)});
    CHECK(seen.strays_m < 0.02);
    CHECK(seen.opens_s < 4.0);
    CHECK(seen.trunk_m < -0.05);
  }
}

TEST_CASE("who stands in what a leaf sweeps steps back out of it, for themselves and for others") {
  for (const Vec2& from : {Vec2(3.5, 0.2), Vec2(3.4, -0.1), Vec2(3.9, 0.1), Vec2(2.7, 0.0)}) {
    INFO(from.x << ", " << from.y);
    const WaitSeen own = wait_for_leaf({goes_west(from)});
    CHECK(own.farthest_m >= sim::Doors::clear_m);
    CHECK(own.opens_s < 10.0);
    CHECK(own.trunk_m < -0.05);
    const PersonSpec stands = person("P", {act(action::Appear{from, 0.0}), act(action::Wait{60.0})});
    const PersonSpec comes = person("Q", {act(action::Appear{{from.x > 3.0 ? 1.0 : 5.0, 0.0}, 0.0}),
                                          act(action::Walk{{{from.x > 3.0 ? 5.0 : 1.0, 1.5}}})});
    const WaitSeen others = wait_for_leaf({stands, comes});
    CHECK(others.farthest_m >= sim::Doors::clear_m);
    CHECK(others.opens_s < 12.0);
    CHECK(others.trunk_m < -0.05);
  }
}

TEST_CASE("a shut leaf hides who is behind it from a sensor that sees them through the open one") {
  const auto seen_behind = [](DoorState state) {
    const PersonSpec waits = person("P", {act(action::Appear{{1.5, 0.0}, 0.0}), act(action::Wait{20.0})});
    ScriptSpec script = script_of({waits});
    script.trials.front().people.front().style = MotionStyle::natural;
    const Model model = compile(two_rooms({inner_door(state)}), script);
    State run(model, 0);
    step_tick(model, run);
    const RayBundle& rays = model.rays();
    for (std::size_t zone = 0; zone < rays.first_zone(1); ++zone) {
      if (run.zones().test(zone)) return true;
    }
    return false;
  };
  CHECK_FALSE(seen_behind(DoorState::shut));
  CHECK(seen_behind(DoorState::open));
}

TEST_CASE("what is remembered of people who stand still is how they looked while the leaf stood as it does now") {
  for (const std::size_t n_people : {1U, 2U}) {
    std::vector<PersonSpec> people{person("P", {act(action::Appear{{1.5, 0.0}, 0.0}), act(action::Wait{20.0})}),
                                   person("Q", {act(action::Appear{{2.0, 1.2}, 0.0}), act(action::Wait{20.0})})};
    people.resize(n_people);
    ScriptSpec script = script_of(people);
    script.sensing.response = Response::analog;
    const Model model = compile(two_rooms({inner_door(DoorState::shut)}), script);
    const sim::SensorArray& array = model.compiled().array();
    sim::RunState state(model.compiled(), 0);
    sim::move_tick(model.compiled(), state);
    const std::vector<sim::Actor>& actors = state.crowd.actors();
    const LeafStep open = array.leaves().front().open_step(), half = open / 2;
    sim::Observer observer(array, TracerKind::direct, sim::ZonesOf::all_sensors);
    sim::Exposure seen = array.unexposed(), anew = seen;
    std::set<std::vector<sim::PowerSteps>> powers;
    for (const LeafStep step : {LeafStep{0}, open, LeafStep{0}, half, open, half}) {
      observer.look(actors, std::span(&step, 1), seen);
      // Who has seen nothing before, and tests every ray against everybody.
      sim::Observer(array, TracerKind::reference, sim::ZonesOf::all_sensors).look(actors, std::span(&step, 1), anew);
      INFO(n_people << " people, step " << step);
      CHECK(seen.zones == anew.zones);
      CHECK(seen.powers == anew.powers);
      powers.insert(anew.powers);
    }
    CHECK(powers.size() > 1);  // the leaf does hide them
  }
}

TEST_CASE("tracers agree on runs with doors, by zones and by power, and so do copies of a state") {
  for (const Response response : {Response::zones, Response::analog}) {
    ScriptSpec script = script_of({walker("A", 1.0, 1, 0.4), walker("B", 6.0, 1, -0.4)});
    script.sensing.response = response;
    script.sensing.tick_rate_hz = response == Response::zones ? 10 : 50;
    if (response == Response::analog) script.trials.front().people.resize(1);
    const SceneSpec scene = two_rooms({front_door(DoorState::shut), inner_door(DoorState::habit)});
    const RunResult direct = run_once(compile(scene, script, {TracerKind::direct}), 0, Record::samples_and_zones);
    const RunResult embree = run_once(compile(scene, script, {TracerKind::embree}), 0, Record::samples_and_zones);
    CHECK(direct.samples == embree.samples);
    CHECK(direct.zones == embree.zones);
    if (response == Response::zones) {
      const RunResult slow = run_once(compile(scene, script, {TracerKind::reference}), 0, Record::samples_and_zones);
      CHECK(direct.zones == slow.zones);
    }
    const Model model = compile(scene, script);
    State one(model, 0);
    for (int i = 0; i < 12; ++i) step(model, one);
    State other = one;
    while (step(model, one)) CHECK((step(model, other) && one.sample() == other.sample()));
    const auto is_open = [](const Sample& row) { return row.doors.at(1) == 1; };
    CHECK(std::ranges::any_of(direct.samples, is_open));
    CHECK_FALSE(std::ranges::all_of(direct.samples, is_open));
  }
}

TEST_CASE("by habit a door is shut after the share of passes that it says, whoever else draws") {
  const auto shut_share = [](double share) {
    DoorSpec inner = inner_door(DoorState::habit);
    inner.shut_share = share;
    inner.stands_open_s = 1e4;
    int n_shut = 0, n_runs = 400;
    ScriptSpec script = script_of(
        {person("P", {act(action::Appear{{1.4, 0.0}, 0.0}), act(action::Walk{{{5.0, 0.0}}}), act(action::Wait{5.0})})});
    script.replicates = n_runs;
    const Model model = compile(two_rooms({inner}), script);
    for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
      sim::RunState state(model.compiled(), run);
      while (!state.finished) sim::move_tick(model.compiled(), state);
      n_shut += state.sample.doors.at(0) == 0 ? 1 : 0;
    }
    return static_cast<double>(n_shut) / n_runs;
  };
  CHECK(shut_share(0.0) == 0.0);
  CHECK(shut_share(1.0) == 1.0);
  CHECK(std::abs(shut_share(0.3) - 0.3) < 4.0 * std::sqrt(0.3 * 0.7 / 400.0));
}

TEST_CASE("windows that are passed over because nobody is there know their doors all the same") {
  DoorSpec front = front_door(DoorState::habit);
  front.shut_share = 0.0;
  front.stands_open_s = 40.0;
  ScriptSpec script = script_of({walker("W", 1.0, 0, 0.0)});
  script.trials.front().duration_s = 120.0;
  const Model model = compile(two_rooms({front}), script);
  State state(model, 0);
  std::vector<Sample> rows;
  while (step(model, state)) rows.push_back(state.sample());
  sim::RunState slow(model.compiled(), 0);
  std::vector<std::uint8_t> open;
  while (!slow.finished) {
    if (sim::move_tick(model.compiled(), slow)) open.push_back(slow.sample.doors.at(0));
  }
  REQUIRE(rows.size() == open.size());
  for (std::size_t i = 0; i < rows.size(); ++i) CHECK(rows[i].doors.at(0) == open[i]);
  CHECK(std::ranges::count(open, 1) > 40);
  CHECK(open.back() == 0);
}

TEST_CASE("check lists doors beside areas, with what their leaves do, a scene without doors has no such line") {
  const auto told = [](std::vector<DoorSpec> doors) {
    SceneSpec scene = two_rooms(std::move(doors));
    scene.areas = {{"west", FloorArea({{{0, -2}, {3, -2}, {3, 2}, {0, 2}}}, 0.0)},
                   {"east", FloorArea({{{3, -2}, {6, -2}, {6, 2}, {3, 2}}}, 0.0)}};
    return check_study(compile(scene, script_of({walker("W", 1.0, 1, 0.0)}))).text;
  };
  CHECK(told({}).find("door") == std::string::npos);
  DoorSpec front = front_door(DoorState::habit);
  front.hinge = DoorHinge::right;
  const std::string text = told({front, inner_door(DoorState::open)});
  INFO(text);
  CHECK(text.find("1 entrance, 2 doors, floor 24.00 m2") != std::string::npos);
  CHECK(text.find("doors: front 0.90 x 2.00 m, from outside to west, hinge right, opens inward, "
                  "shut after 80 % of passes, else open for 300 s\n"
                  "       inner 0.90 x 2.00 m, from west to east, hinge left, opens inward, always open\n") !=
        std::string::npos);
}

TEST_CASE("what a leaf sweeps is drawn where it turns") {
  for (const DoorHinge hinge : {DoorHinge::left, DoorHinge::right}) {
    for (const DoorOpens opens : {DoorOpens::inward, DoorOpens::outward}) {
      DoorSpec door = inner_door(DoorState::shut);
      door.hinge = hinge;
      door.opens = opens;
      const DoorLeaf leaf(two_rooms({door}).doors.front(), 0.1);
      const std::vector<Vec2> sweep = leaf.sweep();
      REQUIRE(sweep.size() > 10);
      const auto is_on_leaf = [&](const Vec2& p, LeafStep step) {
        return testing::signed_distance(leaf.at(step), {p.x, 1.0, p.y}) < 1e-5;
      };
      CHECK((is_on_leaf(sweep.front(), 0) && is_on_leaf(sweep.front(), leaf.open_step())));
      CHECK((is_on_leaf(sweep[1], 0) && is_on_leaf(sweep.back(), leaf.open_step())));
      CHECK(sweep.back().x == Approx(opens == DoorOpens::inward ? 3.9 : 2.1));
      for (std::size_t i = 1; i < sweep.size(); ++i) CHECK(glm::distance(sweep[i], sweep[0]) == Approx(0.9));
    }
  }
}

TEST_CASE("a way leads through a door where it crosses the threshold between its jambs") {
  for (const DoorHinge hinge : {DoorHinge::left, DoorHinge::right}) {
    for (const DoorOpens opens : {DoorOpens::inward, DoorOpens::outward}) {
      DoorSpec door = inner_door(DoorState::shut);  // 0.9 m wide
      door.hinge = hinge;
      door.opens = opens;
      const DoorSpec hung = two_rooms({door}).doors.front();
      const DoorLeaf leaf(hung, 0.1);
      const auto leads_through = [&](const Vec2& from, const Vec2& to) {  // along the wall, and away from it
        return leaf.leads_through(floor_point(hung.world_from_door * Vec3(from.x, 0.0, from.y)),
                                  floor_point(hung.world_from_door * Vec3(to.x, 0.0, to.y)));
      };
      for (const double x : {-0.44, 0.0, 0.44}) CHECK(leads_through({x, 1.0}, {x, -1.0}));
      for (const double x : {-0.46, 0.46}) CHECK_FALSE(leads_through({x, 1.0}, {x, -1.0}));
      CHECK(leads_through({-0.6, 1.0}, {0.6, -1.0}));
      CHECK_FALSE(leads_through({0.2, 1.0}, {1.0, -1.0}));
      CHECK_FALSE(leads_through({-0.4, 1.0}, {0.4, 0.5}));
    }
  }
}
