// How fast whole studies run, as CSV: benchmark,case,value,unit. What stands in a case tells what is measured; the
// machine is described by the first lines. docs/performance.md explains the numbers.
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "engine/effects/catalogue.hpp"
#include "engine/rt/direct_tracer.hpp"
#include "engine/sim/compiled_study.hpp"
#include "engine/sim/observer.hpp"
#include "engine/sim/run_state.hpp"
#include "engine/sim/thermal_array.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/state.hpp"
#include "pirsim/study.hpp"
#include "pirsim/version.hpp"
#include "reconcile/ensemble/reference_table.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using pirsim::test::shipped_scene;
using pirsim::test::shipped_script;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Of this thread alone: other programs that want the processor don't count.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const { return now() - begin_; }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double begin_ = now();
};

void report(const std::string& benchmark, const std::string& what, double value, const std::string& unit) {
  std::cout << benchmark << ",\"" << what << "\"," << value << ',' << unit << std::endl;
}

/// Least of several repetitions: what the machine can do when nobody disturbs it.
double least(int repetitions, const std::function<double()>& measure) {
  double best = measure();
  for (int i = 1; i < repetitions; ++i) best = std::min(best, measure());
  return best;
}

void describe_machine() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  std::string processor = "unknown";
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.starts_with("model name")) processor = line.substr(line.find(':') + 2);
  }
  std::cout << "benchmark,case,value,unit\n";
  std::cout << "machine,\"" << processor << "\"," << std::thread::hardware_concurrency() << ",threads\n";
  std::cout << "machine,\"" << rt::direct_instruction_set() << "\",1,instruction set\n";
  std::cout << "machine,\"pirsim " << version() << ' ' << git_revision() << ", " << compiler() << "\",1,build\n";
}

Model study_a(TracerKind kind, std::vector<std::string> overrides = {}) {
  overrides.emplace_back("replicates=1000");
  return compile(shipped_scene("meeting_room.gltf"), shipped_script("studyA.yaml", overrides), {kind});
}
const std::vector<std::string> scattered{"people.0.seat_scatter.position_sd_m=0.05",
                                         "people.0.seat_scatter.heading_sd_deg=4.3"};

/// The states of a run from the first tick of a phase on.
State at_phase(const Model& model, std::uint32_t run, std::string_view phase) {
  State state(model, run);
  do step_tick(model, state);
  while (state.run_state().crowd.actors().front().phase() != phase);
  return state;
}

/// Nanoseconds per tick of everything: person, posture, rays, motion.
/// What `from` remembers of postures is known, and it learns.
double tick_ns(const Model& model, State& from, int n_ticks) {
  State state = from;
  *state.run_state().observer = *from.run_state().observer;
  const Stopwatch stopwatch;
  for (int i = 0; i < n_ticks; ++i) step_tick(model, state);
  return stopwatch.seconds() / n_ticks * 1e9;
}

struct Phase {
  std::string_view name;
  int n_ticks;
};
constexpr Phase phases[] = {{"walking", 150}, {"sitting_down", 60}, {"working", 8000}};

/// What the physical response costs beside the hard zones.
void responses() {
  for (const Phase& phase : phases) {
    std::array<double, 2> fresh{}, known{};
    for (const bool analog : {false, true}) {
      const std::vector<std::string> overrides{analog ? "sensing.response=analog" : "sensing.response=zones"};
      const Model model = study_a(TracerKind::direct, overrides);
      fresh[analog] = least(3, [&] {
        const Model first = study_a(TracerKind::direct, overrides);
        State from = at_phase(first, 3, phase.name);
        return tick_ns(first, from, phase.n_ticks);
      });
      State from = at_phase(model, 3, phase.name);
      known[analog] = least(5, [&] { return tick_ns(model, from, phase.n_ticks); });
    }
    const std::string name(phase.name);
    report("response", name + ", analog, first run", fresh[1], "ns");
    report("response", name + ", analog, postures known", known[1], "ns");
    report("response", name + ", analog to zones, first run", fresh[1] / fresh[0], "1");
    report("response", name + ", analog to zones, postures known", known[1] / known[0], "1");
  }
}

