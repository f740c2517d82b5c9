#include "app/dataset_command.hpp"

#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "files/write/campaign.hpp"
#include "model/core/text.hpp"
#include "rooms/recipe.hpp"

namespace pirsim::app {
namespace {

/// Tells stages and progress on standard error.
class DatasetTeller {
 public:
  explicit DatasetTeller(Verbosity verbosity) : verbosity_(verbosity) {}
  [[nodiscard]] dataset::DatasetObserver observer() {
    return {[this](Stage stage, std::uint32_t total) { progress_.emplace(work_of(stage, total), verbosity_); },
            [this] { progress_->finished(); }};
  }

 private:
  using Stage = dataset::DatasetObserver::Stage;
  static Work work_of(Stage stage, std::uint32_t total) {
    switch (stage) {
      case Stage::looking_for_days:
        return {"looking for what is there", total, "room-days"};
      case Stage::checking_rooms:
        return {"drawing and checking all rooms before the first day", total, "rooms"};
      case Stage::making_days:
        return {"simulating", total, "room-days"};
      case Stage::describing_rooms:
        break;
    }
    return {"describing", total, "rooms"};
  }

  Verbosity verbosity_;
  std::optional<Progress> progress_;
};

[[noreturn]] void stop_at(const StopRequest& stop, const std::string& what) {
  throw Error(ErrorCode::stopped, stop.signal_name() + ": stopped " + what);
}

void finish(const DatasetWork& work, const dataset::RecipeSpec& recipe, const dataset::DatasetOptions& options,
            const StopRequest& stop) {
  if (!dataset::finish_dataset(recipe, work.folder, options))
    stop_at(stop, "before the dataset was described; continue with --finish");
  tell_written(
      {{work.folder / "datapackage.json", counted(static_cast<std::size_t>(recipe.n_rooms()), "room") + ", " +
                                              counted(static_cast<std::size_t>(recipe.n_room_days()), "room-day")}},
      work.inputs.verbosity);
}

void make(const DatasetWork& work, const dataset::RecipeSpec& recipe, const dataset::DatasetOptions& options,
          const StopRequest& stop) {
  if (!dataset::make_room_days(recipe, work.folder, options))
    stop_at(stop, "at the end of a room-day; continue with --resume");
}

void tell_what_is_missing(const DatasetWork& work, const dataset::RecipeSpec& recipe,
                          const dataset::DatasetOptions& options) {
  if (work.inputs.verbosity == Verbosity::quiet) return;
  const std::size_t missing = dataset::missing_room_days(recipe, work.folder, options.scenes).size();
  if (missing == 0) {
    std::cerr << "all " << recipe.n_room_days() << " room-days are there: finish with --finish\n";
  } else {
    std::cerr << missing << " of " << recipe.n_room_days() << " room-days aren't there yet\n";
  }
}

}  // namespace

std::vector<std::filesystem::path> scenes_of(const dataset::RecipeSpec& recipe) {
  std::vector<std::filesystem::path> files;
  for (const dataset::RoomGroupSpec& group : recipe.rooms) {
    for (const dataset::OwnScene& scene : group.scenes) {
      files.push_back(scene.file);
      if (!scene.marks.empty()) files.push_back(scene.marks);
    }
  }
  return files;
}

dataset::RecipeSpec read_recipe(const std::filesystem::path& file, const DatasetWork& work) {
  const Progress progress({.what = "reading " + file.filename().string()}, work.inputs.verbosity);
  dataset::RecipeSpec recipe =
      dataset::read_recipe(found(io::DataKind::recipes, file), work.inputs.overrides, data_directories());
  keep_inputs(work.inputs, scenes_of(recipe));
  return recipe;
}

Whole make_dataset(const dataset::RecipeSpec& recipe, const DatasetWork& work, const StopRequest& stop) {
  DatasetTeller teller(work.inputs.verbosity);
  dataset::DatasetOptions options;
  options.scenes = scene_options(work.inputs);
  options.threads = work.threads;
  options.start = work.start;
  options.goes_on = [&] { return !stop.was_made(); };
  options.observer = teller.observer();
  options.tell = [&](const Issue& issue) { tell({issue}, work.inputs.verbosity); };
  if (!work.shard.empty()) options.shard = studies::parse_shard(work.shard);
  if (work.part == DatasetWork::Part::make) make(work, recipe, options, stop);
  if (work.part == DatasetWork::Part::finish || work.shard.empty()) {
    finish(work, recipe, options, stop);
    return Whole::yes;
  }
  tell_what_is_missing(work, recipe, options);
  return Whole::no;
}

std::vector<std::string> dataset_contents() {
  std::vector<std::string> contents{dataset::dataset_parts.begin(), dataset::dataset_parts.end()};
  contents.insert(contents.end(), {"provenance.txt", "*.journal"});
  return contents;
}

void offer_dataset_work(CLI::App& command, const std::shared_ptr<DatasetWork>& work) {
  command.add_option("--shard", work->shard, "only the I-th of N parts, or auto/N from the job array")
      ->option_text("I/N");
  offer_changes(command, work->inputs, "recipe");
  offer_threads(command, work->threads);
}

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
