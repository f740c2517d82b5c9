// Cats and dogs: how much of them a sensor sees, how they spend their days, what they leave alone.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "engine/pir/optics.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/state.hpp"
#include "pirsim/study.hpp"
#include "support/catch.hpp"
#include "support/door_scene.hpp"
#include "support/shipped.hpp"
#include "surveys/sight.hpp"

using namespace pirsim;

namespace {

PetSpec pet(PetKind kind) {
  PetSpec pet;
  pet.id = "pet";
  pet.kind = kind;
  return pet;
}

ScriptSpec script_with_pet(PetKind kind, double duration_s) {
  ScriptSpec script = test::script_of({});
  script.sensing.tick_rate_hz = script.sensing.ticks_per_window = 10;
  script.trials.front().pets = {pet(kind)};
  script.trials.front().duration_s = duration_s;
  return script;
}

SceneSpec rooms_with_door(DoorState state) {
  SceneSpec scene = test::two_rooms({test::inner_door(state)});
  PlaceSpec sofa;
  sofa.id = "sofa";
  sofa.world_from_place.origin = {1.0, 0.45, 1.5};
  sofa.uses = {"rest"};
  scene.places = {sofa};
  return scene;
}

/// Sums over many ways of one run.
struct Diary {
  double up_s = 0.0, highest_m = 0.0, least_x_m = 1e9, most_x_m = -1e9;
};
Diary diary_of(const Model& model, std::uint32_t run) {
  const sim::CompiledStudy& study = model.compiled();
  sim::RunState state(study, run);
  Diary diary;
  while (!state.finished) {
    sim::move_tick(study, state);
    const body::Outline now = state.crowd.actors().back().motion().outline();
    if (now.fall < 1.0) diary.up_s += study.tick_s();
    diary.highest_m = std::max(diary.highest_m, now.floor_height_m);
    diary.least_x_m = std::min(diary.least_x_m, now.pelvis.position.x);
    diary.most_x_m = std::max(diary.most_x_m, now.pelvis.position.x);
  }
  return diary;
}

/// An EKMC1601111 that looks along -Z, all of whose zones have one sign, so that nothing cancels.
Model one_sign() {
  SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  SensorModelSpec lens = io::read_sensor_model(test::data("sensors/EKMC1601111.yaml"));
  for (ClusterSpec& cluster : lens.clusters) {
    for (ZoneSpec& zone : cluster.zones) zone.polarity = 1;
  }
  scene.meshes.clear();
  scene.sensor_models = {{lens.id, lens}};
  scene.sensors.resize(1);
  scene.sensors.front().model = lens.id;
  scene.sensors.front().world_from_sensor = {};
  ScriptSpec script = test::script_of({});
  script.sensing.response = Response::analog;
  script.trials.front().duration_s = 1.0;
  return compile(scene, script);
}

/// What the lens receives of a body in all places 3 m away, broadside, over what it would of the same solid angle that
/// is as warm: W/m2.
double seen_m2(const Model& model, const body::Humanoid& figure, double middle_m) {
  const sim::SensorArray& array = model.compiled().array();
  const pir::PowerRays& rays = array.analog()->power().rays();
  double weight = 0.0;
  for (const double each : rays.weights) weight += each;
  constexpr double contrast = 1.0, distance_m = 3.0;
  const double ambient = pir::band_radiance(pir::kelvin(model.compiled().sensing().ambient_c));
  sim::BodyRadiance radiance;
  radiance.fill(ambient + contrast);
  sim::Observer observer(array, fastest_tracer, sim::ZonesOf::zone_sensors);
  sim::Exposure exposure = array.unexposed();
  const double step = radians(1.5), farthest = radians(66.0);
  double sum = 0.0;
  for (double up = -farthest; up <= farthest; up += step) {
    for (double aside = -farthest; aside <= farthest; aside += step) {
      body::Outline outline;
      const Vec2 ahead = std::cos(up) * distance_m * Vec2(std::sin(aside), -std::cos(aside));
      outline.pelvis = {ahead, heading_of(Vec2(std::cos(aside), std::sin(aside)))};
      outline.floor_height_m = std::sin(up) * distance_m - middle_m;
      std::vector<PosedShape> solids;
      if (figure.animal()) {
        sim::append_solids(figure, body::posture_of(figure, outline), solids);
      } else {
        const body::Motion motion(figure, ahead, outline.pelvis.heading, outline.floor_height_m, 0.02);
        sim::append_solids(figure, motion.posture(), solids);
      }
      observer.look(solids, radiance, exposure);
      for (const sim::PowerSteps power : exposure.powers)
        sum += static_cast<double>(power) * sim::watts_per_step * std::cos(up) * step * step;
    }
  }
  return sum / (contrast * weight) * distance_m * distance_m;
}

}  // namespace