void ticks_by_phase() {
  const Model direct = study_a(TracerKind::direct);
  const Model embree = study_a(TracerKind::embree), reference = study_a(TracerKind::reference);
  for (const Phase& phase : phases) {
    const std::string name(phase.name);
    const int few = std::min(phase.n_ticks, 150);
    State from = at_phase(direct, 3, phase.name);
    State by_reference = at_phase(reference, 3, phase.name), by_embree = at_phase(embree, 3, phase.name);
    const double plain = least(3, [&] { return tick_ns(reference, by_reference, few); });
    const double instances = least(3, [&] { return tick_ns(embree, by_embree, few); });
    const double study = least(3, [&] {
      const Model fresh = study_a(TracerKind::direct);
      State first = at_phase(fresh, 3, phase.name);
      return tick_ns(fresh, first, phase.n_ticks);
    });
    const double known = least(5, [&] { return tick_ns(direct, from, phase.n_ticks); });
    report("tick", name + ", reference", plain, "ns");
    report("tick", name + ", embree", instances, "ns");
    report("tick", name + ", direct, first run", study, "ns");
    report("tick", name + ", direct, postures known", known, "ns");
    report("ratio", name + ", reference to direct, first run", plain / study, "1");
    report("ratio", name + ", reference to direct, postures known", plain / known, "1");
  }
}

/// The outlines of `n_people` people who work at as many seats at once.
std::vector<std::vector<body::Outline>> outlines(const Model& model, std::string_view phase, int n_ticks,
                                                 std::uint32_t n_people) {
  std::vector<std::vector<body::Outline>> result(n_people);
  for (std::uint32_t person = 0; person < n_people; ++person) {
    State state = at_phase(model, person, phase);
    for (int i = 0; i < n_ticks; ++i) {
      result[person].push_back(state.run_state().crowd.actors().front().motion().outline());
      step_tick(model, state);
    }
  }
  return result;
}

/// Nanoseconds per tick of posture and rays with one kernel, nothing remembered but the parts that stand still.
double anew_ns(const Model& model, const std::vector<std::vector<body::Outline>>& people, const rt::RayKernel& kernel) {
  rt::DirectTracer tracer({&model.compiled().array().room(), &model.compiled().array().rated(), &model.rays()}, kernel);
  const body::Humanoid humanoid{model.compiled().trials().front().people.front().spec};
  ZoneSet zones(model.compiled().array().rated().n_zones());
  std::vector<PosedShape> solids;
  const std::size_t n_ticks = people.front().size();
  const Stopwatch stopwatch;
  for (std::size_t tick = 0; tick < n_ticks; ++tick) {
    zones.clear();
    for (std::size_t person = 0; person < people.size(); ++person) {
      solids.clear();
      sim::append_solids(humanoid, body::posture_of(humanoid, people[person][tick]), solids);
      tracer.add(person, solids, zones);
    }
  }
  return stopwatch.seconds() / static_cast<double>(n_ticks) * 1e9;
}

void postures_anew() {
  const Model model = study_a(TracerKind::direct);
  for (const Phase& phase : phases) {
    const int n_ticks = std::min(phase.n_ticks, 1000);
    const auto one = outlines(model, phase.name, n_ticks, 1);
    for (const rt::RayKernel* kernel : rt::all_ray_kernels()) {
      if (!kernel->is_available()) continue;
      const double ns = least(5, [&] { return anew_ns(model, one, *kernel); });
      const std::string what = std::string(phase.name) + ", " + std::string(kernel->name);
      report("posture and rays anew", what, ns, "ns");
      report("posture and rays anew", what + ", per ray",
             ns / static_cast<double>(model.compiled().array().rated().rays.size()), "ns");
    }
  }
}

