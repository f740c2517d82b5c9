// Rooms of a model: where one can stand at a height, cut at gaps as wide as a door. Private to studies.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "geom/cell_map.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::studies {

/// An opening; `to` is -1 for the outside.
struct FloorGap {
  int from = 0, to = -1;
  Vec2 at{0.0};
  Vec2 inwards{0.0};
  double width_m = 0.0;
  int leaf = -1;  ///< what shuts it, by its place among the leaves; -1: nothing
};
/// A box on the floor plan that may be the leaf of a door: thin, and as high as one.
struct Leaf {
  Vec2 middle{0.0};
  Vec2 across{0.0};  ///< through the opening, of length 1
  double width_m = 0.0, thickness_m = 0.0;
};

struct FloorPlan {
  double height_m = 0.0;
  CellGrid grid{{}, {}, 0.0, 1.0, 1};
  std::vector<int> room_of_cell;  ///< (n_cells) -1: none
  int n_rooms = 0;
  std::vector<FloorGap> gaps;
  bool is_open = false;      ///< the only way in is a side without walls
  bool is_bare = false;      ///< nothing is inside of walls or below a ceiling, and the largest region is taken
  double standing_m2 = 0.0;  ///< of rooms, where one can stand upright
  double covered_m2 = 0.0;   ///< of it, below a ceiling
  [[nodiscard]] int room_at(const Vec2& place) const { return room_of_cell[grid.at(place)]; }
};

/// What a plan is made from.
struct FloorMaps {
  CellGrid grid;
  Cells floor, walls, sills, ceiling;
  Cells low;      ///< where something is above the floor, too low to stand below
  Cells blocked;  ///< walls, and where there is no floor
};
[[nodiscard]] FloorMaps maps_of(std::span<const TriMesh* const> meshes, double height_m, double side_m);

/// Heights of large level surfaces, from below.
[[nodiscard]] std::vector<double> level_heights_m(std::span<const TriMesh* const> meshes);

/// meshes: in the room's frame. Of the leaves those count that part two regions, or one from the outside.
[[nodiscard]] FloorPlan floor_plan_at(std::span<const TriMesh* const> meshes, std::span<const Leaf> leaves,
                                      double height_m, double side_m);

/// Outlines of the whole floor, inner walls included.
[[nodiscard]] std::vector<std::vector<Vec2>> floor_outlines(const FloorPlan& plan);
/// The outline of one room; none overlap. Empty for a room that is too narrow to have one.
[[nodiscard]] std::vector<Vec2> room_outline(const FloorPlan& whole, int room);

}  // namespace pirsim::studies
