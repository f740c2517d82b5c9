// What an obstacle covers of the floor, and plane distances.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pirsim/geometry.hpp"
#include "pirsim/scene.hpp"

namespace pirsim::body {

inline constexpr double solid_from_m = 0.1;  ///< above the floor: a walker steps over what is lower
inline constexpr double solid_to_m = 2.0;    ///< above the floor: a walker passes under what is higher

/// The part of a triangle between two heights, seen from above: a convex polygon, or the two ends of a line
/// under a vertical triangle.
struct Footprint {
  static constexpr std::size_t max_corners = 5;  ///< a triangle cut by two planes
  std::array<Vec2, max_corners> corners{};
  std::uint32_t n_corners = 0;
  std::uint32_t mesh = 0;  ///< index of the obstacle that it is part of
  bool covers_area = false;
  Vec2 lower{0.0};
  Vec2 upper{0.0};
};

/// The part of a convex polygon where side * (y - height) >= 0. Ref: [SutherlandHodgman1974].
[[nodiscard]] std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, double height, double side);

/// The footprints of all triangles that reach into heights [lower_m, upper_m] (world y); what only touches upper_m from
/// above doesn't: a lintel at 2.00 m is a usual one. Lines that overlap the line
/// before them, of the same mesh, are one with it.
[[nodiscard]] std::vector<Footprint> footprints(std::span<const TriMesh> meshes, double lower_m, double upper_m);

[[nodiscard]] double distance(const Vec2& point, const Vec2& a, const Vec2& b) noexcept;  ///< to the segment ab
[[nodiscard]] double distance(const Vec2& point, const Footprint& footprint) noexcept;    ///< 0 inside
/// Between the segment ab and the footprint, 0 where they touch.
[[nodiscard]] double distance(const Vec2& a, const Vec2& b, const Footprint& footprint) noexcept;
/// A lower bound of the distance between the segment ab and the footprint (that of their bounding boxes, per axis).
[[nodiscard]] double distance_bound(const Vec2& a, const Vec2& b, const Footprint& footprint) noexcept;

// What is in the way of walkers, found by place.

/// Keeps rounding from deciding between places that are mirror images of each other.
inline constexpr double rounding_m = 1e-9;

/// Footprints in the squares that they touch, so that a question costs what is near and not what there is.
class Obstacles {
 public:
  Obstacles() = default;
  explicit Obstacles(std::vector<Footprint> footprints);

  [[nodiscard]] const std::vector<Footprint>& all() const noexcept { return footprints_; }

  /// Whether visit(footprint) is true of one. Visits all that come within reach_m of the segment ab, some that don't,
  /// and some more than once.
  template <class Visit>
  [[nodiscard]] bool any_near(const Vec2& a, const Vec2& b, double reach_m, const Visit& visit) const {
    constexpr double to_spare_m = 1e-6;
    const double reach = reach_m + to_spare_m;
    const double lowest = std::min(a.y, b.y) - reach, highest = std::max(a.y, b.y) + reach;
    for (std::size_t row = row_of(lowest), last = row_of(highest); row <= last && row < n_rows_; ++row) {
      const auto [left, right] = crossing(a, b, row, reach);
      for (std::size_t column = column_of(left - reach), end = column_of(right + reach); column <= end; ++column) {
        for (const std::uint32_t index : in_square(row * n_columns_ + column)) {
          if (visit(footprints_[index])) return true;
        }
      }
    }
    return false;
  }

  /// Does the segment ab keep that far from all, but for a rounding?
  [[nodiscard]] bool clear(const Vec2& a, const Vec2& b, double keep_m) const noexcept;

 private:
  struct Interval {
    double left, right;
  };
  /// The x of that part of ab which is within `reach` of the row.
  [[nodiscard]] Interval crossing(const Vec2& a, const Vec2& b, std::size_t row, double reach) const noexcept;
  [[nodiscard]] std::size_t row_of(double z) const noexcept { return place(z - corner_.y, n_rows_); }
  [[nodiscard]] std::size_t column_of(double x) const noexcept { return place(x - corner_.x, n_columns_); }
  /// The last one or the first one of what lies outside.
  [[nodiscard]] std::size_t place(double from_corner_m, std::size_t n) const noexcept {
    return static_cast<std::size_t>(std::clamp(from_corner_m / side_m_, 0.0, static_cast<double>(n - 1)));
  }
  [[nodiscard]] std::span<const std::uint32_t> in_square(std::size_t square) const noexcept {
    return std::span(indices_).subspan(begins_[square], begins_[square + 1] - begins_[square]);
  }
  template <class Visit>
  void each_square(const Footprint& footprint, const Visit& visit) const;

