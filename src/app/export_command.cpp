#include <cmath>
#include <iostream>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "io/gltf_writer.hpp"
#include "pirsim/state.hpp"
#include "sim/run_state.hpp"
#include "sim/solids.hpp"

namespace pirsim::app {
namespace {

struct ExportOptions {
  std::filesystem::path output = "run.glb";
  RunChoice run;
  double keys_per_s = 10.0;
  std::vector<std::string> beams{"all"};
};

io::ExportedPerson without_keys(const sim::Actor& actor) {
  io::ExportedPerson person{actor.person().spec.id, {}, {}};
  for (std::size_t i = 0; i < body::n_parts; ++i) {
    const auto part = static_cast<body::Part>(i);
    person.parts.push_back({person.id, std::string(body::name(part)), actor.person().humanoid.solids()[i], {}});
  }
  return person;
}

/// While away, a person's parts keep their last place (they are drawn at scale 0).
void add_key(const sim::Actor& actor, io::ExportedPerson& person) {
  person.present.push_back(actor.present() ? 1 : 0);
  const body::Posture posture = actor.present() ? actor.motion().posture() : body::Posture{};
  for (std::size_t i = 0; i < body::n_parts; ++i) {
    auto& keys = person.parts[i].world_from_part;
    keys.push_back(actor.present() || keys.empty() ? posture[i] : keys.back());
  }
}

void export_gltf(const Inputs& inputs, const ExportOptions& options) {
  check_outputs({{"-o", options.output, {".gltf", ".glb"}}}, inputs);
  const Model model = load(inputs);
  const int rate = model.script().sensing.tick_rate_hz;
  const auto ticks_per_key = std::max<std::int64_t>(1, std::llround(rate / options.keys_per_s));

  State state(model, find_run(model, options.run));
  io::ExportedRun run;
  run.title = model.script().name + ", trial " + model.trial_of(state.run());
  run.meshes = model.compiled().scene().meshes;
  for (const std::size_t sensor : find_sensors(model, options.beams)) {
    io::ExportedBeams& beams = run.beams.emplace_back();
    beams.sensor = model.scene().sensors[sensor].id;
    for (const sim::BeamSegment& beam : sim::beams_of(model, state, sensor))
      beams.segments.emplace_back(beam.from, beam.to);
  }
  const std::vector<sim::Actor>& actors = state.run_state().crowd.actors();
  for (const sim::Actor& actor : actors) run.people.push_back(without_keys(actor));
  while (true) {
    if (state.tick() % ticks_per_key == 0 || state.finished()) {
      run.key_times_s.push_back(static_cast<double>(state.tick()) / rate);
      for (std::size_t i = 0; i < run.people.size(); ++i) add_key(actors[i], run.people[i]);
    }
    if (state.finished()) break;
    step_tick(model, state);
  }
  io::write_gltf(options.output, run);
  if (inputs.verbosity != Verbosity::quiet) {
    std::cerr << "wrote " << options.output.string() << ": " << run.title << ", " << run.key_times_s.back() << " s\n";
  }
}

}  // namespace

void add_export_command(CLI::App& app) {
  CLI::App& command = add_command(app, "export", "write one run as an animated glTF", R"(
  pirsim export --scene room.gltf --script study.yaml -o run.glb   the first trial
  pirsim export --scene room.gltf --script study.yaml --trial S8 --beams PIR4,PIR5 -o S8.gltf
)");
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<ExportOptions>();
  offer_study(command, *inputs);
  offer_tracer(command, *inputs);
  offer_seed(command, *inputs);
  offer_output(command, options->output, "FILE", "glTF file, .gltf or .glb (default: run.glb)");
  offer_run_choice(command, options->run);
  command.add_option("--keys-per-s", options->keys_per_s, "animation keys a second (default: 10)")
      ->option_text("N")
      ->check(CLI::Range(0.001, 10000.0));
  command.add_option("--beams", options->beams, "sensors whose beams are drawn, or all or none (default: all)")
      ->option_text("ID,...")
      ->delimiter(',');
  on_call(command, inputs, [options](const Inputs& given) { export_gltf(given, *options); });
}

}  // namespace pirsim::app