TEST_CASE("a cat of 4 kg at 3 m is as visible as a plate of its silhouette, and a doll of its height is not",
          "[pir][seconds]") {
  PetSpec cat = pet(PetKind::cat);
  cat.mass_kg = 4.0;
  const body::AnimalMeasures m = body::measures_of(cat);
  // Broadside: trunk, head, and of each pair of legs the nearer one below the trunk.
  const double plate_m2 = 4.0 * m.trunk_radius_m * m.half_trunk_m + pi * m.trunk_radius_m * m.trunk_radius_m +
                          pi * m.head_radius_m * m.head_radius_m +
                          4.0 * m.leg_radius_m * (m.axis_height_m - m.trunk_radius_m);
  CHECK(plate_m2 == Approx(0.06).epsilon(0.15));
  const Model model = one_sign();
  CHECK(seen_m2(model, body::Humanoid(cat), m.axis_height_m) == Approx(plate_m2).epsilon(0.12));
  PersonSpec doll = test::person("doll", {});
  doll.stature_m = 0.24;
  doll.mass_kg = 0.39;
  CHECK_FALSE(seen_m2(model, body::Humanoid(doll), 0.12) == Approx(plate_m2).epsilon(0.5));
}

TEST_CASE("a coat is 6 K warmer than air of 20 degrees, and no warmer than the animal", "[body]") {
  CHECK(body::coat_c(20.0) == Approx(26.0).margin(0.05));
  CHECK(body::coat_c(38.5) == Approx(38.5));
}

TEST_CASE("a pet stands on the floor, lies on it, and none of it is below", "[body]") {
  for (const PetKind kind : {PetKind::cat, PetKind::dog}) {
    const body::Humanoid figure(pet(kind));
    for (const double lies : {0.0, 0.3, 0.7, 1.0}) {
      body::Outline outline;
      outline.fall = lies;
      outline.hand_ahead_m = {0.05, -0.05};
      std::vector<PosedShape> solids;
      sim::append_solids(figure, body::posture_of(figure, outline), solids);
      float lowest_m = 1.0F, highest_m = 0.0F;
      for (const PosedShape& solid : solids) {
        lowest_m = std::min(lowest_m, bounds(solid).lower.y);
        highest_m = std::max(highest_m, bounds(solid).upper.y);
      }
      CAPTURE(kind, lies);
      CHECK(std::abs(lowest_m) < 0.01F);
      if (lies == 0.0) CHECK(highest_m > (kind == PetKind::cat ? 0.24F : 0.5F));
      if (lies == 1.0) CHECK(highest_m < (kind == PetKind::cat ? 0.24F : 0.45F));
    }
  }
}

TEST_CASE("a cat is up for less than 45 minutes a day, as 28 cats were, and a dog for longer", "[people][seconds]") {
  constexpr double day_s = 86400.0;
  constexpr std::uint32_t n_days = 5;
  const auto up_min = [&](PetKind kind) {
    ScriptSpec script = script_with_pet(kind, day_s);
    script.replicates = n_days;
    const Model model = compile(rooms_with_door(DoorState::open), script);
    double sum_s = 0.0;
    for (std::uint32_t run = 0; run < n_days; ++run) sum_s += diary_of(model, run).up_s;
    return sum_s / n_days / 60.0;
  };
  const double cat_min = up_min(PetKind::cat);
  CHECK(cat_min > 15.0);
  CHECK(cat_min < 45.0);
  CHECK(up_min(PetKind::dog) > cat_min);
}

TEST_CASE("a pet goes through an open door and not through a shut one, and a cat gets onto the sofa, but no dog",
          "[people][doors]") {
  constexpr double wall_x_m = 3.0, half_day_s = 43200.0;
  const auto diary = [&](PetKind kind, DoorState state) {
    return diary_of(compile(rooms_with_door(state), script_with_pet(kind, half_day_s)), 0);
  };
  const Diary cat = diary(PetKind::cat, DoorState::open), shut_in = diary(PetKind::cat, DoorState::shut);
  CHECK(cat.least_x_m < wall_x_m - 0.5);
  CHECK(cat.most_x_m > wall_x_m + 0.5);
  CHECK((shut_in.most_x_m < wall_x_m) != (shut_in.least_x_m > wall_x_m));
  CHECK(cat.highest_m > 0.44);
  CHECK(diary(PetKind::dog, DoorState::open).highest_m == 0.0);
}

