// Warm chairs and fidgeting: rates against closed forms.
#include <array>
#include <cmath>

#include "engine/sim/natural_motion.hpp"
#include "engine/sim/recording.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/state.hpp"
#include "support/body_checks.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"
#include "support/natural_sitter.hpp"

using namespace pirsim;
using namespace pirsim::test;
using body::test::desk_seat, body::test::man;

namespace {

/// Triggers of every sensor in `seconds` after a seat was left, summed over runs.
std::vector<double> after_leaving(const Model& model, std::size_t seat, double rate_per_s, double decay_s, int runs,
                                  int seconds) {
  effects::Pipeline pipeline = sim::make_stages(
      model, std::vector{bare_effect("warm_chair", {{"rate_per_s", rate_per_s}, {"decay_s", decay_s}})});
  std::vector<double> counts(model.scene().sensors.size(), 0.0);
  for (int run = 0; run < runs; ++run) {
    pipeline.begin_run(1, static_cast<std::uint32_t>(run));
    pipeline.seat_left(seat);
    for (int tick = 1; tick <= 50 * seconds; ++tick) {
      std::vector<std::uint8_t> triggers(counts.size(), 0);
      pipeline.hear(tick, triggers);
      for (std::size_t s = 0; s < counts.size(); ++s) counts[s] += triggers[s];
    }
  }
  return counts;
}

}  // namespace

TEST_CASE("a warm chair triggers those who see it as often as its decaying rate says and nobody else") {
  SceneSpec scene = shipped_scene("meeting_room.gltf");
  scene.sensors[1].world_from_sensor.rotation =
      rotation_from_heading(pi) * scene.sensors[1].world_from_sensor.rotation;  // looks into the wall
  const Model model = compile(scene, short_study_a());
  const double rate = 0.2, decay_s = 60.0;
  const int runs = 100, seconds = 90;
  // Of S9, which some sensors see.
  const auto counts = after_leaving(model, 8, rate, decay_s, runs, seconds);
  const double expected = runs * rate * decay_s * (1.0 - std::exp(-seconds / decay_s));  // 932
  int seeing = 0;
  for (const double count : counts) {
    if (count == 0.0) continue;
    ++seeing;
    CHECK(std::abs(count - expected) < 4.0 * std::sqrt(expected));
    CHECK_FALSE(std::abs(count - runs * rate * seconds) < 4.0 * std::sqrt(expected));  // must fail: no decay
  }
  CHECK(seeing > 0);
  CHECK(counts[1] == 0.0);
}

TEST_CASE("who fidgets moves at the given rate within the given angles and who doesn't sits still") {
  const double rate = 0.1, minutes = 60;
  ScriptSpec script = script_of(
      {person("anna", {act(action::Enter{"door"}), act(action::Sit{"S4"}), act(action::Wait{60.0 * minutes})})});
  script.effects = {bare_effect("fidgeting", {{"rate_per_s", rate}, {"tilt_deg", 5.0}, {"turn_deg", 30.0}})};
  const Model model = compile(shipped_scene("meeting_room.gltf"), script);
  State state(model, 0);
  body::Outline last;
  int moves = 0, still_ticks = 2, seated_ticks = 0;
  double furthest_tilt = 0, furthest_turn = 0;
  while (!state.finished()) {
    step_tick(model, state);
    const sim::Actor& actor = state.run_state().crowd.actors()[0];
    if (!actor.present() || actor.motion().stage() != body::Stage::seated) continue;
    ++seated_ticks;
    const body::Outline now = actor.motion().outline();
    furthest_tilt = std::max(furthest_tilt, std::abs(now.spine_tilt));
    furthest_turn = std::max(furthest_turn, std::abs(now.head_turn));
    if (now == last) {
      ++still_ticks;
    } else {
      if (still_ticks > 1) ++moves;
      still_ticks = 0;
    }
    last = now;
  }
  // A move of 0.6 s hides those that begin before it has ended.
  const double seconds = seated_ticks * 0.02, expected = rate * seconds * std::exp(-rate * 0.6);
  CHECK(std::abs(moves - expected) < 4.0 * std::sqrt(expected));
  CHECK_FALSE(std::abs(moves - 1.5 * expected) < 4.0 * std::sqrt(expected));  // must fail
  CHECK(degrees(furthest_tilt) <= 5.0 + 1e-6);
  CHECK(degrees(furthest_tilt) > 4.5);
  CHECK(degrees(furthest_turn) <= 30.0 + 1e-6);
  CHECK(degrees(furthest_turn) > 27.0);
}

