#include "dataset/room_reader.hpp"

#include <algorithm>

namespace pirsim::dataset {
namespace {

const std::vector<std::pair<std::string, DeskOrder>> order_names{
    {"islands", DeskOrder::islands}, {"rows", DeskOrder::rows}, {"walls", DeskOrder::walls}};

template <typename Limits, typename Value, typename ReadOne>
std::pair<Value, Value> read_two(io::YamlMap& map, const std::string& key, std::pair<Value, Value> otherwise,
                                 const Limits& limits, const ReadOne& read_one) {
  const auto node = map.child(key);
  if (!node) return otherwise;
  if (node->is_scalar()) {
    const Value one = read_one(*node, limits);
    return {one, one};
  }
  const auto items = node->items();
  if (!node->is_list() || items.size() != 2) {
    map.faults().error(node->where(), key + ": expected a number, or [least, most]");
    return otherwise;
  }
  const Value least = read_one(items[0], limits), most = read_one(items[1], limits);
  if (most < least) {
    map.faults().error(items[1].where(), key + ": the second number is less than the first");
    return {least, least};
  }
  return {least, most};
}

std::vector<DeskOrder> read_orders(io::YamlMap& map, std::vector<DeskOrder> otherwise) {
  const auto node = map.child("desks");
  if (!node) return otherwise;
  std::vector<std::string> names;
  for (const auto& [name, value] : order_names) names.push_back(name);
  std::vector<DeskOrder> orders;
  const std::vector<io::YamlNode> items = node->is_list() ? node->items() : std::vector{*node};
  for (const io::YamlNode& item : items) {
    if (const auto index = item.choice(map.faults(), "desks", names)) orders.push_back(order_names[*index].second);
  }
  if (items.empty()) map.faults().error(node->where(), "desks: expected islands, rows or walls");
  return orders.empty() ? std::move(otherwise) : orders;
}

SensorGroupSpec read_sensors(const io::YamlNode& node, Diagnostics& faults) {
  io::YamlMap map(node, faults, "sensors");
  SensorGroupSpec group;
  group.where = node.where();
  static_cast<void>(map.required_child("mount"));
  group.mount = map.choice<Mount>("mount", group.mount,
                                  {{"ceiling", Mount::ceiling}, {"corner", Mount::corner}, {"wall", Mount::wall}});
  if (const auto model = map.child("model")) {
    group.where = model->where();
    if (model->is_scalar()) {
      group.models.push_back(model->text(faults, "model"));
    } else {
      group.models = map.texts("model");
    }
  }
  group.count = read_count(map, "count", group.count, {.min = 0, .max = 50});
  if (group.mount != Mount::ceiling) {
    group.height_m = read_range(map, "height_m", group.height_m, {.min = 0.1, .max = 20.0});
    group.tilt_deg = read_range(map, "tilt_deg", group.tilt_deg, {.min = -90.0, .max = 90.0});
  }
  map.finish();
  return group;
}

/// Of a home other keys are read, as flat_reader.hpp says.
RoomKind read_kind(io::YamlMap& map) {
  enum class Word { office, meeting, home };
  const Word word = map.choice<Word>("kind", Word::office,
                                     {{"office", Word::office}, {"meeting", Word::meeting}, {"home", Word::home}});
  if (word == Word::home) map.faults().error(map.where("kind"), "kind: a home is drawn by `pirsim room --home`");
  return word == Word::meeting ? RoomKind::meeting : RoomKind::office;
}

}  // namespace

Range read_range(io::YamlMap& map, const std::string& key, const Range& otherwise, NumberRange limits) {
  const auto read = [&](const io::YamlNode& node, const NumberRange& range) {
    return node.number(map.faults(), key, range);
  };
  const auto [least, most] = read_two(map, key, std::pair(otherwise.least, otherwise.most), limits, read);
  return {least, most};
}

CountRange read_count(io::YamlMap& map, const std::string& key, const CountRange& otherwise, IntegerRange limits) {
  const auto read = [&](const io::YamlNode& node, const IntegerRange& range) {
    return static_cast<int>(node.integer(map.faults(), key, range));
  };
  const auto [least, most] = read_two(map, key, std::pair(otherwise.least, otherwise.most), limits, read);
  return {least, most};
}

RoomSpec read_room_keys(io::YamlMap& map) {
  RoomSpec spec;
  spec.where = map.where();
  spec.kind = read_kind(map);
  constexpr NumberRange sides{.min = 1.5, .max = 100.0}, share{.min = 0.0, .max = 1.0};
  spec.width_m = read_range(map, "width_m", spec.width_m, sides);
  spec.depth_m = read_range(map, "depth_m", spec.depth_m, sides);
  spec.height_m = read_range(map, "height_m", spec.height_m, {.min = 2.2, .max = 20.0});
  spec.l_shaped = map.number("l_shaped", spec.l_shaped, share);
  spec.cut_share = read_range(map, "cut_share", spec.cut_share, {.min = 0.05, .max = 0.8});
  spec.doors = read_count(map, "doors", spec.doors, {.min = 1, .max = 20});
  spec.door_width_m = read_range(map, "door_width_m", spec.door_width_m, {.min = 0.7, .max = 5.0});
  spec.seats = read_count(map, "seats", spec.seats, {.min = 1, .max = 200});
  if (spec.kind == RoomKind::office) {
    spec.orders = read_orders(map, spec.orders);
    spec.desk_width_m = read_range(map, "desk_width_m", spec.desk_width_m, {.min = 1.0, .max = 2.4});
    spec.desk_screens = map.number("desk_screens", spec.desk_screens, share);
  }
  // What is given and no room of these ranges can have.
  if (map.has("cut_share") && !map.has("l_shaped"))
    map.faults().error(map.where("cut_share"), "cut_share: is of rooms that lack a corner: give `l_shaped`, too");
  if (map.has("desk_screens") && spec.desk_screens > 0.0 &&
      std::ranges::find(spec.orders, DeskOrder::islands) == spec.orders.end())
    map.faults().error(map.where("desk_screens"), "desk_screens: is of desks in islands, and `desks` has none");
  spec.cupboards = read_count(map, "cupboards", spec.cupboards, {.min = 0, .max = 50});
  spec.partitions = read_count(map, "partitions", spec.partitions, {.min = 0, .max = 50});
  if (!map.has("sensors")) {
    static_cast<void>(map.list("sensors"));
    return spec;
  }
  spec.sensors.clear();
  for (const io::YamlNode& node : map.list("sensors")) spec.sensors.push_back(read_sensors(node, map.faults()));
  int most = 0;
  for (const SensorGroupSpec& group : spec.sensors) most += group.count.most;
  if (most == 0) map.faults().error(map.where("sensors"), "sensors: a room needs one");
  return spec;
}

}  // namespace pirsim::dataset
