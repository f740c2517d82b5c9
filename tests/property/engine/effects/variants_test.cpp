// Variants of a cause, and effects on people's motion and on lenses, each against something that doesn't use its code.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "engine/pir/zone_motion.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"
#include "support/trigger_bench.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

Model room_with(std::vector<EffectSpec> effects) {
  return compile(shipped_scene("meeting_room.gltf"), with(short_study_a(), std::move(effects)));
}

/// Sensor A's triggers after the pipeline.
Series first_after(effects::Pipeline pipeline, const Series& before) {
  Series after;
  for (std::size_t i = 0; i < before.size(); ++i) {
    std::array<std::uint8_t, 2> triggers{before[i], 0};
    pipeline.hear(static_cast<std::int64_t>(i) + 1, triggers);
    after.push_back(triggers[0]);
  }
  return after;
}
/// One sensor with one zone of seven nested copies, as a bundle without rays.
RayBundle nested_zone() {
  RayBundle bundle;
  for (std::uint32_t i = 0; i < 7; ++i) {
    bundle.zone_rays_begin.push_back(0);
    bundle.cluster_zones_begin.push_back(i + 1);
  }
  bundle.sensor_clusters_begin.push_back(7);
  return bundle;
}
/// So many of the copies.
ZoneSet covered(int n) {
  ZoneSet channels(7);
  for (int i = 0; i < n; ++i) channels.insert(static_cast<std::size_t>(i));
  return channels;
}

/// Of the first person, from when they have sat for a while: a number at each of so many ticks.
template <typename Of>
std::vector<double> while_seated(const Model& model, int n_ticks, Of of) {
  State state(model, 0);
  const auto& person = [&]() -> const sim::Actor& { return state.run_state().crowd.actors().front(); };
  while (!person().present() || person().phase() != "working") step_tick(model, state);
  for (int i = 0; i < 250; ++i) step_tick(model, state);
  std::vector<double> values;
  for (int i = 0; i < n_ticks; ++i) {
    step_tick(model, state);
    values.push_back(of(person().motion().outline()));
  }
  return values;
}

}  // namespace

TEST_CASE("what sweeps a share of a blurred zone is noticed with that chance: swept area") {
  const RayBundle bundle = nested_zone();
  const pir::Channels detector(bundle, ChangePer::cluster);
  pir::SoftEdges edges(detector, 7, {1.0, EdgeRule::swept_area}, 50, 0.02);
  edges.begin_run(1, 0, covered(0));
  constexpr int n = 20000;
  for (const int k : {0, 1, 3, 6, 7}) {
    int noticed = 0;
    for (int i = 0; i < n; ++i) {
      std::array<std::uint8_t, 1> bits{};
      edges.tick(covered(0), covered(k), bits);
      noticed += bits[0];
    }
    const double share = k / 7.0, standard_error = std::sqrt(share * (1.0 - share) / n);
    CHECK(std::abs(static_cast<double>(noticed) / n - share) <= 4.0 * standard_error);
    // Must fail: half the chance.
    if (k > 0) CHECK_FALSE(std::abs(static_cast<double>(noticed) / n - 0.5 * share) <= 4.0 * standard_error);
  }
}

TEST_CASE("a covered share counts while it is beyond the threshold from what its high pass remembers") {
  const RayBundle bundle = nested_zone();
  const pir::Channels detector(bundle, ChangePer::cluster);
  const double threshold = 0.5, tick_s = 0.02, pole_s = 1.0 / (2.0 * pi * 0.3);
  pir::SoftEdges edges(detector, 7, {1.0, EdgeRule::covered_area, threshold}, 50, tick_s);
  // A step of 5/7 decays like exp(-t / pole): it is beyond 1/2 for so long.
  const double lasts_s = pole_s * std::log((5.0 / 7.0) / threshold);
  edges.begin_run(1, 0, covered(0));
  int on = 0;
  for (int i = 0; i < 200; ++i) {
    std::array<std::uint8_t, 1> bits{};
    if (i == 0) edges.tick(covered(0), covered(5), bits);
    if (i > 0) edges.tick_unchanged(covered(5), bits);
    on += bits[0];
  }
  CHECK(std::abs(on * tick_s - lasts_s) <= tick_s + 1e-9);
  CHECK(edges.is_at_rest());
  // A smaller step never is.
  std::array<std::uint8_t, 1> bits{};
  edges.tick(covered(5), covered(2), bits);
  CHECK(bits[0] == 0);
}

