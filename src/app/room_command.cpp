#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <optional>
#include <utility>

#include "app/commands.hpp"
#include "app/session.hpp"
#include "dataset/recipe.hpp"
#include "dataset/room_reader.hpp"
#include "pirsim/room.hpp"

namespace pirsim::app {
namespace {

struct RoomOptions {
  std::filesystem::path recipe;  ///< or settings
  std::filesystem::path output;
  std::vector<std::string> settings;            ///< "width_m=6"
  std::map<std::string, std::string> as_typed;  ///< "--set width_m=6": "--width 6"
  std::optional<std::uint64_t> seed;            ///< default: the recipe's, or 1
  int number = 1;
  Inputs inputs;
};

dataset::RoomSpec room_by_settings(const RoomOptions& options) {
  try {
    Diagnostics faults;
    io::YamlMap map(io::YamlNode::parse("", "", options.settings), faults, "room");
    dataset::RoomSpec spec = dataset::read_room_keys(map);
    map.finish();
    faults.throw_if_errors(ErrorCode::usage);
    return spec;
  } catch (const Error& fault) {
    std::vector<Issue> issues = fault.issues();
    for (Issue& issue : issues) {
      const auto typed = options.as_typed.find(issue.where.file);
      if (typed != options.as_typed.end()) issue.where.file = typed->second;
    }
    throw Error(fault.code(), std::move(issues));
  }
}

std::vector<std::string> scenes_of(const dataset::RecipeSpec& recipe) {
  std::vector<std::string> files;
  for (const dataset::RoomGroupSpec& group : recipe.rooms) {
    for (const dataset::OwnScene& scene : group.scenes) {
      files.push_back(scene.file.string());
      if (!scene.marks.empty()) files.push_back(scene.marks.string());
    }
  }
  return files;
}

dataset::DrawnRoom draw(const RoomOptions& options) {
  const io::SceneOptions scenes = scene_options(options.inputs);
  if (options.recipe.empty())
    return dataset::draw_room(room_by_settings(options), options.seed.value_or(1), options.number, scenes);
  if (!options.settings.empty())
    throw Error(ErrorCode::usage, "a recipe says what its rooms are like: no other options");
  const dataset::RecipeSpec recipe = dataset::read_recipe(options.recipe);
  keep_inputs({{"-o", options.output}}, scenes_of(recipe));
  const dataset::RoomGroupSpec& group = dataset::group_of(recipe, options.number);
  if (!group.scenes.empty()) {
    throw Error(ErrorCode::usage, "--number: room " + std::to_string(options.number) + " is a file already: '" +
                                      dataset::own_scene(recipe, options.number)->file.string() + "'");
  }
  return dataset::draw_room(group.rooms, options.seed.value_or(recipe.seed), recipe.original_of(options.number),
                            scenes);
}

std::string listed(const std::vector<std::string>& ids) {
  std::string text;
  for (const std::string& id : ids) text += ' ' + id;
  return text;
}

void print(const dataset::DrawnRoom& room, const std::filesystem::path& file) {
  std::vector<std::string> sensors, seats;
  for (const SensorSpec& sensor : room.scene.sensors) sensors.push_back(sensor.id + " (" + sensor.model + ")");
  for (const SeatSpec& seat : room.scene.seats) seats.push_back(seat.id);
  std::cerr << "wrote " << file.string() << ": room " << room.number << ", " << room.width_m << " x " << room.depth_m
            << " x " << room.height_m << " m, floor " << std::fixed << std::setprecision(2)
            << room.scene.floor.area_m2() << " m2, doors " << room.scene.entrances.size() << ", seats" << listed(seats)
            << ", sensors" << listed(sensors) << "; found at try " << room.tries << '\n';
}

void make_room(const RoomOptions& options) {
  if (options.output.empty()) throw Error(ErrorCode::usage, "-o FILE is missing: room.gltf or room.glb");
  check_outputs({{"-o", options.output, {".gltf", ".glb"}}}, {});
  const dataset::DrawnRoom room = draw(options);
  io::write_scene(options.output, room.scene);
  if (options.inputs.verbosity != Verbosity::quiet) print(room, options.output);
}

/// An option that stands for a key of the room.
void offer_setting(CLI::App& command, RoomOptions& options, const std::string& name, const std::string& key,
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

}  // namespace

void add_room_command(CLI::App& app) {
  CLI::App& command = add_command(app, "room", "draw a parametric room and write it as glTF", R"(
  pirsim room -o room.gltf                                           a small office
  pirsim room --kind meeting --width 6 --depth 4.6 --seats 8 -o room.gltf
  pirsim room --width [5,8] --seats [2,6] --desks islands --number 3 -o room.gltf
  pirsim room recipe.yaml --number 3 -o room.gltf                    the third room of a dataset
  pirsim room --set "sensors=[{mount: corner, count: 2, model: EKMC1603111}]" -o room.gltf
)");
  const auto options = std::make_shared<RoomOptions>();
  as_input(command.add_option("RECIPE", options->recipe, "take the ranges of its rooms: docs/formats/dataset.md"));
  offer_setting(command, *options, "--kind", "kind", "KIND", "office or meeting (default: office)");
  offer_setting(command, *options, "--width", "width_m", "M", "along x: metres, or [least,most]");
  offer_setting(command, *options, "--depth", "depth_m", "M", "along -z");
  offer_setting(command, *options, "--height", "height_m", "M", "of the ceiling");
  offer_setting(command, *options, "--l-shaped", "l_shaped", "P", "probability that a far corner is missing");
  offer_setting(command, *options, "--doors", "doors", "N", "how many");
  offer_setting(command, *options, "--seats", "seats", "N", "desks, or chairs round the table: N or [least,most]");
  offer_setting(command, *options, "--desks", "desks", "WORD", "islands, rows or walls");
  offer_setting(command, *options, "--cupboards", "cupboards", "N", "how many, before walls");
  offer_setting(command, *options, "--partitions", "partitions", "N", "how many free-standing screens");
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [raw = options.get()](const std::vector<std::string>& given) {
            raw->settings.insert(raw->settings.end(), given.begin(), given.end());
          },
          "any other key of a room (docs/formats/dataset.md)")
      ->option_text("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--sensors", options->inputs.sensor_directories, "folder with sensor models, searched first")
      ->option_text("DIR")
      ->allow_extra_args(false);
  command.add_option("--seed", options->seed, "of all random streams (default: 1, or the recipe's)")
      ->option_text("N")
      ->check(is_seed());
  command.add_option("--number", options->number, "which room of this seed or recipe (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 1'000'000));
  offer_output(command, options->output, "FILE", "the room, .gltf or .glb");
  offer_quiet(command, options->inputs.verbosity);
  command.callback([options] { make_room(*options); });
}

}  // namespace pirsim::app
