#include <iomanip>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "app/commands.hpp"
#include "app/dataset_command.hpp"
#include "app/session.hpp"
#include "files/read/yaml.hpp"
#include "model/core/text.hpp"
#include "pirsim/flat.hpp"
#include "pirsim/room.hpp"
#include "rooms/recipe.hpp"

namespace pirsim::app {
namespace {

struct DrawOptions {
  enum class What { room, home } what = What::room;
  std::filesystem::path recipe;  ///< or settings
  std::filesystem::path plan;    ///< or that
  std::filesystem::path output;
  std::vector<std::string> settings;            ///< "width_m=6"
  std::map<std::string, std::string> as_typed;  ///< "--set width_m=6": "--width 6"
  std::optional<std::uint64_t> seed;            ///< default: the recipe's, or 1
  int number = 1;
  Inputs inputs;
};

/// Reads the settings as a map of keys; faults name the options as they were typed.
template <typename Spec>
Spec read_settings(const DrawOptions& options, const std::string& what, Spec (&read)(io::YamlMap&)) {
  try {
    Diagnostics faults;
    io::YamlMap map(io::YamlNode::parse("", "", options.settings), faults, what);
    Spec spec = read(map);
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

/// The recipe, which goes without settings. Throws Error(usage) if the output is one of its inputs, and if the room of
/// that number is a file.
dataset::RecipeSpec recipe_to_draw_from(const DrawOptions& options) {
  if (!options.settings.empty())
    throw Error(ErrorCode::usage, "a recipe says what its rooms are like: no other options");
  dataset::RecipeSpec recipe =
      dataset::read_recipe(found(io::DataKind::recipes, options.recipe), {}, data_directories());
  keep_inputs(options.inputs, scenes_of(recipe));
  const dataset::RoomGroupSpec& group = dataset::group_of(recipe, options.number);
  const std::string room = "room " + std::to_string(options.number) + " of the recipe";
  if (!group.scenes.empty()) {
    throw Error(ErrorCode::usage, "--number: " + room + " is a file already: '" +
                                      dataset::own_scene(recipe, options.number)->file.string() + "'");
  }
  if (options.what == DrawOptions::What::home && !group.home)
    throw Error(ErrorCode::usage, "--number: " + room + " isn't a home: it is drawn without --home");
  return recipe;
}

/// " a b c"
std::string listed(const std::vector<std::string>& ids) {
  std::string text;
  for (const std::string& id : ids) text += ' ' + id;
  return text;
}

/// " PIR1 (EKMC1601111)", one behind the other.
std::string listed(const std::vector<SensorSpec>& sensors) {
  std::string text;
  for (const SensorSpec& sensor : sensors) text += ' ' + sensor.id + " (" + sensor.model + ")";
  return text;
}

/// A room or a flat.
template <typename Drawn>
void begin_about(std::ostream& text, const char* what, const Drawn& drawn) {
  text << what << ' ' << drawn.number << ", " << drawn.width_m << " x " << drawn.depth_m << " x " << drawn.height_m
       << " m, floor " << std::fixed << std::setprecision(2) << drawn.scene.floor.area_m2() << " m2, ";
}

std::string about(const dataset::DrawnRoom& room) {
  std::ostringstream text;
  std::vector<std::string> seats;
  for (const SeatSpec& seat : room.scene.seats) seats.push_back(seat.id);
  begin_about(text, "room", room);
  text << "doors " << room.scene.entrances.size() << ", seats" << listed(seats) << ", sensors"
       << listed(room.scene.sensors) << "; found at try " << room.tries;
  return std::move(text).str();
}

std::string about(const dataset::DrawnFlat& flat) {
  std::ostringstream text;
  std::vector<std::string> rooms, doors;
  for (const dataset::FlatRoom& room : flat.rooms) rooms.push_back(room.id);
  for (const DoorSpec& door : flat.scene.doors) doors.push_back(door.id);
  begin_about(text, "flat", flat);
  text << "for " << counted(static_cast<std::size_t>(flat.residents), "resident") << ", rooms" << listed(rooms)
       << ", doors" << listed(doors) << ", sensors" << listed(flat.scene.sensors) << "; found at try " << flat.tries;
  return std::move(text).str();
}

template <typename Drawn>
void write(const DrawOptions& options, const Drawn& drawn) {
  io::write_scene(options.output, drawn.scene);
  tell_written({{options.output, about(drawn)}}, options.inputs.verbosity);
}

void draw(const DrawOptions& options) {
  if (options.output.empty()) throw Error(ErrorCode::usage, "-o FILE is missing: room.gltf or room.glb");
  const io::SceneOptions scenes = scene_options(options.inputs);
  if (!options.plan.empty()) {
    if (!options.recipe.empty() || !options.as_typed.empty())
      throw Error(ErrorCode::usage, "--plan says what the flat is like: no recipe, and no other options but --set");
    const auto plan = dataset::read_home_plan(found(io::DataKind::plans, options.plan), options.settings);
    return write(options, dataset::draw_flat(plan, options.seed.value_or(1), options.number, scenes));
  }
  if (options.recipe.empty()) {
    const std::uint64_t seed = options.seed.value_or(1);
    if (options.what == DrawOptions::What::room) {
      const auto spec = read_settings(options, "room", dataset::read_room_keys);
      return write(options, dataset::draw_room(spec, seed, options.number, scenes));
    }
    const auto spec = read_settings(options, "home", dataset::read_flat_keys);
    return write(options, dataset::draw_flat(spec, seed, options.number, scenes));
  }
  const dataset::RecipeSpec recipe = recipe_to_draw_from(options);
  const std::uint64_t seed = options.seed.value_or(recipe.seed);
  const dataset::RoomGroupSpec& group = dataset::group_of(recipe, options.number);
  const int number = recipe.original_of(options.number);
  if (group.home) return write(options, dataset::draw_flat(group.home->flats, seed, number, scenes));
  write(options, dataset::draw_room(group.rooms, seed, number, scenes));
}

/// An option that stands for a key of what is drawn.
CLI::Option* offer_setting(CLI::App& command, DrawOptions& options, const std::string& name, const std::string& key,
                           const std::string& value, const std::string& what) {
  return command
      .add_option_function<std::string>(
          name,
          [&options, name, key](const std::string& text) {
            options.settings.push_back(key + "=" + text);
            options.as_typed["--set " + key + "=" + text] = name + " " + text;
          },
          what)
      ->option_text(value);
}

/// Returns --home.
CLI::Option* offer_drawing(CLI::App& command) {
  const auto drawing = std::make_shared<DrawOptions>();
  DrawOptions& options = *drawing;
  CLI::Option* home = command.add_flag_callback(
      "--home", [&options] { options.what = DrawOptions::What::home; }, "draw a flat instead");
  const auto setting = [&](const char* group, const std::string& name, const std::string& key, const std::string& value,
                           const std::string& what) {
    return offer_setting(command, options, name, key, value, what)->group(group);
  };
  const auto of_room = [&](const std::string& name, const std::string& key, const std::string& value,
                           const std::string& what) { setting("Rooms", name, key, value, what)->excludes(home); };
  const auto of_home = [&](const std::string& name, const std::string& key, const std::string& value,
                           const std::string& what) {
    setting("Flats, with --home", name, key, value, what)->needs(home);
  };
  of_room("--kind", "kind", "KIND", "office or meeting (default: office)");
  of_room("--width", "width_m", "M", "along x: metres, or [least,most]");
  of_room("--depth", "depth_m", "M", "along -z");
  of_room("--l-shaped", "l_shaped", "P", "probability that a far corner is missing");
  of_room("--doors", "doors", "N", "how many");
  of_room("--seats", "seats", "N", "desks, or chairs round the table: N or [least,most]");
  of_room("--desks", "desks", "WORD", "islands, rows or walls");
  of_room("--cupboards", "cupboards", "N", "how many, before walls");
  of_room("--partitions", "partitions", "N", "how many free-standing screens");
  of_home("--rooms", "rooms", "N", "1 to 4 beside kitchen and bath: N or [least,most] (default: [1,4])");
  of_home("--residents", "residents", "N", "1 to 5, a place to lie each (default: [1,2])");
  of_home("--size", "size_m2", "M2", "of the floor (default: as its rooms usually need)");
  of_home("--layout", "layout", "WORD", "corridor, hall or open: how rooms are reached (default: one of them)");
  of_home("--sensors-at", "sensors_at", "WORD", "room or doorway: a sensor in each (default: room)");
  of_home("--mount", "mount", "WORD", "corner or ceiling, of sensors in rooms (default: corner)");
  of_home("--model", "model", "NAME", "of sensors, or [NAME,...]: one is drawn for each");
  offer_input_file(command, "--plan", options.plan, "a flat that somebody has: docs/formats/plan.md")->needs(home);
  setting("Options", "--height", "height_m", "M", "of the ceiling");
  offer_input_file(command, "RECIPE", options.recipe, "take the ranges of its rooms: docs/formats/dataset.md");
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&options](const std::vector<std::string>& given) {
            options.settings.insert(options.settings.end(), given.begin(), given.end());
          },
          "any other key of a room or a home (docs/formats/dataset.md)")
      ->option_text("KEY=VALUE")
      ->allow_extra_args(false);
  offer_sensors(command, options.inputs);
  command.add_option("--seed", options.seed, "of all random streams (default: 1, or the recipe's)")
      ->option_text("N")
      ->check(is_seed());
  command.add_option("--number", options.number, "which room of this seed or recipe (default: 1)")
      ->option_text("N")
      ->check(CLI::Range(1, 1'000'000));
  offer_output(command, output_names, options.output, "the scene, .gltf or .glb", {".gltf", ".glb"});
  offer_quiet(command, options.inputs.verbosity);
  command.callback([drawing] { draw(*drawing); });
  return home;
}

constexpr const char* room_examples = R"(
  pirsim room -o room.gltf                                           a small office
  pirsim room --kind meeting --width 6 --depth 4.6 --seats 8 -o room.gltf
  pirsim room --width [5,8] --seats [2,6] --desks islands --number 3 -o room.gltf
  pirsim room --set "sensors=[{mount: corner, count: 2, model: EKMC1603111}]" -o room.gltf
  pirsim room --home -o flat.gltf                                    one to four rooms, one or two residents
  pirsim room --home --rooms [1,2] --size [35,50] --mount ceiling --number 3 -o flat.gltf
  pirsim room --home --plan my_flat.yaml -o flat.gltf                 a flat that somebody has
  pirsim room recipe.yaml --number 3 -o room.gltf                    the third room of a dataset
)";

}  // namespace

void add_room_command(CLI::App& app) {
  offer_drawing(add_command(app, "room", "draw a parametric room or flat and write it as glTF", room_examples));
  offer_drawing(add_old_command(app, "home", "the same as room --home", room_examples))->add_result("true");
}

}  // namespace pirsim::app