TEST_CASE("triggers that are lost one by one leave hardly any busy window without one") {
  constexpr double p = 0.6;
  constexpr std::size_t n_windows = 20000, ticks = 50;
  for (const std::size_t per_window : {1U, 2U, 5U}) {
    Series before(n_windows * ticks, 0);
    for (std::size_t w = 0; w < n_windows; ++w) {
      for (std::size_t i = 0; i < per_window; ++i) before[w * ticks + 7 * i] = 1;
    }
    const Series after = first_after(
        Bench().pipeline({effect("missed_triggers", {{"trigger_probability", p}}, {{"unit", "trigger"}})}), before);
    double silent = 0.0;
    for (std::size_t w = 0; w < n_windows; ++w) {
      const auto first = after.begin() + static_cast<std::ptrdiff_t>(w * ticks);
      silent += std::find(first, first + ticks, 1) == first + ticks ? 1.0 : 0.0;
    }
    const double expected = std::pow(p, static_cast<double>(per_window));
    const double standard_error = std::sqrt(expected * (1.0 - expected) / n_windows);
    CHECK(std::abs(silent / n_windows - expected) < 4.0 * standard_error);
    // Must fail for more than one: whole windows lost with the same chance.
    if (per_window > 1) CHECK_FALSE(std::abs(silent / n_windows - p) < 4.0 * standard_error);
  }
}

TEST_CASE("simultaneous false triggers come to all sensors at one rate and at the same ticks") {
  constexpr std::size_t n = 1'000'000;
  effects::Pipeline pipeline =
      Bench().pipeline({effect("false_triggers", {{"rate_per_s", 0.1}}, {{"timing", "simultaneous"}})});
  double count = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    std::array<std::uint8_t, 2> triggers{};
    pipeline.hear(static_cast<std::int64_t>(i) + 1, triggers);
    REQUIRE(std::set<std::uint8_t>(triggers.begin(), triggers.end()).size() == 1);
    count += triggers[0];
  }
  const double expected = 0.1 * n / 50.0;
  CHECK(std::abs(count - expected) < 4.0 * std::sqrt(expected));
}

TEST_CASE("a hold that ignores triggers and a paralysable dead time do what their twins in a dozen lines do") {
  const Series before = random_triggers(50'000, 0.02);
  constexpr std::int64_t hold = 40, dead = 60;  // ticks
  const Series held = first_after(
      Bench().pipeline(
          {effect("pulse_stretching", {{"hold_s", hold / 50.0}, {"spread", 0.0}}, {{"retrigger", "ignored"}})}),
      before);
  const Series woken = first_after(
      Bench().pipeline({effect("dead_time", {{"dead_s", dead / 50.0}}, {{"kind", "paralysable"}})}), before);
  Series held_twin(before.size(), 0), woken_twin(before.size(), 0);
  for (std::size_t i = 0; i < before.size();) {
    if (before[i] == 0) {
      ++i;
      continue;
    }
    for (std::int64_t k = 0; k <= hold && i < before.size(); ++k, ++i) held_twin[i] = 1;
  }
  std::int64_t last = -1000;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i] == 0) continue;
    woken_twin[i] = static_cast<std::int64_t>(i) - last >= dead ? 1 : 0;
    last = static_cast<std::int64_t>(i);
  }
  CHECK(held == held_twin);
  CHECK(woken == woken_twin);
}

TEST_CASE("natural motion as an effect is the natural style as the script would have it") {
  ScriptSpec natural = short_study_a();
  for (TrialSpec& trial : natural.trials) {
    for (PersonSpec& person : trial.people) {
      person.style = MotionStyle::natural;
      for (ScriptedAction& action : person.actions) {
        if (auto* work = std::get_if<action::Work>(&action.what)) work->activity = Activity::reading;
      }
    }
  }
  const auto rows = results_of(room_with({effect("natural_motion", {}, {{"activity", "reading"}})}));
  CHECK(same_rows(rows, results_of(compile(shipped_scene("meeting_room.gltf"), natural))));
  CHECK_FALSE(same_rows(rows, results_of(room_with({}))));
}

