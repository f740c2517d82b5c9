#include <algorithm>
#include <iomanip>
#include <iostream>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "sim/compiled_study.hpp"
#include "studies/room_plan.hpp"
#include "studies/schedule_outlook.hpp"
#include "studies/sight.hpp"

namespace pirsim::app {
namespace {

void print(std::ostream& out, const Model& model, const studies::SightReport& report) {
  const SceneSpec& scene = model.compiled().scene();
  const auto percent = [&](std::size_t places) {
    return report.places == 0 ? 0.0 : 100.0 * static_cast<double>(places) / static_cast<double>(report.places);
  };
  out << scene.name << ": " << scene.meshes.size() << " meshes, " << scene.sensors.size() << " sensors, "
      << scene.seats.size() << " seats, " << scene.entrances.size() << " entrances, floor " << std::fixed
      << std::setprecision(2) << scene.floor.area_m2() << " m2\n";
  out << model.script().name << ": " << model.script().trials.size() << " trials x " << model.script().replicates
      << " replicates = " << model.n_runs() << " runs\n\n";
  if (!model.script().trials.empty() && model.script().trials.front().schedule) {
    studies::print(out, studies::outlook(model.compiled(), 0), model.compiled());
  }
  out << "what each sensor sees of a person standing on one of " << report.places << " places (every "
      << report.spacing_m << " m), and seated at rest:\n";
  for (const studies::SensorSight& sight : report.sensors) {
    out << "  " << std::left << std::setw(8) << sight.sensor << std::right << std::setw(5) << sight.rays << " rays, "
        << std::setw(4) << sight.rays_cut << " end at the room, longest " << std::setw(5) << sight.longest_m
        << " m; floor " << std::setw(5) << std::setprecision(1) << percent(sight.places) << std::setprecision(2)
        << " %; seats";
    if (sight.seats.empty()) out << " none";
    for (const std::string& seat : sight.seats) out << ' ' << seat;
    out << '\n';
  }
  out << "  any sensor: floor " << std::setprecision(1) << percent(report.places_seen_by_any) << " %\n";
  const auto is_floor = [&](const TriMesh& mesh) {
    return studies::role_of(mesh, scene.floor.height_m()) == studies::MeshRole::floor;
  };
  if (std::ranges::none_of(scene.meshes, is_floor)) {
    out << "  no ray ends at the floor: it has no mesh that occludes, only an outline\n";
  }
}

void check(const Inputs& inputs) {
  // Warnings are what a check is made for: --quiet leaves out only the report.
  Inputs with_warnings = inputs;
  with_warnings.verbosity = Verbosity::normal;
  const Model model = load(with_warnings);
  const studies::SightReport report = studies::look_around(model);
  tell(studies::warnings(report, model.scene().name), Verbosity::normal);
  if (inputs.verbosity != Verbosity::quiet) print(std::cout, model, report);
  require_written();
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
