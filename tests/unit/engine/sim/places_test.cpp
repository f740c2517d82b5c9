// A room with a bed, a sofa and a stove: who goes there, who is there from the start, and how sleepers move.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/body/seating.hpp"
#include "engine/sim/natural_motion.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/state.hpp"
#include "support/body_checks.hpp"
#include "support/random_scene.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

TriMesh box(const char* name, const Vec3& low, const Vec3& high) {
  TriMesh mesh = testing::box_mesh(low, high);
  mesh.name = name;
  return mesh;
}

/// 4.5 m x 4 m, the door at z = 0; two sensors that look down from corners.
SceneSpec home() {
  SceneSpec scene;
  scene.name = "home";
  scene.meshes = {box("ground", {-0.1, -0.1, -2.0}, {4.6, 0.0, 4.1}), box("bed", {0.05, 0.05, 2.0}, {1.45, 0.5, 4.0}),
                  box("sofa", {2.4, 0.0, 3.1}, {4.2, 0.42, 3.95}), box("counter", {3.9, 0.0, 0.5}, {4.5, 0.9, 2.5}),
                  box("cupboard", {2.6, 0.0, 0.02}, {3.4, 1.9, 0.6})};
  scene.seats = {{"sofa", {Quat(1, 0, 0, 0), {3.3, 0.51, 3.4}}, {"tv"}}};
  scene.places = {{"bed", PlacePosture::lie, {Quat(1, 0, 0, 0), {0.75, 0.5, 3.05}}, {"sleep"}},
                  {"stove", PlacePosture::stand, {rotation_from_heading(-0.5 * pi), {3.65, 0.0, 1.4}}, {"cook"}}};
  scene.entrances = {{"door", {rotation_from_heading(pi), {1.2, 0.0, 0.0}}}};
  scene.floor = FloorArea({{{0, 0}, {4.5, 0}, {4.5, 4}, {0, 4}}}, 0.0);
  const SceneSpec shipped = shipped_scene("meeting_room.gltf");
  scene.sensor_models = shipped.sensor_models;
  const auto looks = [](double heading) {
    return rotation_from_heading(heading) * glm::angleAxis(-0.5, Vec3(1, 0, 0));
  };
  const std::string model = scene.sensor_models.begin()->first;
  scene.sensors = {{"A", model, {looks(1.25 * pi), {0.1, 2.4, 0.1}}}, {"B", model, {looks(0.2), {2.4, 2.4, 3.9}}}};
  return scene;
}

struct Seen {
  std::vector<std::string> phases;  ///< each once, in order
  std::vector<std::string> seats;
  std::vector<Sample> rows;
  std::vector<Vec2> places;  ///< at each row
};

Seen run(const SceneSpec& scene, const ScriptSpec& script) {
  const Model model = compile(scene, script);
  Seen seen;
  for (State state(model, 0); !state.finished();) {
    const bool row = step(model, state);
    const sim::Actor& who = state.run_state().crowd.actors().front();
    const std::string phase(who.phase());
    if (seen.phases.empty() || seen.phases.back() != phase) seen.phases.push_back(phase);
    if (!row) break;
    seen.rows.push_back(state.sample());
    if (who.present()) seen.places.push_back(who.motion().position());
    seen.seats.emplace_back(who.seat());
  }
  return seen;
}

ScriptSpec alone(std::vector<ScriptedAction> actions, MotionStyle style = MotionStyle::choreographed) {
  PersonSpec who = person("anna", std::move(actions));
  who.style = style;
  return script_of({who});
}

bool has(const std::vector<std::string>& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}

