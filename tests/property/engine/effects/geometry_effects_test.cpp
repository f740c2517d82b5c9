// Effects on people, mounting, occlusion and books, each against something that doesn't use its code.
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/random.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

Model meeting_room(std::vector<EffectSpec> effects, int replicates = 1) {
  return compile(shipped_scene("meeting_room.gltf"), with(short_study_a(replicates), std::move(effects)));
}

/// Goes on until the first person sits.
State seated(const Model& model, std::uint32_t run) {
  State state(model, run);
  while (!state.run_state().crowd.actors().front().present() ||
         state.run_state().crowd.actors().front().motion().stage() != body::Stage::seated) {
    step_tick(model, state);
  }
  return state;
}
Vec2 where_seated(const Model& model, std::uint32_t run) {
  return seated(model, run).run_state().crowd.actors().front().motion().position();
}
Vec2 place_of(const Model& model, const std::string& id) {
  return floor_point(std::ranges::find(model.compiled().scene().seats, id, &SeatSpec::id)->world_from_seat.origin);
}

}  // namespace

TEST_CASE("a yawed sensor's rays are turned about the vertical through it: one sensor and no other") {
  const Model plain = meeting_room({}),
              yawed = meeting_room({bare_effect("sensor_yaw", {{"yaw_deg", 5.0}}, {{"sensor", "PIR2"}})});
  const std::size_t begin = plain.compiled().array().rated().first_ray(1),
                    end = plain.compiled().array().rated().first_ray(2);
  const double c = std::cos(radians(5.0)), s = std::sin(radians(5.0));
  for (std::size_t i = 0; i < plain.compiled().array().rated().rays.size(); ++i) {
    const Ray &before = plain.compiled().array().rated().rays[i], &after = yawed.compiled().array().rated().rays[i];
    REQUIRE(after.origin == before.origin);
    const Vec3 d(before.direction);
    // Turning left, seen from above, takes -Z to -X.
    const Vec3 expected = i < begin || i >= end ? d : Vec3(c * d.x + s * d.z, d.y, -s * d.x + c * d.z);
    REQUIRE(glm::distance(Vec3(after.direction), expected) < 1e-6);
  }
}

TEST_CASE("a tilted sensor looks so much further down and a lowered one looks from so much lower") {
  const Model plain = meeting_room({}), tilted = meeting_room({bare_effect("sensor_tilt", {{"tilt_deg", 4.0}})}),
              lowered = meeting_room({bare_effect("sensor_height", {{"height_m", -0.2}})});
  for (std::size_t i = 0; i < plain.scene().sensors.size(); ++i) {
    const auto down_deg = [&](const Model& model) {
      return degrees(std::asin(-model.compiled().scene().sensors[i].world_from_sensor.forward().y));
    };
    CHECK(down_deg(tilted) == Approx(down_deg(plain) + 4.0));
    CHECK(down_deg(lowered) == down_deg(plain));
    const Vec3 up = lowered.compiled().scene().sensors[i].world_from_sensor.origin -
                    plain.scene().sensors[i].world_from_sensor.origin;
    CHECK(glm::distance(up, Vec3(0, -0.2, 0)) < 1e-12);
  }
}

TEST_CASE("no sensor is raised into the ceiling, whose underside is 1 cm above it") {
  const auto raised = [](double height_m) {
    return meeting_room({bare_effect("sensor_height", {{"height_m", height_m}})});
  };
  CHECK_NOTHROW(raised(0.008));
  CHECK_THROWS_WITH(raised(0.02), Catch::Contains("PIR1 would hang in or behind 'ceiling'"));
  CHECK_THROWS_WITH(raised(0.3), Catch::Contains("ceiling"));  // above it
  CHECK_THROWS_WITH(raised(-2.7), Catch::Contains("floor"));
  SceneSpec drawn_on_it = shipped_scene("meeting_room.gltf");
  for (SensorSpec& sensor : drawn_on_it.sensors) sensor.world_from_sensor.origin.y = 2.66;
  CHECK_NOTHROW(compile(drawn_on_it, with(short_study_a(), {bare_effect("sensor_height", {{"height_m", -0.1}})})));
  const Model plain = meeting_room({});
  int lower = 0;
  for (std::uint32_t i = 0; i < 50; ++i) {
    Stream stream({7, i, 0, Purpose::test});
    const EffectSpec drawn =
        effects::draw_from_prior(effects::find("sensor_height"), plain.scene(), plain.script(), stream);
    CHECK(std::abs(drawn.parameters.at("height_m")) <= 0.3);
    CHECK_NOTHROW(meeting_room({drawn}));
    lower += drawn.parameters.at("height_m") < 0.0 ? 1 : 0;
  }
  CHECK(lower >= 45);  // of those above 0 only one in thirty lies below a centimetre
}

