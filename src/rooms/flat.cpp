#include "rooms/flat.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <optional>
#include <ranges>
#include <set>
#include <span>
#include <vector>

#include "model/core/text.hpp"
#include "rooms/flat_layout.hpp"
#include "rooms/floor_plan.hpp"
#include "rooms/recipe_fields.hpp"
#include "rooms/suggested_floor.hpp"

// The floor of one room while it is furnished: what stands on it, and what must stay free to get there.

namespace pirsim::dataset {

/// In the axes of a Spot on the wall: the room is towards -Z, x to the right of who looks into the room.
struct Piece {
  Rectangle solid;
  Rectangle kept;  ///< of no other solid; may overlap what others keep
};

class RoomFloor {
 public:
  explicit RoomFloor(const Rectangle& clear) : plan_(clear) {}

  [[nodiscard]] const Rectangle& bounds() const noexcept { return plan_.bounds(); }
  [[nodiscard]] const std::vector<Wall>& walls() const noexcept { return plan_.walls(); }
  [[nodiscard]] bool fits(const Spot& spot, const Piece& piece) const;
  void put(const Spot& spot, const Piece& piece);
  void keep_free(const Rectangle& rectangle) { kept_.push_back(rectangle); }

  /// Its back to a wall, any or this one, often in a corner: half_m from its middle to its sides. None after some
  /// attempts. Puts it there.
  [[nodiscard]] std::optional<Spot> put_at_wall(const Piece& piece, double half_m, Stream& stream,
                                                std::optional<PlanSide> side = {});
  /// Anywhere, turned by quarters.
  [[nodiscard]] std::optional<Spot> put_anywhere(const Piece& piece, Stream& stream);
  [[nodiscard]] const Wall& wall(PlanSide side) const { return walls()[static_cast<std::size_t>(side)]; }
  [[nodiscard]] bool contains(const Rectangle& rectangle) const noexcept { return plan_.contains(rectangle); }

 private:
  FloorPlan plan_;  ///< occupied by solids
  std::vector<Rectangle> kept_;
};

namespace {

constexpr int most_spots = 60;  // that are tried for one thing

}  // namespace

bool RoomFloor::fits(const Spot& spot, const Piece& piece) const {
  const Rectangle solid = spot * piece.solid;
  return plan_.is_free(solid) && plan_.is_free(spot * piece.kept) &&
         std::ranges::none_of(kept_, [&](const Rectangle& kept) { return overlap(solid, kept); });
}

void RoomFloor::put(const Spot& spot, const Piece& piece) {
  plan_.occupy(spot * piece.solid);
  kept_.push_back(spot * piece.kept);
}

std::optional<Spot> RoomFloor::put_at_wall(const Piece& piece, double half_m, Stream& stream,
                                           std::optional<PlanSide> side) {
  for (int k = 0; k < most_spots; ++k) {
    const Wall& wall = side ? this->wall(*side) : one_of(plan_.walls(), stream);
    const double room = wall.length_m() - 2.0 * half_m;
    const std::uint32_t where = stream.index(4);  // a quarter each in the corners
    const double along = draw_length({0.0, std::max(0.0, room)}, stream);
    if (room < 0.0) continue;
    const Spot spot = wall.facing_room(half_m + (where == 0 ? 0.0 : where == 1 ? room : along));
    if (!fits(spot, piece)) continue;
    put(spot, piece);
    return spot;
  }
  return std::nullopt;
}

std::optional<Spot> RoomFloor::put_anywhere(const Piece& piece, Stream& stream) {
  const Rectangle& b = bounds();
  for (int k = 0; k < most_spots; ++k) {
    const double x = draw_length({b.lower.x, b.upper.x}, stream), z = draw_length({b.lower.y, b.upper.y}, stream);
    const Spot spot{{x, z}, static_cast<int>(stream.index(2))};
    if (!fits(spot, piece)) continue;
    put(spot, piece);
    return spot;
  }
  return std::nullopt;
}

namespace {

using Kind = FlatRoomKind;

std::string fixed_m(double metres) { return fixed(metres, 2); }

class FlatFurnisher {
 public:
  FlatFurnisher(const FlatSpec& spec, int residents, FlatPlan plan, Stream& stream)
      : spec_(spec), plan_(std::move(plan)), stream_(stream) {
    flat_.residents = residents;
    flat_.width_m = plan_.bounds.upper.x - plan_.bounds.lower.x;
    flat_.depth_m = plan_.bounds.upper.y - plan_.bounds.lower.y;
    flat_.height_m = draw_length(spec.height_m, stream_);
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i) floors_.emplace_back(plan_.clear_floor(i));
  }