  std::vector<Footprint> footprints_;
  Vec2 corner_{0.0};
  double side_m_ = 0.5;  ///< the least: somewhat more than walkers keep clear
  std::size_t n_columns_ = 0, n_rows_ = 0;
  std::vector<std::size_t> begins_;     ///< (n_squares + 1) in indices_
  std::vector<std::uint32_t> indices_;  ///< of footprints, square by square
};

// Ways over the floor: the shortest over a grid of cells, pulled tight, and remembered for the next replicate.

struct Step {
  int column = 0;
  int row = 0;
};
inline constexpr int n_directions = 8;
/// Direction d + 4 is the way back of d; even directions are straight, odd ones diagonal.
inline constexpr std::array<Step, n_directions> steps{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
[[nodiscard]] constexpr int opposite(int direction) noexcept { return (direction + 4) % n_directions; }

/// Which of its eight neighbours can be reached from each cell; cells count row by row.
struct StepGrid {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> open;  ///< (rows x columns) bit d is set if the step in direction d can be taken

  [[nodiscard]] bool is_open(int cell, int direction) const noexcept {
    return (open[static_cast<std::size_t>(cell)] >> direction & 1) != 0;
  }
  [[nodiscard]] int neighbour(int cell, int direction) const noexcept {
    const Step step = steps[static_cast<std::size_t>(direction)];
    return cell + step.row * columns + step.column;
  }
  /// There and back.
  void close(int cell, int direction) noexcept {
    open[static_cast<std::size_t>(cell)] &= static_cast<std::uint8_t>(~(1U << direction));
    open[static_cast<std::size_t>(neighbour(cell, direction))] &=
        static_cast<std::uint8_t>(~(1U << opposite(direction)));
  }
};

/// A* with the octile distance; a straight step costs 1, a diagonal one sqrt 2. Of equally good cells the one of
/// the lowest index goes first. The cells from start to goal, both included; empty if there is no way.
[[nodiscard]] std::vector<int> shortest_way(const StepGrid& grid, int start, int goal);

/// A label per cell, equal for cells that are connected (the lowest index of them).
[[nodiscard]] std::vector<int> connected_parts(const StepGrid& grid);

/// Whether one can go straight from the first point to the second.
using StraightWay = std::function<bool(const Vec2&, const Vec2&)>;

/// A shorter way with the same ends, each leg of which `straight` allows; `way` itself must be allowed.
[[nodiscard]] std::vector<Vec2> pulled_tight(std::vector<Vec2> way, const StraightWay& straight);

/// What people in the way leave of a grid.
struct StepsLeft {
  StepGrid grid;
  std::vector<int> parts;  ///< connected_parts() of it
};

/// Safe to use from any thread, of bounded size, and without influence on what is found.
class WayMemory {
 public:
  using Way = std::optional<std::vector<Vec2>>;
  using Others = std::vector<std::array<double, 3>>;  ///< centre and radius of each

  /// What work() finds that these leave; worked out once for the same ones in a row: whoever looks for a place to make
  /// way asks about hundreds of places at once.
  [[nodiscard]] std::shared_ptr<const StepsLeft> left_by(Others others, const std::function<StepsLeft()>& work) {
    {
      const std::lock_guard lock(mutex_);
      if (left_ && others == others_) return left_;
    }
    auto left = std::make_shared<const StepsLeft>(work());
    const std::lock_guard lock(mutex_);
    others_ = std::move(others);
    left_ = left;
    return left;
  }

  /// What search() finds between the points; searched once for points that are the same bit for bit.
  [[nodiscard]] Way way(const Vec2& from, const Vec2& to, const std::function<Way()>& search) {
    const std::array<double, 4> ends{from.x, from.y, to.x, to.y};
    {
      const std::lock_guard lock(mutex_);
      if (const auto known = ways_.find(ends); known != ways_.end()) return known->second;
    }
    Way found = search();
    const std::lock_guard lock(mutex_);
    if (ways_.size() >= most_ways) ways_.clear();
    ways_.emplace(ends, found);
    return found;
  }

 private:
  static constexpr std::size_t most_ways = 1024;  ///< a study with fixed seats has two a seat
  std::mutex mutex_;
  std::map<std::array<double, 4>, Way> ways_;
  Others others_;                          ///< the last ones that were asked about
  std::shared_ptr<const StepsLeft> left_;  ///< what they leave
};

// The floor as it is for walkers of all sizes: its cells, what stands on it, and how much room there is.

/// The floor area and the strips that lead out through the entrances as cells, and what is in the way of walkers.
struct FloorCells {
  static constexpr double side_m = 0.1;

  Vec2 lower{0.0};
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> on_floor;  ///< (rows x columns) 1 where the centre is on the floor or a strip
  std::size_t n_meshes = 0;
  Obstacles obstacles;

  [[nodiscard]] Vec2 centre(int column, int row) const noexcept {
    return lower + side_m * Vec2(column + 0.5, row + 0.5);
  }
  [[nodiscard]] Vec2 centre(int cell) const noexcept { return centre(cell % columns, cell / columns); }
  [[nodiscard]] int column_of(double x) const noexcept;  ///< -1 or columns outside
  [[nodiscard]] int row_of(double z) const noexcept;
  [[nodiscard]] bool floor_at(int column, int row) const noexcept;
  /// Every cell that the segment passes has its centre on the floor. Ref: [AmanatidesWoo1987].
  [[nodiscard]] bool floor_along(const Vec2& a, const Vec2& b) const noexcept;
  /// Those whose centre may be within reach_m of the rectangle.
  template <class Visit>
  void each_near(const Vec2& rectangle_lower, const Vec2& rectangle_upper, double reach_m, const Visit& visit) const {
    const int last_column = std::min(column_of(rectangle_upper.x + reach_m), columns - 1);
    const int last_row = std::min(row_of(rectangle_upper.y + reach_m), rows - 1);
    for (int row = std::max(row_of(rectangle_lower.y - reach_m), 0); row <= last_row; ++row) {
      for (int column = std::max(column_of(rectangle_lower.x - reach_m), 0); column <= last_column; ++column) {
        visit(row * columns + column);
      }
    }
  }
};

/// How far cells, and steps between them, are from everything solid: worked out once for people of all sizes.
class Ground {
 public:
  /// reach_m: the most that anybody keeps clear of. Throws Error(infeasible) where the floor has too many cells.
  Ground(const FloorArea& floor, std::span<const EntranceSpec> entrances, std::span<const TriMesh> meshes,
         double reach_m);

  [[nodiscard]] const std::shared_ptr<const FloorCells>& cells() const noexcept { return cells_; }
  // Of who keeps clearance_m, which is reach_m at most.
  /// (rows x columns) 1 where the cell is walkable.
  [[nodiscard]] std::vector<std::uint8_t> open_cells(double clearance_m) const;
  /// Those that are walkable throughout. open: open_cells().
  [[nodiscard]] StepGrid steps_between(std::span<const std::uint8_t> open, double clearance_m) const;

 private:
  void measure_cells(double reach_m);
  void measure_steps(double reach_m);
  [[nodiscard]] double room_at(int column, int row) const noexcept {
    return room_m_[static_cast<std::size_t>(row * cells_->columns + column)];
  }
  [[nodiscard]] double room_between(const Vec2& a, const Vec2& b, double reach_m) const;
  /// Has less room on its way than at its ends.
  struct NarrowStep {
    int cell, direction;
    double room_m;
  };

  std::shared_ptr<const FloorCells> cells_;
  std::vector<double> room_m_;  ///< (rows x columns) from a cell's centre to what is solid; infinite beyond the reach
  std::vector<NarrowStep> narrow_steps_;
};

// Where a person can walk, and the way from here to there.

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
