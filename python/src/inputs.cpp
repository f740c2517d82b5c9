// Reading files to objects of pirsim.specs, and writing scripts.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

/// The default value of each spec, by its name in Python: what a dataclass without arguments must equal.
nb::dict defaults() {
  nb::dict all;
  const auto add = [&]<typename... Spec>(std::tuple<Spec...>*) {
    ((all[Fields<Spec>::name] =
          [] {
            nb::dict fields;
            Convert<Spec>::add(Spec{}, fields);
            return fields;
          }()),
     ...);
  };
  add(static_cast<SpecsOfPython*>(nullptr));
  return all;
}

std::string find_file(const std::string& file, const std::string& kind,
                      const std::vector<std::filesystem::path>& data) {
  for (const auto known : {io::DataKind::rooms, io::DataKind::plans, io::DataKind::studies, io::DataKind::recipes,
                           io::DataKind::sensors, io::DataKind::measured}) {
    if (io::folder_of(known) == kind) return io::find_file(file, known, data).string();
  }
  throw nb::value_error("kind: not a folder of the data");
}

nb::list catalogue() {
  nb::list all;
  for (const effects::EffectInfo& info : effects::list()) {
    nb::list parameters;
    for (const effects::ParameterInfo& p : info.parameters) {
      parameters.append(nb::make_tuple(p.name, p.unit, p.off, p.typical, p.least, p.most, p.source));
    }
    nb::list choices;
    for (const effects::ChoiceInfo& choice : info.choices) choices.append(choice.name);
    all.append(nb::make_tuple(info.name, std::string(effects::name(info.family)), info.summary, to_python(info.reach),
                              parameters, choices));
  }
  return all;
}

}  // namespace

SceneSpec scene_of(nb::handle scene, const Folders& folders) {
  const bool has_marks = nb::isinstance<nb::tuple>(scene);
  if (!has_marks && !nb::isinstance<nb::str>(scene)) return checked_scene(scene);
  const auto file = nb::cast<std::string>(has_marks ? nb::object(scene[0]) : nb::borrow(scene));
  Folders options = folders;
  if (has_marks) options.marks = nb::cast<std::string>(scene[1]);
  nb::gil_scoped_release release;
  return io::read_scene(file, options);
}

ScriptSpec script_of(nb::handle script, const std::vector<std::string>& overrides, const Folders& folders) {
  if (!nb::isinstance<nb::str>(script)) return checked_script(script);
  const auto file = nb::cast<std::string>(script);
  nb::gil_scoped_release release;
  return io::read_script(file, overrides, folders.data_directories);
}

void add_inputs(nb::module_& module) {
  nb::class_<Folders>(module, "Folders", "Where sensor models of a scene are looked for first, and last.")
      .def(nb::init<std::vector<std::filesystem::path>, std::vector<std::filesystem::path>>(), "sensors"_a, "data"_a);
  nb::class_<MeshSolid>(module, "MeshSolid", "A body part's mesh, as read_script() read it.");
  module.def(
      "read_scene", [](nb::handle file, const Folders& folders) { return to_python(scene_of(file, folders)); },
      "file"_a, "folders"_a, "A pirsim.Scene.");
  module.def(
      "read_script",
      [](const std::string& file, const std::vector<std::string>& overrides, const Folders& folders) {
        return to_python(script_of(nb::cast(file), overrides, folders));
      },
      "file"_a, "overrides"_a, "folders"_a, "A pirsim.Script.");
  module.def("find_file", &find_file, "file"_a, "kind"_a, "data"_a, "The file, or the shipped one of that name.");
  module.def(
      "read_sensor_model", [](const std::string& file) { return to_python(io::read_sensor_model(file)); }, "file"_a,
      "A pirsim.SensorModel.");
  module.def(
      "find_sensor_model",
      [](const std::string& model, const Folders& folders) {
        return to_python(io::find_sensor_model(model, {}, folders));
      },
      "model"_a, "folders"_a, "A pirsim.SensorModel.");
  module.def(
      "to_yaml", [](nb::handle script) { return io::to_yaml(from_python<ScriptSpec>(script, "script")); }, "script"_a,
      "The text of a script file.");
  module.def(
      "write_scene", [](nb::handle scene, const std::string& file) { io::write_scene(file, checked_scene(scene)); },
      "scene"_a, "file"_a, "As glTF.");
  module.def(
      "mounted",
      [](nb::handle position, double yaw_deg, double tilt_deg) {
        return to_python(mounted(from_python<Vec3>(position, "position"), yaw_deg, tilt_deg));
      },
      "position"_a, "yaw_deg"_a, "tilt_deg"_a, "A pirsim.Frame.");
  module.def("catalogue", &catalogue, "Entries of pirsim.effects().");
  module.def("defaults", &defaults, "Fields and default values of every spec, by the name of its class.");
}

}  // namespace pirsim::python
