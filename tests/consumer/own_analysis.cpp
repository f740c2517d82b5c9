// Model against measurement from a program: the verdict in a sentence, its numbers, and the report.
#include <pirsim/error.hpp>
#include <pirsim/io.hpp>
#include <pirsim/reconcile.hpp>

#include <iostream>

namespace rec = pirsim::reconcile;

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  try {
    const pirsim::SceneSpec scene = pirsim::io::read_scene(argv[1]);
    const pirsim::ScriptSpec script = pirsim::io::read_script(argv[2]);
    const rec::Measured measured = rec::read_measured(argv[3], scene, script);
    rec::Settings settings;
    const std::uint32_t few = rec::fewest_datasets_to_refuse(settings.alpha);
    settings.table = {few, few, few, {"false_triggers", "missed_triggers"}};
    settings.max_effects = 1;
    int stages = 0;
    rec::Context context;
    context.observer.stage = [&](const std::string&) { ++stages; };
    const rec::Outcome outcome = rec::reconcile(scene, script, measured, settings, context);
    std::cout << rec::sentence(outcome) << '\n';
    for (const rec::Candidate& candidate : outcome.candidates) {
      if (!candidate.kept) std::cerr << candidate.score.hypothesis << ' ' << candidate.score.p_relative << '\n';
    }
    rec::write_report(argv[4], outcome, measured, script, settings, context,
                      {"own_analysis", argv[1], argv[2], argv[3]});
    return stages > 2 && outcome.location.cells.size() == scene.sensors.size() ? 0 : 1;
  } catch (const pirsim::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  }
}
