#include "dataset/flat_reader.hpp"

#include <algorithm>

#include "core/text.hpp"
#include "dataset/room_reader.hpp"

namespace pirsim::dataset {
namespace {

template <typename Value>
using Words = std::vector<std::pair<std::string, Value>>;

/// A word, or a list of words of which one is drawn.
template <typename Value>
std::vector<Value> read_words(io::YamlMap& map, const std::string& key, std::vector<Value> otherwise,
                              const Words<Value>& words) {
  const auto node = map.child(key);
  if (!node) return otherwise;
  std::vector<std::string> names;
  for (const auto& [name, value] : words) names.push_back(name);
  std::vector<Value> values;
  const std::vector<io::YamlNode> items =
      node->is_list() ? io::read_list(*node, map.faults(), key) : std::vector{*node};
  for (const io::YamlNode& item : items) {
    if (const auto index = item.choice(map.faults(), key, names)) values.push_back(words[*index].second);
  }
  if (items.empty())
    map.faults().error(node->where(), key + ": expected " + names.front() + " or another of its words");
  return values.empty() ? std::move(otherwise) : values;
}

/// Refuses what is given and no flat of these ranges can have.
void refuse_vain_wishes(io::YamlMap& map, const FlatSpec& spec) {
  const auto refuse = [&](const std::string& key, const std::string& why) {
    map.faults().error(map.where(key), key + ": " + why);
  };
  // Beside the living room and the study, a bedroom for every two.
  const int rooms_with_study = std::max(3, 2 + (spec.residents.least + 1) / 2);
  if (map.has("study") && spec.study > 0.0 && spec.rooms.most < rooms_with_study)
    refuse("study", "a flat for " + counted(static_cast<std::size_t>(spec.residents.least), "resident") +
                        " has one from `rooms: " + std::to_string(rooms_with_study) + "` on, and `rooms` is " +
                        std::to_string(spec.rooms.most) + " at most");
  const auto hangs = [](const auto& places, auto place) { return std::ranges::find(places, place) != places.end(); };
  const bool in_rooms = hangs(spec.sensors_at, SensorsAt::rooms);
  if (map.has("mount") && !in_rooms)
    refuse("mount", "is of sensors in rooms, and all hang above doorways (`sensors_at: doorway`)");
  for (const char* key : {"sensor_height_m", "sensor_tilt_deg"}) {
    if (!map.has(key) || (in_rooms && hangs(spec.mounts, Mount::corner))) continue;
    refuse(key, std::string("is of sensors in corners, and all hang ") +
                    (in_rooms ? "on ceilings (`mount: ceiling`)" : "above doorways (`sensors_at: doorway`)"));
  }
}

}  // namespace

FlatSpec read_flat_keys(io::YamlMap& map) {
  constexpr NumberRange share{.min = 0.0, .max = 1.0};
  FlatSpec spec;
  spec.where = map.where();
  spec.rooms = read_count(map, "rooms", spec.rooms, {.min = 1, .max = 4});
  spec.residents = read_count(map, "residents", spec.residents, {.min = 1, .max = 5});
  const bool has_size = map.has("size_m2");
  const Range size = read_range(map, "size_m2", {}, {.min = 15.0, .max = 1000.0});
  if (has_size) spec.size_m2 = size;
  spec.stretch = read_range(map, "stretch", spec.stretch, {.min = 0.3, .max = 4.0});
  spec.height_m = read_range(map, "height_m", spec.height_m, {.min = 2.3, .max = 5.0});
  spec.layouts = read_words(
      map, "layout", spec.layouts,
      Words<FlatLayout>{{"corridor", FlatLayout::corridor}, {"hall", FlatLayout::hall}, {"open", FlatLayout::open}});
  spec.own_kitchen = map.number("own_kitchen", spec.own_kitchen, share);
  spec.double_beds = map.number("double_beds", spec.double_beds, share);
  spec.study = map.number("study", spec.study, share);
  spec.sensors_at = read_words(map, "sensors_at", spec.sensors_at,
                               Words<SensorsAt>{{"room", SensorsAt::rooms}, {"doorway", SensorsAt::doorways}});
  spec.mounts =
      read_words(map, "mount", spec.mounts, Words<Mount>{{"corner", Mount::corner}, {"ceiling", Mount::ceiling}});
  if (const auto model = map.child("model")) {
    spec.models = model->is_scalar() ? std::vector{model->text(map.faults(), "model")} : map.texts("model");
    spec.models_where = model->where();
  }
  spec.sensor_height_m = read_range(map, "sensor_height_m", spec.sensor_height_m, {.min = 0.1, .max = 5.0});
  spec.sensor_tilt_deg = read_range(map, "sensor_tilt_deg", spec.sensor_tilt_deg, {.min = -90.0, .max = 90.0});
  refuse_vain_wishes(map, spec);
  return spec;
}

}  // namespace pirsim::dataset