TEST_CASE("a shifted seat is taken so far forward of where it is drawn") {
  for (const double forward_m : {0.1, -0.1}) {
    const Model model = meeting_room({bare_effect("seat_shift", {{"forward_m", forward_m}})});
    for (std::uint32_t run = 0; run < 2; ++run) {
      const SeatSpec& seat = *std::ranges::find(model.compiled().scene().seats, model.trial_of(run), &SeatSpec::id);
      const Vec3 expected = seat.world_from_seat * Vec3(0, 0, -forward_m);
      CHECK(glm::distance(where_seated(model, run), floor_point(expected)) < 1e-6);
    }
  }
}

TEST_CASE("scattered seats are taken with the scatter's spread") {
  const double sd = 0.05;
  const Model model = meeting_room({bare_effect("seat_scatter", {{"position_sd_m", sd}, {"heading_sd_deg", 0.0}})}, 60);
  double squares = 0;
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    const Vec2 off = where_seated(model, run) - place_of(model, model.trial_of(run));
    squares += glm::dot(off, off);
  }
  const double n = 2.0 * model.n_runs(), variance = squares / n, standard_error = sd * sd * std::sqrt(2.0 / n);
  CHECK(std::abs(variance - sd * sd) < 4.0 * standard_error);
  CHECK_FALSE(std::abs(variance - 1.5 * sd * sd) < 4.0 * standard_error);  // must fail
}