  std::variant<FurnishedFlat, NoPlace> furnish() {
    for (const Doorway& door : plan_.doorways) keep_doorway_free(door, kept_free_at_door_m);
    build_shell(plan_, flat_.height_m, flat_.scene);
    add_beds();
    for (std::size_t i = 0; i < plan_.rooms.size() && lacking_.empty(); ++i) furnish_room(i);
    const SensorsAt at = one_of(spec_.sensors_at, stream_);
    if (at == SensorsAt::doorways) {
      hang_at_doorways(spec_, plan_, stream_, flat_.scene);
    } else {
      hang_in_rooms(spec_, plan_, flat_.height_m, stream_, flat_.scene);
    }
    return result();
  }

  /// As somebody has it. What has a place comes first, so that the rest is put around it.
  std::variant<FurnishedFlat, NoPlace> furnish(const HomePlanSpec& own, Diagnostics& faults) {
    faults_ = &faults;
    for (const Doorway& door : plan_.doorways)
      keep_doorway_free(door, door.leaf ? std::max(door.width_m, kept_by_passers_m) : kept_by_passers_m);
    keep_open_sides_free();
    build_shell(plan_, flat_.height_m, flat_.scene);
    for (const bool has_place : {true, false}) {
      for (std::size_t i = 0; i < own.rooms.size(); ++i) {
        asked_in_ = &own.rooms[i];
        for (const PlanPieceSpec& piece : own.rooms[i].furniture.value_or(std::vector<PlanPieceSpec>{}))
          if (is_placed(piece) == has_place) add_piece(floors_[i], piece);
      }
    }
    asked_ = nullptr;
    for (std::size_t i = 0; i < own.rooms.size(); ++i) {
      if (own.rooms[i].furniture) continue;
      asked_in_ = &own.rooms[i];
      if (own.rooms[i].kind == Kind::bedroom) add_bed(floors_[i], true, 2);
      furnish_room(i);
    }
    name_by_rooms();
    hang_sensors(own, plan_, spec_, stream_, flat_);
    return result();
  }

 private:
  std::variant<FurnishedFlat, NoPlace> result() {
    if (!lacking_.empty()) return NoPlace{lacking_, lacking_at_};
    flat_.rooms = plan_.rooms;
    return FurnishedFlat{std::move(flat_), std::move(demands_), std::move(origins_)};
  }

  // Sizes are `assumed`: common furniture, as in the shipped flat; the ranges that were looked at stand behind.
  static constexpr double off_wall_m = 0.02;
  static constexpr double kept_free_at_door_m = 1.0;  // 0.9-1.2, on both sides
  static constexpr double kept_by_passers_m = 0.6;    // 0.5-0.8, on both sides: what somebody has there may be so near
  static constexpr double bed_length_m = 2.05, bed_height_m = 0.48;  // 2.0-2.1, 0.45-0.5
  static constexpr double pelvis_from_wall_m = 1.03;  // of who lies: the head of the largest person has room
  static constexpr double beside_bed_m = 0.7;         // 0.6-0.8: to get in
  static constexpr double sofa_depth_m = 0.9, sofa_height_m = 0.42;  // 0.85-1.0, 0.40-0.45
  static constexpr double pelvis_above_seat_m = 0.09;
  static constexpr double table_depth_m = 0.8, chair_from_table_m = 0.25, chair_spacing_m = 0.7, chair_zone_m = 0.9;
  static constexpr double hip_height_m = 0.53;
  static constexpr double counter_depth_m = 0.6, stand_from_counter_m = 0.37;  // 0.3-0.5
  static constexpr double knees_m = 0.45, back_m = 0.2;  // of sitters, from the pelvis: no leaf turns there
  static constexpr double desk_depth_m = 0.7;            // 0.6-0.8

  static constexpr Rectangle television{{-0.7, -0.4}, {0.7, -off_wall_m}};

