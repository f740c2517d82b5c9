#include <iomanip>
#include <sstream>
#include <utility>

#include "app/commands.hpp"
#include "app/drawn_scene.hpp"
#include "app/session.hpp"
#include "dataset/recipe.hpp"
#include "dataset/room_reader.hpp"
#include "pirsim/room.hpp"

namespace pirsim::app {
namespace {

dataset::DrawnRoom draw_room(const DrawOptions& options) {
  const io::SceneOptions scenes = scene_options(options.inputs);
  if (options.recipe.empty()) {
    dataset::RoomSpec spec;
    read_settings(options, "room", [&](io::YamlMap& map) { spec = dataset::read_room_keys(map); });
    return dataset::draw_room(spec, options.seed.value_or(1), options.number, scenes);
  }
  const dataset::RecipeSpec recipe = recipe_to_draw_from(options);
  const dataset::RoomGroupSpec& group = dataset::group_of(recipe, options.number);
  if (group.home) {
    throw Error(ErrorCode::usage,
                "--number: room " + std::to_string(options.number) + " of the recipe is a home: pirsim home draws it");
  }
  return dataset::draw_room(group.rooms, options.seed.value_or(recipe.seed), recipe.original_of(options.number),
                            scenes);
}

std::string about(const dataset::DrawnRoom& room) {
  std::ostringstream text;
  std::vector<std::string> seats;
  for (const SeatSpec& seat : room.scene.seats) seats.push_back(seat.id);
  text << "room " << room.number << ", " << room.width_m << " x " << room.depth_m << " x " << room.height_m
       << " m, floor " << std::fixed << std::setprecision(2) << room.scene.floor.area_m2() << " m2, doors "
       << room.scene.entrances.size() << ", seats" << listed(seats) << ", sensors" << listed(room.scene.sensors)
       << "; found at try " << room.tries;
  return std::move(text).str();
}

void make_room(const DrawOptions& options) {
  check_scene_output(options, "room");
  const dataset::DrawnRoom room = draw_room(options);
  io::write_scene(options.output, room.scene);
  tell_written({{options.output, about(room)}}, options.inputs.verbosity);
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
  const auto options = std::make_shared<DrawOptions>();
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
  offer_drawing(command, *options, "room");
  command.callback([options] { make_room(*options); });
}

}  // namespace pirsim::app
