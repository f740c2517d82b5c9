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
                        const Folders& folders, bool resume, unsigned threads, nb::handle progress) {
  const dataset::RecipeSpec spec = dataset::read_recipe(recipe, set, folders.data_directories);
  dataset::DatasetOptions options;
  options.scenes = folders;
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

nb::object room(const std::string& recipe, int number, const Folders& folders) {
  const dataset::RecipeSpec spec = dataset::read_recipe(recipe, {}, folders.data_directories);
  if (number < 1 || number > spec.n_rooms())
    throw nb::index_error(
        ("room " + std::to_string(number) + ": the recipe has rooms 1 to " + std::to_string(spec.n_rooms())).c_str());
  return to_python(dataset::room_of(spec, number, folders));
}

}  // namespace

void add_dataset(nb::module_& module) {
  module.def("dataset", &make_dataset, "recipe"_a, "folder"_a, "set"_a, "folders"_a, "resume"_a, "threads"_a,
             "progress"_a.none(), "Diagnostics.");
  module.def("room", &room, "recipe"_a, "number"_a, "folders"_a, "A pirsim.Scene.");
}

}  // namespace pirsim::python
