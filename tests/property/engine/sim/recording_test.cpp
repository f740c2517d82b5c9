// Rows from recordings are those of the study, whatever the sensors' responses and electronics.
#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>
#include <set>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/recording.hpp"
#include "engine/sim/recording_family.hpp"
#include "engine/sim/run_state.hpp"
#include "pirsim/random.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/door_scene.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

Model short_study(const std::string& change_per) {
  return compile(shipped_scene("meeting_room.gltf"),
                 shipped_script("studyA.yaml", {"replicates=2", "people.0.actions.3.work.duration_s=65",
                                                "sensing.change_per=" + change_per}));
}

/// Misses every trigger with probability one half.
class DozingLogic final : public DetectorLogic {
 public:
  explicit DozingLogic(const Model& model) : awake_(sim::make_logic(model)), seen_(model.scene().sensors.size()) {}
  void prepare(const Recording& recording) override { awake_->prepare(recording); }
  void begin_run(std::uint64_t seed, std::uint32_t run) override {
    awake_->begin_run(seed, run);
    stream_ = Stream({seed, run, 0, Purpose::test});
  }
  void tick(std::uint32_t before, std::uint32_t after, std::span<std::uint8_t> bits) noexcept override {
    std::fill(seen_.begin(), seen_.end(), std::uint8_t{0});
    awake_->tick(before, after, seen_);
    for (std::size_t s = 0; s < bits.size(); ++s) {
      if (seen_[s] != 0 && stream_.index(2) == 0) bits[s] = 1;
    }
  }

 private:
  std::unique_ptr<DetectorLogic> awake_;
  std::vector<std::uint8_t> seen_;
  Stream stream_{{}};
};

int total_bits(const RunResult& result) {
  int total = 0;
  for (const Sample& sample : result.samples) total += std::accumulate(sample.bits.begin(), sample.bits.end(), 0);
  return total;
}

}  // namespace

TEST_CASE("what is replayed from recorded zones is the study, bit for bit, whichever change counts") {
  const Model per_cluster = short_study("cluster"), per_beam = short_study("beam");
  const Recording tracks = record(per_cluster, all_runs(per_cluster));
  REQUIRE(tracks.runs.size() == 20);
  CHECK(tracks.sets.front() == ZoneSet(per_cluster.compiled().array().channels().n_zones()));
  int differences = 0;
  std::vector<std::vector<RunResult>> studies;
  // One recording serves both: the second study was never followed.
  for (const Model* model : {&per_cluster, &per_beam}) {
    const auto logic = sim::make_logic(*model);
    logic->prepare(tracks);
    studies.push_back(results_of(*model));
    for (std::size_t i = 0; i < tracks.runs.size(); ++i) {
      const RunResult emitted = replay(tracks, i, *logic, 1);
      REQUIRE(emitted.trial == studies.back()[i].trial);
      REQUIRE(emitted.samples == studies.back()[i].samples);
    }
  }
  for (std::size_t i = 0; i < 20; ++i) differences += studies[0][i].samples == studies[1][i].samples ? 0 : 1;
  CHECK(differences > 0);  // the two logics do differ
}

TEST_CASE("a detector's chance follows from the seed and the run alone") {
  const Model model = short_study("cluster");
  const Recording tracks = record(model, all_runs(model), 1);
  DozingLogic dozing(model);
  dozing.prepare(tracks);
  const auto rows = [&](std::size_t run, std::uint64_t seed) { return replay(tracks, run, dozing, seed).samples; };
  const auto first = rows(0, 1);
  CHECK(rows(1, 1) != rows(0, 1));
  CHECK(rows(0, 1) == first);
  CHECK(rows(0, 2) != first);
  CHECK(total_bits(replay(tracks, 0, dozing, 3)) < total_bits(tracks.runs[0].rows));
}

TEST_CASE("recordings don't depend on the number of threads") {
  ScriptSpec office = short_office();
  office.sensing.response = Response::analog;
  office.replicates = 3;
  for (const Model& model : {short_study("cluster"), compile(shipped_scene("open_office.gltf"), office)}) {
    const Recording one = record(model, all_runs(model), 1), two = record(model, all_runs(model), 2);
    CHECK(one.sets == two.sets);
    CHECK(one.moments == two.moments);
    CHECK(std::ranges::equal(one.powers, two.powers, {}, &PowerRows::power, &PowerRows::power));
    for (std::size_t i = 0; i < one.runs.size(); ++i) REQUIRE(one.runs[i].moments == two.runs[i].moments);
  }
}

