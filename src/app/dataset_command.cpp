#include <iostream>
#include <optional>

#include "app/commands.hpp"
#include "app/long_work.hpp"
#include "app/session.hpp"
#include "pirsim/dataset.hpp"
#include "studies/campaign.hpp"

namespace pirsim::app {
namespace {

struct DatasetCommand {
  std::filesystem::path recipe, folder;
  std::string shard;
  enum class Work { make, finish } work = Work::make;
  dataset::DatasetOptions::Start start = dataset::DatasetOptions::Start::anew;
  unsigned threads = 0;
  Inputs inputs;
};

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

void finish(const DatasetCommand& command, const dataset::RecipeSpec& recipe, const dataset::DatasetOptions& options,
            const StopRequest& stop) {
  if (!dataset::finish_dataset(recipe, command.folder, options))
    stop_at(stop, "before the dataset was described; continue with --finish");
  if (command.inputs.verbosity != Verbosity::quiet)
    std::cerr << "wrote " << (command.folder / "datapackage.json").string() << ": " << recipe.n_rooms() << " rooms, "
              << recipe.n_room_days() << " room-days\n";
}

void make(const DatasetCommand& command, const dataset::RecipeSpec& recipe, const dataset::DatasetOptions& options,
          const StopRequest& stop) {
  if (!dataset::make_room_days(recipe, command.folder, options))
    stop_at(stop, "at the end of a room-day; continue with --resume");
}

void tell_what_is_missing(const DatasetCommand& command, const dataset::RecipeSpec& recipe,
                          const dataset::DatasetOptions& options) {
  if (command.inputs.verbosity == Verbosity::quiet) return;
  const std::size_t missing = dataset::missing_room_days(recipe, command.folder, options.scenes).size();
  if (missing == 0) {
    std::cerr << "all " << recipe.n_room_days() << " room-days are there: finish with --finish\n";
  } else {
    std::cerr << missing << " of " << recipe.n_room_days() << " room-days aren't there yet\n";
  }
}

void run(const DatasetCommand& command) {
  if (command.folder.empty()) throw Error(ErrorCode::usage, "-o DIR is missing");
  const dataset::RecipeSpec recipe = [&] {
    const Progress progress({.what = "reading " + command.recipe.filename().string()}, command.inputs.verbosity);
    return dataset::read_recipe(command.recipe, command.inputs.overrides);
  }();
  const StopRequest stop;  // of all phases: the last one takes minutes too
  DatasetTeller teller(command.inputs.verbosity);
  dataset::DatasetOptions options;
  options.scenes = scene_options(command.inputs);
  options.threads = command.threads;
  options.start = command.start;
  options.goes_on = [&] { return !stop.was_made(); };
  options.observer = teller.observer();
  options.tell = [&](const Issue& issue) { tell({issue}, command.inputs.verbosity); };
  if (!command.shard.empty()) options.shard = studies::parse_shard(command.shard);
  if (command.work == DatasetCommand::Work::make) make(command, recipe, options, stop);
  if (command.work == DatasetCommand::Work::finish || command.shard.empty())
    return finish(command, recipe, options, stop);
  tell_what_is_missing(command, recipe, options);
}

}  // namespace

void add_dataset_command(CLI::App& app) {
  CLI::App& command = add_command(app, "dataset", "make a dataset of many rooms and days from a recipe", R"(
  pirsim dataset recipe.yaml -o DIR                       rows, datapackage.json, README.md, pictures
  pirsim dataset recipe.yaml -o DIR --resume              continue where it was stopped
  pirsim dataset recipe.yaml -o DIR --shard 3/100         one part of a job array ...
  pirsim dataset recipe.yaml -o DIR --finish              ... and when all are through
  pirsim dataset recipe.yaml -o DIR --response zones      as 0.1 made it; so must --resume and --finish say
)");
  const auto options = std::make_shared<DatasetCommand>();
  as_input(command.add_option("RECIPE", options->recipe, "what the rooms, people and days are like: a YAML file"))
      ->required();
  offer_output(command, options->folder, "DIR", "folder of the dataset");
  command.add_option("--shard", options->shard, "only the I-th of N parts, or auto/N from the job array")
      ->option_text("I/N");
  command.add_flag_callback(
      "--resume", [raw = options.get()] { raw->start = dataset::DatasetOptions::Start::resume; },
      "keep the room-days that are there (without it, all are made anew)");
  command.add_flag_callback(
      "--finish", [raw = options.get()] { raw->work = DatasetCommand::Work::finish; },
      "only describe what is there: tables, datapackage.json, README.md");
  offer_changes(command, options->inputs, "recipe");
  offer_threads(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace pirsim::app