  static constexpr std::size_t least_places = 8;  // half a square metre: what a sensor must see at least

  enum class Wanted { always, if_it_fits };

  void fail(const std::string& reason) {
    if (!lacking_.empty()) return;
    lacking_ = reason;
    if (asked_in_ == nullptr) return;
    lacking_ += " in '" + asked_in_->id + "'";
    lacking_at_ = origin();
  }
  /// Of what is put down now: the piece that a plan asks for, or the room that has what is usual.
  [[nodiscard]] const Where& origin() const { return asked_ != nullptr ? asked_->where : asked_in_->where; }

  /// Of what has no leaf, so much as a usual door is wide.
  void keep_doorway_free(const Doorway& door, double depth_m) {
    const double half = 0.5 * (door.leaf ? door.width_m : std::min(door.width_m, doorway_m));
    const Vec2 across{half * door.direction.y, half * door.direction.x};
    const auto keep = [&](std::size_t room, const Vec2& towards) {
      const Vec2 far = door.middle + depth_m * towards;
      const Rectangle way{glm::min(glm::min(door.middle + across, door.middle - across), far - glm::abs(across)),
                          glm::max(glm::max(door.middle + across, door.middle - across), far + glm::abs(across))};
      floors_[room].keep_free(way);
      taken_.push_back({way, "is in the way of door '" + door.id + "'"});
    };
    keep(door.into, door.direction);
    if (door.from) keep(*door.from, -door.direction);
  }

  /// Where rooms of one area meet, nothing has its back.
  void keep_open_sides_free() {
    constexpr double near_m = 0.1;
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i) {
      for (std::size_t k = 0; k < plan_.rooms.size(); ++k) {
        const Rectangle& other = plan_.rooms[k].area;
        if (i != k && plan_.rooms[k].id == plan_.rooms[i].id)
          floors_[i].keep_free({other.lower - Vec2(near_m), other.upper + Vec2(near_m)});
      }
    }
  }

  // -- things --------------------------------------------------------------------------------------------------------

  static bool is_placed(const PlanPieceSpec& piece) {
    if (piece.kind == PieceKind::table) return piece.x_m.has_value();
    return piece.wall && (runs_along_x(*piece.wall) ? piece.x_m : piece.y_m);
  }

  /// Its back to a wall.
  std::optional<Spot> put_at_wall(RoomFloor& floor, const Piece& piece, double half_m) {
    if (asked_ == nullptr) return floor.put_at_wall(piece, half_m, stream_);
    return is_placed(*asked_) ? put_as_asked(floor, piece) : floor.put_at_wall(piece, half_m, stream_, asked_->wall);
  }
  std::optional<Spot> put_anywhere(RoomFloor& floor, const Piece& piece) {
    return asked_ != nullptr && is_placed(*asked_) ? put_as_asked(floor, piece) : floor.put_anywhere(piece, stream_);
  }

  /// Wherever that is, with a fault if it can't be there.
  Spot put_as_asked(RoomFloor& floor, const Piece& piece) {
    Spot spot = floor.wall(asked_->wall.value_or(PlanSide::bottom)).facing_room(0.0);
    if (asked_->x_m) spot.origin.x = *asked_->x_m;
    if (asked_->y_m) spot.origin.y = 0.0 - *asked_->y_m;
    const Rectangle solid = spot * piece.solid;
    const std::string name = word_of(asked_->kind);
    std::string fault;
    if (!floor.contains(solid)) {
      fault = "isn't inside of its room: it takes x from " + fixed_m(solid.lower.x) + " to " + fixed_m(solid.upper.x) +
              " m and y from " + fixed_m(-solid.upper.y) + " to " + fixed_m(-solid.lower.y) + " m";
    }
    for (const Taken& other : taken_)
      if (fault.empty() && overlap(solid, other.area)) fault = other.fault;
    if (!fault.empty()) faults_->error(asked_->where, name + ' ' + fault);
    taken_.push_back({solid, "is where a " + name + " is"});
    floor.put(spot, piece);
    return spot;
  }

  /// Of what a drawn flat draws a plan takes the middle.
  double width(const Range& usual) {
    if (asked_ == nullptr) return draw_length(usual, stream_);
    return asked_->width_m.value_or(0.5 * (usual.least + usual.most));
  }
  [[nodiscard]] int places(int usual) const { return asked_ != nullptr ? asked_->places.value_or(usual) : usual; }