namespace {

enum class Answers { zones, analog, mixed };

double drawn(Stream& stream, double low, double high) { return low + (high - low) * stream.uniform(); }

/// Short, with sensors that answer physically.
ScriptSpec analog_office() {
  ScriptSpec script = short_office();
  script.sensing.response = Response::analog;
  return script;
}

/// Anything that electronics may be, most of them noisy.
void draw_electronics(DetectorSpec& detector, Stream& stream) {
  detector.element.thermal_s = drawn(stream, 0.1, 0.5);
  detector.amplifier.low_hz = drawn(stream, 0.2, 0.8);
  detector.amplifier.order = 1 + static_cast<int>(stream.index(3));
  detector.amplifier.noise_v_pp = stream.index(3) == 0 ? 0.0 : drawn(stream, 0.05, 0.4);
  detector.comparator.positive_v = drawn(stream, 0.2, 0.6);
  detector.comparator.negative_v = drawn(stream, 0.2, 0.6);
  detector.comparator.pulse_count = 1 + static_cast<int>(stream.index(2));
  detector.comparator.pulse_window_s = 2.0;
  detector.report.hold_s = stream.index(2) == 0 ? 0.0 : 1.5;
  detector.report.again_s = stream.index(2) == 0 ? 0.0 : 1.0;
  detector.report.blind_s = stream.index(2) == 0 ? 0.0 : 0.5;
}

/// The open office with electronics that nobody has, and two makes of sensors where some answer by zones.
SceneSpec drawn_scene(Answers answers, Stream& stream) {
  SceneSpec scene = shipped_scene("open_office.gltf");
  std::map<std::string, SensorModelSpec> by_zones;
  for (auto& [id, model] : scene.sensor_models) {
    model.response = answers == Answers::zones ? Response::zones : Response::analog;
    draw_electronics(model.detector, stream);
    SensorModelSpec& twin = by_zones[id + "_zones"] = model;
    twin.id += "_zones";
    twin.response = Response::zones;
  }
  if (answers != Answers::mixed) return scene;
  scene.sensor_models.insert(by_zones.begin(), by_zones.end());
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    if (i % 2 == 1) scene.sensors[i].model += "_zones";
  }
  return scene;
}

std::vector<EffectSpec> drawn_effects(Stream& stream) {
  const std::vector<EffectSpec> all{{"missed_triggers", {{"probability", 0.4}}, {}, {}},
                                    {"clock_lag", {{"lag_s", -2.3}, {"drift_percent", 0.5}}, {}, {}},
                                    {"false_triggers", {{"rate_per_s", 0.05}}, {}, {}},
                                    {"warm_chair", {{"rate_per_s", 0.3}}, {}, {}},
                                    {"dead_time", {{"dead_s", 2.0}}, {}, {}},
                                    {"dual_polarity", {{"threshold", 0.3}}, {}, {}},
                                    {"soft_zone_edges", {{"sigma_deg", 0.5}}, {}, {}}};
  std::vector<EffectSpec> some;
  for (const EffectSpec& effect : all) {
    if (stream.index(3) == 0) some.push_back(effect);
  }
  // No sensor can have both.
  if (std::ranges::count(some, "dual_polarity", &EffectSpec::name) != 0) {
    std::erase_if(some, [](const EffectSpec& effect) { return effect.name == "soft_zone_edges"; });
  }
  return some;
}

ScriptSpec drawn_script(Stream& stream) {
  std::vector<PersonSpec> people;
  const std::uint32_t n_people = 1 + stream.index(3);
  for (std::uint32_t i = 0; i < n_people; ++i) {
    const std::string seat = "S" + std::to_string(1 + 3 * i);
    action::Work work;
    work.duration_s = drawn(stream, 5.0, 15.0);
    people.push_back(person(seat, {act(action::Enter{i == 1 ? "side_door" : "front_door"}), act(action::Sit{seat}),
                                   act(work), act(action::Leave{"front_door"})}));
    people.back().style = stream.index(2) == 0 ? MotionStyle::natural : MotionStyle::choreographed;
  }
  ScriptSpec script = script_of(people);
  script.sensing.response.reset();  // as each sensor has it
  script.seed = stream.next_u32();
  script.replicates = 2;
  script.trials.front().duration_s = 25.0;
  script.sensing.reader = stream.index(2) == 0 ? Reader::free_running : Reader::in_step;
  script.effects = drawn_effects(stream);
  return script;
}

