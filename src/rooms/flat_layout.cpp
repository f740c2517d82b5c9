#include "rooms/flat_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "rooms/recipe_fields.hpp"

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
  return word_of(kind) + (which == 1 ? "" : '_' + std::to_string(which));
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

namespace {

using Kind = FlatRoomKind;

// Sizes are `assumed`: the least that the furniture of each kind of room needs.
constexpr double corridor_least_m = 1.15, corridor_most_m = 1.5, hall_least_m = 1.3, hall_most_m = 1.8;
constexpr double row_depth_least_m = 2.4, row_without_beds_least_m = 1.9, bath_widest_m = 3.4;
constexpr double door_from_wall_m = 0.1;  ///< of a doorway, from the room's side wall

/// Of a row of rooms, beside others of weight 1.
double weight_of(Kind kind) {
  switch (kind) {
    case Kind::living_room:
      return 1.7;
    case Kind::kitchen:
      return 0.85;
    case Kind::bath:
      return 0.55;
    case Kind::study:
      return 0.8;
    case Kind::bedroom:
    case Kind::corridor:
      break;
  }
  return 1.0;
}

double least_width_m(Kind kind) {
  switch (kind) {
    case Kind::living_room:
      return 3.0;
    case Kind::kitchen:
    case Kind::study:
      return 2.0;
    case Kind::bath:
      return 1.7;
    case Kind::bedroom:
      return 2.4;
    case Kind::corridor:
      break;
  }
  return corridor_least_m;
}

void shuffle(std::vector<Kind>& kinds, Stream& stream) {
  for (std::size_t i = kinds.size(); i > 1; --i)
    std::swap(kinds[i - 1], kinds[stream.index(static_cast<std::uint32_t>(i))]);
}

double whole_cm(double length) { return std::round(100.0 * length) / 100.0; }

class FlatArchitect {
 public:
  FlatArchitect(const FlatSpec& spec, int residents, Stream& stream) : spec_(spec), stream_(stream) {
    draw_kinds(residents);
    draw_layout();
    draw_size();
  }

  std::variant<FlatPlan, NoPlace> lay_out() {
    if (!lacking_.empty()) return NoPlace{lacking_};
    layout_ == FlatLayout::corridor ? add_rows_at_corridor() : add_rows_at_living_room();
    if (!lacking_.empty()) return NoPlace{lacking_};
    name_rooms();
    add_front_door();
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i) add_doorway(i);
    if (!lacking_.empty()) return NoPlace{lacking_};
    mirror();
    plan_.inner_walls = walls_between(plan_.rooms);
    return std::move(plan_);
  }

 private:
  void fail(const std::string& reason) {
    if (lacking_.empty()) lacking_ = reason;
  }

  /// Which rooms there are: those beside the living room in `back_`.
  void draw_kinds(int residents) {
    rooms_ = draw(spec_.rooms, stream_);
    int bedrooms = rooms_ - 1;
    const bool needs_all = 2 * (bedrooms - 1) < residents;
    const bool has_study = stream_.uniform() < spec_.study;
    const bool has_kitchen = stream_.uniform() < spec_.own_kitchen;
    back_.push_back(Kind::bath);
    if (bedrooms > 1 && !needs_all && has_study) back_.push_back(Kind::study), --bedrooms;
    back_.insert(back_.end(), static_cast<std::size_t>(bedrooms), Kind::bedroom);
    if (has_kitchen) back_.push_back(Kind::kitchen);
  }

  /// One room has nothing on the other side of a corridor.
  void draw_layout() {
    std::vector<FlatLayout> layouts = spec_.layouts;
    if (rooms_ == 1) std::erase(layouts, FlatLayout::corridor);
    if (layouts.empty()) return fail("a flat of one room had no use for a corridor");
    layout_ = one_of(layouts, stream_);
  }

  /// One room and what is before it are longer than wide.
  void draw_size() {
    const double size = draw(spec_.size_m2.value_or(usual_size_m2(rooms_)), stream_);
    const double stretch = draw(spec_.stretch, stream_);
    const double depth = whole_cm(std::sqrt(rooms_ == 1 ? size * stretch : size / stretch));
    plan_.bounds = {{0.0, -depth}, {whole_cm(size / depth), 0.0}};
  }

  [[nodiscard]] double width() const { return plan_.bounds.upper.x; }
  [[nodiscard]] double depth() const { return -plan_.bounds.lower.y; }

  // -- rooms ---------------------------------------------------------------------------------------------------------