TEST_CASE("a swaying trunk and a swinging chair go to and fro by their amplitude and in their period") {
  constexpr int n = 1000;  // ticks: 20 s
  const auto crossings = [](const std::vector<double>& values, double middle) {
    int n_crossings = 0;
    for (std::size_t i = 1; i < values.size(); ++i) n_crossings += (values[i - 1] < middle) != (values[i] < middle);
    return n_crossings;
  };
  const auto lean = while_seated(room_with({effect("trunk_sway", {{"amplitude_deg", 2.0}, {"period_s", 4.0}})}), n,
                                 [](const body::Outline& outline) { return outline.spine_lean; });
  CHECK(std::ranges::max(lean) == Approx(radians(2.0)).margin(1e-9));
  CHECK(std::ranges::min(lean) == Approx(radians(-2.0)).margin(1e-9));
  CHECK(std::abs(crossings(lean, 0.0) - 10) <= 1);
  const auto turn =
      while_seated(room_with({effect("chair_swing", {{"amplitude_deg", 10.0}, {"period_s", 2.0}, {"share", 1.0}})}), n,
                   [](const body::Outline& outline) { return outline.pelvis.heading; });
  const double middle = 0.5 * (std::ranges::max(turn) + std::ranges::min(turn));
  CHECK(std::ranges::max(turn) - middle == Approx(radians(10.0)).margin(1e-9));
  CHECK(std::abs(crossings(turn, middle) - 20) <= 1);
  const auto still = while_seated(room_with({}), n, [](const body::Outline& outline) { return outline.spine_lean; });
  CHECK(std::ranges::all_of(still, [](double value) { return value == 0.0; }));
}

TEST_CASE("uneven arms don't repeat themselves, and stay within reach of the table") {
  const auto of = [](const body::Outline& outline) { return outline.hand_offset_m; };
  constexpr int period = 150, n = 1200;  // ticks of the script's swing, and altogether
  const auto repeats = [&](const std::vector<double>& values) {
    int same = 0;
    for (std::size_t i = period; i < values.size(); ++i) same += std::abs(values[i] - values[i - period]) < 1e-12;
    return same;
  };
  const auto even = while_seated(room_with({}), n, of);
  const auto uneven = while_seated(room_with({effect("uneven_arms", {{"spread", 0.3}, {"pause_share", 0.0}})}), n, of);
  CHECK(repeats(even) == n - period);
  CHECK(repeats(uneven) < n / 100);
  const auto paused = while_seated(room_with({effect("uneven_arms", {{"spread", 0.0}, {"pause_share", 1.0}})}), n, of);
  CHECK(std::ranges::all_of(paused, [](double value) { return std::abs(value) < 1e-12; }));
}

TEST_CASE("a blind field takes the stated share of one lens's rays, all on the stated side") {
  const Model plain = room_with({}),
              blind = room_with({effect("blind_field", {{"share", 0.3}, {"side_deg", 0.0}}, {{"sensor", "PIR2"}})});
  const RayBundle &before = plain.compiled().array().rated(), &after = blind.compiled().array().rated();
  const SensorSpec& sensor = plain.scene().sensors[1];
  double n_blind = 0.0, leftmost_blind = 1e9, rightmost_seeing = -1e9;
  for (std::size_t i = 0; i < before.rays.size(); ++i) {
    const bool of_lens = i >= before.first_ray(1) && i < before.first_ray(2);
    if (after.range[i] == before.range[i]) {
      if (of_lens) {
        const Vec3 d = glm::conjugate(sensor.world_from_sensor.rotation) * Vec3(before.rays[i].direction);
        rightmost_seeing = std::max(rightmost_seeing, d.x);
      }
      continue;
    }
    REQUIRE(of_lens);
    const Vec3 d = glm::conjugate(sensor.world_from_sensor.rotation) * Vec3(before.rays[i].direction);
    leftmost_blind = std::min(leftmost_blind, d.x);
    n_blind += 1.0;
  }
  CHECK(n_blind == std::round(0.3 * static_cast<double>(before.first_ray(2) - before.first_ray(1))));
  CHECK(leftmost_blind >= rightmost_seeing - 1e-12);
}

TEST_CASE("a warm object moves and is seen and nobody counts it but a second person is counted") {
  const auto plain = results_of(room_with({}));
  for (const char* moves : {"roams", "sweeps"}) {
    const auto rows = results_of(room_with({effect("warm_object", {}, {{"moves", moves}})}));
    REQUIRE(rows.size() == plain.size());
    std::size_t more = 0;
    for (std::size_t run = 0; run < rows.size(); ++run) {
      for (std::size_t i = 0; i < std::min(rows[run].samples.size(), plain[run].samples.size()); ++i) {
        const Sample &sample = rows[run].samples[i], &without = plain[run].samples[i];
        CHECK(sample.people <= 1);
        for (std::size_t s = 0; s < sample.bits.size(); ++s) more += sample.bits[s] > without.bits[s] ? 1 : 0;
      }
    }
    CHECK(more > 0);
  }
  const auto rows = results_of(room_with({effect("second_person", {}, {{"moves", "wanders"}})}));
  CHECK(std::ranges::max(rows.front().samples, {}, &Sample::people).people == 2);
}

