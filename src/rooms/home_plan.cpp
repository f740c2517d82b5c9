// A flat that somebody has: read from a file, and laid out.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <set>
#include <utility>

#include "files/read/reader_parts.hpp"
#include "files/read/yaml.hpp"
#include "model/core/text.hpp"
#include "pirsim/flat.hpp"
#include "rooms/flat_layout.hpp"
#include "rooms/recipe_fields.hpp"

namespace pirsim::dataset {
namespace {

using io::YamlMap;
using io::YamlNode;

void refuse(const YamlMap& map, std::initializer_list<const char*> keys, const std::string& why) {
  for (const char* key : keys)
    if (map.has(key)) map.faults().error(map.where(key), std::string(key) + ": " + why);
}

const char* along(PlanSide side) { return runs_along_x(side) ? "x_m" : "y_m"; }
const char* across(PlanSide side) { return runs_along_x(side) ? "y_m" : "x_m"; }

bool is_among(PieceKind kind, std::initializer_list<PieceKind> kinds) {
  return std::ranges::find(kinds, kind) != kinds.end();
}

PlanPieceSpec read_piece(const YamlNode& node, Diagnostics& faults) {
  using K = PieceKind;
  YamlMap map(node, faults, "furniture");
  PlanPieceSpec piece;
  piece.where = node.where();
  map.require("kind");
  io::read_fields(map, piece);
  map.finish();
  if (!is_among(piece.kind, {K::bed, K::sofa, K::table}))
    refuse(map, {"places"}, "only beds, sofas and tables have some");
  if (piece.kind == K::bed && piece.places.value_or(1) > 2) refuse(map, {"places"}, "a bed has 1 or 2");
  if (is_among(piece.kind, {K::sofa, K::table, K::shower, K::toilet, K::washbasin, K::television}))
    refuse(map, {"width_m"}, "a " + std::string(word_of(piece.kind)) + " has its own");
  if (piece.kind == K::kitchen && piece.width_m.value_or(2.0) < 1.8)
    refuse(map, {"width_m"}, "stove, sink and fridge need 1.8 m side by side");
  if (piece.kind == K::table) {
    if (piece.x_m.has_value() != piece.y_m.has_value()) refuse(map, {"x_m", "y_m"}, "a table's place has both");
  } else if (!piece.wall) {
    refuse(map, {"x_m", "y_m"}, "to which `wall` is its back?");
  } else if (!map.has(along(*piece.wall))) {
    refuse(map, {across(*piece.wall)}, std::string("and ") + along(*piece.wall) + '?');
  }
  return piece;
}

PlanSensorSpec read_sensor(const YamlNode& node, const PlanRoomSpec& room, Diagnostics& faults) {
  YamlMap map(node, faults, "sensor");
  PlanSensorSpec sensor;
  sensor.where = node.where();
  sensor.id = map.text("id");
  sensor.model = map.text("model");
  io::read_fields(map, sensor);
  map.finish();
  if (sensor.corner) refuse(map, {"wall", "x_m", "y_m"}, "the corner says where it hangs");
  if (sensor.wall) refuse(map, {across(*sensor.wall)}, "the wall says that");
  if (!sensor.corner && !sensor.wall)
    refuse(map, {"height_m", "tilt_deg"}, "it looks down from the ceiling (or a `corner` or `wall`?)");
  const auto check_inside = [&](const char* key, const std::optional<double>& value, const Range& range) {
    if (value && (*value < range.least || *value > range.most)) refuse(map, {key}, "it isn't in '" + room.id + "'");
  };
  check_inside("x_m", sensor.x_m, room.x_m);
  check_inside("y_m", sensor.y_m, room.y_m);
  return sensor;
}

PlanRoomSpec read_room(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "room");
  PlanRoomSpec room;
  room.where = node.where();
  room.id = map.required_text("id");
  room.area = map.text("area");
  for (const char* key : {"kind", "x_m", "y_m"}) map.require(key);
  io::read_fields(map, room);
  for (const auto& [key, name] : {std::pair("id", room.id), std::pair("area", room.area)}) {
    const std::string fault = name.empty() ? "" : name_fault(name);
    if (!fault.empty()) faults.error(map.where(key), std::string(key) + ": '" + name + "': " + fault);
  }
  if (map.child("furniture")) {
    room.furniture.emplace();
    for (const YamlNode& piece : map.list("furniture")) room.furniture->push_back(read_piece(piece, faults));
  }
  if (map.child("sensors")) {
    room.sensors.emplace();
    for (const YamlNode& sensor : map.list("sensors")) room.sensors->push_back(read_sensor(sensor, room, faults));
  }
  map.finish();
  return room;
}

PlanDoorSpec read_door(const YamlNode& node, Diagnostics& faults) {
  YamlMap map(node, faults, "door");
  PlanDoorSpec door;
  door.where = node.where();
  door.id = map.text("id");
  door.from = map.text("from");
  door.into = map.required_text("into");
  io::read_fields(map, door);
  if (door.from.empty()) {
    map.require("wall");
  } else {
    refuse(map, {"wall"}, "rooms share one wall at most");
  }
  map.finish();
  return door;
}

/// "PIR_bath", then "PIR_bath_2". A name that was given twice is a fault.
std::string unlike_others(std::set<std::string>& known, const std::string& given, const std::string& usual,
                          const Where& where, Diagnostics& faults) {
  std::string name = given.empty() ? usual : given;
  for (int which = 2; given.empty() && known.contains(name); ++which) name = usual + '_' + std::to_string(which);
  if (!known.insert(name).second) faults.error(where, "id: a second '" + name + "'");
  return name;
}

/// Pieces of a room's wall that no room is behind.
std::vector<InnerWall> outer_pieces(const std::vector<FlatRoom>& rooms, std::size_t room, PlanSide side) {
  const Rectangle& r = rooms[room].area;
  const bool at_x = runs_along_x(side);
  const Vec2 end = wall_of(r, side).from;
  const auto on_line = [&](double at) { return at_x ? Vec2(at, end.y) : Vec2(end.x, at); };
  const auto place = [&](const Vec2& point) { return at_x ? point.x : point.y; };
  std::vector<std::pair<double, double>> behind;
  for (const FlatRoom& other : rooms)
    if (const auto piece = shared_wall(r, side, other.area)) behind.emplace_back(place(piece->from), place(piece->to));
  std::ranges::sort(behind);
  behind.emplace_back(place(r.upper), place(r.upper));
  std::vector<InnerWall> pieces;
  double from = place(r.lower);
  for (const auto& [begin, last] : behind) {
    if (begin > from) pieces.push_back({on_line(from), on_line(begin)});
    from = last;
  }
  return pieces;
}

/// Rooms, walls and doors of a plan, with all faults.
class Layout {
 public:
  explicit Layout(const HomePlanSpec& plan) : plan_(plan) {}

