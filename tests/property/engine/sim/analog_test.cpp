// The physical response from people to powers, on the shipped meeting room.
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/pir/calibration.hpp"
#include "engine/pir/optics.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/fine_mesh.hpp"
#include "support/natural_sitter.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using pirsim::test::act;
using pirsim::test::shipped_scene;

namespace {

using Powers = std::vector<std::vector<sim::PowerSteps>>;  ///< (n_ticks x n_receivers)

ScriptSpec walkers(int n_people) {
  std::vector<PersonSpec> people;
  const std::vector<std::pair<Vec2, Vec2>> ways{{{1.0, -0.6}, {2.2, -3.6}}, {{6.0, -3.6}, {5.2, -0.8}}};
  for (int i = 0; i < n_people; ++i) {
    const auto& [from, to] = ways[static_cast<std::size_t>(i)];
    people.push_back(test::person("p" + std::to_string(i), {act(action::Appear{from, 0.0}), act(action::Walk{{to}})}));
  }
  ScriptSpec script = test::script_of(people);
  script.sensing.response = Response::analog;
  return script;
}

Powers powers_of(const SceneSpec& scene, const ScriptSpec& script, TracerKind kind = fastest_tracer) {
  const Model model = compile(scene, script, {kind});
  State state(model, 0);
  Powers powers;
  while (!state.finished()) {
    step_tick(model, state);
    powers.emplace_back(state.run_state().exposure().powers.begin(), state.run_state().exposure().powers.end());
  }
  return powers;
}

double sum_of_squares(const Powers& powers) {
  double sum = 0.0;
  for (const auto& row : powers) {
    for (const sim::PowerSteps power : row) sum += std::pow(static_cast<double>(power) * sim::watts_per_step * 1e9, 2);
  }
  return sum;
}

/// Skin all over.
WarmthSpec bare() { return {.skin_c = 33.5, .clothing_clo = 0.0, .bare = {}, .hair_share = 0.0, .parts_c = {}}; }
/// Of bare skin before a background.
double contrast(double background_c) {
  return pir::band_radiance(pir::kelvin(33.5)) - pir::band_radiance(pir::kelvin(background_c));
}

/// Every power is `ratio` times what it was, but for a step of rounding a ray.
void check_ratio(const Powers& now, const Powers& before, double ratio) {
  REQUIRE(now.size() == before.size());
  REQUIRE(sum_of_squares(before) > 0.0);
  for (std::size_t tick = 0; tick < now.size(); ++tick) {
    for (std::size_t i = 0; i < now[tick].size(); ++i) {
      REQUIRE(std::abs(static_cast<double>(now[tick][i]) - ratio * static_cast<double>(before[tick][i])) < 1e4);
    }
  }
}

}  // namespace

TEST_CASE("in a room where everything is equally warm no sensor receives any power", "[sim][analog]") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  ScriptSpec script = walkers(2);
  script.sensing.ambient_c = 31.0;
  for (PersonSpec& person : script.trials[0].people) person.warmth.skin_c = 31.0;
  const Powers furnace = powers_of(scene, script);
  CHECK(std::ranges::all_of(furnace, [](const auto& row) { return std::ranges::count(row, 0) == std::ssize(row); }));
  script.trials[0].people[0].warmth.skin_c = 31.5;
  CHECK(sum_of_squares(powers_of(scene, script)) > 0.0);
}

TEST_CASE("the sign of the power changes as the room gets warmer than its people", "[sim][analog]") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  ScriptSpec script = walkers(1);
  double before = 1e300;
  for (const double ambient_c : {15.0, 20.0, 25.0, 30.0, 33.0}) {
    script.sensing.ambient_c = ambient_c;
    const double now = sum_of_squares(powers_of(scene, script));
    CHECK(now < before);
    before = now;
  }
  script.trials[0].people[0].warmth = bare();
  script.sensing.ambient_c = 20.0;
  const Powers cool = powers_of(scene, script);
  script.sensing.ambient_c = 40.0;
  check_ratio(powers_of(scene, script), cool, contrast(40.0) / contrast(20.0));
}