TEST_CASE("a cat leaves a sofa alone on which somebody lies", "[people][seconds]") {
  ScriptSpec script = script_with_pet(PetKind::cat, 43200.0);
  script.trials.front().people = {
      test::person("ann", {test::act(action::Appear{{}, 0.0, "sofa"}), test::act(action::Wait{43100.0})})};
  CHECK(diary_of(compile(rooms_with_door(DoorState::open), script), 0).highest_m == 0.0);
}

TEST_CASE("a dog gets up a tenth as often by night as by day", "[people][seconds]") {
  ScriptSpec script = test::shipped_script("flat_week.yaml", {"sensing.response=zones", "sensing.tick_rate_hz=5"});
  script.trials.front().pets = {pet(PetKind::dog)};
  const Model model = compile(test::shipped_scene("flat.gltf"), script);
  const sim::CompiledStudy& study = model.compiled();
  int by_night = 0, by_day = 0;
  for (std::uint32_t run = 0; run < 3; ++run) {
    sim::RunState state(study, run);
    bool lay = true;
    while (!state.finished) {
      sim::move_tick(study, state);
      const bool lies = state.crowd.actors().back().motion().outline().fall == 1.0;
      const double begin_s = study.clock_of(run)->begin_second();
      const double hour = std::fmod(begin_s + static_cast<double>(state.tick) * study.tick_s(), 86400.0) / 3600.0;
      if (lay && !lies) ++(hour >= 23.0 || hour < 6.0 ? by_night : by_day);
      lay = lies;
    }
  }
  // Bouts come at 24 a day: 51 by day, 2.1 by night, each with the standard error of a Poisson number; 21 if nights
  // were days.
  CHECK(by_day > 51 - 3 * 7);
  CHECK(by_day < 51 + 3 * 7);
  CHECK(by_night < 8);
}

TEST_CASE("a pet's night is from 23 to 6: before and after it gets up as by day", "[people][seconds]") {
  // Bouts begin once an hour by day, by night a cat's half as often and a dog's a tenth as often. Between two of them
  // it is up for two minutes in the mean. So many hours of the day, each begun anew, have Poisson numbers.
  constexpr double hour_s = 3600.0;
  constexpr std::uint32_t n_hours = 240;
  const auto bouts = [&](PetKind kind, const char* begin) {
    ScriptSpec script = script_with_pet(kind, hour_s);
    script.sensing.tick_rate_hz = script.sensing.ticks_per_window = 2;
    script.begin = begin;
    script.replicates = static_cast<int>(n_hours);
    const Model model = compile(rooms_with_door(DoorState::open), script);
    int found = 0;
    for (std::uint32_t run = 0; run < n_hours; ++run) {
      sim::RunState state(model.compiled(), run);
      bool lay = true;
      while (!state.finished) {
        sim::move_tick(model.compiled(), state);
        const bool lies = state.crowd.actors().back().motion().outline().fall == 1.0;
        if (lay && !lies) ++found;
        lay = lies;
      }
    }
    return found;
  };
  const double least_by_day = n_hours - 4.0 * std::sqrt(n_hours) - 0.1 * n_hours;
  for (const char* begin : {"2026-03-02T20:00", "2026-03-03T06:00"}) {
    INFO(begin);
    CHECK(bouts(PetKind::cat, begin) > least_by_day);
  }
  for (const char* begin : {"2026-03-02T23:00", "2026-03-03T05:00"}) {
    INFO(begin);
    CHECK(bouts(PetKind::cat, begin) < least_by_day);
    CHECK(bouts(PetKind::dog, begin) < 0.1 * n_hours + 4.0 * std::sqrt(0.1 * n_hours));
  }
}

