// The parts of the module pirsim._core; what users call is python/pirsim/*.py.
#pragma once

#include <nanobind/nanobind.h>

#include <pirsim/pirsim.hpp>
#include <string>
#include <vector>

namespace pirsim::python {

using namespace nanobind::literals;

void add_inputs(nanobind::module_& module);
void add_study(nanobind::module_& module);
void add_surveys(nanobind::module_& module);
void add_dataset(nanobind::module_& module);
void add_reconcile(nanobind::module_& module);
void add_logs(nanobind::module_& module);

/// Where sensor models of a scene are looked for: in the user's folders first, in the shipped data last.
using Folders = io::SceneOptions;
/// A file is read, an object of pirsim.specs is converted and checked.
[[nodiscard]] SceneSpec scene_of(nanobind::handle scene, const Folders& folders);
[[nodiscard]] ScriptSpec script_of(nanobind::handle script, const std::vector<std::string>& overrides,
                                   const Folders& folders);

}  // namespace pirsim::python