std::vector<RunResult> emitted(const Model& model, const Recording& recording, const EmitOptions& options = {}) {
  std::vector<RunResult> results;
  emit(model, recording, options, [&](const RunResult& result) { results.push_back(result); });
  return results;
}

int total_bits(const std::vector<RunResult>& results) {
  int total = 0;
  for (const RunResult& result : results) total += total_bits(result);
  return total;
}

}  // namespace

TEST_CASE("a recording of any study serves its own and any other electronics, bit for bit", "[seconds]") {
  Stream stream({2026, 0, 0, Purpose::test});
  int n_bits = 0, n_differ = 0;
  std::size_t n_sets = 0, n_sets_of_analog = 0;
  for (const Answers answers : {Answers::zones, Answers::analog, Answers::mixed}) {
    for (int i = 0; i < 5; ++i) {
      INFO("response " << static_cast<int>(answers) << ", study " << i);
      const SceneSpec scene = drawn_scene(answers, stream);
      const ScriptSpec script = drawn_script(stream);
      const Model model = compile(scene, script);
      const Recording recording = record(model, all_runs(model));
      const auto rows = results_of(model);
      REQUIRE(same_rows(emitted(model, recording), rows));
      n_bits += total_bits(rows);

      SceneSpec other_scene = scene;
      for (auto& [id, sensor] : other_scene.sensor_models) draw_electronics(sensor.detector, stream);
      ScriptSpec other_script = script;
      other_script.sensing.reader = Reader::in_step;
      const Model other = compile(other_scene, other_script, {.like = &model});
      const auto other_rows = results_of(other);
      REQUIRE(same_rows(emitted(other, recording), other_rows));
      n_differ += same_rows(other_rows, rows) ? 0 : 1;

      (answers == Answers::analog ? n_sets_of_analog : n_sets) += recording.sets.size() - 1;
      CHECK(recording.moments.empty() == (answers == Answers::zones));
    }
  }
  CHECK(n_bits > 300);
  CHECK(n_differ > 9);
  CHECK(n_sets > 600);
  CHECK(n_sets_of_analog == 0);  // nobody needs them
}

TEST_CASE("another seed is another noise on the same people") {
  const auto office_with = [](double noise_v_pp) {
    SceneSpec scene = shipped_scene("open_office.gltf");
    for (auto& [id, model] : scene.sensor_models) model.detector.amplifier.noise_v_pp = noise_v_pp;
    return scene;
  };
  const Model model = compile(office_with(0.4), analog_office());
  const Recording recording = record(model, std::vector<std::uint32_t>{0});
  const auto noisy = emitted(model, recording, {.effects = {}, .seed = 8});
  CHECK_FALSE(same_rows(noisy, emitted(model, recording)));
  CHECK(same_rows(noisy, emitted(model, recording, {.effects = {}, .seed = 8})));
  const Model silent = compile(office_with(0.0), analog_office());
  CHECK(same_rows(emitted(silent, recording, {.effects = {}, .seed = 8}), emitted(silent, recording)));
}

TEST_CASE("what the optics showed is kept once, exactly as runs have it") {
  const Model model = compile(shipped_scene("open_office.gltf"), analog_office());
  const Recording recording = record(model, all_runs(model), 1);
  const RecordedRun& run = recording.runs[0];
  CHECK(run.rest == 0);  // nobody is there yet
  CHECK(recording.n_moments() < run.moments.size());
  State state(model, 0);
  for (const std::uint32_t number : run.moments) {
    step_tick(model, state);
    std::vector<std::int64_t> powers;
    for (std::size_t sensor = 0; sensor < recording.n_sensors; ++sensor) {
      for (const std::int64_t power : recording.powers_of(number, sensor)) powers.push_back(power);
    }
    REQUIRE(powers == state.run_state().exposure().powers);
  }
  std::set<std::vector<std::uint32_t>> different;
  const auto width = static_cast<std::ptrdiff_t>(1 + recording.n_sensors);
  for (auto moment = recording.moments.begin(); moment != recording.moments.end(); moment += width) {
    different.emplace(moment, moment + width);
  }
  CHECK(different.size() == recording.n_moments());
  for (const auto& [n_steps, power] : recording.powers) {
    std::set<std::vector<std::int64_t>> rows;
    const auto n = static_cast<std::ptrdiff_t>(n_steps);
    for (auto row = power.begin(); row != power.end(); row += n) rows.emplace(row, row + n);
    CHECK(rows.size() * n_steps == power.size());
    CHECK(rows.size() < recording.n_moments());
    CHECK(std::ranges::all_of(std::span(power).first(n_steps), [](std::int64_t step) { return step == 0; }));
  }
}