TEST_CASE("fidgets that leave long still periods come at the given rate too, from the moment of sitting down on") {
  constexpr int n_people = 600, n_ticks = 180 * body::test::tick_rate_hz;
  constexpr double rate = 0.03, expected = rate * 180.0;
  PersonChanges changes;
  changes.fidgeting = {rate, 5.0, 30.0, FidgetTiming::still_periods};
  double sum = 0.0, squares = 0.0;
  for (std::uint32_t person = 0; person < n_people; ++person) {
    body::Motion motion = body::test::Sitter(person, man(), desk_seat()).motion;
    sim::Restlessness restless(changes, 1, 0, person, 1.0 / body::test::tick_rate_hz);
    double moves = 0.0;
    for (int tick = 0; tick < n_ticks; ++tick) {
      const auto targets = [&] {
        return std::pair(motion.target(body::Channel::trunk_tilt), motion.target(body::Channel::head_turn));
      };
      const auto before = targets();
      restless.tick(motion, nullptr);
      moves += before != targets() ? 1.0 : 0.0;
      motion.advance();
    }
    sum += moves;
    squares += moves * moves;
  }
  const double mean = sum / n_people, error = std::sqrt((squares / n_people - mean * mean) / n_people);
  CHECK(std::abs(mean - expected) < 4.0 * error);
  CHECK_FALSE(std::abs(1.5 * mean - expected) < 4.0 * error);  // must fail: what ordinary renewals would give
}

TEST_CASE("a chair swings about its own table's side on every seat") {
  PersonChanges changes;
  changes.chair_swing = {5.0, 2.0, 1.0};
  sim::Restlessness restless(changes, 1, 0, 0, 1.0 / body::test::tick_rate_hz);
  const auto furthest = [&](double approach_turn) {
    body::SeatPlace seat = desk_seat();
    seat.approach_turn = approach_turn;
    body::Motion motion = body::test::Sitter(0, man(), seat).motion;
    double most = 0.0;
    for (int tick = 0; tick < 20 * body::test::tick_rate_hz; ++tick) {
      restless.tick(motion, nullptr);
      motion.advance();
      most = std::max(most, std::abs(motion.heading()));  // the seat faces 0
    }
    return degrees(most);
  };
  CHECK(furthest(0.0) == Approx(5.0).margin(0.1));
  CHECK(furthest(1.2) > 30.0);  // must fail: it was never told that the seat was left
  restless.leave_seat();
  CHECK(furthest(1.2) == Approx(5.0).margin(0.1));
}

TEST_CASE("a burst is under way when a run begins as often as at any other time") {
  const Model model = compile(shipped_scene("meeting_room.gltf"), short_study_a());
  const double rate_per_s = 2.0, length_s = 12.0, period_s = 60.0;
  effects::Pipeline pipeline = sim::make_stages(
      model, std::vector{bare_effect("trigger_bursts",
                                     {{"length_s", length_s}, {"period_s", period_s}, {"rate_per_s", rate_per_s}})});
  constexpr int runs = 600, parts = 10;
  std::array<double, parts> with_triggers{};  // runs of which the first sensor is triggered in that tenth of a period
  for (int run = 0; run < runs; ++run) {
    pipeline.begin_run(1, static_cast<std::uint32_t>(run));
    std::array<bool, parts> any{};
    for (int tick = 0; tick < 3000; ++tick) {
      std::vector<std::uint8_t> triggers(model.scene().sensors.size(), 0);
      pipeline.hear(tick, triggers);
      any[static_cast<std::size_t>(tick / 300)] |= triggers[0] != 0;
    }
    for (std::size_t part = 0; part < parts; ++part) with_triggers[part] += any[part] ? 1 : 0;
  }
  // A burst of 12 s overlaps a part of 6 s by x seconds: all 6 for 6 s of its starts, 0 to 6 for 6 s at each end. No
  // trigger comes with probability exp(-2 x); averaged over a start that is uniform in 60 s.
  const double ends = 2.0 * (6.0 - (1.0 - std::exp(-12.0)) / 2.0), whole = 6.0 * (1.0 - std::exp(-12.0));
  const double share = (ends + whole) / period_s;
  const double tolerance = 4.0 * std::sqrt(runs * share * (1.0 - share));
  for (const double n : with_triggers) CHECK(std::abs(n - runs * share) < tolerance);
  // Must fail: no burst before the run, so that only starts within the first 6 s count there.
  const double none_before = (6.0 - (1.0 - std::exp(-12.0)) / 2.0) / period_s;
  CHECK_FALSE(std::abs(with_triggers[0] - runs * none_before) < tolerance);
}
