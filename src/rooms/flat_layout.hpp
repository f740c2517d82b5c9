// What areas, doors and sensors of drawn flats are called, so that the homes of a dataset share columns.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pirsim/columns.hpp"
#include "pirsim/flat.hpp"
#include "rooms/floor_plan.hpp"

namespace pirsim::dataset {

/// `which`: of those of its kind, from 1.
[[nodiscard]] std::string area_name(FlatRoomKind kind, int which = 1);
/// Whether the doorway into such a room has a leaf.
[[nodiscard]] bool has_leaf(FlatRoomKind kind) noexcept;

/// A door is called as the area behind it, the front door so.
inline constexpr const char* front_door_name = "front";
[[nodiscard]] std::string room_sensor_name(const std::string& area);
[[nodiscard]] std::string doorway_sensor_name(const std::string& door);

/// All that flats of these ranges can have; none needs to have them all.
[[nodiscard]] ColumnOwners columns_of(const FlatSpec& spec);

// The rooms of a flat and the ways between them, before anything stands in them.

inline constexpr double flat_wall_m = 0.1;  ///< thickness of every wall
inline constexpr double doorway_m = 0.9;    ///< width of every doorway
inline constexpr double doorway_height_m = 2.1;

/// A gap in a wall, with a leaf or without.
struct Doorway {
  std::string id{};
  double width_m = doorway_m;
  std::optional<std::size_t> from;  ///< index of the room that it leads out of; none: from outside
  std::size_t into = 0;
  Vec2 middle{0.0};     ///< on the wall's middle; of the front door on the floor's edge
  Vec2 direction{0.0};  ///< unit, into the room
  std::optional<DoorState> leaf;
  DoorHinge hinge = DoorHinge::left;  ///< at the wall that is nearer
};

/// A straight piece of wall between two rooms; `from` is the lower end.
struct InnerWall {
  Vec2 from{0.0}, to{0.0};
};

struct FlatPlan {
  Rectangle bounds;
  std::vector<FlatRoom> rooms;  ///< the living room first
  std::vector<InnerWall> inner_walls;
  std::vector<Doorway> doorways;  ///< the front door first
  /// Without the walls.
  [[nodiscard]] Rectangle clear_floor(std::size_t room) const;
};

inline constexpr std::array all_sides{PlanSide::bottom, PlanSide::right, PlanSide::top, PlanSide::left};

/// A room's wall on that side of the page, seen from inside.
[[nodiscard]] Wall wall_of(const Rectangle& room, PlanSide side);
/// What of it another room has behind it, or nothing.
[[nodiscard]] std::optional<InnerWall> shared_wall(const Rectangle& room, PlanSide side, const Rectangle& other);
/// Of rooms that touch, unless they are of one area.
[[nodiscard]] std::vector<InnerWall> walls_between(const std::vector<FlatRoom>& rooms);

/// Rooms and ways of a plan, in its order. Throws Error(input) for what doesn't fit together.
[[nodiscard]] FlatPlan plan_of(const HomePlanSpec& plan);
/// Whether a room's wall on that side of the page does.
[[nodiscard]] constexpr bool runs_along_x(PlanSide side) noexcept {
  return side == PlanSide::bottom || side == PlanSide::top;
}

/// One attempt. How many bedrooms there are goes by the residents, two a room.
[[nodiscard]] std::variant<FlatPlan, NoPlace> lay_out(const FlatSpec& spec, int residents, Stream& stream);

}  // namespace pirsim::dataset