  /// "sofa", then "sofa_2". In a plan each room counts its own, and name_by_rooms() says which.
  std::string named(const std::string& kind) {
    const std::string room = asked_in_ == nullptr ? "" : of_room + asked_in_->id + of_room;
    if (!room.empty()) rooms_with_[kind].insert(asked_in_->id);
    const int which = ++numbers_[kind + room];
    return kind + room + (which == 1 ? "" : '_' + std::to_string(which));
  }
  /// "sofa", or "sofa_ROOM" where another room has one as well: whatever the order of a plan's rooms.
  void name_by_rooms() {
    const auto rename = [&](std::string& name) {
      const std::size_t from = name.find(of_room), to = name.rfind(of_room);
      if (from == to) return;
      const bool is_alone = rooms_with_.at(name.substr(0, from)).size() == 1;
      const std::string room = is_alone ? "" : '_' + name.substr(from + 1, to - from - 1);
      name = name.substr(0, from) + room + name.substr(to + 1);
    };
    for (SeatSpec& seat : flat_.scene.seats) rename(seat.id);
    for (PlaceSpec& place : flat_.scene.places) rename(place.id);
    for (TriMesh& mesh : flat_.scene.meshes) rename(mesh.name);
    for (const auto& [name, where] : std::exchange(origins_, {})) {
      std::string renamed = name;
      rename(renamed);
      origins_[renamed] = where;
    }
  }

  void add_piece(RoomFloor& floor, const PlanPieceSpec& piece) {
    asked_ = &piece;
    switch (piece.kind) {
      case PieceKind::bed:
        return add_bed(floor, piece.width_m ? *piece.width_m > 1.2 : places(1) == 2, places(1));
      case PieceKind::sofa:
        return add_sofa(floor);
      case PieceKind::table:
        return add_table(floor);
      case PieceKind::kitchen:
        return add_kitchen(floor);
      case PieceKind::counter:
        return add_block(floor, "counter", 0.9, {});
      case PieceKind::stove:
        return add_block(floor, "stove", 0.9, {"cook"});
      case PieceKind::sink:
        return add_block(floor, "sink", 0.9, {"chores", "cook"});
      case PieceKind::fridge:
        return add_block(floor, "fridge", 1.8, {});
      case PieceKind::shower:
        return add_shower(floor);
      case PieceKind::toilet:
        return add_toilet(floor);
      case PieceKind::washbasin:
        return add_washbasin(floor);
      case PieceKind::wardrobe:
        return add_wardrobe(floor);
      case PieceKind::desk:
        return add_desk(floor, Wanted::always);
      case PieceKind::shelf:
        return add_shelf(floor);
      case PieceKind::television:
        if (const auto spot = put_at_wall(floor, {television, television}, 0.7)) return build_television(*spot);
        return fail("there was no place for a television");
    }
  }

  /// As deep as a kitchen counter; with uses there is a place to stand before it.
  void add_block(RoomFloor& floor, const std::string& kind, double height_m, std::vector<std::string> uses) {
    const double half = 0.5 * width({0.6, 0.6}), front = -off_wall_m - counter_depth_m;
    const Rectangle solid{{-half, front}, {half, -off_wall_m}};
    const auto spot = put_at_wall(floor, {solid, {{-half, front - 0.9}, {half, -off_wall_m}}}, half);
    if (!spot) return fail("there was no place for a " + kind);
    const std::string id = named(kind);
    add(id, *spot, {{solid, 0.0, height_m}});
    if (!uses.empty())
      add_place(id, PlacePosture::stand, *spot, {0.0, front - stand_from_counter_m}, 2, 0.0, std::move(uses));
  }

  void add(const std::string& name, const Spot& spot, std::span<const BoxPart> parts) {
    flat_.scene.meshes.push_back(boxes(name, spot, parts));
  }
  void add(const std::string& name, const Spot& spot, const std::vector<BoxPart>& parts) {
    add(name, spot, std::span(parts));
  }

