#include "app/drawn_scene.hpp"

#include "app/dataset_work.hpp"
#include "app/session.hpp"
#include "dataset/recipe.hpp"

namespace pirsim::app {
void offer_setting(CLI::App& command, DrawOptions& options, const std::string& name, const std::string& key,
                   const std::string& value, const std::string& what) {
  command
      .add_option_function<std::string>(
          name,
          [&options, name, key](const std::string& text) {
            options.settings.push_back(key + "=" + text);
            options.as_typed["--set " + key + "=" + text] = name + " " + text;
          },
          what)
      ->option_text(value);
}

void offer_drawing(CLI::App& command, DrawOptions& options, const std::string& what) {
  offer_input_file(command, "RECIPE", options.recipe, "take the ranges of its rooms: docs/formats/dataset.md");
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&options](const std::vector<std::string>& given) {
            options.settings.insert(options.settings.end(), given.begin(), given.end());
          },
          "any other key of a " + what + " (docs/formats/dataset.md)")
      ->option_text("KEY=VALUE")
      ->allow_extra_args(false);
  offer_sensors(command, options.inputs);
  command.add_option("--seed", options.seed, "of all random streams (default: 1, or the recipe's)")
      ->option_text("N")
      ->check(is_seed());
  command.add_option("--number", options.number, "which " + what + " of this seed or recipe (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 1'000'000));
  offer_output(command, output_names, options.output, "the " + what + ", .gltf or .glb", {".gltf", ".glb"});
  offer_quiet(command, options.inputs.verbosity);
}

void read_settings(const DrawOptions& options, const std::string& what, const std::function<void(io::YamlMap&)>& read) {
  try {
    Diagnostics faults;
    io::YamlMap map(io::YamlNode::parse("", "", options.settings), faults, what);
    read(map);
    map.finish();
    faults.throw_if_errors(ErrorCode::usage);
  } catch (const Error& fault) {
    std::vector<Issue> issues = fault.issues();
    for (Issue& issue : issues) {
      const auto typed = options.as_typed.find(issue.where.file);
      if (typed != options.as_typed.end()) issue.where.file = typed->second;
    }
    throw Error(fault.code(), std::move(issues));
  }
}

dataset::RecipeSpec recipe_to_draw_from(const DrawOptions& options) {
  if (!options.settings.empty())
    throw Error(ErrorCode::usage, "a recipe says what its rooms are like: no other options");
  dataset::RecipeSpec recipe =
      dataset::read_recipe(found(io::DataKind::recipes, options.recipe), {}, data_directories());
  keep_inputs(options.inputs, scenes_of(recipe));
  if (!dataset::group_of(recipe, options.number).scenes.empty()) {
    throw Error(ErrorCode::usage, "--number: room " + std::to_string(options.number) + " is a file already: '" +
                                      dataset::own_scene(recipe, options.number)->file.string() + "'");
  }
  return recipe;
}

void check_scene_output(const DrawOptions& options, const std::string& example) {
  if (options.output.empty())
    throw Error(ErrorCode::usage, "-o FILE is missing: " + example + ".gltf or " + example + ".glb");
}

std::string listed(const std::vector<std::string>& ids) {
  std::string text;
  for (const std::string& id : ids) text += ' ' + id;
  return text;
}

std::string listed(const std::vector<SensorSpec>& sensors) {
  std::string text;
  for (const SensorSpec& sensor : sensors) text += ' ' + sensor.id + " (" + sensor.model + ")";
  return text;
}

}  // namespace pirsim::app
