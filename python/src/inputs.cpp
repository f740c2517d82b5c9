// Reading files to objects of pirsim.specs, and writing scripts.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

template <typename Spec>
nb::object default_of() {
  return to_python(Spec{});
}

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

std::string find_file(const std::string& file, const std::string& kind, const std::vector<std::string>& data) {
  const std::vector<std::filesystem::path> folders(data.begin(), data.end());
  for (const auto known : {io::DataKind::rooms, io::DataKind::studies, io::DataKind::recipes, io::DataKind::sensors,
                           io::DataKind::measured}) {
    if (io::folder_of(known) == kind) return io::find_file(file, known, folders).string();
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

std::vector<std::filesystem::path> folders_of(const std::vector<std::string>& folders) {
  return {folders.begin(), folders.end()};
}

io::SceneOptions options_of(const Folders& folders) { return {folders_of(folders.sensors), folders_of(folders.data)}; }

SceneSpec scene_of(nb::handle scene, const Folders& folders) {
  const bool has_marks = nb::isinstance<nb::tuple>(scene);
  if (!has_marks && !nb::isinstance<nb::str>(scene)) return checked_scene(scene);
  const auto file = nb::cast<std::string>(has_marks ? nb::object(scene[0]) : nb::borrow(scene));
  io::SceneOptions options = options_of(folders);
  if (has_marks) options.marks = nb::cast<std::string>(scene[1]);
  nb::gil_scoped_release release;
  return io::read_scene(file, options);
}

ScriptSpec script_of(nb::handle script, const std::vector<std::string>& overrides,
                     const std::vector<std::string>& data) {
  if (!nb::isinstance<nb::str>(script)) return checked_script(script);
  const auto file = nb::cast<std::string>(script);
  const std::vector<std::filesystem::path> folders = folders_of(data);
  nb::gil_scoped_release release;
  return io::read_script(file, overrides, folders);
}

void add_inputs(nb::module_& module) {
  nb::class_<MeshSolid>(module, "MeshSolid", "A body part's mesh, as read_script() read it.");
  module.def(
      "read_scene",
      [](nb::handle file, std::vector<std::string> sensors, std::vector<std::string> data) {
        return to_python(scene_of(file, {std::move(sensors), std::move(data)}));
      },
      nb::arg("file"), nb::arg("sensors"), nb::arg("data"), "A pirsim.Scene.");
  module.def(
      "read_script",
      [](const std::string& file, const std::vector<std::string>& overrides, const std::vector<std::string>& data) {
        return to_python(script_of(nb::cast(file), overrides, data));
      },
      nb::arg("file"), nb::arg("overrides"), nb::arg("data"), "A pirsim.Script.");
  module.def("find_file", &find_file, nb::arg("file"), nb::arg("kind"), nb::arg("data"),
             "The file, or the shipped one of that name.");
  module.def(
      "read_sensor_model", [](const std::string& file) { return to_python(io::read_sensor_model(file)); },
      nb::arg("file"), "A pirsim.SensorModel.");
  module.def(
      "find_sensor_model",
      [](const std::string& model, std::vector<std::string> sensors, std::vector<std::string> data) {
        return to_python(io::find_sensor_model(model, {}, options_of({std::move(sensors), std::move(data)})));
      },
      nb::arg("model"), nb::arg("sensors"), nb::arg("data"), "A pirsim.SensorModel.");
  module.def(
      "to_yaml", [](nb::handle script) { return io::to_yaml(from_python<ScriptSpec>(script, "script")); },
      nb::arg("script"), "The text of a script file.");
  module.def(
      "write_scene", [](nb::handle scene, const std::string& file) { io::write_scene(file, checked_scene(scene)); },
      nb::arg("scene"), nb::arg("file"), "As glTF.");
  module.def(
      "mounted",
      [](nb::handle position, double yaw_deg, double tilt_deg) {
        return to_python(mounted(from_python<Vec3>(position, "position"), yaw_deg, tilt_deg));
      },
      nb::arg("position"), nb::arg("yaw_deg"), nb::arg("tilt_deg"), "A pirsim.Frame.");
  module.def("catalogue", &catalogue, "Entries of pirsim.effects().");
  module.def("defaults", &defaults, "Fields and default values of every spec, by the name of its class.");
}

}  // namespace pirsim::python