  /// Faces into the room (0 quarters) or the wall (2).
  void add_seat(const std::string& id, const Spot& spot, const Vec2& own, int quarters, double height,
                std::vector<std::string> uses) {
    const Spot seat{spot * own, spot.quarters + quarters};
    flat_.scene.seats.push_back({id, seat.frame(height), std::move(uses)});
    if (asked_in_ != nullptr) origins_[id] = origin();
  }
  void add_place(const std::string& id, PlacePosture posture, const Spot& spot, const Vec2& own, int quarters,
                 double height, std::vector<std::string> uses) {
    const Spot place{spot * own, spot.quarters + quarters};
    flat_.scene.places.push_back({id, posture, place.frame(height), std::move(uses)});
    if (asked_in_ != nullptr) origins_[id] = origin();
  }

  // -- beds ----------------------------------------------------------------------------------------------------------

  /// Two who share one get a wide one, in the first room that has none; the others are shared out.
  void add_beds() {
    std::vector<std::size_t> rooms;
    for (std::size_t i = 0; i < plan_.rooms.size(); ++i)
      if (plan_.rooms[i].kind == Kind::bedroom) rooms.push_back(i);
    if (rooms.empty()) rooms.push_back(0);
    std::size_t next = 0;
    for (int left = flat_.residents; left > 0 && lacking_.empty();) {
      const bool is_wide = stream_.uniform() < spec_.double_beds;
      const int sleepers =
          is_wide && left >= 2 && left > static_cast<int>(rooms.size() - next % rooms.size()) - 1 ? 2 : 1;
      add_bed(floors_[rooms[next++ % rooms.size()]], is_wide, sleepers);
      left -= sleepers;
    }
  }

  void add_bed(RoomFloor& floor, bool is_wide, int sleepers) {
    const double half = 0.5 * width(is_wide ? Range{1.4, 1.8} : Range{0.9, 1.0});
    const double end = -off_wall_m - bed_length_m;
    const Rectangle solid{{-half, end}, {half, -off_wall_m}};
    // One alone gets in at the right: x is mirrored by turns.
    const double side = stream_.index(2) == 0 ? 1.0 : -1.0;
    const double left = sleepers == 2 || side < 0.0 ? -half - beside_bed_m : -half;
    const double right = sleepers == 2 || side > 0.0 ? half + beside_bed_m : half;
    // Two get to both sides round the foot.
    const double foot = sleepers == 2 ? end - beside_bed_m : end;
    const Piece piece{solid, {{left, foot}, {right, -off_wall_m}}};
    const auto spot = put_at_wall(floor, piece, half + off_wall_m);
    if (!spot) return fail("there was no place for a bed");
    const std::string bed = asked_in_ != nullptr ? named("bed") : "bed_" + std::to_string(++beds_);
    add(asked_in_ != nullptr ? bed : "bed " + std::to_string(beds_), *spot, {{solid, 0.0, bed_height_m}});
    const double x = is_wide ? 0.5 * half : 0.0;
    for (int k = 0; k < sleepers; ++k) {
      const double at = sleepers == 1 ? side * x : k == 0 ? -x : x;
      const std::string id = bed + (sleepers == 1 ? "" : k == 0 ? "_left" : "_right");
      add_place(id, PlacePosture::lie, *spot, {at, -pelvis_from_wall_m}, 0, bed_height_m, {"sleep"});
      if (sleepers == 2) demands_.shared_beds.push_back(id);
    }
  }

  // -- rooms ---------------------------------------------------------------------------------------------------------

  void furnish_room(std::size_t index) {
    RoomFloor& floor = floors_[index];
    const auto has = [&](Kind kind) {
      return std::ranges::find(plan_.rooms, kind, &FlatRoom::kind) != plan_.rooms.end();
    };
    switch (plan_.rooms[index].kind) {
      case Kind::living_room:
        if (!has(Kind::kitchen)) add_kitchen(floor);
        add_sofa(floor);
        add_table(floor);
        if (!has(Kind::bedroom)) add_wardrobe(floor);
        return add_shelf(floor);
      case Kind::kitchen:
        return add_kitchen(floor);
      case Kind::bedroom:
        add_wardrobe(floor);
        if (!has(Kind::study) && stream_.index(2) == 0) add_desk(floor, Wanted::if_it_fits);
        return;
      case Kind::study:
        add_desk(floor, Wanted::always);
        return add_shelf(floor);
      case Kind::bath:
        return add_bath(floor);
      case Kind::corridor:
        return;
    }
  }

