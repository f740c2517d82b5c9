#include "dataset/flat_names.hpp"

#include <algorithm>

namespace pirsim::dataset {
namespace {

using Kind = FlatRoomKind;

struct NamedRoom {
  Kind kind;
  std::string area;
};

template <typename T>
bool has(const std::vector<T>& some, const T& one) {
  return std::ranges::find(some, one) != some.end();
}

/// With a corridor along the middle, which a flat of one room never has.
bool can_have_long_corridor(const FlatSpec& spec) {
  return spec.rooms.most > 1 && has(spec.layouts, FlatLayout::corridor);
}

std::vector<NamedRoom> rooms_of(const FlatSpec& spec) {
  std::vector<NamedRoom> rooms;
  const auto add = [&](Kind kind, int which = 1) { rooms.push_back({kind, area_name(kind, which)}); };
  add(Kind::living_room);
  if (spec.own_kitchen > 0.0) add(Kind::kitchen);
  for (int bedroom = 1; bedroom < spec.rooms.most; ++bedroom) add(Kind::bedroom, bedroom);
  if (spec.rooms.most > 2 && spec.study > 0.0) add(Kind::study);
  add(Kind::bath);
  if (can_have_long_corridor(spec) || has(spec.layouts, FlatLayout::hall)) add(Kind::corridor);
  return rooms;
}

/// Into the corridor along the middle leads the front door alone, and without that corridor all leave the living room.
bool has_doorway(const FlatSpec& spec, Kind kind) {
  if (kind == Kind::living_room) return can_have_long_corridor(spec);
  return kind != Kind::corridor || has(spec.layouts, FlatLayout::hall);
}

}  // namespace

std::string area_name(FlatRoomKind kind, int which) {
  const std::string number = which == 1 ? "" : '_' + std::to_string(which);
  switch (kind) {
    case Kind::living_room:
      return "living_room" + number;
    case Kind::kitchen:
      return "kitchen" + number;
    case Kind::bath:
      return "bath" + number;
    case Kind::study:
      return "study" + number;
    case Kind::bedroom:
      return "bedroom" + number;
    case Kind::corridor:
      break;
  }
  return "corridor" + number;
}

bool has_leaf(FlatRoomKind kind) noexcept { return kind == Kind::bath || kind == Kind::bedroom; }

std::string room_sensor_name(const std::string& area) { return "PIR_" + area; }
std::string doorway_sensor_name(const std::string& door) { return "PIR_" + door + "_door"; }

ColumnOwners columns_of(const FlatSpec& spec) {
  ColumnOwners names{{}, {}, {front_door_name}};
  const std::vector<NamedRoom> rooms = rooms_of(spec);
  for (const NamedRoom& room : rooms) {
    names.areas.push_back(room.area);
    if (has_leaf(room.kind)) names.doors.push_back(room.area);
    if (has(spec.sensors_at, SensorsAt::rooms)) names.sensors.push_back(room_sensor_name(room.area));
  }
  if (!has(spec.sensors_at, SensorsAt::doorways)) return names;
  names.sensors.push_back(doorway_sensor_name(front_door_name));
  for (const NamedRoom& room : rooms) {
    if (has_doorway(spec, room.kind)) names.sensors.push_back(doorway_sensor_name(room.area));
  }
  return names;
}

}  // namespace pirsim::dataset