TEST_CASE("a scatter of headings moves nobody's place, at the first seat and at the next") {
  const auto places = [](double heading_sd_deg) {
    ScriptSpec script = script_of({person(
        "P", {act(action::Enter{"door"}), act(action::Sit{"S4"}), act(action::Wait{1.0}), act(action::Sit{"S10"}),
              act(action::Wait{1.0}), act(action::Sit{"S3"}), act(action::Wait{1.0})})});
    script.trials.front().people.front().seat_scatter = {0.05, heading_sd_deg};
    const Model model = compile(shipped_scene("meeting_room.gltf"), script);
    State state(model, 0);
    std::vector<Vec2> sat;
    bool was_seated = false;
    while (step_tick(model, state) || !state.finished()) {
      const auto& actor = state.run_state().crowd.actors().front();
      const bool is_seated = actor.present() && actor.motion().stage() == body::Stage::seated;
      if (is_seated && !was_seated) sat.push_back(actor.motion().position());
      was_seated = is_seated;
    }
    return sat;
  };
  const std::vector<Vec2> straight = places(0.0), turned = places(3.0);
  REQUIRE(straight.size() == 3);
  REQUIRE(turned.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(glm::distance(straight[i], turned[i]) < 1e-6);
}

TEST_CASE("a scatter of seats adds to the script's own as variances do") {
  ScriptSpec script = short_study_a();
  for (TrialSpec& trial : script.trials) trial.people.front().seat_scatter = {0.03, 5.0};
  const Model model =
      compile(shipped_scene("meeting_room.gltf"),
              with(script, {bare_effect("seat_scatter", {{"position_sd_m", 0.04}, {"heading_sd_deg", 12.0}})}));
  const SeatScatterSpec& scatter = model.compiled().trials()[0].people[0].spec.seat_scatter;
  CHECK(scatter.position_sd_m == Approx(0.05));
  CHECK(scatter.heading_sd_deg == Approx(13.0));
}

TEST_CASE("a scaled body is as stout: all of it is scaled, its mass by the cube") {
  const Model plain = meeting_room({}), small = meeting_room({bare_effect("body_size", {{"scale", 0.8}})});
  const auto who = [](const Model& model) { return model.compiled().trials()[0].people[0]; };
  CHECK(who(small).spec.mass_kg == Approx(0.512 * who(plain).spec.mass_kg));
  for (const body::Part part : {body::Part::head, body::Part::left_forearm, body::Part::left_thigh})
    CHECK(who(small).humanoid.radius_m(part) == Approx(0.8 * who(plain).humanoid.radius_m(part)));
}

TEST_CASE("a scaled body has scaled lengths") {
  const Model plain = meeting_room({}), small = meeting_room({bare_effect("body_size", {{"scale", 0.8}})});
  const auto head_m = [](const Model& model) {
    return model.compiled().trials()[0].people[0].humanoid.measures().shoulder_height_m;
  };
  CHECK(head_m(small) == Approx(0.8 * head_m(plain)));
}

TEST_CASE("four times the contrast reaches twice as far and is the same as a scaled range") {
  const Model plain = meeting_room({}), warm = meeting_room({bare_effect("thermal_contrast", {{"delta_t_k", 16.0}})}),
              far = meeting_room({bare_effect("range_scale", {{"scale", 2.0}})});
  for (std::size_t i = 0; i < plain.compiled().array().rated().range.size(); ++i) {
    REQUIRE(warm.compiled().array().rated().range[i] == 2.0F * plain.compiled().array().rated().range[i]);
    REQUIRE(far.compiled().array().rated().range[i] == warm.compiled().array().rated().range[i]);
  }
}

TEST_CASE("chair backs cut rays where boxes behind the seats stand and nobody walks otherwise than before") {
  const Model plain = meeting_room({}), backs = meeting_room({bare_effect("missing_occluder", {{"height_m", 0.5}})});
  std::size_t cut = 0;
  for (std::size_t i = 0; i < plain.rays().rays.size(); ++i) {
    float expected = plain.rays().range[i];
    for (const SeatSpec& seat : plain.scene().seats) {
      const Box back{Vec3(0.225, 0.25, 0.015)};
      const PosedShape box = place(back, seat.world_from_seat * Frame{Quat(1, 0, 0, 0), Vec3(0, 0.25, 0.17)});
      expected = entry_distance(plain.rays().rays[i], box, expected).value_or(expected);
    }
    cut += expected < plain.rays().range[i] ? 1 : 0;
    REQUIRE(backs.rays().range[i] == Approx(expected).margin(2e-3));
  }
  CHECK(cut > 20);
  State a(plain, 0), b(backs, 0);
  while (!a.finished()) {
    step_tick(plain, a);
    step_tick(backs, b);
    REQUIRE(a.run_state().crowd.actors()[0].present() == b.run_state().crowd.actors()[0].present());
    if (a.run_state().crowd.actors()[0].present())
      REQUIRE(a.run_state().crowd.actors()[0].motion().outline() == b.run_state().crowd.actors()[0].motion().outline());
  }
}

TEST_CASE("a mirrored room looks to its sensors as the room does to mirrored sensors") {
  for (const std::string across : {"x", "z"}) {
    const Model plain = meeting_room({});
    const ScriptSpec script =
        with(short_study_a(), {bare_effect("mirrored_room", {{"mirrored", 1.0}}, {{"across", across}})});
    SceneSpec scene = effects::in_force(plain.scene(), script).scene;
    const rt::Room room(scene.meshes);
    const FloorArea& floor = plain.scene().floor;
    const auto mirrored = [&](Vec3f p, bool is_point) {
      if (across == "x") p.x = (is_point ? static_cast<float>(floor.lower().x + floor.upper().x) : 0.0F) - p.x;
      if (across == "z") p.z = (is_point ? static_cast<float>(floor.lower().y + floor.upper().y) : 0.0F) - p.z;
      return p;
    };
    std::size_t differing = 0;
    for (std::size_t i = 0; i < plain.compiled().array().rated().rays.size(); i += 7) {
      const Ray& ray = plain.compiled().array().rated().rays[i];
      const auto here = room.first_hit(ray, 50.0F);
      const auto there = plain.compiled().array().room().first_hit(
          {mirrored(ray.origin, true), mirrored(ray.direction, false)}, 50.0F);
      REQUIRE(here.has_value() == there.has_value());
      if (here) REQUIRE(here->distance == Approx(there->distance).margin(1e-4));
      const auto before = plain.compiled().array().room().first_hit(ray, 50.0F);
      if (here && before && std::abs(here->distance - before->distance) > 1e-3F) ++differing;
    }
    CHECK(differing > 0);
    // Seats face the mirrored way; twice is as before.
    scene = effects::in_force(scene, script).scene;
    for (std::size_t i = 0; i < scene.seats.size(); ++i) {
      const Frame &once_more = scene.seats[i].world_from_seat, &first = plain.scene().seats[i].world_from_seat;
      CHECK(glm::distance(once_more.origin, first.origin) < 1e-9);
      CHECK(glm::distance(once_more.forward(), first.forward()) < 1e-9);
    }
  }
}

TEST_CASE("with seats shifted by one everybody sits on the next and the last on the first") {
  const Model plain = meeting_room({}), shifted = meeting_room({bare_effect("seats_shifted", {{"places", 1.0}})});
  CHECK(place_of(shifted, "S1") == place_of(plain, "S2"));
  CHECK(place_of(shifted, "S10") == place_of(plain, "S1"));
  CHECK(glm::distance(where_seated(shifted, 0), place_of(plain, "S5")) < 1e-6);  // trial S4
}

TEST_CASE("swapped labels swap two columns and a dead sensor's column is empty") {
  const auto plain = results_of(meeting_room({}));
  const auto swapped = results_of(
      meeting_room({bare_effect("labels_swapped", {{"swapped", 1.0}}, {{"sensor", "PIR2"}, {"other", "PIR5"}})}));
  const auto dead = results_of(meeting_room({bare_effect("dead_sensor", {{"loss", 1.0}}, {{"sensor", "PIR4"}})}));
  int ones = 0;
  for (std::size_t run = 0; run < plain.size(); ++run) {
    for (std::size_t i = 0; i < plain[run].samples.size(); ++i) {
      auto bits = plain[run].samples[i].bits;
      ones += bits[3];
      auto without_fourth = bits;
      without_fourth[3] = 0;
      REQUIRE(dead[run].samples[i].bits == without_fourth);
      std::swap(bits[1], bits[4]);
      REQUIRE(swapped[run].samples[i].bits == bits);
    }
  }
  CHECK(ones > 0);
}

TEST_CASE("a dying sensor keeps the share of its ones that it doesn't lose") {
  Sample row;
  row.time_s = 10.0;
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  effects::Pipeline pipeline(
      std::vector{bare_effect("dead_sensor", {{"loss", 0.6}, {"from_s", 5.0}}, {{"sensor", "PIR1"}})}, {scene, {}, {}});
  pipeline.begin_run(1, 0);
  const int n = 20000;
  int kept = 0;
  for (int i = 0; i < n; ++i) {
    row.bits.assign(5, 1);
    pipeline.apply(row);
    kept += row.bits[0];
    REQUIRE(row.bits[1] == 1);
  }
  const double standard_error = std::sqrt(0.24 * n);
  CHECK(std::abs(kept - 0.4 * n) < 4.0 * standard_error);
  CHECK_FALSE(std::abs(kept - 0.43 * n) < 4.0 * standard_error);  // must fail
  row.time_s = 5.0;
  row.bits.assign(5, 1);
  pipeline.apply(row);
  CHECK(row.bits[0] == 1);
}

TEST_CASE("scaled arm and trunk motion is the script with the scaled numbers") {
  const auto scripted = [](const std::vector<std::string>& more) {
    std::vector<std::string> overrides{"trials.for_each.seat=[S4, S10]", "replicates=1",
                                       "people.0.actions.3.work.duration_s=35"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return results_of(compile(shipped_scene("meeting_room.gltf"), shipped_script("studyA.yaml", overrides)));
  };
  const std::string work = "people.0.actions.3.work.";
  CHECK(same_rows(
      results_of(meeting_room({bare_effect("arm_motion", {{"amplitude_scale", 0.5}, {"period_scale", 1.5}})})),
      scripted({work + "arm_amplitude_m=0.05", work + "arm_period_s=4.5"})));
  CHECK(same_rows(
      results_of(meeting_room({bare_effect("trunk_tilt", {{"amplitude_scale", 0.5}, {"period_scale", 0.5}})})),
      scripted({work + "tilt_choices_deg=[-7.5, 0, 7.5]", work + "tilt_every_s=15"})));
}

TEST_CASE("a second person is counted beside the first and doesn't keep the run going") {
  const auto plain = results_of(meeting_room({})), two = results_of(meeting_room({bare_effect("second_person", {})}));
  for (std::size_t run = 0; run < plain.size(); ++run) {
    REQUIRE(two[run].samples.size() == plain[run].samples.size());
    for (std::size_t i = 0; i < plain[run].samples.size(); ++i) {
      REQUIRE(two[run].samples[i].people == plain[run].samples[i].people + 1);
      REQUIRE(two[run].samples[i].phase == plain[run].samples[i].phase);
    }
  }
  const Model given = meeting_room({bare_effect(
      "second_person", {{"x_m", 1.2}, {"z_m", -2.0}, {"path_m", 1.0}, {"every_s", 2.0}, {"heading_deg", 0.0}},
      {{"place", "given"}})});
  State state(given, 0);
  double nearest = 10, farthest = 0;
  while (step(given, state)) {
    const double z = state.run_state().crowd.actors()[1].motion().position().y;
    nearest = std::min(nearest, std::abs(z + 2.0));
    farthest = std::max(farthest, std::abs(z + 2.0));
  }
  CHECK(nearest < 1e-6);
  CHECK(farthest == Approx(1.0).margin(1e-6));
}

TEST_CASE("a second person goes on moving for as long as somebody walks slowly") {
  ScriptSpec script = with(short_study_a(1), {bare_effect("second_person", {{"every_s", 5.0}})});
  script.trials.resize(1);
  script.summary = {};  // nobody works
  PersonSpec& slow = script.trials[0].people[0];
  slow.walking_speed_m_s = 0.1;
  const Where where;
  const Vec2 here(1.2, -2.0), there(1.2, -4.0);
  slow.actions = {{action::Appear{here, 0.0}, {}, {}, where},
                  {action::Walk{{there, here, there, here, there, here, there, here, there, here}}, {}, {}, where}};
  const Model model = compile(shipped_scene("meeting_room.gltf"), script);
  State state(model, 0);
  double last_s = 0.0, last_move_s = 0.0;
  Vec3 before(0.0);
  while (step(model, state)) {
    last_s += 1.0;
    const Vec2 facing = direction_of(state.run_state().crowd.actors()[1].motion().heading());
    const Vec3 now(facing.x, facing.y, 0.0);
    if (glm::distance(now, before) > 0.01) last_move_s = last_s;
    before = now;
  }
  CHECK(last_s > 190.0);
  CHECK(last_move_s > last_s - 10.0);
}

TEST_CASE("what was estimated is moved to where the room has a place for it, and stays if that is so") {
  const SceneSpec room = shipped_scene("meeting_room.gltf");
  const auto raised = [&](double height_m) {
    return effects::settled(bare_effect("sensor_height", {{"height_m", height_m}}), room).parameters.at("height_m");
  };
  CHECK(raised(-0.2) == -0.2);
  CHECK(raised(0.2) > 0.0);
  CHECK(raised(0.2) < 0.01);  // the ceiling is 1 cm above
  const auto placed = [&](double x, double z) {
    const EffectSpec given = bare_effect("second_person", {{"x_m", x}, {"z_m", z}}, {{"place", "given"}});
    const EffectSpec there = effects::settled(effects::resolved(effects::find("second_person"), given), room);
    CHECK_NOTHROW(results_of(meeting_room({there})));
    return Vec2(there.parameters.at("x_m"), there.parameters.at("z_m"));
  };
  CHECK(placed(5.15, -1.2) == Vec2(5.15, -1.2));
  const Vec2 outside(5.15, 3.0), moved = placed(outside.x, outside.y);
  CHECK(room.floor.contains(moved));
  CHECK(std::abs(moved.x - outside.x) < 2.0);  // no farther than to what is free near the wall
  const EffectSpec box = bare_effect(
      "missing_occluder", {{"box_height_m", 1.0}, {"width_m", 0.5}, {"x_m", 40.0}, {"z_m", 40.0}}, {{"what", "box"}});
  const EffectSpec inside = effects::settled(box, room);
  CHECK(room.floor.contains(Vec2(inside.parameters.at("x_m"), inside.parameters.at("z_m"))));
  CHECK_NOTHROW(results_of(meeting_room({inside})));
}