// A kernel that counts what it is asked.
struct Counts {
  std::size_t packets = 0, hits = 0;
};
Counts counts;
template <typename Solid>
using Intersect = void (*)(const rt::RayPacket*, const std::uint32_t*, std::size_t, const Solid&,
                           const rt::BoundingSphere&, rt::PacketHits*) noexcept;
template <typename Solid, Intersect<Solid> rt::RayKernel::*hit>
void counted(const rt::RayPacket* rays, const std::uint32_t* picked, std::size_t n, const Solid& solid,
             const rt::BoundingSphere& around, rt::PacketHits* hits) noexcept {
  (rt::best_ray_kernel().*hit)(rays, picked, n, solid, around, hits);
  counts.packets += n;
  for (std::size_t k = 0; k < n; ++k) counts.hits += static_cast<std::size_t>(std::popcount(hits[k]));
}

/// What must be tested at all: packets that pass the cones of a part, and rays that hit it.
void limit() {
  const Model model = study_a(TracerKind::direct);
  rt::RayKernel counting = rt::best_ray_kernel();
  counting.intersect_sphere = counted<PosedSphere, &rt::RayKernel::intersect_sphere>;
  counting.intersect_capsule = counted<PosedCapsule, &rt::RayKernel::intersect_capsule>;
  counting.intersect_box = counted<PosedBox, &rt::RayKernel::intersect_box>;
  for (const Phase& phase : phases) {
    const std::string name(phase.name);
    const int n_ticks = std::min(phase.n_ticks, 1000);
    const auto one = outlines(model, phase.name, n_ticks, 1);
    const body::Humanoid humanoid{model.compiled().trials().front().people.front().spec};
    std::vector<PosedShape> solids;
    const double pose = least(5, [&] {
      const Stopwatch stopwatch;
      for (const body::Outline& outline : one.front()) {
        solids.clear();
        sim::append_solids(humanoid, body::posture_of(humanoid, outline), solids);
      }
      return stopwatch.seconds() / n_ticks * 1e9;
    });
    counts = {};
    (void)anew_ns(model, one, counting);
    report("limit", name + ", pose alone", pose, "ns");
    report("limit", name + ", pairs of a part and a packet tested", static_cast<double>(counts.packets) / n_ticks,
           "per tick");
    report("limit", name + ", pairs of a part and a ray that hit", static_cast<double>(counts.hits) / n_ticks,
           "per tick");
  }
}

void people() {
  const Model model = study_a(TracerKind::direct);
  const auto all = outlines(model, "working", 1000, 8);
  double apart = 0.0;
  for (std::size_t person = 0; person < all.size(); ++person) {
    const double ns = least(5, [&] { return anew_ns(model, {all[person]}, rt::best_ray_kernel()); });
    report("people at work anew", "the one at seat " + std::to_string(person + 1), ns, "ns");
    apart += ns;
    if ((person & (person + 1)) != 0) continue;
    const std::vector<std::vector<body::Outline>> together(all.begin(), all.begin() + static_cast<long>(person) + 1);
    const double ns_together = least(5, [&] { return anew_ns(model, together, rt::best_ray_kernel()); });
    report("people at work anew", std::to_string(person + 1) + " together", ns_together, "ns");
    report("people at work anew", std::to_string(person + 1) + " together, share of one by one", ns_together / apart,
           "1");
  }
}

/// So many people at work in one room.
struct Office {
  Office(const SceneSpec& scene, const ScriptSpec& script) : model(compile(scene, script)), state(model, 0) {
    const auto works = [](const sim::Actor& actor) { return actor.phase() == "working"; };
    do step_tick(model, state);
    while (!std::ranges::all_of(state.run_state().crowd.actors(), works));
  }
  Model model;
  State state;
  double ns = 1e30;  ///< per tick, the least measured so far
};

