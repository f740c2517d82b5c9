#include <iostream>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "pirsim/look.hpp"

namespace pirsim::app {
namespace {

void check(const Inputs& inputs) {
  // Warnings are what a check is made for: --quiet leaves out only the report.
  Inputs with_warnings = inputs;
  with_warnings.verbosity = Verbosity::normal;
  const Model model = load(with_warnings, inputs.verbosity);
  const CheckReport report = [&] {
    const Progress progress({.what = "looking at what sensors see"}, inputs.verbosity);
    return check_study(model);
  }();
  if (inputs.verbosity != Verbosity::quiet) std::cout << report.text;
  require_written();
  tell(report.warnings, Verbosity::normal);  // last, where a terminal shows them
}

}  // namespace

void add_check_command(CLI::App& app) {
  CLI::App& command = add_command(app, "check", "validate scene and script without running them", R"(
  pirsim check --scene room.gltf --script study.yaml               validate, and report what each sensor can see
  pirsim check --scene room.gltf --script study.yaml -q            only faults and warnings
)");
  const auto inputs = std::make_shared<Inputs>();
  offer_study(command, *inputs);
  offer_tracer(command, *inputs);
  offer_replicates(command, *inputs);
  on_call(command, inputs, check);
}

}  // namespace pirsim::app