  /// Seats side by side, and a television opposite where there is room for it.
  void add_sofa(RoomFloor& floor) {
    const int seats = places(2 + static_cast<int>(stream_.index(2)));
    const double half = 0.5 * (0.8 * seats + 0.3);
    const Rectangle solid{{-half, -sofa_depth_m}, {half, -off_wall_m}};
    const Rectangle with_sitters{{-half, -0.55 - knees_m}, {half, -off_wall_m}};
    const auto spot = put_at_wall(floor, {with_sitters, {{-half, -sofa_depth_m - 0.7}, {half, -off_wall_m}}}, half);
    if (!spot) return fail("there was no place for a sofa");
    const std::string id = named("sofa");
    add(id, *spot, {{solid, 0.0, sofa_height_m}});
    add(id + " back", *spot, {{{{-half, -off_wall_m - 0.2}, {half, -off_wall_m}}, sofa_height_m, 0.85}});
    for (int k = 0; k < seats; ++k)
      add_seat(id + '_' + std::to_string(k + 1), *spot, {0.8 * (k + 0.5 - 0.5 * seats), -0.55}, 0,
               sofa_height_m + pelvis_above_seat_m, {"tv", "rest", "read"});
    if (asked_ == nullptr) add_television(floor, *spot);
  }

  void add_television(RoomFloor& floor, const Spot& sofa) {
    const Rectangle& b = floor.bounds();
    const Vec2 straight = sofa * Vec2(0.0, -1.0) - sofa.origin;
    const double far = straight.x != 0.0 ? b.upper.x - b.lower.x : b.upper.y - b.lower.y;
    const Spot opposite{sofa.origin + far * straight, sofa.quarters + 2};
    if (!floor.fits(opposite, {television, television})) return;
    floor.put(opposite, {television, television});
    build_television(opposite);
  }
  void build_television(const Spot& spot) {
    add(named("television"), spot, {{television, 0.0, 0.45}, {{{-0.5, -0.22}, {0.5, -0.18}}, 0.5, 1.08}});
  }

  /// Chairs for the residents and a guest, two at least, on its long sides.
  void add_table(RoomFloor& floor) {
    const int across = std::max(1, places(flat_.residents + 2) / 2);
    const double half = 0.5 * (chair_spacing_m * across + 0.1), deep = 0.5 * table_depth_m;
    const Rectangle solid{{-half, -deep}, {half, deep}};
    const double sitters = deep + chair_from_table_m + back_m;
    const auto spot = put_anywhere(
        floor, {{{-half, -sitters}, {half, sitters}}, {{-half, -deep - chair_zone_m}, {half, deep + chair_zone_m}}});
    if (!spot) return fail("there was no place for a table");
    std::vector<BoxPart> parts{{solid, 0.71, 0.74}};
    for (const double x : {-half + 0.08, half - 0.08})
      parts.push_back({{{x - 0.03, -0.03}, {x + 0.03, 0.03}}, 0.0, 0.71});
    const std::string id = named("table");
    add(id, *spot, parts);
    for (int k = 0; k < 2 * across; ++k) {
      const double x = (k / 2 + 0.5 - 0.5 * across) * chair_spacing_m, side = k % 2 == 0 ? 1.0 : -1.0;
      add_seat(id + '_' + std::to_string(k + 1), *spot, {x, side * (deep + chair_from_table_m)}, k % 2 == 0 ? 0 : 2,
               hip_height_m, {"eat", "play", "work"});
    }
  }

  /// A counter with sink, stove and, at one end, a fridge.
  void add_kitchen(RoomFloor& floor) {
    const double half = 0.5 * width({2.4, 3.2}), front = -off_wall_m - counter_depth_m;
    const Rectangle solid{{-half, front}, {half, -off_wall_m}};
    const auto spot = put_at_wall(floor, {solid, {{-half, front - 0.9}, {half, -off_wall_m}}}, half);
    if (!spot) return fail("there was no place for a kitchen counter");
    const double side = stream_.index(2) == 0 ? 1.0 : -1.0;
    const auto part = [&](double a, double b) {
      return Rectangle{{std::min(side * a, side * b), front}, {std::max(side * a, side * b), -off_wall_m}};
    };
    add(named("counter"), *spot, {{part(-half, half - 0.6), 0.0, 0.9}});
    add(named("fridge"), *spot, {{part(half - 0.6, half), 0.0, 1.8}});
    const double length = 2.0 * half - 0.6;
    const Vec2 stove(side * (-half + 0.28 * length), front - stand_from_counter_m);
    const Vec2 sink(side * (-half + 0.75 * length), front - stand_from_counter_m);
    add_place(named("stove"), PlacePosture::stand, *spot, stove, 2, 0.0, {"cook"});
    add_place(named("sink"), PlacePosture::stand, *spot, sink, 2, 0.0, {"chores", "cook"});
  }