TEST_CASE("swapping the polarity of all zones negates every power", "[sim][analog]") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  SceneSpec swapped = scene;
  for (auto& [id, model] : swapped.sensor_models) {
    for (ClusterSpec& cluster : model.clusters) {
      for (ZoneSpec& zone : cluster.zones) zone.polarity = -zone.polarity;
    }
  }
  const Powers powers = powers_of(scene, walkers(1)), negative = powers_of(swapped, walkers(1));
  REQUIRE(powers.size() == negative.size());
  CHECK(sum_of_squares(powers) > 0.0);
  for (std::size_t tick = 0; tick < powers.size(); ++tick) {
    for (std::size_t i = 0; i < powers[tick].size(); ++i) REQUIRE(powers[tick][i] == -negative[tick][i]);
  }
}

TEST_CASE("what the lens' steps receive doesn't depend on the electronics, whose calibration weighs them",
          "[sim][analog]") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  SceneSpec other = scene;
  for (auto& [id, model] : other.sensor_models) {
    model.detector.element.electrical_s = 0.4;
    model.detector.amplifier.low_hz = 0.7;
    model.detector.comparator.negative_v = 0.2;
  }
  const Powers powers = powers_of(scene, walkers(1));
  CHECK(powers_of(other, walkers(1)) == powers);
  const std::size_t n_steps = 3;
  REQUIRE(powers[0].size() == 5 * n_steps);

  ScriptSpec script = walkers(1);
  script.sensing.units = Units::guaranteed;
  const Model model = compile(scene, script), model_of_other = compile(other, script);
  int n_differ = 0;
  for (const Model* of : {&model, &model_of_other}) {
    const SensorModelSpec& sensor = of->scene().sensor_models.begin()->second;
    const pir::Calibration calibration = pir::calibrate(sensor);
    const sim::AnalogModel& analog = *of->compiled().array().analog();
    for (const auto& row : powers) {
      for (std::size_t s = 0; s < 5; ++s) {
        double watts = 0.0;
        for (std::size_t step = 0; step < n_steps; ++step) {
          const double aperture_m2 = calibration.apertures_m2.at(static_cast<int>(step) + 1);
          watts += static_cast<double>(row[s * n_steps + step]) * sim::watts_per_step * aperture_m2 /
                   (1e-6 * sensor.optics.aperture_mm2);
        }
        CHECK(analog.watts(s, row) == Approx(watts).epsilon(1e-12).margin(1e-20));
        n_differ += analog.watts(s, row) != model.compiled().array().analog()->watts(s, row) ? 1 : 0;
      }
    }
  }
  CHECK(n_differ > 0);  // the apertures do depend on it
}

TEST_CASE("zones superpose: what two halves of every facet receive adds up to the whole", "[sim][analog]") {
  SceneSpec whole = shipped_scene("meeting_room.gltf");
  // Of the first lens step alone: the apertures of the others are fitted to whole facets.
  for (auto& [id, model] : whole.sensor_models) {
    std::erase_if(model.clusters, [](const ClusterSpec& cluster) { return cluster.lens_step != 1; });
  }
  std::vector<SceneSpec> halves(2, whole);
  for (std::size_t half = 0; half < 2; ++half) {
    for (auto& [id, model] : halves[half].sensor_models) {
      for (ClusterSpec& cluster : model.clusters) {
        REQUIRE(cluster.zones.size() == 4);
        const auto middle = cluster.zones.begin() + 2;
        cluster.zones = half == 0 ? std::vector<ZoneSpec>(cluster.zones.begin(), middle)
                                  : std::vector<ZoneSpec>(middle, cluster.zones.end());
      }
    }
  }
  const Powers all = powers_of(whole, walkers(1)), one = powers_of(halves[0], walkers(1)),
               other = powers_of(halves[1], walkers(1));
  REQUIRE(all.size() == one.size());
  CHECK(sum_of_squares(one) > 0.0);
  CHECK(sum_of_squares(other) > 0.0);
  for (std::size_t tick = 0; tick < all.size(); ++tick) {
    for (std::size_t i = 0; i < all[tick].size(); ++i) REQUIRE(all[tick][i] == one[tick][i] + other[tick][i]);
  }
}

TEST_CASE("warm surfaces are the background before which people are seen", "[sim][analog]") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  SceneSpec heated = scene;
  for (TriMesh& mesh : heated.meshes) mesh.temperature_c = 60.0;
  ScriptSpec script = walkers(1);
  script.sensing.ambient_c = 20.0;
  script.trials[0].people[0].warmth = bare();
  check_ratio(powers_of(heated, script), powers_of(scene, script), contrast(60.0) / contrast(20.0));
}