/// Whole ticks of so many people at work in one room, all postures known. The numbers of people take turns, so that a
/// slow moment of the machine strikes all alike.
void people_known() {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  const ScriptSpec alone = shipped_script("studyA.yaml");
  std::map<std::size_t, std::unique_ptr<Office>> offices;
  for (const std::size_t n_people : {1U, 2U, 4U, 8U, 10U}) {
    ScriptSpec script = alone;
    script.trials.resize(1);
    script.trials.front().people.clear();
    for (std::size_t person = 0; person < n_people; ++person) {
      script.trials.front().people.push_back(alone.trials[person].people.front());
      script.trials.front().people.back().id += std::to_string(person);
    }
    offices.emplace(n_people, std::make_unique<Office>(scene, script));
  }
  for (int round = 0; round < 40; ++round) {
    for (auto& [n_people, office] : offices) {
      office->ns = std::min(office->ns, tick_ns(office->model, office->state, 3000));
    }
  }
  for (const auto& [n_people, office] : offices) {
    const std::string what = std::to_string(n_people) + " together";
    report("people at work, postures known", what, office->ns, "ns");
    report("people at work, postures known", what + ", in people alone", office->ns / offices.at(1)->ns, "1");
  }
}

/// The first of Study A's seats with a person of this style each, who work for ever.
ScriptSpec full_room(std::size_t n_people, MotionStyle style, Response response) {
  const ScriptSpec alone = shipped_script("studyA.yaml");
  ScriptSpec script = alone;
  script.sensing.response = response;
  script.trials.resize(1);
  script.trials.front().people.clear();
  constexpr std::array activities{Activity::typing, Activity::typing, Activity::reading, Activity::phone};
  for (std::size_t i = 0; i < n_people; ++i) {
    PersonSpec person = alone.trials[i].people.front();
    person.id += std::to_string(i);
    person.style = style;
    for (ScriptedAction& action : person.actions) {
      auto* work = std::get_if<action::Work>(&action.what);
      if (work == nullptr) continue;
      work->duration_s = 1e6;
      if (style == MotionStyle::natural) work->activity = activities[i % activities.size()];
    }
    script.trials.front().people.push_back(person);
  }
  return script;
}

/// How fast people at work are simulated, from the moment on when all of them sit.
void hours_per_second() {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  for (const Response response : {Response::zones, Response::analog}) {
    for (const MotionStyle style : {MotionStyle::choreographed, MotionStyle::natural}) {
      for (const std::size_t n_people : {1U, 3U, 8U, 10U}) {
        Office office(scene, full_room(n_people, style, response));
        constexpr int n_ticks = 60000;
        const double ns = tick_ns(office.model, office.state, n_ticks);
        const std::string what = std::string(response == Response::analog ? "analog, " : "zones, ") +
                                 (style == MotionStyle::natural ? "natural, " : "the paper's, ") +
                                 std::to_string(n_people) + " people";
        report("people at work", what, ns, "ns a tick");
        report("people at work", what, 1e9 / (ns * 50.0 * 3600.0), "hours a second");
      }
    }
  }
}