  void add_bath(RoomFloor& floor) {
    add_shower(floor);
    add_toilet(floor);
    add_washbasin(floor);
  }

  void add_shower(RoomFloor& floor) {
    const Rectangle shower{{-0.45, -0.9}, {0.45, 0.0}};
    const auto tray = put_at_wall(floor, {shower, {{-0.45, -1.4}, {0.45, 0.0}}}, 0.45);
    if (!tray) return fail("there was no place for a shower");
    const std::string id = named("shower");
    add(id + " tray", *tray, {{{{-0.44, -0.88}, {0.44, -off_wall_m}}, 0.0, 0.02}});
    add_place(id, PlacePosture::stand, *tray, {0.0, -0.45}, 0, 0.0, {"shower", "wash"});
  }

  void add_toilet(RoomFloor& floor) {
    const Rectangle bowl{{-0.2, -0.7}, {0.2, -off_wall_m}};
    const auto toilet =
        put_at_wall(floor, {{{-0.2, -0.48 - knees_m}, {0.2, -off_wall_m}}, {{-0.35, -1.2}, {0.35, -off_wall_m}}}, 0.4);
    if (!toilet) return fail("there was no place for a toilet");
    const std::string id = named("toilet");
    add(id, *toilet, {{bowl, 0.0, 0.42}});
    add_seat(id, *toilet, {0.0, -0.48}, 0, 0.42 + pelvis_above_seat_m, {"toilet"});
  }

  void add_washbasin(RoomFloor& floor) {
    const Rectangle basin{{-0.3, -0.42}, {0.3, -off_wall_m}};
    const auto sink = put_at_wall(floor, {basin, {{-0.35, -1.1}, {0.35, -off_wall_m}}}, 0.35);
    if (!sink) return fail("there was no place for a basin");
    add(named("basin"), *sink, {{basin, 0.7, 0.85}});
    add_place(named("washbasin"), PlacePosture::stand, *sink, {0.0, -0.78}, 2, 0.0, {"wash", "dress"});
  }

  void add_wardrobe(RoomFloor& floor) {
    const double half = 0.5 * width({1.0, 1.8});
    const Rectangle solid{{-half, -0.62}, {half, -off_wall_m}};
    const auto spot = put_at_wall(floor, {solid, {{-half, -1.1}, {half, -off_wall_m}}}, half);
    if (!spot) return fail("there was no place for a wardrobe");
    add("wardrobe " + std::to_string(++wardrobes_), *spot, {{solid, 0.0, 2.0}});
  }

  void add_desk(RoomFloor& floor, Wanted wanted) {
    const double half = 0.5 * width({1.2, 1.6}), front = -off_wall_m - desk_depth_m;
    const Rectangle solid{{-half, front}, {half, -off_wall_m}};
    const Rectangle with_sitter{{-half, front - 0.28 - back_m}, {half, -off_wall_m}};
    const auto spot = put_at_wall(floor, {with_sitter, {{-0.5, front - 1.0}, {0.5, -off_wall_m}}}, half);
    if (!spot && wanted == Wanted::always) return fail("there was no place for a desk");
    if (!spot) return;
    const std::string desk = asked_in_ != nullptr ? named("desk") : "desk_" + std::to_string(++desks_);
    std::vector<BoxPart> parts{{solid, 0.71, 0.74}};
    for (const double x : {0.05 - half, half - 0.05})
      parts.push_back({{{x - 0.02, front + 0.02}, {x + 0.02, -off_wall_m - 0.02}}, 0.0, 0.71});
    add(asked_in_ != nullptr ? desk : "desk " + std::to_string(desks_), *spot, parts);
    add_seat(desk, *spot, {0.0, front - 0.28}, 2, hip_height_m, {"work"});
  }

