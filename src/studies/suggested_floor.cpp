#include "studies/suggested_floor.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace pirsim::studies {
namespace {

// All assumed, for rooms that people live and work in; tried on the models of docs/validation/foreign_models.md.
constexpr double narrowest_way_m = 0.55;  ///< regions that are narrower everywhere are insides of walls (0.5-0.6)
constexpr double least_room_m2 = 1.2;     ///< smaller ones belong to their neighbour (0.8-2)
constexpr double narrowest_door_m = 0.55, widest_door_m = 2.2;  ///< to the outside, double doors included
constexpr double indoors = 0.3;  ///< least part below a ceiling, if there are ceilings at all (0.2-0.5)

/// What is told of a region.
struct Region {
  std::size_t n_cells = 0, n_covered = 0;
  std::size_t n_at_walls = 0, n_at_void = 0;  ///< squares beside a wall, beside no floor
  double widest_m = 0.0;
};

/// Regions become rooms, or the outside.
class Planner {
 public:
  Planner(FloorMaps maps, std::span<const Leaf> leaves, double height_m)
      : maps_(std::move(maps)), grid_(maps_.grid), leaves_(leaves), height_m_(height_m) {}

  FloorPlan run() {
    distance_m_ = distances_m(grid_, maps_.blocked);
    regions_ = regions_of(grid_, distance_m_, {});
    measure();
    join_small();
    tell_outside();
    return plan();
  }

 private:
  [[nodiscard]] double square_metres(std::size_t n_cells) const {
    return static_cast<double>(n_cells) * grid_.side_m * grid_.side_m;
  }
  Region& region(int number) { return measured_[static_cast<std::size_t>(number)]; }

  void measure() {
    measured_.assign(static_cast<std::size_t>(regions_.count), {});
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      if (regions_.of_cell[i] < 0) continue;
      Region& own = region(regions_.of_cell[i]);
      ++own.n_cells;
      own.n_covered += maps_.ceiling[i];
      own.widest_m = std::max(own.widest_m, 2.0 * distance_m_[i]);
      bool wall = false, nothing = false;
      grid_.each_neighbour(i, [&](std::size_t neighbour) {
        wall = wall || maps_.walls[neighbour] != 0;
        nothing = nothing || (maps_.walls[neighbour] == 0 && maps_.floor[neighbour] == 0);
      });
      own.n_at_walls += wall ? 1 : 0;
      own.n_at_void += nothing ? 1 : 0;
    }
  }

  /// Corners behind wardrobes go to the room that they are open to; insides of walls to nothing.
  void join_small() {
    std::vector<int> joined(measured_.size());
    std::iota(joined.begin(), joined.end(), 0);
    std::vector<const RegionGap*> widest_of(measured_.size(), nullptr);
    for (const RegionGap& gap : regions_.gaps) {
      for (const int own : {gap.a, gap.b}) {
        const RegionGap*& widest = widest_of[static_cast<std::size_t>(own)];
        if (widest == nullptr || gap.width_m > widest->width_m) widest = &gap;
      }
    }
    for (std::size_t i = 0; i < measured_.size(); ++i) {
      if (square_metres(measured_[i].n_cells) >= least_room_m2 && measured_[i].widest_m >= narrowest_way_m) continue;
      const RegionGap* widest = widest_of[i];
      const int other = widest == nullptr ? -1 : widest->a == static_cast<int>(i) ? widest->b : widest->a;
      const bool is_larger = other >= 0 && region(other).n_cells > measured_[i].n_cells;
      joined[i] = is_larger ? other : -1;
    }
    const auto final_of = [&](int number) {
      while (number >= 0 && joined[static_cast<std::size_t>(number)] != number)
        number = joined[static_cast<std::size_t>(number)];
      return number;
    };
    for (int& number : regions_.of_cell) number = number < 0 ? -1 : final_of(number);
    std::vector<RegionGap> gaps;
    for (RegionGap gap : regions_.gaps) {
      gap.a = final_of(gap.a), gap.b = final_of(gap.b);
      if (gap.a >= 0 && gap.b >= 0 && gap.a != gap.b) gaps.push_back(gap);
    }
    regions_.gaps = std::move(gaps);
    measure();
  }

  /// Regions with a way in or out, or larger than any cupboard or shaft.
  [[nodiscard]] Cells possible_rooms() const {
    constexpr double most_m2 = 4.0;  // assumed, of what has no way in (2-6)
    Cells may_be(measured_.size(), 0);
    const auto take = [&](int number) {
      if (number >= 0) may_be[static_cast<std::size_t>(number)] = 1;
    };
    for (const RegionGap& gap : regions_.gaps) take(gap.a), take(gap.b);
    for (const Leaf& leaf : leaves_) {
      for (const Vec2& aside : {leaf.across, -leaf.across}) take(beside(regions_.of_cell, leaf, aside));
    }
    for (std::size_t i = 0; i < measured_.size(); ++i) {
      if (square_metres(measured_[i].n_cells) > most_m2 || measured_[i].n_at_void > 0) may_be[i] = 1;
    }
    return may_be;
  }