std::string refused(const SceneSpec& scene, const ScriptSpec& script) {
  try {
    static_cast<void>(compile(scene, script));
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

int triggers(const Sample& row) { return static_cast<int>(std::ranges::count(row.bits, std::uint8_t{1})); }

}  // namespace

TEST_CASE("somebody comes in, cooks, watches television, sleeps and leaves", "[places]") {
  const Seen seen = run(home(), alone({act(action::Enter{"door"}), act(action::Stand{"stove"}), act(action::Wait{20.0}),
                                       act(action::Sit{"sofa"}), act(action::Wait{20.0}),
                                       act(action::Lie{"bed", LyingPosture::left_side}), act(action::Wait{30.0}),
                                       act(action::Rise{}), act(action::Leave{"door"})}));
  for (const char* phase : {"walking", "sitting_down", "seated", "rising", "lying_down", "lying", "getting_up"})
    CHECK(has(seen.phases, phase));
  for (const char* place : {"stove", "sofa", "bed"}) CHECK(has(seen.seats, place));
  const auto been_at = [&](const Vec2& place) {
    return std::ranges::count_if(seen.places, [&](const Vec2& p) { return glm::distance(p, place) < 1e-6; });
  };
  CHECK(been_at({3.65, 1.4}) >= 20);
  CHECK(been_at({3.3, 3.4}) >= 20);
  CHECK(been_at({0.75, 3.05}) >= 30);
  CHECK(seen.rows.back().people == 0);
}

TEST_CASE("somebody is there from the start, still, and no sensor reports motion until they move", "[places]") {
  for (const Response response : {Response::zones, Response::analog}) {
    for (const std::string place : {"bed", "sofa", "stove"}) {
      ScriptSpec script =
          alone({act(action::Appear{{}, 0.0, place}), act(action::Wait{12.0}), act(action::Leave{"door"})});
      script.sensing.response = response;
      const Seen seen = run(home(), script);
      INFO(place << (response == Response::zones ? ", zones" : ", analog"));
      int still = 0, moving = 0;
      for (std::size_t i = 0; i < seen.rows.size(); ++i) (i < 11 ? still : moving) += triggers(seen.rows[i]);
      CHECK(seen.rows.front().people == 1);
      CHECK(seen.seats.front() == place);
      CHECK(still == 0);
      CHECK(moving > 0);  // or the sensors would see nobody
      CHECK(seen.phases.front() == (place == "bed" ? "lying" : place == "sofa" ? "seated" : "standing"));
    }
  }
}

TEST_CASE("two are in one home from the start, and one of them in a bed that the other waits for", "[places]") {
  PersonSpec first =
      person("anna", {act(action::Appear{{}, 0.0, "bed"}), act(action::Wait{20.0}), act(action::Leave{"door"})});
  PersonSpec second =
      person("ben", {act(action::Appear{{}, 0.0, "sofa"}), act(action::Lie{"bed"}), act(action::Wait{5.0})});
  const Model model = compile(home(), script_of({first, second}));
  std::set<std::string> together;
  bool ben_lay = false;
  for (State state(model, 0); !state.finished(); static_cast<void>(step_tick(model, state))) {
    const auto& actors = state.run_state().crowd.actors();
    if (actors[1].present() && actors[1].motion().stage() == body::Stage::lying) ben_lay = true;
    const bool both_lie =
        actors[0].present() && actors[1].present() && actors[0].motion().in_bed() && actors[1].motion().in_bed();
    CHECK_FALSE(both_lie);
  }
  CHECK(ben_lay);
}

TEST_CASE("what can't be done at a place is refused in a sentence", "[places]") {
  const auto going = [](Action what) { return alone({act(action::Enter{"door"}), act(std::move(what))}); };
  CHECK_THAT(refused(home(), going(action::Lie{"bet"})), contains("place 'bet' is not in home (did you mean 'bed'?)"));
  CHECK_THAT(refused(home(), going(action::Lie{"stove"})), contains("'stove' is a place to stand: `stand: stove`"));
  CHECK_THAT(refused(home(), going(action::Stand{"sofa"})), contains("'sofa' is a place to sit: `sit: sofa`"));
  CHECK_THAT(refused(home(), going(action::Sit{"bed"})), contains("'bed' is a place to lie: `lie: bed`"));
  SceneSpec walled = home();
  walled.meshes.push_back(box("shelf", {1.46, 0.0, 1.2}, {2.0, 1.5, 4.0}));
  walled.meshes.push_back(box("chest", {0.0, 0.0, 1.2}, {1.45, 1.2, 1.99}));
  CHECK_THAT(refused(walled, going(action::Lie{"bed"})), contains("place 'bed' of home can't be reached by 'anna'") &&
                                                             contains("at either side of it or at its foot"));
  SceneSpec low = home();
  low.places[0].world_from_place.origin.y = 0.12;
  CHECK_THAT(refused(low, going(action::Lie{"bed"})), contains("can't be sat on"));
  SceneSpec inside = home();
  inside.places[1].world_from_place.origin = {3.0, 0.0, 0.3};
  CHECK_THAT(refused(inside, going(action::Stand{"stove"})), contains("it is inside of 'cupboard'"));
  CHECK_THAT(refused(inside, alone({act(action::Appear{{}, 0.0, "stove"})})), contains("can't appear at (3.00, 0.30)"));
  CHECK_THAT(refused(home(), alone({act(action::Appear{{3.0, 0.3}})})), contains("it is inside of 'cupboard'"));
  SceneSpec near = home();
  near.places[1].world_from_place.origin = {3.85, 0.0, 1.4};
  CHECK_THAT(refused(near, going(action::Stand{"stove"})), contains("nobody stands nearer than"));
  CHECK(refused(home(), alone({act(action::Appear{{}, 0.0, "bed"}), act(action::Work{5.0})})) != "nothing");
  CHECK(refused(home(), alone({act(action::Appear{{}, 0.0, "bed"}), act(action::Rise{})})) == "nothing");
}

TEST_CASE("specs refuse what a place is for but nobody knows, and a name that is taken", "[places]") {
  SceneSpec scene = home();
  scene.places[0].uses = {"slep"};
  CHECK_THAT(refused(scene, alone({})),
             contains("scene.places[0].uses[0]: 'slep' isn't a use of a place (did you mean 'sleep'?)"));
  SceneSpec twice = home();
  twice.places[1].id = "sofa";
  CHECK_THAT(refused(twice, alone({})), contains("sofa"));
}

TEST_CASE("sleepers turn over as often as accelerometers tell, and move as often and as long as cameras tell",
          "[places][seconds]") {
  constexpr int tick_rate_hz = 10, people = 40;
  constexpr double hours = 6.0;
  body::LyingPlace bed;
  bed.world_from_place.origin.y = 0.5;
  bed.edge.world_from_seat = {rotation_from_heading(-0.5 * pi),
                              {0.2, 0.5 + body::edge_height_m(body::test::man()), 0.0}};
  double turns = 0.0, hours_of_mean_person = 0.0;
  std::vector<double> movements_s;
  for (std::uint32_t i = 0; i < people; ++i) {
    const double falls_m = body::fall_back_m(body::test::man(), bed.edge);
    body::Motion motion(body::test::man(), {0.2 + falls_m, 0.0}, -0.5 * pi, 0.0, 1.0 / tick_rate_hz);
    motion.sit_down(bed.edge);
    while (motion.stage() != body::Stage::seated) motion.advance();
    motion.lie_down(bed);
    while (motion.stage() != body::Stage::lying) motion.advance();
    sim::NaturalMotion sleeper(7, 0, i, tick_rate_hz);
    double rolled = 0.0;
    int turned = 0, moving_ticks = 0;
    body::Outline last = motion.outline();
    for (int tick = 0; tick < static_cast<int>(hours * 3600.0) * tick_rate_hz; ++tick) {
      sleeper.tick(motion, Activity::sleeping, {});
      motion.advance();
      const double roll = motion.target(body::Channel::roll);
      if (std::abs(roll - rolled) > 1e-9) ++turned;
      rolled = roll;
      REQUIRE(std::abs(roll) < 0.56 * pi);
      body::Outline now = motion.outline();
      now.chest_m = last.chest_m;  // who merely breathes keeps still
      if (now != last) ++moving_ticks;
      if (now == last && moving_ticks > 0) movements_s.push_back(std::exchange(moving_ticks, 0) * 1.0 / tick_rate_hz);
      last = now;
    }
    turns += turned;
    hours_of_mean_person += hours * sleeper.liveliness();
  }
  // Standard errors: a twentieth of the turns (Poisson), and a thirtieth of all movements, whose gaps vary 2.5 times as
  // much as a Poisson process's.
  CHECK(turns == Approx(1.6 * hours_of_mean_person).epsilon(0.15));
  CHECK(turns != Approx(3.2 * hours_of_mean_person).epsilon(0.15));
  const double an_hour = static_cast<double>(movements_s.size()) / hours_of_mean_person;
  CHECK(an_hour == Approx(11.0).epsilon(0.15));
  CHECK(an_hour != Approx(6.8).epsilon(0.15));  // those of large groups of muscles alone
  std::ranges::nth_element(movements_s, movements_s.begin() + static_cast<std::ptrdiff_t>(movements_s.size() / 2));
  CHECK(movements_s[movements_s.size() / 2] == Approx(4.0).margin(1.0));
}
