// Changes every field of a spec in turn, by the one list of fields, so that no test of "all fields" forgets one.
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "model/schema/fields.hpp"

namespace pirsim::test {

template <typename Value>
concept HasItems = requires(Value& value) {
  value.begin()->second;
};

/// Calls check(path) with each part of the value changed in turn, and restores it: the fields of specs; of lists the
/// first item, and the list without it; of variants what is there. Nothing of an empty map, and of body meshes, which
/// can't be changed once they are made.
template <typename Value, typename Check>
void each_change(Value& value, const std::string& path, const Check& check);

template <typename Value, typename Check>
void with(Value& value, const Value& changed, const std::string& path, const Check& check) {
  const Value before = value;
  value = changed;
  check(path);
  value = before;
}

template <typename Check>
void each_change_of(MeshSolid&, const std::string&, const Check&) {}
template <typename Check>
void each_change_of(FloorArea& floor, const std::string& path, const Check& check) {
  with(floor, FloorArea(floor.loops(), floor.height_m() + 1.0), path + ".height", check);
  auto loops = floor.loops();
  each_change(loops, path,
              [&](const std::string& part) { with(floor, FloorArea(loops, floor.height_m()), part, check); });
}
template <typename Item, typename Check>
void each_change_of(std::vector<Item>& items, const std::string& path, const Check& check) {
  if (items.empty()) {
    with(items, {Item{}}, path, check);
    return;
  }
  std::vector<Item> fewer(items.begin() + 1, items.end());
  with(items, fewer, path, check);
  each_change(items.front(), path + "[0]", check);
}
template <typename Item, std::size_t n, typename Check>
void each_change_of(std::array<Item, n>& items, const std::string& path, const Check& check) {
  for (std::size_t i = 0; i < n; ++i) each_change(items[i], path + '[' + std::to_string(i) + ']', check);
}
template <typename Item, typename Check>
void each_change_of(std::optional<Item>& item, const std::string& path, const Check& check) {
  if (!item) return with(item, std::optional(Item{}), path, check);
  with(item, std::optional<Item>(), path, check);
  each_change(*item, path, check);
}
template <typename... Items, typename Check>
void each_change_of(std::variant<Items...>& item, const std::string& path, const Check& check) {
  std::visit([&](auto& one) { each_change(one, path, check); }, item);
}

template <typename Value, typename Check>
void each_change(Value& value, const std::string& path, const Check& check) {
  if constexpr (Described<Value>) {
    each_field<Value>([&](const auto& field) { each_change(value.*field.member, path + '.' + field.name, check); });
  } else if constexpr (std::is_same_v<Value, bool>) {
    with(value, !value, path, check);
  } else if constexpr (std::is_enum_v<Value>) {
    const auto& all = Words<Value>::all;
    with(value, all[0].second == value ? all[1].second : all[0].second, path, check);
  } else if constexpr (std::is_floating_point_v<Value>) {
    with(value, std::nextafter(value, std::numeric_limits<Value>::max()), path, check);  // what is valid stays so
  } else if constexpr (std::is_integral_v<Value>) {
    with(value, static_cast<Value>(value + 1), path, check);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    with(value, value + "x", path, check);
  } else if constexpr (std::is_same_v<Value, Frame>) {
    each_change(value.origin, path + ".origin", check);
    each_change(value.rotation, path + ".rotation", check);
  } else if constexpr (std::is_same_v<Value, Vec2> || std::is_same_v<Value, Vec3> || std::is_same_v<Value, Quat>) {
    for (int i = 0; i < Value::length(); ++i) each_change(value[i], path + '[' + std::to_string(i) + ']', check);
  } else if constexpr (HasItems<Value>) {
    if (!value.empty()) each_change(value.begin()->second, path + '{' + value.begin()->first + '}', check);
  } else {
    each_change_of(value, path, check);
  }
}

}  // namespace pirsim::test