  /// Kitchen and, as long as the living room's side is the shorter one, bedrooms change sides.
  void add_rows_at_corridor() {
    std::vector<Kind> front{Kind::living_room}, back;
    double front_weight = weight_of(Kind::living_room), back_weight = 0.0;
    const auto put = [&](Kind kind, std::vector<Kind>& row, double& weight) {
      row.push_back(kind);
      weight += weight_of(kind);
    };
    for (const Kind kind : back_) {
      const bool is_front = kind == Kind::kitchen ? rooms_ > 1 : kind != Kind::bath && front_weight < back_weight;
      is_front ? put(kind, front, front_weight) : put(kind, back, back_weight);
    }
    const double corridor = draw_length({corridor_least_m, corridor_most_m}, stream_);
    const double front_depth = whole_cm((depth() - corridor) * draw(Range{0.45, 0.55}, stream_));
    add_row(front, 0.0, -front_depth);
    plan_.rooms.push_back({Kind::corridor, {}, {{0.0, -front_depth - corridor}, {width(), -front_depth}}});
    add_row(back, -front_depth - corridor, -depth());
  }

  void add_rows_at_living_room() {
    const double front_depth = rooms_ == 1 ? whole_cm(depth() - draw(Range{2.0, 2.6}, stream_))
                                           : whole_cm(depth() * draw(Range{0.45, 0.58}, stream_));
    plan_.rooms.push_back({Kind::living_room, {}, {{0.0, -front_depth}, {width(), 0.0}}});
    if (front_depth < 2.8) fail("the living room was too narrow");
    if (layout_ == FlatLayout::hall) back_.push_back(Kind::corridor);
    add_row(back_, -front_depth, -depth());
  }

  void add_row(std::vector<Kind> kinds, double from_z, double to_z) {
    shuffle(kinds, stream_);
    const bool has_beds = std::ranges::find(kinds, Kind::bedroom) != kinds.end();
    if (from_z - to_z < (has_beds ? row_depth_least_m : row_without_beds_least_m))
      return fail("a row of rooms was too narrow");
    std::vector<double> shares;
    double left = width(), sum = 0.0, hall = 0.0;
    for (const Kind kind : kinds) {
      if (kind == Kind::corridor) hall = draw_length({hall_least_m, hall_most_m}, stream_);
      shares.push_back(kind == Kind::corridor ? 0.0 : weight_of(kind) * draw(Range{0.88, 1.12}, stream_));
      sum += shares.back();
    }
    left -= hall;
    double x = 0.0;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      const double wide = kinds[i] == Kind::corridor ? hall : whole_cm(left * shares[i] / sum);
      const double end = i + 1 == kinds.size() ? width() : whole_cm(x + wide);
      if (end - x < least_width_m(kinds[i])) fail("the " + spoken(kinds[i]) + " was too narrow");
      if (kinds[i] == Kind::bath && end - x > bath_widest_m) fail("the bath took too much space");
      plan_.rooms.push_back({kinds[i], {}, {{x, to_z}, {end, from_z}}});
      x = end;
    }
  }

  static std::string spoken(Kind kind) {
    std::string word = area_name(kind);
    std::ranges::replace(word, '_', ' ');
    return word;
  }

  /// The living room first, the others in the order in which they are listed in files.
  void name_rooms() {
    std::ranges::stable_sort(plan_.rooms, {}, &FlatRoom::kind);
    int bedrooms = 0;
    for (FlatRoom& room : plan_.rooms) room.id = area_name(room.kind, room.kind == Kind::bedroom ? ++bedrooms : 1);
  }

  [[nodiscard]] std::optional<std::size_t> corridor() const {
    const auto found = std::ranges::find(plan_.rooms, Kind::corridor, &FlatRoom::kind);
    if (found == plan_.rooms.end()) return std::nullopt;
    return static_cast<std::size_t>(found - plan_.rooms.begin());
  }

  // -- ways ----------------------------------------------------------------------------------------------------------

  void add_front_door() {
    Doorway door;
    door.id = front_door_name;
    door.leaf = DoorState::shut;
    door.into = corridor().value_or(0);
    const Rectangle& r = plan_.rooms[door.into].area;
    if (layout_ == FlatLayout::hall) {
      door.middle = {whole_cm(0.5 * (r.lower.x + r.upper.x)), r.lower.y};
      door.direction = {0.0, 1.0};
    } else if (layout_ == FlatLayout::corridor) {
      door.middle = {0.0, whole_cm(0.5 * (r.lower.y + r.upper.y))};
      door.direction = {1.0, 0.0};
    } else {
      const double keep = 0.5 * doorway_m + flat_wall_m + door_from_wall_m;
      door.middle = {0.0, -draw_length({keep, -r.lower.y - keep}, stream_)};
      door.direction = {1.0, 0.0};
    }
    door.hinge = stream_.index(2) == 0 ? DoorHinge::left : DoorHinge::right;
    plan_.doorways.push_back(door);
  }

  /// From the corridor where there is one beside the room, else from the living room.
  void add_doorway(std::size_t into) {
    const Kind kind = plan_.rooms[into].kind;
    if (into == 0 && layout_ != FlatLayout::corridor) return;  // all others open into it
    if (kind == Kind::corridor && layout_ == FlatLayout::corridor) return;
    const std::size_t from = layout_ == FlatLayout::corridor ? *corridor() : 0;
    const Rectangle &a = plan_.rooms[from].area, &b = plan_.rooms[into].area;
    const double low = std::max(a.lower.x, b.lower.x), high = std::min(a.upper.x, b.upper.x);
    const double keep = 0.5 * flat_wall_m + door_from_wall_m + 0.5 * doorway_m;
    if (high - low < 2.0 * keep) return fail("a room had no wall for its door");
    const bool is_behind = b.upper.y <= a.lower.y;
    const bool is_shut = has_leaf(kind);
    // A leaf rests at a side wall; a gap may be anywhere.
    const double room_m = high - low - 2.0 * keep;
    const bool at_low_end = stream_.index(2) == 0;
    const double along = draw_length({0.0, is_shut ? std::min(room_m, 0.3) : room_m}, stream_);
    Doorway door;
    door.id = plan_.rooms[into].id;
    door.from = from;
    door.into = into;
    door.direction = {0.0, is_behind ? -1.0 : 1.0};
    door.middle = {whole_cm(at_low_end ? low + keep + along : high - keep - along), is_behind ? b.upper.y : b.lower.y};
    if (is_shut) door.leaf = DoorState::habit;
    // Who goes towards -z has +x to the right.
    door.hinge = at_low_end == is_behind ? DoorHinge::left : DoorHinge::right;
    plan_.doorways.push_back(door);
  }

  // -- the whole -----------------------------------------------------------------------------------------------------

  void mirror() {
    const bool in_x = stream_.index(2) == 0, in_z = stream_.index(2) == 0;
    const auto flipped = [&](const Vec2& p) {
      return Vec2(in_x ? whole_cm(width() - p.x) : p.x, in_z ? 0.0 - whole_cm(depth() + p.y) : p.y);
    };
    for (FlatRoom& room : plan_.rooms) {
      const Vec2 a = flipped(room.area.lower), b = flipped(room.area.upper);
      room.area = {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
    }
    for (Doorway& door : plan_.doorways) {
      door.middle = flipped(door.middle);
      door.direction *= Vec2(in_x ? -1.0 : 1.0, in_z ? -1.0 : 1.0);
      if (in_x != in_z) door.hinge = door.hinge == DoorHinge::left ? DoorHinge::right : DoorHinge::left;
    }
  }

  const FlatSpec& spec_;
  Stream& stream_;
  FlatPlan plan_;
  FlatLayout layout_ = FlatLayout::corridor;
  int rooms_ = 1;
  std::vector<Kind> back_;  ///< all rooms but the living room
  std::string lacking_;
};

}  // namespace