TEST_CASE("a recording is refused to a model whose optics it doesn't tell") {
  const SceneSpec scene = shipped_scene("open_office.gltf");
  const ScriptSpec script = analog_office();
  const Recording recording = record(compile(scene, script), std::vector<std::uint32_t>{0});
  const auto check_refused = [&](const SceneSpec& other_scene, const ScriptSpec& other_script) {
    CHECK_THROWS_WITH(emitted(compile(other_scene, other_script), recording), contains("other optics"));
  };
  SceneSpec moved = scene;
  moved.sensors[1].world_from_sensor.origin.y -= 0.01;
  check_refused(moved, script);
  SceneSpec warmer = scene;
  warmer.meshes.front().temperature_c = 30.0;
  check_refused(warmer, script);
  SceneSpec blurred = scene;
  blurred.sensor_models.begin()->second.optics.blur_deg = 0.3;
  check_refused(blurred, script);
  SceneSpec larger = scene;
  larger.sensor_models.begin()->second.optics.aperture_mm2 = 30.0;
  check_refused(larger, script);
  SceneSpec fewer = scene;
  fewer.sensors.pop_back();
  check_refused(fewer, script);
  SceneSpec other_seats = scene;
  std::ranges::reverse(other_seats.seats);
  check_refused(other_seats, script);
  SceneSpec other_steps = scene;  // as many facets of each step as before, and as many rays
  std::vector<ClusterSpec>& facets = other_steps.sensor_models.at("EKMC1604111").clusters;
  const auto first = std::ranges::find(facets, 1, &ClusterSpec::lens_step);
  const auto third = std::ranges::find(facets, 3, &ClusterSpec::lens_step);
  REQUIRE(third != facets.end());
  std::swap(first->lens_step, third->lens_step);
  std::swap(first->range_m, third->range_m);
  check_refused(other_steps, script);
  ScriptSpec zones = script;
  zones.sensing.response = Response::zones;
  check_refused(scene, zones);
  ScriptSpec slower = script;
  slower.sensing.tick_rate_hz = 25;
  check_refused(scene, slower);
}

TEST_CASE("a recording is refused where a wall or a leaf alone ends the same rays elsewhere") {
  const auto ends = [](const Model& model) { return model.compiled().array().range(); };
  for (const Response response : {Response::zones, Response::analog}) {
    ScriptSpec script = script_of({person("P", {act(action::Appear{{1.5, 0.0}, 0.0}), act(action::Wait{2.0})})});
    script.sensing.response = response;
    SceneSpec wider = two_rooms({});
    for (Vec3& at : std::ranges::find(wider.meshes, "north", &TriMesh::name)->positions) at.z += 0.2;
    const std::vector<std::pair<SceneSpec, SceneSpec>> pairs{
        {two_rooms({}), wider}, {two_rooms({inner_door(DoorState::shut)}), two_rooms({inner_door(DoorState::open)})}};
    for (const auto& [scene, other_scene] : pairs) {
      const Model model = compile(scene, script), other = compile(other_scene, script);
      const auto same_bytes = [](const Ray& a, const Ray& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
      REQUIRE(std::ranges::equal(model.rays().rays, other.rays().rays, same_bytes));
      REQUIRE(ends(model) != ends(other));
      const Recording recording = record(model, std::vector<std::uint32_t>{0});
      CHECK(same_rows(emitted(compile(scene, script), recording), results_of(model)));
      CHECK_THROWS_WITH(emitted(other, recording), contains("other optics"));
    }
  }
}
