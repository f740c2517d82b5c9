// What effects and the nuisance are to sensors with the analog response, against optics that say the same themselves.
#include <cmath>

#include "engine/pir/optics.hpp"
#include "engine/sim/compiled_study.hpp"
#include "pirsim/geometry.hpp"
#include "reconcile/ensemble/realization.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

ScriptSpec analog_study() {
  ScriptSpec script = short_study_a();
  script.sensing.response = Response::analog;
  return script;
}

const sim::AnalogModel& analog_of(const Model& model) { return *model.compiled().array().analog(); }

bool same_rays(const RayBundle& a, const RayBundle& b) {
  const auto same_ray = [](const Ray& x, const Ray& y) { return x.origin == y.origin && x.direction == y.direction; };
  return std::ranges::equal(a.rays, b.rays, same_ray) && a.range == b.range;
}

}  // namespace

TEST_CASE("soft edges are more blur of an analog sensor's lens, and leave its gain") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const double blur_deg = scene.sensor_models.begin()->second.optics.blur_deg;
  SceneSpec blurred = scene;
  for (auto& [id, sensor] : blurred.sensor_models) sensor.optics.blur_deg = std::hypot(blur_deg, 1.2);
  const Model plain = compile(scene, analog_study()), by_file = compile(blurred, analog_study());
  const EffectSpec edges{"soft_zone_edges", {{"sigma_deg", 1.2}}, {}, {}};
  const Model by_effect = compile(scene, with(analog_study(), {edges}));
  CHECK(same_rays(analog_of(by_effect).power().clipped(), analog_of(by_file).power().clipped()));
  CHECK(analog_of(by_effect).power().rays().weights == analog_of(by_file).power().rays().weights);
  CHECK_FALSE(same_rays(analog_of(by_effect).power().clipped(), analog_of(plain).power().clipped()));
  CHECK(analog_of(by_effect).sensors()[0]->watts_per_step == analog_of(plain).sensors()[0]->watts_per_step);
  CHECK(analog_of(by_file).sensors()[0]->watts_per_step != analog_of(plain).sensors()[0]->watts_per_step);
  CHECK_FALSE(same_rows(results_of(by_effect), results_of(plain)));
}

TEST_CASE("a blind field takes as many of an analog sensor's rays away as it says, on its side") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const EffectSpec right{"blind_field", {{"share", 0.3}, {"side_deg", 0.0}}, {{"sensor", "PIR2"}}, {}};
  const Model plain = compile(scene, analog_study()), half = compile(scene, with(analog_study(), {right}));
  const RayBundle &before = analog_of(plain).power().clipped(), &after = analog_of(half).power().clipped();
  REQUIRE(before.rays.size() == after.rays.size());
  std::size_t n = 0, n_blind = 0;
  double least_blind = 2.0, most_seeing = -2.0;
  for (std::size_t sensor = 0; sensor < after.n_sensors(); ++sensor) {
    const Quat from_world = glm::conjugate(scene.sensors[sensor].world_from_sensor.rotation);
    for (std::size_t ray = after.first_ray(sensor); ray < after.first_ray(sensor + 1); ++ray) {
      const bool is_blind = after.range[ray] < before.range[ray];
      if (scene.sensors[sensor].id != "PIR2") {
        REQUIRE_FALSE(is_blind);
        continue;
      }
      const double to_the_right = (from_world * Vec3(after.rays[ray].direction)).x;
      ++n;
      n_blind += is_blind ? 1 : 0;
      if (is_blind) least_blind = std::min(least_blind, to_the_right);
      if (!is_blind) most_seeing = std::max(most_seeing, to_the_right);
    }
  }
  CHECK(static_cast<double>(n_blind) == std::round(0.3 * static_cast<double>(n)));
  CHECK(least_blind >= most_seeing);
  const EffectSpec all{"blind_field", {{"share", 1.0}}, {}, {}};
  for (const RunResult& run : results_of(compile(scene, with(analog_study(), {all})))) {
    for (const Sample& row : run.samples) REQUIRE(std::ranges::count(row.bits, 1) == 0);
  }
}

TEST_CASE("a sensor's gain scales its signal and nobody else's, however it came to be compiled") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  SceneSpec louder = scene;
  louder.sensors[1].gain = 1.5;
  ScriptSpec study = analog_study();
  study.sensing.units = Units::guaranteed;  // a product of two factors would round otherwise than one of three
  const Model plain = compile(scene, study);
  const Model alone = compile(louder, study), beside = compile(louder, study, {.like = &plain});
  for (const Model* model : {&alone, &beside}) {
    for (std::size_t sensor = 0; sensor < scene.sensors.size(); ++sensor) {
      const auto& steps = analog_of(plain).sensors()[sensor]->watts_per_step;
      const auto& now = analog_of(*model).sensors()[sensor]->watts_per_step;
      for (std::size_t i = 0; i < steps.size(); ++i) CHECK(now[i] == (sensor == 1 ? 1.5 : 1.0) * steps[i]);
    }
  }
  CHECK(same_rows(results_of(alone), results_of(beside)));
  const auto before = results_of(plain), after = results_of(alone);
  std::size_t n_before = 0, n_after = 0;
  for (std::size_t run = 0; run < before.size(); ++run) {
    for (std::size_t row = 0; row < before[run].samples.size(); ++row) {
      const auto &bits = before[run].samples[row].bits, &louder_bits = after[run].samples[row].bits;
      n_before += bits[1];
      n_after += louder_bits[1];
      for (const std::size_t other : {0U, 2U, 3U, 4U}) REQUIRE(bits[other] == louder_bits[other]);
    }
  }
  CHECK(n_before < n_after);
}

TEST_CASE("the nuisance of analog sensors is drawn beside the others, and not for zones") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  NuisanceSpec none, much;
  none.sensor_gain = none.ambient_c = 0.0;
  much.sensor_gain = 0.2;
  much.ambient_c = 3.0;
  double least = 2.0, most = 0.0;
  for (std::uint32_t index = 0; index < 40; ++index) {
    const auto drawn = [&](const ScriptSpec& script, const NuisanceSpec& nuisance) {
      return reconcile::draw_realization(scene, script, nuisance, 5, index);
    };
    const reconcile::Realization zones = drawn(short_study_a(), much), analog = drawn(analog_study(), much),
                                 plain = drawn(analog_study(), none);
    CHECK(zones.script.sensing.ambient_c == short_study_a().sensing.ambient_c);
    CHECK(zones.script.seed == analog.script.seed);
    CHECK(std::abs(analog.script.sensing.ambient_c - plain.script.sensing.ambient_c) <= 3.0);
    CHECK(analog.script.sensing.ambient_c != plain.script.sensing.ambient_c);
    for (std::size_t sensor = 0; sensor < scene.sensors.size(); ++sensor) {
      CHECK(zones.scene.sensors[sensor].gain == 1.0);
      CHECK(plain.scene.sensors[sensor].gain == 1.0);
      CHECK(zones.scene.sensors[sensor].world_from_sensor.rotation ==
            analog.scene.sensors[sensor].world_from_sensor.rotation);
      const double gain = analog.scene.sensors[sensor].gain;
      least = std::min(least, gain);
      most = std::max(most, gain);
    }
    for (std::size_t seat = 0; seat < scene.seats.size(); ++seat) {
      CHECK(zones.scene.seats[seat].world_from_seat.origin == analog.scene.seats[seat].world_from_seat.origin);
    }
  }
  CHECK((0.8 <= least && least < 0.82 && 1.18 < most && most <= 1.2));
}