  FlatPlan lay_out() {
    add_rooms();
    faults_.throw_if_errors();
    flat_.inner_walls = walls_between(flat_.rooms);
    for (std::size_t i = 0; i < flat_.rooms.size(); ++i) add_walls_to_notches(i);
    for (const PlanDoorSpec& door : plan_.doors) add_door(door);
    if (!faults_.has_errors()) require_ways();
    faults_.throw_if_errors();
    return std::move(flat_);
  }

 private:
  static constexpr double least_room_m = 0.6, least_notch_m = 0.3;  // assumed: 0.6-0.9, 0.2-0.4

  void add_rooms() {
    for (const PlanRoomSpec& room : plan_.rooms) {
      const Rectangle area{{room.x_m.least, 0.0 - room.y_m.most}, {room.x_m.most, 0.0 - room.y_m.least}};
      if (area.upper.x - area.lower.x < least_room_m || area.upper.y - area.lower.y < least_room_m)
        faults_.error(room.where, "'" + room.id + "' is narrower than " + fixed(least_room_m, 1) + " m");
      for (std::size_t i = 0; i < flat_.rooms.size(); ++i)
        check_beside(plan_.rooms[i], flat_.rooms[i].area, room, area);
      flat_.bounds = flat_.rooms.empty() ? area
                                         : Rectangle{glm::min(flat_.bounds.lower, area.lower),
                                                     glm::max(flat_.bounds.upper, area.upper)};
      flat_.rooms.push_back({room.kind, room.area.empty() ? room.id : room.area, area});
    }
    if (plan_.rooms.empty()) faults_.error(plan_.where, "the plan has no rooms");
  }

  void check_beside(const PlanRoomSpec& other, const Rectangle& others, const PlanRoomSpec& room,
                    const Rectangle& own) {
    if (other.id == room.id) faults_.error(room.where, "a second room '" + room.id + "'");
    if (overlap(own, others)) return faults_.error(room.where, "'" + room.id + "' overlaps '" + other.id + "'");
    const Vec2 gap = glm::max(own.lower - others.upper, others.lower - own.upper);
    const double between = std::max(gap.x, gap.y);
    if (std::min(gap.x, gap.y) >= 0.0 || between <= 0.0 || between >= least_notch_m) return;
    faults_.error(room.where, "'" + room.id + "' ends " + fixed(100.0 * between, 0) + " cm from '" + other.id +
                                  "': rooms reach to the middle of the wall between them");
  }