TEST_CASE("all tracers give the same powers and signals of two people one of whom is a mesh",
          "[sim][analog][seconds]") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  ScriptSpec script = walkers(2);
  script.sensing.analog_rays_per_zone = 13;
  script.trials[0].people[1].body_meshes["torso"] =
      testing::mesh_solid(testing::box_mesh({-0.2, -0.25, -0.12}, {0.2, 0.25, 0.12}));
  for (PersonSpec& person : script.trials[0].people) person.actions[1] = act(action::Wait{1.0});
  script.trials[0].people[0].actions.push_back(act(action::Walk{{{2.0, -0.8}}}));
  std::vector<RunResult> results;
  std::vector<Powers> powers;
  for (const auto kind : {TracerKind::reference, TracerKind::embree, TracerKind::direct}) {
    powers.push_back(powers_of(scene, script, kind));
    results.push_back(run_once(compile(scene, script, {kind}), 0));
  }
  CHECK(sum_of_squares(powers[0]) > 0.0);
  CHECK(powers[1] == powers[0]);
  CHECK(powers[2] == powers[0]);
  CHECK(results[1].samples == results[0].samples);
  CHECK(results[2].samples == results[0].samples);
}

TEST_CASE("a crowd of natural people gives embree's powers at every tick, whoever comes, passes and leaves",
          "[sim][analog][seconds]") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  std::vector<PersonSpec> people;
  for (const std::string seat : {"S1", "S2", "S6", "S7"}) {
    action::Work work;
    work.duration_s = 3.0;
    work.activity = Activity::meeting;
    people.push_back(test::person(seat, {act(action::Enter{"door"}), act(action::Sit{seat}), act(work),
                                         act(action::Rise{}), act(action::Leave{"door"})}));
    people.back().style = MotionStyle::natural;
    people.back().warmth.clothing_clo = seat == "S1" ? 0.5 : 1.0;
  }
  ScriptSpec script = test::script_of(people);
  script.sensing.response = Response::analog;
  script.sensing.tick_rate_hz = 10;
  script.sensing.ticks_per_window = 10;
  script.sensing.analog_rays_per_zone = 13;
  script.trials[0].duration_s = 45.0;
  const Powers powers = powers_of(scene, script);
  CHECK(sum_of_squares(powers) > 0.0);
  CHECK(powers == powers_of(scene, script, TracerKind::embree));
  // Whoever has just begun to look receives as much: nothing stays of who has moved or gone.
  const Model model = compile(scene, script);
  State state(model, 0);
  std::vector<sim::PowerSteps> anew(powers.front().size());
  std::size_t n_left = 0, n_before = 0;
  for (std::size_t tick = 0; tick < powers.size(); ++tick) {
    step_tick(model, state);
    const auto& actors = state.run_state().crowd.actors();
    const auto n_present = static_cast<std::size_t>(std::ranges::count_if(actors, &sim::Actor::present));
    n_left += n_present < n_before ? 1 : 0;
    n_before = n_present;
    sim::PowerMeter(model.compiled().array(), fastest_tracer).measure(actors, {}, anew);
    REQUIRE(anew == powers[tick]);
  }
  CHECK(n_left >= 2);
  // So do runs that take over what other runs remember.
  script.replicates = 3;
  const Model more = compile(scene, script);
  run_study(more, {.threads = 1},
            [&](const RunResult& result) { CHECK(result.samples == run_once(more, result.run).samples); });
}

namespace {

/// A sitter's movements in steps of n ticks of 50 a second, and what the first sensor's amplifier makes of them.
class SteppingSitter {
 public:
  SteppingSitter(const Model& model, std::uint32_t person, const body::SeatPlace& seat, int n_ticks)
      : sitter_(person, body::Humanoid{PersonSpec{}}, seat),
        n_ticks_(n_ticks),
        humanoid_{PersonSpec{}},
        radiance_(sim::radiance_of(WarmthSpec{}, 20.0)),
        filter_(model.compiled().array().analog()->sensors().front()->silent_filter),
        meter_(model.compiled().array(), fastest_tracer),
        powers_(model.compiled().array().analog()->power().n_receivers()),
        analog_(*model.compiled().array().analog()) {
    watts_ = watts();
    sections_ = filter_.at_rest(watts_);
  }
  double volts_after_tick(Activity activity) {
    sitter_.natural.tick(sitter_.motion, activity, {});
    sitter_.motion.move_in_steps_of(n_ticks_);
    sitter_.motion.advance();
    const double before = std::exchange(watts_, watts());
    filter_.advance(sections_, before, watts_, 0.0);
    return filter_.output(sections_);
  }

