// Where a person can walk, and the way from here to there.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "body/ground.hpp"
#include "pirsim/geometry.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::body {

class WayMemory;
struct StepsLeft;

/// Another person to walk around.
struct Disc {
  Vec2 centre{0.0};
  double radius_m = 0.0;
};

/// The floor area and the strips that lead out through the entrances, as a grid of 0.1 m cells (paper: section 2.2).
/// A point is walkable if the centre of its cell is on the floor and the point itself keeps `clearance_m` from
/// everything solid between 0.1 m and 2.0 m above the floor; a cell is walkable if its centre is.
/// Immutable; copies share their data.
class WalkableFloor {
 public:
  static constexpr double cell_m = FloorCells::side_m;
  /// clearance_m: at most what the ground reaches.
  WalkableFloor(const Ground& ground, double clearance_m);
  WalkableFloor(const FloorArea& floor, std::span<const EntranceSpec> entrances, std::span<const TriMesh> obstacles,
                double clearance_m);

  [[nodiscard]] double clearance_m() const noexcept;
  /// Is the point itself at a walkable place?
  [[nodiscard]] bool walkable(const Vec2& point) const noexcept;
  /// Can one walk straight from a to b, clear of `others`?
  [[nodiscard]] bool walkable(const Vec2& a, const Vec2& b, std::span<const Disc> others = {}) const noexcept;
  /// Is the segment from a to b on the floor, and does it keep `clearance_m` (not the floor's own) from everything
  /// solid?
  [[nodiscard]] bool has_room(const Vec2& a, const Vec2& b, double clearance_m) const noexcept;
  /// Shortest way found by A* (8 neighbours, ties broken by cell index), then pulled tight: each leg of the result
  /// is walkable throughout. Starts at `from` and ends at `to` exactly. A start or goal that isn't walkable itself
  /// is led to the nearest walkable cell within 0.5 m, by a leg that comes no nearer to anything than the start or
  /// goal already is. `others` are kept clear of, by their radius and clearance_m. std::nullopt: no way.
  [[nodiscard]] std::optional<std::vector<Vec2>> find_way(const Vec2& from, const Vec2& to,
                                                          std::span<const Disc> others = {}) const;
  /// Does find_way() find one? Without searching for it.
  [[nodiscard]] bool has_way(const Vec2& from, const Vec2& to, std::span<const Disc> others = {}) const;

 private:
  [[nodiscard]] std::shared_ptr<const StepsLeft> steps_left(std::span<const Disc> others) const;

  struct Impl;
  std::shared_ptr<const Impl> impl_;
  std::shared_ptr<WayMemory> known_ways_;  ///< not part of what a floor is
};

}  // namespace pirsim::body
