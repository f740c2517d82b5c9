#include "app/commands.hpp"
#include "app/dataset_work.hpp"

namespace pirsim::app {

void add_dataset_command(CLI::App& app) {
  CLI::App& command = add_command(app, "dataset", "make a dataset of many rooms and days from a recipe", R"(
  pirsim dataset recipe.yaml -o DIR                       rows, datapackage.json, README.md, pictures
  pirsim dataset recipe.yaml -o DIR --resume              continue where it was stopped
  pirsim dataset recipe.yaml -o DIR --shard 3/100         one part of a job array ...
  pirsim dataset recipe.yaml -o DIR --finish              ... and when all are through
  pirsim dataset recipe.yaml -o DIR --response zones      as 0.1 made it; so must --resume and --finish say
)");
  const auto work = std::make_shared<DatasetWork>();
  const auto file = std::make_shared<std::filesystem::path>();
  offer_input_file(command, "RECIPE", *file, "what the rooms, people and days are like: a YAML file")->required();
  offer_output_folder(command, output_names, work->folder, "folder of the dataset", dataset_contents());
  command.add_flag_callback(
      "--resume", [work] { work->start = dataset::DatasetOptions::Start::resume; },
      "keep the room-days that are there (without it, all are made anew)");
  command.add_flag_callback(
      "--finish", [work] { work->part = DatasetWork::Part::finish; },
      "only describe what is there: tables, datapackage.json, README.md");
  offer_dataset_work(command, work);
  command.callback([file, work] {
    if (work->folder.empty()) throw Error(ErrorCode::usage, "-o DIR is missing");
    const dataset::RecipeSpec recipe = read_recipe(*file, *work);
    const StopRequest stop;  // of all phases: the last one takes minutes too
    static_cast<void>(make_dataset(recipe, *work, stop));
  });
}

}  // namespace pirsim::app