 private:
  double watts() {
    solids_.clear();
    sim::append_solids(humanoid_, sitter_.motion.posture(), solids_);
    meter_.measure(solids_, radiance_, powers_);
    return analog_.watts(0, powers_);
  }

  body::test::Sitter sitter_;
  int n_ticks_;
  body::Humanoid humanoid_;
  sim::BodyRadiance radiance_;
  pir::AnalogFilter filter_;
  sim::PowerMeter meter_;
  std::vector<sim::PowerSteps> powers_;
  const sim::AnalogModel& analog_;
  std::vector<PosedShape> solids_;
  double watts_ = 0.0;
  pir::AnalogFilter::Sections sections_{};
};

}  // namespace

TEST_CASE("small movements in steps of 40 ms change a signal by less than the rays' own error",
          "[sim][analog][seconds]") {
  // docs/physics/analog.md: 34 rays a zone leave 6.9 % (rms) of the power.
  constexpr double error_of_rays = 0.069;
  ScriptSpec script = walkers(1);
  const Model model = compile(shipped_scene("meeting_room.gltf"), script);
  body::SeatPlace place;
  place.world_from_seat.origin = {3.5, 0.531, -2.0};
  place.table_height_m = 0.74;
  double squares = 0.0, squares_of_coarse = 0.0, signal = 0.0;
  std::size_t n = 0;
  for (const Activity activity : {Activity::typing, Activity::reading, Activity::meeting, Activity::phone}) {
    for (std::uint32_t person = 0; person < 3; ++person) {
      SteppingSitter exact(model, person, place, 1), stepping(model, person, place, 2),
          coarse(model, person, place, 10);
      for (int tick = 0; tick < 120 * body::test::tick_rate_hz; ++tick, ++n) {
        const double volts = exact.volts_after_tick(activity);
        signal += volts * volts;
        squares += std::pow(stepping.volts_after_tick(activity) - volts, 2);
        squares_of_coarse += std::pow(coarse.volts_after_tick(activity) - volts, 2);
      }
    }
  }
  const auto rms = [n](double sum) { return std::sqrt(sum / static_cast<double>(n)); };
  INFO("rms of the signal " << rms(signal) << " V; of what steps of 40 ms change " << rms(squares) << " V, of 200 ms "
                            << rms(squares_of_coarse) << " V");
  CHECK(rms(squares) < error_of_rays * rms(signal));
  CHECK(rms(squares_of_coarse) > error_of_rays * rms(signal));
}

TEST_CASE("a copied state with analog sensors goes on as the original does", "[sim][analog]") {
  const Model model = compile(shipped_scene("meeting_room.gltf"), walkers(2));
  State state(model, 0);
  for (int i = 0; i < 70; ++i) step_tick(model, state);
  State copy = state;
  while (!state.finished()) {
    step_tick(model, state);
    step_tick(model, copy);
    REQUIRE(copy.sample() == state.sample());
    for (std::size_t i = 0; i < 5; ++i)
      REQUIRE(copy.run_state().detector.analog()[i] == state.run_state().detector.analog()[i]);
  }
}

TEST_CASE("a free-running reader tells the same triggers as one in step and at most one row later", "[sim][analog]") {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  ScriptSpec script = walkers(1);
  const RunResult in_step = run_once(compile(scene, script), 0);
  script.sensing.reader = Reader::free_running;
  const RunResult late = run_once(compile(scene, script), 0);
  REQUIRE(late.samples.size() == in_step.samples.size());
  CHECK(late.samples != in_step.samples);
  for (std::size_t row = 0; row < late.samples.size(); ++row) {
    for (std::size_t sensor = 0; sensor < 5; ++sensor) {
      if (late.samples[row].bits[sensor] == 0) continue;
      CHECK((in_step.samples[row].bits[sensor] != 0 || (row > 0 && in_step.samples[row - 1].bits[sensor] != 0)));
    }
  }
}

TEST_CASE("a trace explains every output and its shares stay within the signal's sum", "[sim][analog]") {
  const Model model = compile(shipped_scene("meeting_room.gltf"), walkers(2));
  const RunResult plain = run_once(model, 0);
  const RunResult traced = run_once(model, 0, Record::samples, Trace::signals);
  CHECK(traced.samples == plain.samples);
  CHECK(plain.trace.empty());
  REQUIRE(traced.trace.size() % 5 == 0);
  std::size_t n_on = 0;
  for (const TraceRow& row : traced.trace) {
    if (row.output == 0) continue;
    ++n_on;
    CHECK((row.person == "p0" || row.person == "p1"));
    CHECK_FALSE(row.part.empty());
    CHECK(row.zone < 68);
    CHECK(std::abs(row.share_v) > 0.02);  // noise alone doesn't reach a threshold
  }
  CHECK(n_on > 50);
}