  /// Where it fits; a drawn flat may go without.
  void add_shelf(RoomFloor& floor) {
    const double half = 0.5 * width({0.8, 1.6});
    const double height = one_of(std::vector<double>{0.8, 1.2, 2.0}, stream_);
    const Rectangle solid{{-half, -0.35}, {half, -off_wall_m}};
    const auto spot = put_at_wall(floor, {solid, {{-half, -0.8}, {half, -off_wall_m}}}, half);
    if (spot) return add("shelf " + std::to_string(++shelves_), *spot, {{solid, 0.0, height}});
    if (asked_ != nullptr) fail("there was no place for a shelf");
  }

  const FlatSpec& spec_;
  FlatPlan plan_;
  Stream& stream_;
  DrawnFlat flat_;
  Demands demands_{{}, least_places};
  std::vector<RoomFloor> floors_;  ///< (rooms)
  std::string lacking_;
  struct Taken {
    Rectangle area;
    std::string fault;  ///< of what is put there
  };
  std::vector<Taken> taken_;                ///< by doors, and by what a plan gives a place
  const PlanPieceSpec* asked_ = nullptr;    ///< what is put down, if a plan asks for it
  const PlanRoomSpec* asked_in_ = nullptr;  ///< in this room of a plan, or none
  Origins origins_;                         ///< of seats and places of a plan
  Where lacking_at_;
  static constexpr char of_room = '\n';                      ///< around a room in names that aren't final; no id has it
  std::map<std::string, std::set<std::string>> rooms_with_;  ///< things of that kind
  Diagnostics* faults_ = nullptr;                            ///< of a plan
  std::map<std::string, int> numbers_;                       ///< of things by kind (and room)
  int beds_ = 0, wardrobes_ = 0, desks_ = 0, shelves_ = 0;
};

}  // namespace

std::variant<FurnishedFlat, NoPlace> furnish_flat(const FlatSpec& spec, int residents, Stream& stream) {
  auto plan = lay_out(spec, residents, stream);
  if (auto* lacking = std::get_if<NoPlace>(&plan)) return *lacking;
  return FlatFurnisher(spec, residents, std::get<FlatPlan>(std::move(plan)), stream).furnish();
}

std::variant<FurnishedFlat, NoPlace> furnish_flat(const HomePlanSpec& own, const FlatPlan& plan, Stream& stream,
                                                  Diagnostics& faults) {
  FlatSpec spec;
  spec.height_m = {own.height_m, own.height_m};
  int residents = 0;
  for (const PlanRoomSpec& room : own.rooms) {
    if (!room.furniture) residents += room.kind == Kind::bedroom ? 2 : 0;
    for (const PlanPieceSpec& piece : room.furniture.value_or(std::vector<PlanPieceSpec>{}))
      residents += piece.kind == PieceKind::bed ? piece.places.value_or(1) : 0;
  }
  return FlatFurnisher(spec, residents, plan, stream).furnish(own, faults);
}

DrawnFlat draw_flat(const FlatSpec& spec, std::uint64_t seed, int number, const io::SceneOptions& options) {
  // Drawn once: who is refused for lack of space stays.
  Stream people({seed, static_cast<std::uint32_t>(number), 0, Purpose::flat_household});
  const int residents = draw(spec.residents, people);
  ModelFinder models({{spec.models, spec.models_where}}, spec.where, options);
  Failures failures;
  for (int tries = 1; tries <= most_tries; ++tries) {
    Stream stream({seed, static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(tries), Purpose::flat});
    auto drawn = furnish_flat(spec, residents, stream);
    if (const auto* lacking = std::get_if<NoPlace>(&drawn)) {
      failures.add(lacking->reason);
      continue;
    }
    auto& [flat, demands, origins] = std::get<FurnishedFlat>(drawn);
    flat.number = number;
    flat.tries = tries;
    flat.scene.name = "flat " + std::to_string(number);
    models.add_to(flat.scene);
    const std::string fault = fault_of(flat.scene, demands);
    if (fault.empty()) return std::move(flat);
    failures.add(fault);
  }
  failures.give_up("flat", number, spec.where);
}

}  // namespace pirsim::dataset