TEST_CASE("who wanders gets about: several places far from each other") {
  const Model model = room_with({effect("second_person", {{"every_s", 5.0}}, {{"moves", "wanders"}})});
  State state(model, 0);
  Vec2 lower(1e9), upper(-1e9);
  while (step(model, state)) {
    const Vec2 at = state.run_state().crowd.actors().back().motion().position();
    lower = glm::min(lower, at);
    upper = glm::max(upper, at);
  }
  CHECK(glm::distance(lower, upper) > 2.0);
}

TEST_CASE("a rough wall scatters mirrored rays by the stated angle, the same in every model") {
  const auto ghosts = [](const Model& model) {
    std::vector<Vec3> directions;
    const RayBundle& rays = model.compiled().array().rated();
    for (std::size_t zone = 0; zone < rays.n_zones(); ++zone) {
      for (auto i = rays.zone_rays_begin[zone] + 5; i < rays.zone_rays_begin[zone + 1]; ++i)
        directions.emplace_back(rays.rays[i].direction);
    }
    return directions;
  };
  const auto smooth = ghosts(room_with({effect("wall_reflection", {{"coefficient", 0.9}})}));
  const EffectSpec spec =
      effect("wall_reflection", {{"coefficient", 0.9}, {"scatter_deg", 5.0}}, {{"finish", "rough"}});
  const auto rough = ghosts(room_with({spec}));
  REQUIRE(smooth.size() == rough.size());
  REQUIRE(smooth.size() > 50);
  double sum2 = 0.0;
  for (std::size_t i = 0; i < smooth.size(); ++i)
    sum2 += std::pow(degrees(std::acos(std::min(1.0, glm::dot(smooth[i], rough[i])))), 2);
  // Two normal angles of 5 deg: their squares sum to 50 on average, with a relative standard error of 1 / sqrt(n).
  const double mean = sum2 / static_cast<double>(smooth.size()),
               error = 1.0 / std::sqrt(static_cast<double>(smooth.size()));
  CHECK(mean == Approx(50.0).epsilon(4.0 * error + 0.02));
  CHECK(ghosts(room_with({spec})) == rough);
}

TEST_CASE("several bystanders, at rest or not, keep a study small: each has as many actions as a trial has time for") {
  const auto at = [](double z_m) {
    return effect("warm_object", {{"x_m", 1.0}, {"z_m", z_m}, {"every_s", 0.0}}, {{"place", "given"}});
  };
  const Model model = room_with({at(-1.0), at(-2.0), at(-3.0), effect("second_person", {})});
  const sim::TrialModel& trial = model.compiled().trials().front();
  REQUIRE(trial.people.size() == 5);
  for (const sim::PersonModel& person : trial.people) CHECK(person.spec.actions.size() < 20'000);
  CHECK(results_of(model).front().samples.size() == results_of(room_with({})).front().samples.size());
}

TEST_CASE("a bystander of a day moves as long as the day lasts") {
  ScriptSpec script = short_study_a();
  script.trials.resize(1);
  script.trials.front().people.clear();
  script.summary = {};  // a day has other phases
  script.trials.front().schedule.emplace();
  script.trials.front().schedule->to_h = 1.0;
  script.trials.front().schedule->cleaning_h = 0.5;
  script.effects = {effect("warm_object", {{"every_s", 20.0}})};
  const Model model = compile(shipped_scene("meeting_room.gltf"), script);
  State state(model, 0);
  double last_moved_s = 0.0;
  Vec2 before(0.0);
  while (step(model, state)) {
    const auto& actors = state.run_state().crowd.actors();
    const auto object = std::ranges::find_if(
        actors, [](const auto& actor) { return actor.person().spec.changes.role == PersonRole::object; });
    REQUIRE(object != actors.end());
    if (object->motion().position() != before) last_moved_s = state.sample().time_s;
    before = object->motion().position();
  }
  CHECK(last_moved_s > 3500.0);
}