  /// Without a ceiling where others have one, or with more edge than wall. A model of one room that is open stays.
  void tell_outside() {
    std::size_t n_cells = 0, n_covered = 0;
    for (const Region& own : measured_) n_cells += own.n_cells, n_covered += own.n_covered;
    const bool has_ceilings = static_cast<double>(n_covered) >= indoors * static_cast<double>(n_cells);
    is_outside_.assign(measured_.size(), 0);
    const Cells may_be_room = possible_rooms();
    std::size_t n_inside = 0;
    for (std::size_t i = 0; i < measured_.size(); ++i) {
      const Region& own = measured_[i];
      const bool is_bare = static_cast<double>(own.n_covered) < indoors * static_cast<double>(own.n_cells);
      const bool is_garden = has_ceilings ? is_bare : own.n_at_void > own.n_at_walls;
      is_outside_[i] = own.n_cells == 0 || is_garden || may_be_room[i] == 0 ? 1 : 0;
      n_inside += is_outside_[i] == 0 ? 1 : 0;
    }
    if (n_inside > 0) return;
    is_bare_ = true;
    const auto largest = std::ranges::max_element(measured_, {}, &Region::n_cells);
    if (largest != measured_.end()) is_outside_[static_cast<std::size_t>(largest - measured_.begin())] = 0;
  }