TEST_CASE("what a meter has looked at before changes nothing, a body of another radiance or a crowd", "[sim][analog]") {
  const Model model = compile(shipped_scene("meeting_room.gltf"), walkers(2));
  const sim::SensorArray& array = model.compiled().array();
  State state(model, 0);
  for (int tick = 0; tick < 30; ++tick) step_tick(model, state);
  const auto& actors = state.run_state().crowd.actors();
  std::vector<PosedShape> solids;
  sim::append_solids(actors.front(), solids);
  const sim::BodyRadiance at_20 = sim::radiance_of(WarmthSpec{}, 20.0), at_10 = sim::radiance_of(WarmthSpec{}, 10.0);
  const std::span<const LeafStep> no_doors;
  sim::PowerMeter used(array, fastest_tracer);
  const auto check_as_anew = [&](const auto&... what) {
    std::vector<sim::PowerSteps> powers(array.analog()->power().n_receivers()), anew = powers;
    used.measure(what..., powers);
    sim::PowerMeter(array, fastest_tracer).measure(what..., anew);
    CHECK(powers == anew);
    CHECK(std::ranges::count(powers, 0) < static_cast<std::ptrdiff_t>(powers.size()));
  };
  check_as_anew(solids, at_20);
  check_as_anew(solids, at_10);
  check_as_anew(actors, no_doors);
  check_as_anew(solids, at_20);
  check_as_anew(actors, no_doors);
}

TEST_CASE("beside sensors of the other response each sensor answers as it does among its own kind", "[sim][analog]") {
  SceneSpec scene = shipped_scene("meeting_room.gltf");
  scene.sensor_models["HARD"] = scene.sensor_models.at("EKMC1604111");
  scene.sensor_models["HARD"].response = Response::zones;
  const std::vector<std::size_t> hard{1, 4};
  for (const std::size_t sensor : hard) scene.sensors[sensor].model = "HARD";
  ScriptSpec script = walkers(2);
  const auto run = [&](std::optional<Response> response, Record record) {
    script.sensing.response = response;
    return run_once(compile(scene, script), 0, record);
  };
  const RunResult mixed = run(std::nullopt, Record::samples), zones = run(Response::zones, Record::samples_and_zones),
                  analog = run(Response::analog, Record::samples);
  std::size_t n_differ = 0;
  for (std::size_t row = 0; row < mixed.samples.size(); ++row) {
    for (std::size_t sensor = 0; sensor < scene.sensors.size(); ++sensor) {
      const bool is_hard = std::ranges::find(hard, sensor) != hard.end();
      const auto bit = [&](const RunResult& result) { return result.samples[row].bits[sensor]; };
      REQUIRE(bit(mixed) == bit(is_hard ? zones : analog));
      n_differ += bit(zones) != bit(analog) ? 1 : 0;
    }
  }
  CHECK(n_differ > 0);
  // Whoever asks for zones gets those of all sensors, whatever they answer by.
  CHECK(run(std::nullopt, Record::samples_and_zones).zones == zones.zones);
  CHECK(run(Response::analog, Record::samples_and_zones).zones == zones.zones);
  const Model model = compile(scene, script);
  State state(model, 0);
  for (const ZoneSet& expected : zones.zones) {
    step_tick(model, state);
    REQUIRE(state.zones() == expected);
  }
}

TEST_CASE("sensors answer physically unless their files or the study ask for zones", "[sim][analog]") {
  SceneSpec scene = shipped_scene("meeting_room.gltf");
  ScriptSpec script = walkers(1);
  const RunResult analog = run_once(compile(scene, script), 0);
  script.sensing.response.reset();
  CHECK(run_once(compile(scene, script), 0).samples == analog.samples);
  scene.sensor_models.begin()->second.response = Response::zones;
  const RunResult zones = run_once(compile(scene, script), 0);
  CHECK(compile(scene, script).compiled().array().analog() == nullptr);
  CHECK(analog.samples != zones.samples);
  script.sensing.response = Response::analog;
  CHECK(run_once(compile(scene, script), 0).samples == analog.samples);
}
