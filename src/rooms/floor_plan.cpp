#include "rooms/floor_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/sim/compiled_study.hpp"
#include "engine/study/people.hpp"
#include "model/schema/check_scene.hpp"
#include "pirsim/model.hpp"
#include "pirsim/room.hpp"
#include "surveys/sight.hpp"

namespace pirsim::dataset {
namespace {

constexpr double rounding_m = 1e-9;

/// Cosine and sine of whole quarters, exactly.
std::array<int, 2> turn(int quarters) {
  constexpr std::array<std::array<int, 2>, 4> turns{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  return turns[static_cast<std::size_t>(((quarters % 4) + 4) % 4)];
}

/// Of what faces that way; `direction` is along an axis.
int quarters_facing(const Vec2& direction) { return static_cast<int>(std::lround(heading_of(direction) / (0.5 * pi))); }

}  // namespace

Vec2 Spot::operator*(const Vec2& own) const {
  const auto [c, s] = turn(quarters);
  return origin + Vec2(c * own.x + s * own.y, c * own.y - s * own.x);
}

Rectangle Spot::operator*(const Rectangle& own) const {
  const Vec2 a = *this * own.lower, b = *this * own.upper;
  return {glm::min(a, b), glm::max(a, b)};
}

Frame Spot::frame(double height_m) const {
  return {rotation_from_heading(0.5 * pi * quarters), Vec3(origin.x, height_m, origin.y)};
}

double Wall::length_m() const { return glm::distance(from, to); }
Vec2 Wall::along() const { return (to - from) / length_m(); }
Vec2 Wall::inward() const { return {along().y, -along().x}; }
Spot Wall::facing_room(double along_m) const { return {at(along_m), quarters_facing(inward())}; }
Spot Wall::facing_wall(double along_m, double inward_m) const {
  return {at(along_m, inward_m), quarters_facing(-inward())};
}

FloorPlan::FloorPlan(double width_m, double depth_m, std::optional<Rectangle> missing_corner)
    : bounds_{{0.0, -depth_m}, {width_m, 0.0}}, missing_(missing_corner) {
  outline_ = {{0.0, 0.0}, {width_m, 0.0}};
  if (!missing_) {
    outline_.insert(outline_.end(), {{width_m, -depth_m}, {0.0, -depth_m}});
  } else if (missing_->upper.x == width_m) {
    outline_.insert(outline_.end(), {{width_m, missing_->upper.y},
                                     {missing_->lower.x, missing_->upper.y},
                                     {missing_->lower.x, -depth_m},
                                     {0.0, -depth_m}});
  } else {
    outline_.insert(outline_.end(), {{width_m, -depth_m},
                                     {missing_->upper.x, -depth_m},
                                     {missing_->upper.x, missing_->upper.y},
                                     {0.0, missing_->upper.y}});
  }
  build_walls();
}

FloorPlan::FloorPlan(const Rectangle& bounds)
    : bounds_(bounds),
      outline_{{bounds.lower.x, bounds.upper.y}, bounds.upper, {bounds.upper.x, bounds.lower.y}, bounds.lower} {
  build_walls();
}

void FloorPlan::build_walls() {
  const std::size_t n = outline_.size();
  const auto is_inner = [&](const Vec2& p) {
    return missing_ && p.y == missing_->upper.y && p.x != bounds_.lower.x && p.x != bounds_.upper.x;
  };
  for (std::size_t i = 0; i < n; ++i) {
    Wall& wall = walls_.emplace_back();
    wall.from = outline_[i];
    wall.to = outline_[(i + 1) % n];
    wall.convex_at_from = !is_inner(wall.from);
    wall.convex_at_to = !is_inner(wall.to);
    if (!wall.convex_at_from || !wall.convex_at_to) wall.kind = Wall::Kind::of_missing_corner;
  }
}

bool overlap(const Rectangle& a, const Rectangle& b) noexcept {
  return a.lower.x < b.upper.x - rounding_m && b.lower.x < a.upper.x - rounding_m &&
         a.lower.y < b.upper.y - rounding_m && b.lower.y < a.upper.y - rounding_m;
}

bool FloorPlan::contains(const Rectangle& r) const noexcept {
  const bool within = r.lower.x >= bounds_.lower.x - rounding_m && r.lower.y >= bounds_.lower.y - rounding_m &&
                      r.upper.x <= bounds_.upper.x + rounding_m && r.upper.y <= bounds_.upper.y + rounding_m;
  return within && !(missing_ && overlap(r, *missing_));
}

bool FloorPlan::is_free(const Rectangle& r) const noexcept {
  return contains(r) && std::ranges::none_of(occupied_, [&](const Rectangle& other) { return overlap(r, other); });
}

double draw(const Range& range, Stream& stream) { return range.least + (range.most - range.least) * stream.uniform(); }
int draw(const CountRange& range, Stream& stream) {
  return range.least + static_cast<int>(stream.index(static_cast<std::uint32_t>(range.most - range.least + 1)));
}
double draw_length(const Range& range, Stream& stream) {
  const double length = std::round(100.0 * draw(range, stream)) / 100.0;
  return std::clamp(length, range.least, range.most);
}

namespace {

/// Single precision, as a file holds it, so that a room in memory and one read back are the same.
using Sides = std::array<float, 2>;
Sides sides(double lower, double upper) { return {static_cast<float>(lower), static_cast<float>(upper)}; }

}  // namespace

TriMesh boxes(const std::string& name, const Spot& spot, std::span<const BoxPart> parts) {
  // Corner k has the upper x, y, z where bit 0, 1, 2 is set; outward, counter-clockwise.
  constexpr std::array<std::array<std::uint32_t, 4>, 6> quads{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  TriMesh mesh;
  mesh.name = name;
  for (const BoxPart& part : parts) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Rectangle r = spot * part.footprint;
    const Sides x = sides(r.lower.x, r.upper.x), y = sides(part.from_y_m, part.to_y_m), z = sides(r.lower.y, r.upper.y);
    for (std::size_t k = 0; k < 8; ++k) mesh.positions.emplace_back(x[k & 1], y[k >> 1 & 1], z[k >> 2 & 1]);
    for (const auto& q : quads) {
      mesh.triangles.push_back({first + q[0], first + q[1], first + q[2]});
      mesh.triangles.push_back({first + q[0], first + q[2], first + q[3]});
    }
  }
  return mesh;
}

TriMesh floor_mesh(const std::vector<Rectangle>& pieces) {
  TriMesh mesh;
  mesh.name = "floor";
  for (const Rectangle& r : pieces) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Sides x = sides(r.lower.x, r.upper.x), z = sides(r.lower.y, r.upper.y);
    for (const auto& [i, k] : {std::pair(0, 1), std::pair(1, 1), std::pair(1, 0), std::pair(0, 0)}) {
      mesh.positions.emplace_back(x[static_cast<std::size_t>(i)], 0.0F, z[static_cast<std::size_t>(k)]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

namespace {

/// What takes somebody to each seat and place.
std::vector<ScriptedAction> stops_of(const SceneSpec& scene, const Origins& origins) {
  const auto origin = [&](const std::string& id) {
    const auto known = origins.find(id);
    return known == origins.end() ? Where{} : known->second;
  };
  std::vector<ScriptedAction> stops;
  for (const SeatSpec& seat : scene.seats) stops.push_back({action::Sit{seat.id}, {}, {}, origin(seat.id)});
  for (const PlaceSpec& place : scene.places) {
    if (place.posture == PlacePosture::lie) {
      stops.push_back({action::Lie{place.id}, {}, {}, origin(place.id)});
    } else {
      stops.push_back({action::Stand{place.id}, {}, {}, origin(place.id)});
    }
  }
  return stops;
}

/// To every seat and place, in and out through each door by turns; only through the doors where there is neither.
std::vector<ScriptedAction> ways_through(const SceneSpec& scene, const Origins& origins) {
  std::vector<ScriptedAction> actions;
  const std::vector<ScriptedAction> stops = stops_of(scene, origins);
  const std::size_t n_doors = scene.entrances.size();
  for (std::size_t i = 0; i < std::max(stops.size(), n_doors); ++i) {
    const std::string& door = scene.entrances[i % n_doors].id;
    actions.push_back({action::Enter{door}, {}, {}, {}});
    if (!stops.empty()) actions.push_back(stops[i % stops.size()]);
    actions.push_back({action::Leave{door}, {}, {}, {}});
  }
  return actions;
}

/// The first is the largest; where sides of beds matter somebody of usual size comes as well.
ScriptSpec tour_of(const SceneSpec& scene, const Demands& demands, const Origins& origins = {}) {
  ScriptSpec script;
  script.name = "tour of " + scene.name;
  std::vector<PersonSpec> visitors{largest_body("visitor")};
  if (!demands.shared_beds.empty()) visitors.emplace_back().id = "other";
  for (PersonSpec& visitor : visitors) visitor.actions = ways_through(scene, origins);
  script.trials.push_back({"1", std::move(visitors)});
  return script;
}

/// Nobody climbs over whom they share a bed with.
bool gets_in_at_own_side(const sim::PersonModel& person, const SceneSpec& scene, const std::string& bed) {
  constexpr double half_bed_m = 0.9, calves_m = 0.15;
  const sim::LyingPlan& plan = person.beds.at(bed);
  const Vec2 stand = plan.edge.stand(plan.edge.place.world_from_seat);
  const Vec3& place = std::ranges::find(scene.places, bed, &PlaceSpec::id)->world_from_place.origin;
  return glm::distance(stand, floor_point(place)) < half_bed_m + calves_m;
}

}  // namespace

std::optional<Issue> unreached(const SceneSpec& scene, const Origins& origins) {
  try {
    static_cast<void>(compile(scene, tour_of(scene, {}, origins)));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    return error.issues().front();
  }
  return {};
}

std::string fault_of(const SceneSpec& scene, const Demands& demands) {
  try {
    const Model model = compile(scene, tour_of(scene, demands));
    for (const sim::PersonModel& person : model.compiled().trials().front().people) {
      for (const std::string& bed : demands.shared_beds) {
        if (!gets_in_at_own_side(person, scene, bed)) return "one side of a shared bed couldn't be reached";
      }
    }
    const SightReport report = studies::look_around(model);
    if (std::ranges::any_of(report.sensors, &SensorSight::sees_nothing)) return "a sensor saw nobody";
    const auto sees_little = [&](const SensorSight& sensor) { return sensor.places < demands.least_places; };
    if (std::ranges::any_of(report.sensors, sees_little)) return "a sensor saw hardly any of the floor";
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    return scene.places.empty() ? "a seat or door couldn't be reached" : "a seat, place or door couldn't be reached";
  }
  return {};
}

void ModelFinder::add_to(SceneSpec& scene) {
  for (const SensorSpec& sensor : scene.sensors) {
    if (!known_.contains(sensor.model)) {
      const auto by = std::ranges::find_if(
          named_, [&](const Named& one) { return std::ranges::find(one.models, sensor.model) != one.models.end(); });
      const Where& named_at = by == named_.end() ? otherwise_ : by->where;
      known_.emplace(sensor.model, io::find_sensor_model(sensor.model, {}, options_, named_at));
    }
    scene.sensor_models.emplace(sensor.model, known_.at(sensor.model));
  }
  move_arrays(scene);
}

void Failures::give_up(const std::string& what, int number, const Where& where) const {
  std::string told;
  int tries = 0;
  for (const auto& [reason, times] : reasons_) {
    tries += times;
    told += (told.empty() ? "" : "; ") + std::to_string(times) + (times == 1 ? " time " : " times ") + reason;
  }
  throw Error(ErrorCode::infeasible, where,
              what + ' ' + std::to_string(number) + ": none of " + std::to_string(tries) + ' ' + what +
                  "s drawn from these ranges could be used (" + told + "): allow more space or less furniture");
}

namespace {

// Sizes are `assumed`: common office furniture, as in the shipped rooms; the ranges that were looked at stand behind.
constexpr double wall_m = 0.1;
constexpr double door_height_m = 2.1, door_from_corner_m = 0.3;
constexpr double kept_free_at_door_m = 1.2;                   // 0.9-1.5
constexpr double desk_depth_m = 0.8, desk_height_m = 0.74;    // 0.7-0.8, 0.72-0.76
constexpr double hip_height_m = 0.53;                         // of sitters, as in the shipped rooms
constexpr double pelvis_behind_desk_m = 0.16;                 // 0.12-0.25
constexpr double chair_zone_m = 1.0;                          // 0.8-1.2: behind a desk, to get to the chair
constexpr double seat_spacing_m = 0.70, table_width_m = 1.1;  // 0.6-0.75 and 1.0-1.4
constexpr double cupboard_depth_m = 0.42;                     // 0.35-0.45
constexpr double off_wall_m = 0.03;                           // of a sensor
// Where these leave no place for a meeting table: a narrow one, chairs drawn in, nobody behind its ends.
constexpr double narrow_table_m = 0.8, narrow_chair_zone_m = 0.75;  // 0.7-0.9, 0.7-0.8
constexpr int attempts = 60;                                        // to place one thing

class Furnisher {
 public:
  Furnisher(const RoomSpec& spec, Fit fit, Stream& stream)
      : spec_(spec), fit_(fit), stream_(stream), plan_(draw_shape()) {}

  std::variant<DrawnRoom, NoPlace> furnish() {
    for (int i = draw(spec_.doors, stream_); i > 0; --i) add_door();
    build_walls();
    const int seats = draw(spec_.seats, stream_);
    spec_.kind == RoomKind::office ? add_desks(seats) : add_meeting_table(seats);
    for (int i = draw(spec_.cupboards, stream_); i > 0; --i) add_cupboard();
    for (int i = draw(spec_.partitions, stream_); i > 0; --i) add_partition();
    for (const SensorGroupSpec& group : spec_.sensors) {
      for (int i = draw(group.count, stream_); i > 0; --i) add_sensor(group);
    }
    if (room_.scene.sensors.empty()) fail("no sensor was drawn");
    if (!lacking_.empty()) return NoPlace{lacking_};
    for (const Furnishing& furnishing : room_.furnishings) room_.scene.meshes.push_back(furnishing.mesh);
    return std::move(room_);
  }

 private:
  FloorPlan draw_shape() {
    room_.width_m = draw_length(spec_.width_m, stream_);
    room_.depth_m = draw_length(spec_.depth_m, stream_);
    room_.height_m = draw_length(spec_.height_m, stream_);
    std::optional<Rectangle> missing;
    const bool is_l_shaped = stream_.uniform() < spec_.l_shaped;
    const double w = std::round(100.0 * room_.width_m * draw(spec_.cut_share, stream_)) / 100.0;
    const double d = std::round(100.0 * room_.depth_m * draw(spec_.cut_share, stream_)) / 100.0;
    const bool at_right = stream_.index(2) == 0;
    if (is_l_shaped) {
      missing = at_right ? Rectangle{{room_.width_m - w, -room_.depth_m}, {room_.width_m, d - room_.depth_m}}
                         : Rectangle{{0.0, -room_.depth_m}, {w, d - room_.depth_m}};
    }
    FloorPlan plan(room_.width_m, room_.depth_m, missing);
    room_.outline = plan.outline();
    room_.scene.floor = FloorArea({plan.outline()}, 0.0);
    std::vector<Rectangle> pieces{plan.bounds()};
    if (missing) {
      pieces = {{{0.0, missing->upper.y}, {room_.width_m, 0.0}},
                at_right ? Rectangle{{0.0, -room_.depth_m}, {missing->lower.x, missing->upper.y}}
                         : Rectangle{{missing->upper.x, -room_.depth_m}, {room_.width_m, missing->upper.y}}};
    }
    room_.furnishings.push_back({Fixture::structure, floor_mesh(pieces), {}});
    return plan;
  }

  void fail(const std::string& reason) {
    if (lacking_.empty()) lacking_ = reason;
  }

  // -- doors and walls
  // -------------------------------------------------------------------------------------------------

  struct Door {
    std::size_t wall;
    double from_m, to_m;  ///< along the wall
  };

  void add_door() {
    const double width = draw_length(spec_.door_width_m, stream_);
    for (int k = 0; k < attempts; ++k) {
      const std::size_t wall = stream_.index(static_cast<std::uint32_t>(plan_.walls().size()));
      const Wall& w = plan_.walls()[wall];
      const double room = w.length_m() - 2.0 * door_from_corner_m - width;
      const double from = door_from_corner_m + draw_length({0.0, std::max(0.0, room)}, stream_);
      if (room < 0.0 || w.kind == Wall::Kind::of_missing_corner) continue;
      const Spot spot = w.facing_room(from + 0.5 * width);
      const Rectangle before = spot * Rectangle{{-0.5 * width - 0.1, -kept_free_at_door_m}, {0.5 * width + 0.1, 0.0}};
      if (!plan_.is_free(before)) continue;
      plan_.occupy(before);
      doors_.push_back({wall, from, from + width});
      const std::string id = doors_.size() == 1 ? "door" : "door_" + std::to_string(doors_.size());
      room_.scene.entrances.push_back({id, spot.frame(0.0), width, 1.5});
      return;
    }
    fail("there was no place for a door");
  }

  void build_walls() {
    const double top = room_.height_m;
    for (std::size_t i = 0; i < plan_.walls().size(); ++i) {
      const Wall& wall = plan_.walls()[i];
      const std::string name = "wall " + std::to_string(i + 1);
      double from = wall.convex_at_from ? -wall_m : 0.0;
      const double end = wall.length_m() + (wall.convex_at_to ? wall_m : 0.0);
      std::vector<Door> doors;
      std::ranges::copy_if(doors_, std::back_inserter(doors), [&](const Door& door) { return door.wall == i; });
      std::ranges::sort(doors, {}, &Door::from_m);
      for (const Door& door : doors) {
        add_wall_piece(name, wall, from, door.from_m, 0.0, top);
        add_wall_piece(name + " above a door", wall, door.from_m, door.to_m, door_height_m, top);
        from = door.to_m;
      }
      add_wall_piece(name, wall, from, end, 0.0, top);
    }
    const Rectangle b = plan_.bounds();
    add(Fixture::structure, "ceiling", {}, {{{b.lower - Vec2(wall_m), b.upper + Vec2(wall_m)}, top, top + wall_m}});
  }

  void add_wall_piece(const std::string& name, const Wall& wall, double from_m, double to_m, double low, double high) {
    // Who faces the room there has the wall's end to the right and the outside behind.
    add(Fixture::structure, name, wall.facing_room(0.0), {{{{from_m, 0.0}, {to_m, wall_m}}, low, high}});
  }

  // -- desks, tables, seats
  // --------------------------------------------------------------------------------------------

  /// What has a part between 0.1 and 2 m covers the floor there.
  void add(Fixture kind, const std::string& name, const Spot& spot, const std::vector<BoxPart>& parts) {
    Rectangle all = parts.front().footprint;
    for (const BoxPart& part : parts) {
      all = {glm::min(all.lower, part.footprint.lower), glm::max(all.upper, part.footprint.upper)};
    }
    room_.furnishings.push_back({kind, boxes(name, spot, parts), spot * all});
  }

  void add_seat(const Spot& spot) {
    room_.scene.seats.push_back({"S" + std::to_string(room_.scene.seats.size() + 1), spot.frame(hip_height_m)});
  }

  /// A desk whose user sits at its +Z.
  void add_desk(const Spot& spot, double width) {
    const std::string name = "desk " + std::to_string(room_.scene.seats.size() + 1);
    const double x = 0.5 * width - 0.01, z = 0.5 * desk_depth_m - 0.01, top = desk_height_m, under = top - 0.025;
    const bool drawers_left = stream_.index(2) == 0;
    const double side = drawers_left ? -1.0 : 1.0;
    const auto between = [&](double a, double b) {
      return Rectangle{{std::min(side * a, side * b), -0.35}, {std::max(side * a, side * b), 0.35}};
    };
    add(Fixture::desk, name, spot,
        {{{{-x, -z}, {x, z}}, under, top},
         {between(0.02 - x, 0.05 - x), 0.0, under},
         {between(0.23 * width, x - 0.02), 0.0, under}});
    add(Fixture::screen, "monitor " + std::to_string(room_.scene.seats.size() + 1), spot,
        {{{{-0.3, -0.25}, {0.3, -0.21}}, top + 0.11, top + 0.46}});
    add_seat({spot * Vec2(0.0, 0.5 * desk_depth_m + pelvis_behind_desk_m), spot.quarters});
  }

  void add_desks(int seats) {
    const DeskOrder order = one_of(spec_.orders, stream_);
    const double width = draw_length(spec_.desk_width_m, stream_);
    const int common = static_cast<int>(stream_.index(4));
    while (seats > 0 && lacking_.empty()) {
      if (order == DeskOrder::islands) {
        const int block = std::min(seats, 2 + 2 * static_cast<int>(stream_.index(3)));
        add_island(block, width);
        seats -= block;
      } else if (order == DeskOrder::rows) {
        const int block = std::min(seats, 1 + static_cast<int>(stream_.index(4)));
        add_row(block, width, common);
        seats -= block;
      } else {
        add_desk_at_wall(width);
        --seats;
      }
    }
  }

  /// Where such a rectangle, given in the axes of what is put down, is free; or none after some attempts.
  template <typename Propose>
  std::optional<Spot> find_spot(const Rectangle& own, const Propose& propose) {
    for (int k = 0; k < attempts; ++k) {
      const Spot spot = propose();
      if (plan_.is_free(spot * own)) return spot;
    }
    return std::nullopt;
  }

  Spot anywhere(int quarters) {
    const Rectangle b = plan_.bounds();
    const Vec2 place(draw_length({b.lower.x, b.upper.x}, stream_), draw_length({b.lower.y, b.upper.y}, stream_));
    return {place, quarters};
  }

  /// Its back to a wall, half_width_m from its middle to its sides, and the middle of its back inward_m off the wall.
  Spot somewhere_at_wall(double half_width_m, double inward_m) {
    const Wall& wall = one_of(plan_.walls(), stream_);
    const double room = std::max(0.0, wall.length_m() - 2.0 * half_width_m);
    return wall.facing_wall(half_width_m + draw_length({0.0, room}, stream_), inward_m);
  }

  void add_island(int desks, double width) {
    const int across = (desks + 1) / 2;
    const double half = 0.5 * across * width, deep = desk_depth_m + chair_zone_m + 0.02;
    // Without a facing desk there is nobody behind it.
    const Rectangle own{{-half, desks == 1 ? -0.02 : -deep}, {half, deep}};
    const auto spot = find_spot(own, [&] { return anywhere(static_cast<int>(stream_.index(4))); });
    if (!spot) return fail("there was no place for an island of desks");
    plan_.occupy(*spot * own);
    for (int i = 0; i < desks; ++i) {
      const double x = (i / 2 + 0.5) * width - half;
      const bool facing = i % 2 == 0;
      const double z = (facing ? 1.0 : -1.0) * (0.5 * desk_depth_m + 0.02);
      add_desk({*spot * Vec2(x, z), spot->quarters + (facing ? 0 : 2)}, width);
    }
    if (stream_.uniform() >= spec_.desk_screens) return;
    add(Fixture::partition, "desk screen", *spot, {{{{-half, -0.02}, {half, 0.02}}, 0.6, 1.25}});
  }

  void add_row(int desks, double width, int quarters) {
    const double half = 0.5 * desks * width;
    const Rectangle own{{-half, -0.5 * desk_depth_m}, {half, 0.5 * desk_depth_m + chair_zone_m}};
    const auto spot = find_spot(own, [&] { return anywhere(quarters); });
    if (!spot) return fail("there was no place for a row of desks");
    plan_.occupy(*spot * own);
    for (int i = 0; i < desks; ++i) add_desk({*spot * Vec2((i + 0.5) * width - half, 0.0), quarters}, width);
  }

  void add_desk_at_wall(double width) {
    const double half = 0.5 * width;
    const Rectangle own{{-half, -0.5 * desk_depth_m}, {half, 0.5 * desk_depth_m + chair_zone_m}};
    const auto spot = find_spot(own, [&] { return somewhere_at_wall(half, 0.5 * desk_depth_m); });
    if (!spot) return fail("there was no place for a desk at a wall");
    plan_.occupy(*spot * own);
    add_desk(*spot, width);
  }

  void add_meeting_table(int seats) {
    // At the table's ends: one for an odd number, two for half of the large even ones.
    const int heads = seats % 2 + (seats % 2 == 0 && seats >= 6 && stream_.index(2) == 0 ? 2 : 0);
    const int a_side = std::max(1, (seats - heads) / 2);
    const bool is_tight = fit_ == Fit::tight;
    const double x = 0.5 * (a_side * seat_spacing_m + (heads > 0 ? 0.5 : 0.2));
    const double z = 0.5 * (is_tight ? narrow_table_m : table_width_m);
    const double behind = is_tight ? narrow_chair_zone_m : chair_zone_m;
    const double left = is_tight && heads < 2 ? 0.0 : behind, right = is_tight && heads < 1 ? 0.0 : behind;
    const Rectangle own{{-x - left, -z - behind}, {x + right, z + behind}};
    const auto spot = find_spot(own, [&] { return anywhere(static_cast<int>(stream_.index(2))); });
    if (!spot) return fail("there was no place for the table");
    plan_.occupy(*spot * own);
    std::vector<BoxPart> parts{{{{-x, -z}, {x, z}}, desk_height_m - 0.03, desk_height_m}};
    for (const double leg : {-0.5 * x, 0.5 * x}) {
      parts.push_back({{{leg - 0.03, -0.25}, {leg + 0.03, 0.25}}, 0.0, desk_height_m - 0.03});
    }
    add(Fixture::table, "table", *spot, parts);
    for (int i = 0; i < seats - heads; ++i) {
      const double along = (i / 2 + 0.5 - 0.5 * a_side) * seat_spacing_m;
      const int turned = i % 2 == 0 ? 0 : 2;
      const double away = (i % 2 == 0 ? 1.0 : -1.0) * (z + pelvis_behind_desk_m);
      add_seat({*spot * Vec2(along, away), spot->quarters + turned});
    }
    if (heads > 0) add_seat({*spot * Vec2(x + pelvis_behind_desk_m, 0.0), spot->quarters + 1});
    if (heads > 1) add_seat({*spot * Vec2(-x - pelvis_behind_desk_m, 0.0), spot->quarters + 3});
  }

  void add_cupboard() {
    const double width = draw_length({0.8, 1.6}, stream_);
    const double height = one_of(std::vector<double>{0.8, 1.2, 2.0}, stream_);
    const double half = 0.5 * width;
    const Rectangle own{{-half, -0.5 * cupboard_depth_m}, {half, 0.5 * cupboard_depth_m}};
    const auto spot = find_spot(own, [&] { return somewhere_at_wall(half, 0.5 * cupboard_depth_m); });
    if (!spot) return fail("there was no place for a cupboard");
    plan_.occupy(*spot * own);
    add(Fixture::cupboard, "cupboard " + std::to_string(++cupboards_), *spot, {{own, 0.0, height}});
  }

  void add_partition() {
    const double half = 0.5 * draw_length({1.0, 2.0}, stream_), height = draw_length({1.4, 1.8}, stream_);
    const Rectangle own{{-half, -0.025}, {half, 0.025}};
    const auto spot = find_spot(own, [&] { return anywhere(static_cast<int>(stream_.index(2))); });
    if (!spot) return fail("there was no place for a partition");
    plan_.occupy(*spot * own);
    add(Fixture::partition, "partition " + std::to_string(++partitions_), *spot, {{own, 0.0, height}});
  }

  // -- sensors
  // ---------------------------------------------------------------------------------------------------------

  void add_sensor(const SensorGroupSpec& group) {
    SensorSpec& sensor = room_.scene.sensors.emplace_back();
    sensor.id = "PIR" + std::to_string(room_.scene.sensors.size());
    sensor.model = one_of(models_of(group), stream_);
    const double height = std::min(draw_length(group.height_m, stream_), room_.height_m - off_wall_m);
    const double tilt = radians(std::round(draw(group.tilt_deg, stream_)));
    if (group.mount == Mount::ceiling) return hang_on_ceiling(sensor);
    const Quat down = glm::angleAxis(-tilt, Vec3(1, 0, 0));
    const auto& [place, direction] = group.mount == Mount::wall ? place_on_wall() : place_in_corner();
    sensor.world_from_sensor = {rotation_from_heading(heading_of(direction)) * down, Vec3(place.x, height, place.y)};
  }

  /// Away from the sensors that are there: the best of some places.
  void hang_on_ceiling(SensorSpec& sensor) {
    constexpr double from_wall_m = 0.5;
    Vec2 best = 0.5 * (plan_.bounds().lower + plan_.bounds().upper);
    double farthest = -1.0;
    for (int k = 0; k < 8; ++k) {
      const Vec2 place = anywhere(0).origin;
      if (!plan_.contains({place - Vec2(from_wall_m), place + Vec2(from_wall_m)})) continue;
      double nearest = 1e9;
      for (const Vec2& other : on_ceiling_) nearest = std::min(nearest, glm::distance(place, other));
      if (nearest > farthest) farthest = nearest, best = place;
      if (on_ceiling_.empty()) break;
    }
    on_ceiling_.push_back(best);
    const Quat straight_down = glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0));
    const double turn = radians(5.0 * stream_.index(72));
    sensor.world_from_sensor = {rotation_from_heading(turn) * straight_down,
                                Vec3(best.x, room_.height_m - 0.01, best.y)};
  }

  std::pair<Vec2, Vec2> place_on_wall() {
    const Wall& wall = one_of(plan_.walls(), stream_);
    const double from_corner = std::min(0.5, 0.5 * wall.length_m());
    return {wall.at(draw_length({from_corner, wall.length_m() - from_corner}, stream_), off_wall_m), wall.inward()};
  }

  /// A corner that no sensor has yet, while there is one.
  std::pair<Vec2, Vec2> place_in_corner() {
    std::vector<std::size_t> free;
    const std::size_t n = plan_.walls().size();
    const bool all_taken = corners_.size() >= n - (n > 4 ? 1 : 0);
    for (std::size_t i = 0; i < n; ++i) {
      if (!plan_.walls()[i].convex_at_from) continue;
      if (all_taken || std::ranges::find(corners_, i) == corners_.end()) free.push_back(i);
    }
    const std::size_t corner = one_of(free, stream_);
    corners_.push_back(corner);
    const Vec2 inward = plan_.walls()[corner].inward() + plan_.walls()[(corner + n - 1) % n].inward();
    return {plan_.walls()[corner].from + 0.05 * inward, glm::normalize(inward)};
  }

  const RoomSpec& spec_;
  Fit fit_;
  Stream& stream_;
  DrawnRoom room_;
  FloorPlan plan_;
  std::string lacking_;
  std::vector<Door> doors_;
  std::vector<Vec2> on_ceiling_;
  std::vector<std::size_t> corners_;
  int cupboards_ = 0, partitions_ = 0;
};

}  // namespace

const std::vector<std::string>& models_of(const SensorGroupSpec& group) {
  static const std::vector<std::string> ceiling_default{"EKMC1601111"}, other_default{"EKMC1604111"};
  if (!group.models.empty()) return group.models;
  return group.mount == Mount::ceiling ? ceiling_default : other_default;
}

std::variant<DrawnRoom, NoPlace> furnish(const RoomSpec& spec, Fit fit, Stream& stream) {
  return Furnisher(spec, fit, stream).furnish();
}

namespace {

void number_through(std::vector<SensorSpec>& sensors, const std::string& kind) {
  for (std::size_t i = 0; i < sensors.size(); ++i) sensors[i].id = kind + std::to_string(i + 1);
}

}  // namespace

DrawnRoom draw_room(const RoomSpec& spec, std::uint64_t seed, int number, const io::SceneOptions& options) {
  std::vector<ModelFinder::Named> named;
  for (const SensorGroupSpec& group : spec.sensors) named.push_back({group.models, group.where});
  ModelFinder models(std::move(named), spec.where, options);
  Failures failures;
  const int all_tries = spec.kind == RoomKind::meeting ? 2 * most_tries : most_tries;
  for (int tries = 1; tries <= all_tries; ++tries) {
    Stream stream({seed, static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(tries), Purpose::room});
    auto drawn = furnish(spec, tries <= most_tries ? Fit::usual : Fit::tight, stream);
    if (const auto* lacking = std::get_if<NoPlace>(&drawn)) {
      failures.add(lacking->reason);
      continue;
    }
    auto& room = std::get<DrawnRoom>(drawn);
    room.number = number;
    room.tries = tries;
    room.scene.name = "room " + std::to_string(number);
    models.add_to(room.scene);
    if (!room.scene.arrays.empty()) {
      number_through(room.scene.sensors, "PIR");
      number_through(room.scene.arrays, "ARRAY");
    }
    const std::string fault = fault_of(room.scene);
    if (fault.empty()) return std::move(room);
    failures.add(fault);
  }
  failures.give_up("room", number, spec.where);
}

}  // namespace pirsim::dataset
