// Making a dataset, or a shard of it: what `dataset` and `calibrate` share.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/long_work.hpp"
#include "app/options.hpp"
#include "pirsim/dataset.hpp"

namespace pirsim::app {

struct DatasetWork {
  std::filesystem::path folder;
  std::string shard;
  enum class Part { make, finish } part = Part::make;
  dataset::DatasetOptions::Start start = dataset::DatasetOptions::Start::anew;
  unsigned threads = 0;
  Inputs inputs;
};

/// What a dataset's folder holds, but for recipe.yaml: that is the recipe's text, and never written over.
[[nodiscard]] std::vector<std::string> dataset_contents();
/// --shard, --threads, --set, --response, --sensors and --quiet.
void offer_dataset_work(CLI::App& command, const std::shared_ptr<DatasetWork>& work);

/// The user's own scenes, with their marks.
[[nodiscard]] std::vector<std::filesystem::path> scenes_of(const dataset::RecipeSpec& recipe);
/// Throws as dataset::read_recipe(), and Error(usage) for an output in the place of a scene that it names.
[[nodiscard]] dataset::RecipeSpec read_recipe(const std::filesystem::path& file, const DatasetWork& work);

enum class Whole { yes, no };
/// Makes what is asked for, and describes the dataset if that is all. Throws Error(stopped) when it was stopped.
Whole make_dataset(const dataset::RecipeSpec& recipe, const DatasetWork& work, const StopRequest& stop);

}  // namespace pirsim::app
