// Datasets of many rooms and days.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <pirsim/dataset.hpp>

#include "attend.hpp"
#include "bindings.hpp"
#include "convert.hpp"

namespace pirsim::python {
namespace {

nb::object make_dataset(const std::string& recipe, const std::string& folder, const std::vector<std::string>& set,
                        std::vector<std::string> sensors, std::vector<std::string> data, bool resume, unsigned threads,
                        nb::handle progress) {
  const dataset::RecipeSpec spec = dataset::read_recipe(recipe, set, folders_of(data));
  dataset::DatasetOptions options;
  options.scenes = options_of({std::move(sensors), std::move(data)});
  options.threads = threads;
  options.start = resume ? dataset::DatasetOptions::Start::resume : dataset::DatasetOptions::Start::anew;
  std::vector<Issue> told;
  options.tell = [&](const Issue& issue) { told.push_back(issue); };
  attend(progress, [&](Job& job) {
    using Stage = dataset::DatasetObserver::Stage;
    Stage stage = Stage::looking_for_days;
    options.goes_on = [&] { return !job.stop; };
    options.observer.begin = [&](Stage begun, std::uint32_t total) {
      stage = begun;
      if (stage == Stage::making_days) job.n_all = total;
    };
    options.observer.done_one = [&] { job.n_done += stage == Stage::making_days ? 1 : 0; };
    if (dataset::make_room_days(spec, folder, options)) dataset::finish_dataset(spec, folder, options);
  });
  return to_python(told);
}

nb::object room(const std::string& recipe, int number, std::vector<std::string> sensors,
                std::vector<std::string> data) {
  const dataset::RecipeSpec spec = dataset::read_recipe(recipe, {}, folders_of(data));
  if (number < 1 || number > spec.n_rooms())
    throw nb::index_error(
        ("room " + std::to_string(number) + ": the recipe has rooms 1 to " + std::to_string(spec.n_rooms())).c_str());
  return to_python(dataset::room_of(spec, number, options_of({std::move(sensors), std::move(data)})));
}

}  // namespace

void add_dataset(nb::module_& module) {
  module.def("dataset", &make_dataset, nb::arg("recipe"), nb::arg("folder"), nb::arg("set"), nb::arg("sensors"),
             nb::arg("data"), nb::arg("resume"), nb::arg("threads"), nb::arg("progress").none(), "Diagnostics.");
  module.def("room", &room, nb::arg("recipe"), nb::arg("number"), nb::arg("sensors"), nb::arg("data"),
             "A pirsim.Scene.");
}

}  // namespace pirsim::python