  /// Where the flat isn't a rectangle.
  void add_walls_to_notches(std::size_t room) {
    for (const PlanSide side : all_sides) {
      for (const InnerWall& wall : outer_pieces(flat_.rooms, room, side)) {
        const Vec2 low = glm::min(wall.from, wall.to), high = glm::max(wall.from, wall.to);
        const bool is_at_edge = runs_along_x(side) ? low.y == flat_.bounds.lower.y || low.y == flat_.bounds.upper.y
                                                   : high.x == flat_.bounds.lower.x || high.x == flat_.bounds.upper.x;
        if (!is_at_edge) flat_.inner_walls.push_back(wall);
      }
    }
  }

  std::optional<std::size_t> room_of(const std::string& id, const char* key, const Where& where) {
    const auto found = std::ranges::find(plan_.rooms, id, &PlanRoomSpec::id);
    if (found != plan_.rooms.end()) return static_cast<std::size_t>(found - plan_.rooms.begin());
    std::vector<std::string> known;
    for (const PlanRoomSpec& room : plan_.rooms) known.push_back(room.id);
    faults_.error(where, std::string(key) + ": no room '" + id + "'" + near_or_all(id, known));
    return std::nullopt;
  }

  void add_door(const PlanDoorSpec& own) {
    Doorway door;
    const auto into = room_of(own.into, "into", own.where);
    if (!own.from.empty()) door.from = room_of(own.from, "from", own.where);
    if (!into || (!own.from.empty() && !door.from)) return;
    door.into = *into;
    door.id = unlike_others(ids_, own.id, door.from ? own.into : front_door_name, own.where, faults_);
    door.width_m = own.width_m;
    const FlatRoom& room = flat_.rooms[*into];
    std::vector<InnerWall> walls;
    PlanSide side = own.wall.value_or(PlanSide::bottom);
    if (!door.from) {
      walls = outer_pieces(flat_.rooms, *into, side);
    } else if (flat_.rooms[*door.from].id != room.id) {
      for (const PlanSide one : all_sides) {
        const auto wall = shared_wall(room.area, one, flat_.rooms[*door.from].area);
        if (!wall) continue;
        walls.push_back(*wall);
        side = one;
      }
    }
    const std::string which =
        own.from.empty() ? "'" + own.into + "' and the outside" : "'" + own.from + "' and '" + own.into + "'";
    if (walls.empty()) {
      const std::string at = own.from.empty() ? " at the " + std::string(word_of(side)) : "";
      return faults_.error(own.where, "no wall" + at + " is between " + which);
    }
    place(own, side, walls, which, door);
    const auto& leaf = own.leaf;
    const bool has = leaf ? *leaf != PlanLeaf::none : !door.from || has_leaf(room.kind);
    if (has)
      door.leaf = leaf == PlanLeaf::open                            ? DoorState::open
                  : leaf == PlanLeaf::shut || (!leaf && !door.from) ? DoorState::shut
                                                                    : DoorState::habit;
    for (const Doorway& other : flat_.doorways) {
      if (overlap(gap_of(door), gap_of(other))) {
        faults_.error(own.where, "it overlaps door '" + other.id + "'");
      } else if (is_before(door, other)) {
        faults_.error(own.where, "its open leaf is in the way of door '" + other.id + "' (another `hinge`?)");
      } else if (is_before(other, door)) {
        faults_.error(own.where, "the open leaf of door '" + other.id + "' is in its way (another `hinge`?)");
      }
    }
    flat_.doorways.push_back(door);
  }

  void place(const PlanDoorSpec& own, PlanSide side, const std::vector<InnerWall>& walls, const std::string& which,
             Doorway& door) {
    const bool at_x = runs_along_x(side);
    const auto at = [&](const Vec2& point) { return at_x ? point.x : point.y; };
    if (at_x ? own.y_m : own.x_m)
      faults_.error(own.where,
                    std::string(across(side)) + ": the wall between " + which + " runs along " + (at_x ? "x" : "y"));
    const std::optional<double> given = at_x ? own.x_m : own.y_m ? std::optional(0.0 - *own.y_m) : std::nullopt;
    constexpr double rounding_m = 1e-9;
    const double half = 0.5 * (own.width_m + flat_wall_m) - rounding_m;
    std::string told;
    for (const InnerWall& wall : walls) {
      const double middle = given.value_or(0.5 * (at(wall.from) + at(wall.to)));
      told += (told.empty() ? "" : ", ") + fixed(at_x ? at(wall.from) : -at(wall.to), 2) + " to " +
              fixed(at_x ? at(wall.to) : -at(wall.from), 2);
      if (middle - half < at(wall.from) || middle + half > at(wall.to)) continue;
      door.middle = at_x ? Vec2(middle, wall.from.y) : Vec2(wall.from.x, middle);
      const Rectangle& r = flat_.rooms[door.into].area;
      door.direction = wall_of(r, side).inward();
      const bool is_low_nearer = middle - at(r.lower) < at(r.upper) - middle;
      // To the right of who goes along +z or -x coordinates fall.
      const bool is_low_left = side == PlanSide::bottom || side == PlanSide::left;
      door.hinge = own.hinge.value_or(is_low_nearer == is_low_left ? DoorHinge::left : DoorHinge::right);
      return;
    }
    faults_.error(own.where, "a door of " + fixed(own.width_m, 2) + " m doesn't fit there: the wall between " + which +
                                 " has " + along(side) + " from " + told + ", with other walls at its ends");
  }