/// What a thermal array costs beside a wall PIR at equal frame rates: a frame a tick, people who never do the same
/// twice.
void arrays() {
  const SceneSpec room = shipped_scene("meeting_room.gltf");
  const auto scene_with = [&](const std::string& model, int rays_per_pixel) {
    SceneSpec scene = room;
    scene.sensors.resize(model.empty() ? 1 : 0);
    if (model.empty() || model == "nothing") return scene;
    scene.sensor_models[model] = io::read_sensor_model(test::data("sensors/" + model + ".yaml"));
    scene.sensor_models[model].array->rays_per_pixel = rays_per_pixel;
    scene.arrays = {{"A1", model, {glm::angleAxis(radians(-90.0), Vec3(1, 0, 0)), Vec3(3.5, 2.6, -2.0)}}};
    return scene;
  };
  const std::vector<std::pair<std::string, SceneSpec>> cases{{"no sensor", scene_with("nothing", 0)},
                                                             {"a wall PIR, analog", scene_with("", 0)},
                                                             {"8 x 8", scene_with("AMG8833", 24)},
                                                             {"32 x 24", scene_with("MLX90640-BAA", 8)}};
  for (const std::size_t n_people : {1U, 3U}) {
    std::map<std::string, double> ns;
    for (int round = 0; round < 5; ++round) {
      for (const auto& [what, scene] : cases) {
        ScriptSpec script = full_room(n_people, MotionStyle::natural, Response::analog);
        script.sensing.frame_rate_hz = script.sensing.tick_rate_hz;
        Office office(scene, script);
        std::vector<sim::Camera> cameras;
        for (const auto& array : office.model.compiled().arrays()) cameras.emplace_back(*array, fastest_tracer, 0);
        constexpr int n_ticks = 4000;
        const Stopwatch stopwatch;
        for (int i = 0; i < n_ticks; ++i) {
          step_tick(office.model, office.state);
          for (sim::Camera& camera : cameras) camera.look(office.state.run_state());
        }
        const double now = stopwatch.seconds() / n_ticks * 1e9;
        ns[what] = round == 0 ? now : std::min(ns[what], now);
      }
    }
    const std::string people = std::to_string(n_people) + " at work, ";
    for (const auto& [what, value] : ns) {
      report("arrays", people + what, value, "ns a tick");
      report("arrays", people + what + ", in wall PIRs", value / ns["a wall PIR, analog"], "1");
    }
  }
}

/// Seconds of wall clock until every one of some independent ensembles of 300 runs is done.
double seconds_of_ensembles(const std::vector<std::string>& overrides, unsigned n_ensembles, unsigned threads_each) {
  const auto begin = Clock::now();
  std::vector<std::thread> ensembles;
  for (unsigned i = 0; i < n_ensembles; ++i) {
    ensembles.emplace_back([&] {
      const Model model = compile(shipped_scene("meeting_room.gltf"), shipped_script("studyA.yaml", overrides));
      std::ofstream null("/dev/null");
      io::CsvWriter csv(null, model.columns());
      run_study(model, {threads_each, Record::samples}, [&](const RunResult& result) {
        for (const Sample& sample : result.samples) csv.write(sample);
      });
    });
  }
  for (std::thread& ensemble : ensembles) ensemble.join();
  return seconds_since(begin);
}

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// The speed-up of several threads beside what the machine gives to as many independent ensembles of one thread each,
/// in turns: on a shared machine cores take from each other, whatever the program does.
void runs_per_second() {
  constexpr int n_rounds = 9;
  const unsigned most = std::max(1U, std::thread::hardware_concurrency());
  for (const bool is_scattered : {false, true}) {
    const std::string kind = is_scattered ? "scattered seats" : "Study A";
    std::vector<std::string> overrides = is_scattered ? scattered : std::vector<std::string>{};
    overrides.emplace_back("replicates=30");
    for (unsigned threads = 2; threads <= most; ++threads) {
      std::vector<double> seconds_alone, seconds, speed_up, speed_up_of_machine;
      for (int round = 0; round < n_rounds; ++round) {
        const double alone = seconds_of_ensembles(overrides, 1, 1);
        const double together = seconds_of_ensembles(overrides, 1, threads);
        const double apart = seconds_of_ensembles(overrides, threads, 1);
        seconds_alone.push_back(alone);
        seconds.push_back(together);
        speed_up.push_back(alone / together);
        speed_up_of_machine.push_back(threads * alone / apart);
      }
      const std::string what = kind + ", " + std::to_string(threads) + " threads";
      if (threads == 2) report("runs per second", kind + ", 1 thread", 300.0 / median_of(seconds_alone), "1/s");
      report("runs per second", what, 300.0 / median_of(seconds), "1/s");
      report("speed-up", what, median_of(speed_up), "1");
      report("speed-up of independent ensembles", what, median_of(speed_up_of_machine), "1");
    }
  }
}

