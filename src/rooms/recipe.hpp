// What a recipe means for one room, or one of its days.
#pragma once

#include <array>

#include "files/read/yaml.hpp"
#include "pirsim/dataset.hpp"
#include "pirsim/flat.hpp"
#include "pirsim/room.hpp"

namespace pirsim::dataset {

/// Room numbers in order, each about as often as its weight says (systematic resampling).
[[nodiscard]] std::vector<int> drawn_by_weight(const DrawBySpec& draw_by, std::uint64_t seed);

[[nodiscard]] const RoomGroupSpec& group_of(const RecipeSpec& recipe, int room);
/// "office", "meeting" or "home", of drawn rooms.
[[nodiscard]] std::string kind_of(const RoomGroupSpec& group);
/// The user's own file, or empty for a drawn room.
[[nodiscard]] const OwnScene* own_scene(const RecipeSpec& recipe, int room);
[[nodiscard]] SceneSpec read_own(const OwnScene& own, io::SceneOptions options);
/// The study of one room on one of its days (from 1): replicate `day` of it is that day. Throws Error(input) for what
/// doesn't fit the scene.
[[nodiscard]] ScriptSpec script_of(const RecipeSpec& recipe, const SceneSpec& scene, int room, int day);

/// Why the room has fewer people than the recipe asks for at least; empty if it hasn't.
[[nodiscard]] std::string lack_of_people(const RecipeSpec& recipe, const SceneSpec& scene, int room);

[[nodiscard]] std::string name_of(Part part);   ///< "test_days"
[[nodiscard]] std::string room_name(int room);  ///< "room_0003"
/// Files and folders that a dataset is made of, beside its recipe, provenance and journals.
inline constexpr std::array dataset_parts{
    "README.md", "datapackage.json", "rooms.csv", "sensors.csv", "days.csv", "effects.csv",
    "areas.csv", "doors.csv",        "pictures",  "rooms",       "scripts",  "rows",
    "occupants", "frames",           "exports"};
// Relative to the dataset's folder.
[[nodiscard]] std::string room_path(int room);  ///< "rooms/room_0003.gltf"
/// "rows/room_0003/day_01.csv"
[[nodiscard]] std::string day_path(const std::string& folder, int room, int day, const std::string& ending);
/// Of a room-day, room by room.
[[nodiscard]] std::uint32_t index_of(const RecipeSpec& recipe, int room, int day);

// Ranges of rooms as YAML: `rooms:` of a recipe, and the options of `pirsim room`.

/// Reads the keys of a RoomSpec; the caller finishes the map.
[[nodiscard]] RoomSpec read_room_keys(io::YamlMap& map);

// Ranges of flats as YAML: homes of a recipe, and the options of `pirsim room --home`.

/// Reads the keys of a FlatSpec; the caller finishes the map.
[[nodiscard]] FlatSpec read_flat_keys(io::YamlMap& map);

}  // namespace pirsim::dataset
