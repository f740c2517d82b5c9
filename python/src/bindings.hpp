// The parts of the module pirsim._core; what users call is python/pirsim/*.py.
#pragma once

#include <nanobind/nanobind.h>

#include <filesystem>
#include <pirsim/pirsim.hpp>
#include <string>
#include <vector>

namespace pirsim::python {

void add_errors(nanobind::module_& module);
void add_inputs(nanobind::module_& module);
void add_study(nanobind::module_& module);
void add_surveys(nanobind::module_& module);
void add_look(nanobind::module_& module);
void add_log(nanobind::module_& module);
void add_dataset(nanobind::module_& module);
void add_reconcile(nanobind::module_& module);
void add_counting(nanobind::module_& module);
void add_control(nanobind::module_& module);

/// Where sensor models of a scene are looked for.
struct Folders {
  std::vector<std::string> sensors, data;
};
[[nodiscard]] std::vector<std::filesystem::path> folders_of(const std::vector<std::string>& folders);
[[nodiscard]] io::SceneOptions options_of(const Folders& folders);
/// A file is read, an object of pirsim.specs is converted and checked.
[[nodiscard]] SceneSpec scene_of(nanobind::handle scene, const Folders& folders);
[[nodiscard]] ScriptSpec script_of(nanobind::handle script, const std::vector<std::string>& overrides,
                                   const std::vector<std::string>& data);

}  // namespace pirsim::python
