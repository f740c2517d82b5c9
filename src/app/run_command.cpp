#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "app/study_run.hpp"
#include "effects/catalogue.hpp"

namespace pirsim::app {
namespace {

void print_config(const Inputs& inputs) {
  const ScriptSpec script = read_script(inputs);
  Diagnostics diagnostics;
  effects::check(script.effects, diagnostics);
  diagnostics.throw_if_errors();
  std::cout << io::to_yaml(script);
  require_written();
}

void offer_run(CLI::App& command) {
  enum class Action { run, print_config };
  const auto inputs = std::make_shared<Inputs>();
  const auto options = std::make_shared<RunOptions>();
  const auto action = std::make_shared<Action>(Action::run);
  offer_study(command, *inputs);
  offer_verbose(command, inputs->verbosity);
  offer_tracer(command, *inputs);
  offer_seed(command, *inputs);
  offer_replicates(command, *inputs);
  offer_run_options(command, options);
  command.add_flag_callback(
      "--print-config", [action] { *action = Action::print_config; }, "print the resolved script and stop");
  on_call(command, inputs, [options, action](const Inputs& given) {
    if (*action == Action::print_config) return print_config(given);
    check_options(*options);
    run(load(given), given, *options);
  });
}

constexpr const char* examples = R"(
  pirsim run --scene room.gltf --script study.yaml                 rows of the whole study as CSV on stdout
  pirsim run --scene room.gltf --script study.yaml -o rows.csv --summary table.md
  pirsim run --scene room.gltf --script study.yaml --replicates 20 --set people.0.stature_m=1.7
  pirsim run --scene room.gltf --script study.yaml --shard 3/100 -o out   a block of the runs; then pirsim status, merge
)";

}  // namespace

void add_run_command(CLI::App& app) {
  offer_run(app);  // the default
  offer_run(add_command(app, "run", "run the study (the default)", examples));
}

}  // namespace pirsim::app