TEST_CASE("people do the same with a cat as without, and nobody counts it", "[people][seconds]") {
  const SceneSpec scene = test::shipped_scene("flat.gltf");
  ScriptSpec script = test::shipped_script("flat_week.yaml", {"sensing.response=zones", "sensing.tick_rate_hz=10"});
  const RunResult without = run_once(compile(scene, script), 0, Record::samples, Trace::none, Occupants::told);
  script.trials.front().pets = {pet(PetKind::cat)};
  const RunResult with = run_once(compile(scene, script), 0, Record::samples, Trace::none, Occupants::told);
  REQUIRE(with.samples.size() == without.samples.size());
  REQUIRE(with.occupants.size() == without.occupants.size());
  bool same_bits = true;
  for (std::size_t i = 0; i < with.samples.size(); ++i) {
    REQUIRE(with.samples[i].people == without.samples[i].people);
    REQUIRE(with.samples[i].doors == without.samples[i].doors);
    same_bits = same_bits && with.samples[i].bits == without.samples[i].bits;
  }
  for (std::size_t i = 0; i < with.occupants.size(); ++i) {
    REQUIRE(with.occupants[i].person == without.occupants[i].person);
    REQUIRE(with.occupants[i].place_m == without.occupants[i].place_m);
  }
  CHECK_FALSE(same_bits);
}

TEST_CASE("runs with pets are the same in any number of threads and in any order", "[determinism]") {
  ScriptSpec script = script_with_pet(PetKind::cat, 7200.0);
  script.replicates = 4;
  const Model model = compile(rooms_with_door(DoorState::open), script);
  const auto bits = [&](unsigned threads, RunRange range) {
    std::vector<std::vector<std::uint8_t>> all;
    run_study(model, {.threads = threads, .runs = range}, [&](const RunResult& result) {
      for (const Sample& sample : result.samples) all.push_back(sample.bits);
    });
    return all;
  };
  const auto whole = bits(1, {0, 4});
  CHECK(whole == bits(3, {0, 4}));
  auto parts = bits(2, {0, 1});
  for (auto& row : bits(2, {1, 4})) parts.push_back(std::move(row));
  CHECK(whole == parts);
  const std::size_t n = whole.size() / 4;
  CHECK_FALSE(std::equal(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n),
                         whole.begin() + static_cast<std::ptrdiff_t>(n),
                         whole.begin() + static_cast<std::ptrdiff_t>(2 * n)));
}

TEST_CASE("check says of how many passes of a pet a sensor reports motion, whatever it holds", "[people][seconds]") {
  SceneSpec scene = rooms_with_door(DoorState::open);
  ScriptSpec script = script_with_pet(PetKind::cat, 86400.0);
  script.sensing.response = Response::zones;
  // The same day as any run has it: a pass lasts from the first step behind a pause of half a second to the next.
  const Model model = compile(scene, script);
  State state(model, 0);
  std::size_t passes = 0;
  std::vector<std::size_t> seen(scene.sensors.size(), 0);
  std::vector<std::uint8_t> now(scene.sensors.size(), 0);
  double way_m = 0.0;
  int still = 5;
  Vec2 at(0.0);
  for (bool first = true; !state.run_state().finished; first = false) {
    step_tick(model, state);
    const Vec2 next = state.run_state().crowd.actors().front().motion().position();
    const double step_m = first ? 0.0 : glm::length(next - at);
    at = next;
    if (still >= 5 && step_m > 0.0) way_m = 0.0, still = 0, now.assign(now.size(), 0);
    if (still >= 5) continue;
    way_m += step_m;
    still = step_m > 0.0 ? 0 : still + 1;
    for (std::size_t i = 0; i < now.size(); ++i) now[i] |= state.run_state().triggers[i];
    if (still < 5 || way_m < 1.0) continue;
    ++passes;
    for (std::size_t i = 0; i < now.size(); ++i) seen[i] += now[i];
  }
  REQUIRE(passes > 30);
  const studies::PetSight sight_of = studies::watch_pets(model).front();
  CHECK(sight_of.pet == "pet");
  CHECK(sight_of.passes == passes);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    CAPTURE(i, seen[i], sight_of.seen[i]);  // the first step of a pass may be all that a run has seen of it
    CHECK(sight_of.seen[i] <= seen[i]);
    CHECK(sight_of.seen[i] + 2 >= seen[i]);
  }
  CHECK(std::ranges::max(seen) > passes / 10);
  for (auto& [id, sensor] : scene.sensor_models) sensor.detector.report.hold_s = 600.0;
  CHECK(studies::watch_pets(compile(scene, script)).front().seen == sight_of.seen);
  CHECK_THAT(check_study(model).text, contains("sees the pet in ") && contains(" of 100 of its passes"));
}