void start_up() {
  const double seconds = least(5, [] {
    const auto begin = Clock::now();
    const Model model = study_a(TracerKind::direct);
    State state(model, 0);
    step(model, state);
    return seconds_since(begin);
  });
  report("start-up", "files to first row", seconds, "s");
}

/// What every trial of an ensemble over rooms or seats costs: nothing is known yet, and every trial runs once.
void first_runs() {
  const SceneSpec scene = shipped_scene("meeting_room.gltf");
  for (const bool is_scattered : {false, true}) {
    std::vector<std::string> overrides = is_scattered ? scattered : std::vector<std::string>{};
    overrides.emplace_back("replicates=1");
    const ScriptSpec script = shipped_script("studyA.yaml", overrides);
    const std::string what = is_scattered ? "scattered seats, " : "Study A, ";
    const auto compiling = [&] {
      const Stopwatch stopwatch;
      const Model model = compile(scene, script);
      return stopwatch.seconds();
    };
    const auto all = [&] {
      const Stopwatch stopwatch;
      const Model model = compile(scene, script);
      for (std::uint32_t run = 0; run < model.n_runs(); ++run) (void)run_once(model, run);
      return stopwatch.seconds();
    };
    report("first runs", what + "compile", least(10, compiling), "s");
    report("first runs", what + "compile and ten first runs", least(10, all), "s");
  }
}

/// What a realization of a reconciliation's reference table costs, and each effect in it.
void realizations() {
  const reconcile::RealizationSource source{
      shipped_scene("meeting_room.gltf"), shipped_script("studyA.yaml", {"replicates=1"}), {}, 1};
  const reconcile::StudyFrame frame = reconcile::frame_of(source.scene, source.script);
  constexpr std::uint32_t n_realizations = 4;
  std::map<std::string, double> seconds;
  for (std::uint32_t index = 0; index < n_realizations; ++index) {
    Stopwatch stopwatch;
    const reconcile::SimulatedRealization realization(source, frame, index, 1);
    (void)realization.plain(0, 1);
    seconds["plain model"] += stopwatch.seconds();
    for (const effects::Effect* effect : effects::catalogue()) {
      Stream stream({1, index, 0, Purpose::test});
      const EffectSpec spec =
          effects::draw_from_prior(*effect, realization.drawn().scene, realization.drawn().script, stream);
      stopwatch = {};
      (void)realization.with_effects(std::span(&spec, 1), 0, 1);
      seconds[effect->info.name] += stopwatch.seconds();
    }
  }
  for (const auto& [what, all] : seconds) report("realizations", what, all / n_realizations, "s");
  const auto pilot = reconcile::pilot_runs(source, frame, n_realizations, {1, 1});
  const auto shape = reconcile::full_shape(frame, reconcile::Measured::Kind::series, 1, pilot);
  const auto profile = reconcile::profile_of(frame, source.script, pilot);
  const Stopwatch stopwatch;
  (void)reconcile::make_reference_table(source, frame, shape, profile,
                                        {n_realizations, n_realizations, n_realizations, {}}, {}, {1, 1});
  report("realizations", "all hypotheses of the table", stopwatch.seconds() / n_realizations, "s");
}

}  // namespace

/// With a name, that section alone.
int main(int argc, char** argv) {
  const std::string wanted = argc > 1 ? argv[1] : "";
  struct Section {
    std::string name;
    void (*run)();
  };
  describe_machine();
  for (const Section& section :
       {Section{"start-up", start_up}, Section{"first", first_runs}, Section{"anew", postures_anew},
        Section{"limit", limit}, Section{"people", people}, Section{"known", people_known},
        Section{"hours", hours_per_second}, Section{"realizations", realizations}, Section{"ticks", ticks_by_phase},
        Section{"responses", responses}, Section{"arrays", arrays}, Section{"runs", runs_per_second}}) {
    if (wanted.empty() || wanted == section.name) section.run();
  }
}