Range usual_size_m2(int rooms) noexcept {
  constexpr Range first{28.0, 42.0}, other{17.0, 23.0};
  return {first.least + (rooms - 1) * other.least, first.most + (rooms - 1) * other.most};
}

Rectangle FlatPlan::clear_floor(std::size_t room) const {
  const Rectangle& area = rooms[room].area;
  constexpr double half = 0.5 * flat_wall_m;
  return {{area.lower.x + (area.lower.x > bounds.lower.x ? half : 0.0),
           area.lower.y + (area.lower.y > bounds.lower.y ? half : 0.0)},
          {area.upper.x - (area.upper.x < bounds.upper.x ? half : 0.0),
           area.upper.y - (area.upper.y < bounds.upper.y ? half : 0.0)}};
}

Wall wall_of(const Rectangle& room, PlanSide side) { return FloorPlan(room).walls()[static_cast<std::size_t>(side)]; }

std::optional<InnerWall> shared_wall(const Rectangle& room, PlanSide side, const Rectangle& other) {
  const bool at_x = runs_along_x(side), at_upper = side == PlanSide::bottom || side == PlanSide::right;
  const Vec2 &own = at_upper ? room.upper : room.lower, &facing = at_upper ? other.lower : other.upper;
  const Vec2 low = glm::max(room.lower, other.lower), high = glm::min(room.upper, other.upper);
  if (at_x ? own.y != facing.y || high.x <= low.x : own.x != facing.x || high.y <= low.y) return std::nullopt;
  return InnerWall{low, high};
}

std::vector<InnerWall> walls_between(const std::vector<FlatRoom>& rooms) {
  std::vector<InnerWall> walls;
  for (const FlatRoom& one : rooms) {
    for (const FlatRoom& other : rooms) {
      if (one.id == other.id) continue;
      for (const PlanSide side : {PlanSide::right, PlanSide::bottom})
        if (const auto wall = shared_wall(one.area, side, other.area)) walls.push_back(*wall);
    }
  }
  return walls;
}

std::variant<FlatPlan, NoPlace> lay_out(const FlatSpec& spec, int residents, Stream& stream) {
  return FlatArchitect(spec, residents, stream).lay_out();
}

}  // namespace pirsim::dataset