  FloorPlan plan() {
    FloorPlan plan;
    plan.height_m = height_m_;
    plan.is_bare = is_bare_;
    plan.grid = grid_;
    std::map<int, int> rooms;
    plan.room_of_cell.assign(grid_.size(), -1);
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      const int number = regions_.of_cell[i];
      if (number < 0 || is_outside_[static_cast<std::size_t>(number)] != 0) continue;
      plan.room_of_cell[i] = rooms.try_emplace(number, static_cast<int>(rooms.size())).first->second;
      if (maps_.low[i] != 0) continue;
      plan.standing_m2 += square_metres(1);
      plan.covered_m2 += square_metres(maps_.ceiling[i]);
    }
    plan.n_rooms = static_cast<int>(rooms.size());
    add_leaves(plan);
    for (const RegionGap& gap : regions_.gaps) {
      const auto a = rooms.find(gap.a), b = rooms.find(gap.b);
      const int one = a == rooms.end() ? -1 : a->second, other = b == rooms.end() ? -1 : b->second;
      if (std::max(one, other) < 0 || gap.width_m < narrowest_door_m || is_sill(gap.cell)) continue;
      FloorGap opening{
          one < 0 ? other : one, std::min(one, other) < 0 ? -1 : other, grid_.centre(gap.cell), {}, gap.width_m};
      opening.inwards = inwards(plan, opening.from, gap.cell);
      add_gap(plan, opening);
    }
    add_ways_out(plan);
    return plan;
  }

  /// One opening has one gap, which is told by its leaf if there is one.
  static void add_gap(FloorPlan& plan, const FloorGap& gap) {
    constexpr double apart_m = 0.6;
    const auto is_same = [&](const FloorGap& known) { return glm::distance(known.at, gap.at) < apart_m; };
    if (std::ranges::none_of(plan.gaps, is_same)) plan.gaps.push_back(gap);
  }

  /// Leaves with one room before them, and another or the outside behind.
  void add_leaves(FloorPlan& plan) const {
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      const Leaf& leaf = leaves_[i];
      const int before = beside(plan.room_of_cell, leaf, leaf.across);
      const int behind = beside(plan.room_of_cell, leaf, -leaf.across);
      if (before == behind) continue;
      const Vec2 inwards = before >= 0 ? leaf.across : -leaf.across;
      add_gap(plan, {before >= 0 ? before : behind, std::min(before, behind) < 0 ? -1 : behind, leaf.middle, inwards,
                     leaf.width_m, static_cast<int>(i)});
    }
  }
  /// What squares are numbered first on one side of a leaf, beyond the frame.
  [[nodiscard]] int beside(const std::vector<int>& of_cell, const Leaf& leaf, const Vec2& aside) const {
    constexpr double frame_m = 0.3;  // assumed: of a wall's half thickness (0.15-0.3)
    for (double away_m = 0.5 * grid_.side_m; away_m < 0.5 * leaf.thickness_m + frame_m; away_m += 0.5 * grid_.side_m) {
      if (const int number = of_cell[grid_.at(leaf.middle + away_m * aside)]; number >= 0) return number;
    }
    return -1;
  }

  /// Does something at the knees bar the place, from wall to wall?
  [[nodiscard]] bool is_sill(std::size_t cell) const {
    bool found = maps_.sills[cell] != 0;
    grid_.each_neighbour(cell, [&](std::size_t neighbour) { found = found || maps_.sills[neighbour] != 0; });
    return found;
  }

  /// From a place to the middle of the room's squares near it.
  [[nodiscard]] Vec2 inwards(const FloorPlan& plan, int room, std::size_t cell) const {
    constexpr double near_m = 0.5;
    const Vec2 at = grid_.centre(cell);
    const std::size_t first = grid_.at(at - near_m), last = grid_.at(at + near_m);
    Vec2 sum(0.0);
    for (std::size_t row = first / grid_.n_columns; row <= last / grid_.n_columns; ++row) {
      for (std::size_t column = first % grid_.n_columns; column <= last % grid_.n_columns; ++column) {
        const std::size_t other = row * grid_.n_columns + column;
        if (plan.room_of_cell[other] == room) sum += grid_.centre(other) - at;
      }
    }
    return glm::length(sum) > 1e-9 ? glm::normalize(sum) : Vec2(0.0, -1.0);
  }

  /// Where a room's floor ends without a wall, for the width of a door.
  void add_ways_out(FloorPlan& plan) const {
    Cells edge(grid_.size(), 0);
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      if (plan.room_of_cell[i] < 0) continue;
      grid_.each_neighbour(i, [&](std::size_t neighbour) {
        if (maps_.walls[neighbour] == 0 && maps_.floor[neighbour] == 0) edge[i] = 1;
      });
    }
    const bool has_way_in = std::ranges::any_of(plan.gaps, [](const FloorGap& gap) { return gap.to < 0; });
    std::vector<FloorGap> doors, sides;
    for (const std::vector<std::size_t>& run : runs_of(edge)) {
      const FloorGap gap = gap_along(plan, run);
      const auto n_sills = std::ranges::count_if(run, [&](std::size_t cell) { return is_sill(cell); });
      if (3 * n_sills > static_cast<long>(run.size()) || gap.width_m < narrowest_door_m) continue;
      (gap.width_m <= widest_door_m ? doors : sides).push_back(gap);
    }
    if (doors.empty() && !has_way_in && !sides.empty()) {
      FloorGap widest = *std::ranges::max_element(sides, {}, &FloorGap::width_m);
      widest.width_m = 0.9;
      doors.push_back(widest);
      plan.is_open = true;
    }
    for (const FloorGap& door : doors) add_gap(plan, door);
  }

  /// Squares that touch, corners included.
  [[nodiscard]] std::vector<std::vector<std::size_t>> runs_of(const Cells& edge) const {
    std::vector<std::vector<std::size_t>> runs;
    Cells left = edge;
    for (std::size_t first = 0; first < left.size(); ++first) {
      if (left[first] == 0) continue;
      std::vector<std::size_t>& run = runs.emplace_back(1, first);
      left[first] = 0;
      for (std::size_t i = 0; i < run.size(); ++i) {
        const std::size_t column = run[i] % grid_.n_columns, row = run[i] / grid_.n_columns;
        for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(row + 1, grid_.n_rows - 1); ++r) {
          for (std::size_t c = column == 0 ? 0 : column - 1; c <= std::min(column + 1, grid_.n_columns - 1); ++c) {
            if (std::exchange(left[r * grid_.n_columns + c], 0) != 0) run.push_back(r * grid_.n_columns + c);
          }
        }
      }
    }
    return runs;
  }

  [[nodiscard]] FloorGap gap_along(const FloorPlan& plan, const std::vector<std::size_t>& run) const {
    Vec2 lower(std::numeric_limits<double>::max()), upper(std::numeric_limits<double>::lowest()), sum(0.0);
    for (const std::size_t cell : run) {
      const Vec2 at = grid_.centre(cell);
      lower = glm::min(lower, at), upper = glm::max(upper, at), sum += at;
    }
    const Vec2 middle = sum / static_cast<double>(run.size());
    const auto nearest =
        std::ranges::min_element(run, {}, [&](std::size_t cell) { return glm::distance(grid_.centre(cell), middle); });
    FloorGap gap;
    gap.from = plan.room_of_cell[*nearest];
    gap.inwards = inwards(plan, gap.from, *nearest);
    gap.at = grid_.centre(*nearest) - 0.5 * grid_.side_m * gap.inwards;
    gap.width_m = glm::distance(lower, upper) + grid_.side_m;
    return gap;
  }

  FloorMaps maps_;
  const CellGrid& grid_;
  std::span<const Leaf> leaves_;
  double height_m_;
  std::vector<double> distance_m_;
  Regions regions_;
  std::vector<Region> measured_;  ///< (n_regions)
  Cells is_outside_;              ///< (n_regions)
  bool is_bare_ = false;
};

}  // namespace

FloorPlan floor_plan_at(std::span<const TriMesh* const> meshes, std::span<const Leaf> leaves, double height_m,
                        double side_m) {
  return Planner(maps_of(meshes, height_m, side_m), leaves, height_m).run();
}

}  // namespace pirsim::studies
