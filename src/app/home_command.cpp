#include <iomanip>
#include <sstream>
#include <utility>

#include "app/commands.hpp"
#include "app/drawn_scene.hpp"
#include "app/session.hpp"
#include "core/text.hpp"
#include "dataset/flat_reader.hpp"
#include "dataset/recipe.hpp"
#include "pirsim/flat.hpp"

namespace pirsim::app {
namespace {

dataset::DrawnFlat draw_flat(const DrawOptions& options) {
  const io::SceneOptions scenes = scene_options(options.inputs);
  if (options.recipe.empty()) {
    dataset::FlatSpec spec;
    read_settings(options, "home", [&](io::YamlMap& map) { spec = dataset::read_flat_keys(map); });
    return dataset::draw_flat(spec, options.seed.value_or(1), options.number, scenes);
  }
  const dataset::RecipeSpec recipe = recipe_to_draw_from(options);
  const dataset::RoomGroupSpec& group = dataset::group_of(recipe, options.number);
  if (!group.home) {
    throw Error(ErrorCode::usage, "--number: room " + std::to_string(options.number) +
                                      " of the recipe isn't a home: pirsim room draws it");
  }
  return dataset::draw_flat(group.home->flats, options.seed.value_or(recipe.seed), recipe.original_of(options.number),
                            scenes);
}

std::string about(const dataset::DrawnFlat& flat) {
  std::ostringstream text;
  std::vector<std::string> rooms, doors;
  for (const dataset::FlatRoom& room : flat.rooms) rooms.push_back(room.id);
  for (const DoorSpec& door : flat.scene.doors) doors.push_back(door.id);
  text << "flat " << flat.number << ", " << flat.width_m << " x " << flat.depth_m << " x " << flat.height_m
       << " m, floor " << std::fixed << std::setprecision(2) << flat.scene.floor.area_m2() << " m2, for "
       << counted(static_cast<std::size_t>(flat.residents), "resident") << ", rooms" << listed(rooms) << ", doors"
       << listed(doors) << ", sensors" << listed(flat.scene.sensors) << "; found at try " << flat.tries;
  return std::move(text).str();
}

void make_home(const DrawOptions& options) {
  check_scene_output(options, "flat");
  const dataset::DrawnFlat flat = draw_flat(options);
  io::write_scene(options.output, flat.scene);
  tell_written({{options.output, about(flat)}}, options.inputs.verbosity);
}

}  // namespace

void add_home_command(CLI::App& app) {
  CLI::App& command = add_command(app, "home", "draw a parametric flat and write it as glTF", R"(
  pirsim home -o flat.gltf                                           one to four rooms, one or two residents
  pirsim home --rooms 3 --residents 2 --sensors-at doorway -o flat.gltf
  pirsim home --rooms [1,2] --size [35,50] --mount ceiling --number 3 -o flat.gltf
  pirsim home recipe.yaml --number 3 -o flat.gltf                    the third home of a dataset
  pirsim home --rooms 2 --set own_kitchen=0 --model EKMC1601111 -o flat.gltf
)");
  const auto options = std::make_shared<DrawOptions>();
  offer_setting(command, *options, "--rooms", "rooms", "N",
                "1 to 4 beside kitchen and bath: N or [least,most] (default: [1,4])");
  offer_setting(command, *options, "--residents", "residents", "N", "1 to 5, a place to lie each (default: [1,2])");
  offer_setting(command, *options, "--size", "size_m2", "M2", "of the floor (default: as its rooms usually need)");
  offer_setting(command, *options, "--height", "height_m", "M", "of the ceiling");
  offer_setting(command, *options, "--layout", "layout", "WORD",
                "corridor, hall or open: how rooms are reached (default: one of them)");
  offer_setting(command, *options, "--sensors-at", "sensors_at", "WORD",
                "room or doorway: a sensor in each (default: room)");
  offer_setting(command, *options, "--mount", "mount", "WORD",
                "corner or ceiling, of sensors in rooms (default: corner)");
  offer_setting(command, *options, "--model", "model", "NAME", "of sensors, or [NAME,...]: one is drawn for each");
  offer_drawing(command, *options, "home");
  command.callback([options] { make_home(*options); });
}

}  // namespace pirsim::app