  static Rectangle gap_of(const Doorway& door) {
    const Vec2 half = 0.5 * (door.width_m * Vec2(std::abs(door.direction.y), std::abs(door.direction.x)) +
                             flat_wall_m * glm::abs(door.direction));
    return {door.middle - half, door.middle + half};
  }

  /// Whether the first one's leaf, open, leaves nobody a way through the other.
  static bool is_before(const Doorway& one, const Doorway& other) {
    constexpr double before_m = 0.3, way_m = 0.6;  // assumed: 0.2-0.4, 0.5-0.7
    if (!one.leaf) return false;
    const Vec2 to_right{-one.direction.y, one.direction.x};
    const Vec2 post = one.middle + (one.hinge == DoorHinge::right ? 0.5 : -0.5) * one.width_m * to_right;
    const Vec2 end = post + one.width_m * one.direction, thick(0.02);
    const Rectangle leaf{glm::min(post, end) - thick, glm::max(post, end) + thick}, gap = gap_of(other);
    const Vec2 deep = before_m * glm::abs(other.direction);
    const Vec2 beside = glm::max(leaf.lower - gap.lower, gap.upper - leaf.upper);
    return overlap(leaf, {gap.lower - deep, gap.upper + deep}) &&
           (other.direction.x == 0.0 ? beside.x : beside.y) < way_m;
  }

  /// A way leads from outside into every room.
  void require_ways() {
    std::set<std::string> reached;
    for (std::size_t before = 1, now = 0; before != now;) {
      before = reached.size();
      for (const Doorway& door : flat_.doorways) {
        const std::string& into = flat_.rooms[door.into].id;
        if (!door.from || reached.contains(flat_.rooms[*door.from].id)) reached.insert(into);
        if (door.from && reached.contains(into)) reached.insert(flat_.rooms[*door.from].id);
      }
      now = reached.size();
    }
    if (reached.empty()) return faults_.error(plan_.where, "doors: none leads in from outside (one without `from`)");
    for (std::size_t i = 0; i < flat_.rooms.size(); ++i)
      if (!reached.contains(flat_.rooms[i].id))
        faults_.error(plan_.rooms[i].where, "no door leads to '" + plan_.rooms[i].id + "'");
  }

  const HomePlanSpec& plan_;
  FlatPlan flat_;
  Diagnostics faults_;
  std::set<std::string> ids_;
};

}  // namespace

HomePlanSpec read_home_plan(const std::filesystem::path& file, std::span<const std::string> overrides) {
  Diagnostics faults;
  YamlMap map(YamlNode::load(io::read_input(file), overrides), faults, "plan");
  io::check_version(map, "pirsim_plan");
  HomePlanSpec plan;
  plan.where = map.where();
  plan.name = map.text("name", io::stem_of_input(file));
  io::read_fields(map, plan);
  for (const YamlNode& room : map.required_list("rooms", limits::rooms)) plan.rooms.push_back(read_room(room, faults));
  for (const YamlNode& door : map.required_list("doors")) plan.doors.push_back(read_door(door, faults));
  map.finish();
  std::set<std::string> sensors;
  for (PlanRoomSpec& room : plan.rooms) {
    if (!room.sensors) sensors.insert(room_sensor_name(room.area.empty() ? room.id : room.area));
    if (room.sensors)
      for (PlanSensorSpec& sensor : *room.sensors)
        sensor.id = unlike_others(sensors, sensor.id, room_sensor_name(room.id), sensor.where, faults);
  }
  faults.throw_if_errors();
  return plan;
}

FlatPlan plan_of(const HomePlanSpec& plan) { return Layout(plan).lay_out(); }

}  // namespace pirsim::dataset
