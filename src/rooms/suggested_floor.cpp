#include "rooms/suggested_floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace pirsim {

CellGrid::CellGrid(const Vec2& lower, const Vec2& upper, double margin_m, double wanted_side_m, std::size_t most)
    : corner(lower - margin_m) {
  const Vec2 size = upper - lower + 2.0 * margin_m;
  side_m = std::max(wanted_side_m, std::sqrt(size.x * size.y / static_cast<double>(most)));
  n_columns = static_cast<std::size_t>(size.x / side_m) + 1;
  n_rows = static_cast<std::size_t>(size.y / side_m) + 1;
}

Vec2 CellGrid::centre(std::size_t cell) const noexcept {
  const Vec2 place(static_cast<double>(cell % n_columns), static_cast<double>(cell / n_columns));
  return corner + side_m * (place + 0.5);
}

std::size_t CellGrid::at(const Vec2& point) const noexcept {
  const Vec2 place = (point - corner) / side_m;
  const auto within = [](double value, std::size_t n) {
    return static_cast<std::size_t>(std::clamp(value, 0.0, static_cast<double>(n - 1)));
  };
  return within(place.y, n_rows) * n_columns + within(place.x, n_columns);
}

void take_line(Cells& cells, const CellGrid& grid, const Vec2& from, const Vec2& to) {
  // Half a square a step: what it misses at a corner, its neighbours have.
  const double length = glm::distance(from, to);
  const auto steps = static_cast<std::size_t>(std::ceil(2.0 * length / grid.side_m));
  const Vec2 upper = grid.corner + grid.side_m * Vec2(grid.n_columns, grid.n_rows);
  for (std::size_t i = 0; i <= steps; ++i) {
    const double part = steps == 0 ? 0.0 : static_cast<double>(i) / static_cast<double>(steps);
    const Vec2 p = from + part * (to - from);
    if (p.x >= grid.corner.x && p.y >= grid.corner.y && p.x < upper.x && p.y < upper.y) cells[grid.at(p)] = 1;
  }
}

void take_triangle(Cells& cells, const CellGrid& grid, const Vec2& a, const Vec2& b, const Vec2& c) {
  const auto cross = [](const Vec2& u, const Vec2& v) { return u.x * v.y - u.y * v.x; };
  const double whole = cross(b - a, c - a);
  if (std::abs(whole) < 1e-12) return;
  const std::size_t first = grid.at(glm::min(a, glm::min(b, c))), last = grid.at(glm::max(a, glm::max(b, c)));
  for (std::size_t row = first / grid.n_columns; row <= last / grid.n_columns; ++row) {
    for (std::size_t column = first % grid.n_columns; column <= last % grid.n_columns; ++column) {
      const std::size_t cell = row * grid.n_columns + column;
      const Vec2 p = grid.centre(cell);
      const double at_c = cross(b - a, p - a) / whole, at_a = cross(c - b, p - b) / whole;
      if (std::min({at_a, at_c, 1.0 - at_a - at_c}) >= 0.0) cells[cell] = 1;
    }
  }
}

namespace {

/// The lower envelope of parabolas over one line of squares (Felzenszwalb and Huttenlocher 2012): squared distances
/// along the line become squared distances in the plane.
void sweep(std::vector<double>& squared) {
  const std::size_t n = squared.size();
  std::vector<std::size_t> lowest;  ///< whose parabola is lowest somewhere, from left to right
  std::vector<double> from;         ///< where each begins to be
  const auto height = [&](std::size_t q) { return squared[q] + static_cast<double>(q) * static_cast<double>(q); };
  for (std::size_t q = 0; q < n; ++q) {
    if (!std::isfinite(squared[q])) continue;
    double meets = -std::numeric_limits<double>::infinity();
    while (!lowest.empty()) {
      meets = (height(q) - height(lowest.back())) / (2.0 * static_cast<double>(q - lowest.back()));
      if (meets > from.back()) break;
      lowest.pop_back(), from.pop_back();
      meets = -std::numeric_limits<double>::infinity();
    }
    lowest.push_back(q), from.push_back(meets);
  }
  if (lowest.empty()) return;
  std::vector<double> result(n);
  std::size_t k = 0;
  for (std::size_t q = 0; q < n; ++q) {
    while (k + 1 < lowest.size() && from[k + 1] < static_cast<double>(q)) ++k;
    const double apart = static_cast<double>(q) - static_cast<double>(lowest[k]);
    result[q] = squared[lowest[k]] + apart * apart;
  }
  squared = std::move(result);
}

/// Squares join the region of their widest neighbour; where two regions meet they become one, or stay apart for good.
class Flood {
 public:
  Flood(const CellGrid& grid, const std::vector<double>& distance_m, const RegionLimits& limits)
      : grid_(grid), distance_m_(distance_m), limits_(limits), of_cell_(grid.size(), -1) {}

  Regions run() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < distance_m_.size(); ++i) {
      if (distance_m_[i] > 0.0) order.push_back(i);
    }
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return distance_m_[a] > distance_m_[b]; });
    for (const std::size_t cell : order) add(cell);
    return finish();
  }

 private:
  void add(std::size_t cell) {
    int own = -1;
    grid_.each_neighbour(cell, [&](std::size_t neighbour) {
      if (of_cell_[neighbour] < 0) return;
      const int other = root(of_cell_[neighbour]);
      if (own < 0) {
        own = other;
      } else if (own != other) {
        own = meet(own, other, cell);
      }
    });
    if (own < 0) {
      own = static_cast<int>(parent_.size());
      parent_.push_back(own);
      peak_m_.push_back(distance_m_[cell]);
    }
    of_cell_[cell] = own;
  }
  int meet(int a, int b, std::size_t cell) {
    const auto place = [](int region) { return static_cast<std::size_t>(region); };
    const double half_m = distance_m_[cell];
    const double narrower_m = std::min(peak_m_[place(a)], peak_m_[place(b)]);
    if (2.0 * half_m > limits_.widest_gap_m || half_m >= limits_.least_narrowing * narrower_m) {
      const auto [kept, joined] = std::minmax(a, b);
      parent_[place(joined)] = kept;
      peak_m_[place(kept)] = std::max(peak_m_[place(kept)], peak_m_[place(joined)]);
      return kept;
    }
    meetings_.push_back({a, b, cell, 2.0 * half_m});
    return peak_m_[place(a)] >= peak_m_[place(b)] ? a : b;
  }
  int root(int region) {
    while (parent_[static_cast<std::size_t>(region)] != region) {
      int& above = parent_[static_cast<std::size_t>(region)];
      above = parent_[static_cast<std::size_t>(above)];
      region = above;
    }
    return region;
  }

  Regions finish() {
    Regions result;
    std::map<int, int> numbers;
    result.of_cell.assign(of_cell_.size(), -1);
    for (std::size_t i = 0; i < of_cell_.size(); ++i) {
      if (of_cell_[i] < 0) continue;
      const int next = static_cast<int>(numbers.size());
      result.of_cell[i] = numbers.try_emplace(root(of_cell_[i]), next).first->second;
    }
    result.count = static_cast<int>(numbers.size());
    std::map<std::pair<int, int>, std::vector<RegionGap>> gaps;
    for (RegionGap gap : meetings_) {
      std::tie(gap.a, gap.b) = std::minmax({numbers.at(root(gap.a)), numbers.at(root(gap.b))});
      if (gap.a == gap.b) continue;
      std::vector<RegionGap>& known = gaps[{gap.a, gap.b}];
      if (is_new(known, gap)) known.push_back(gap);
    }
    for (const auto& [regions, between] : gaps) result.gaps.insert(result.gaps.end(), between.begin(), between.end());
    return result;
  }
  /// Regions meet along the whole of a gap, its middle first.
  [[nodiscard]] bool is_new(const std::vector<RegionGap>& gaps, const RegionGap& gap) const {
    return std::ranges::none_of(gaps, [&](const RegionGap& known) {
      return glm::distance(grid_.centre(known.cell), grid_.centre(gap.cell)) < known.width_m + 2.0 * grid_.side_m;
    });
  }

  const CellGrid& grid_;
  const std::vector<double>& distance_m_;
  RegionLimits limits_;
  std::vector<int> of_cell_, parent_;
  std::vector<double> peak_m_;
  std::vector<RegionGap> meetings_;
};

/// Leaves out corners of a closed line that are near the line between those that stay (Douglas and Peucker).
class Simplifier {
 public:
  Simplifier(const std::vector<Vec2>& line, double tolerance)
      : line_(line), tolerance_(tolerance), stays_(line.size()) {}

  std::vector<Vec2> run() {
    std::size_t far = 0;
    for (std::size_t i = 0; i < line_.size(); ++i) {
      if (glm::distance(line_[0], line_[i]) > glm::distance(line_[0], line_[far])) far = i;
    }
    stays_[0] = stays_[far] = 1;
    split(0, far);
    split(far, line_.size());
    std::vector<Vec2> result;
    for (std::size_t i = 0; i < line_.size(); ++i) {
      if (stays_[i] != 0) result.push_back(line_[i]);
    }
    return result;
  }

 private:
  /// last may be the size: the line is closed.
  void split(std::size_t first, std::size_t last) {
    std::vector<std::pair<std::size_t, std::size_t>> pending{{first, last}};
    while (!pending.empty()) {
      const auto [from, to] = pending.back();
      pending.pop_back();
      std::size_t farthest = from;
      double most = tolerance_;
      for (std::size_t i = from + 1; i < to; ++i) {
        if (const double away = from_line(line_[i], line_[from], line_[to % line_.size()]); away > most)
          most = away, farthest = i;
      }
      if (farthest == from) continue;
      stays_[farthest] = 1;
      pending.emplace_back(from, farthest);
      pending.emplace_back(farthest, to);
    }
  }
  static double from_line(const Vec2& p, const Vec2& a, const Vec2& b) {
    const Vec2 along = b - a;
    const double length = glm::dot(along, along);
    const double part = length > 0.0 ? std::clamp(glm::dot(p - a, along) / length, 0.0, 1.0) : 0.0;
    return glm::distance(p, a + part * along);
  }

  const std::vector<Vec2>& line_;
  double tolerance_;
  Cells stays_;
};

/// Walks round what is taken with it on one side, from corner to corner of squares.
class Tracer {
 public:
  Tracer(const CellGrid& grid, const Cells& taken) : grid_(grid), taken_(taken) {}

  /// From the upper side of a square that is the first of its part, row by row: that side is on its outer outline.
  std::vector<Vec2> from(std::size_t cell) const {
    const long first_column = static_cast<long>(cell % grid_.n_columns),
               first_row = static_cast<long>(cell / grid_.n_columns);
    // Directions: +column, +row, -column, -row; what is taken lies on the side of the next direction.
    constexpr std::array<std::array<long, 2>, 4> step{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    long column = first_column, row = first_row;
    std::size_t heading = 0;
    std::vector<Vec2> corners;
    do {
      corners.push_back(grid_.corner + grid_.side_m * Vec2(static_cast<double>(column), static_cast<double>(row)));
      do {
        column += step[heading][0], row += step[heading][1];
      } while (goes_straight(column, row, heading));
      heading = is_taken_ahead(column, row, heading, Side::own) ? (heading + 3) % 4 : (heading + 1) % 4;
    } while (column != first_column || row != first_row || heading != 0);
    return corners;
  }

 private:
  enum class Side { own, other };
  /// The square ahead of a corner, on the side of what is taken or on the other one.
  [[nodiscard]] bool is_taken_ahead(long column, long row, std::size_t heading, Side side) const {
    // Of heading 0 the taken side is +row; squares are named by their lower corner.
    constexpr std::array<std::array<long, 2>, 4> own{{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
    constexpr std::array<std::array<long, 2>, 4> other{{{0, -1}, {0, 0}, {-1, 0}, {-1, -1}}};
    const auto& offset = side == Side::own ? own[heading] : other[heading];
    return is_taken(column + offset[0], row + offset[1]);
  }
  [[nodiscard]] bool goes_straight(long column, long row, std::size_t heading) const {
    return is_taken_ahead(column, row, heading, Side::own) && !is_taken_ahead(column, row, heading, Side::other);
  }
  [[nodiscard]] bool is_taken(long column, long row) const {
    return column >= 0 && row >= 0 && column < static_cast<long>(grid_.n_columns) &&
           row < static_cast<long>(grid_.n_rows) &&
           taken_[static_cast<std::size_t>(row) * grid_.n_columns + static_cast<std::size_t>(column)] != 0;
  }

  const CellGrid& grid_;
  const Cells& taken_;
};

}  // namespace

std::vector<double> distances_m(const CellGrid& grid, const Cells& taken) {
  std::vector<double> squared(grid.size());
  for (std::size_t i = 0; i < squared.size(); ++i)
    squared[i] = taken[i] != 0 ? 0.0 : std::numeric_limits<double>::infinity();
  const auto along = [&](std::size_t first, std::size_t step, std::size_t n) {
    std::vector<double> line(n);
    for (std::size_t i = 0; i < n; ++i) line[i] = squared[first + i * step];
    sweep(line);
    for (std::size_t i = 0; i < n; ++i) squared[first + i * step] = line[i];
  };
  for (std::size_t row = 0; row < grid.n_rows; ++row) along(row * grid.n_columns, 1, grid.n_columns);
  for (std::size_t column = 0; column < grid.n_columns; ++column) along(column, grid.n_columns, grid.n_rows);
  for (double& distance : squared) distance = grid.side_m * std::sqrt(distance);
  return squared;
}

Cells grown(const CellGrid& grid, const Cells& taken, double by_m) {
  const std::vector<double> distance_m = distances_m(grid, taken);
  Cells result(taken.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = distance_m[i] <= by_m ? 1 : 0;
  return result;
}

Cells shrunk(const CellGrid& grid, Cells taken, double by_m) {
  for (auto& cell : taken) cell = cell == 0 ? 1 : 0;
  Cells result = grown(grid, taken, by_m);
  for (auto& cell : result) cell = cell == 0 ? 1 : 0;
  return result;
}

std::vector<CellHole> holes_of(const CellGrid& grid, const Cells& taken) {
  std::vector<CellHole> holes;
  Cells seen = taken;
  for (std::size_t first = 0; first < seen.size(); ++first) {
    if (seen[first] != 0) continue;
    CellHole& hole = holes.emplace_back();
    hole.cells.push_back(first);
    seen[first] = 1;
    for (std::size_t i = 0; i < hole.cells.size(); ++i) {
      int n = 0;
      grid.each_neighbour(hole.cells[i], [&](std::size_t neighbour) {
        ++n;
        if (seen[neighbour] != 0) return;
        seen[neighbour] = 1;
        hole.cells.push_back(neighbour);
      });
      if (n < 4) hole.is_at_edge = true;
    }
  }
  return holes;
}

void fill_holes(const CellGrid& grid, Cells& taken, double most_m2) {
  for (const CellHole& hole : holes_of(grid, taken)) {
    if (hole.is_at_edge || static_cast<double>(hole.cells.size()) * grid.side_m * grid.side_m > most_m2) continue;
    for (const std::size_t cell : hole.cells) taken[cell] = 1;
  }
}

Regions regions_of(const CellGrid& grid, const std::vector<double>& distance_m, const RegionLimits& limits) {
  return Flood(grid, distance_m, limits).run();
}

std::vector<std::vector<Vec2>> outlines_of(const CellGrid& grid, const Cells& taken, double tolerance_m) {
  std::vector<std::vector<Vec2>> outlines;
  Cells seen(taken.size(), 0);
  const Tracer tracer(grid, taken);
  for (std::size_t first = 0; first < taken.size(); ++first) {
    if (taken[first] == 0 || seen[first] != 0) continue;
    std::vector<std::size_t> pending{first};
    seen[first] = 1;
    while (!pending.empty()) {
      const std::size_t cell = pending.back();
      pending.pop_back();
      grid.each_neighbour(cell, [&](std::size_t neighbour) {
        if (taken[neighbour] == 0 || seen[neighbour] != 0) return;
        seen[neighbour] = 1;
        pending.push_back(neighbour);
      });
    }
    const std::vector<Vec2> corners = tracer.from(first);
    outlines.push_back(Simplifier(corners, tolerance_m).run());
    std::ranges::reverse(outlines.back());
  }
  return outlines;
}

}  // namespace pirsim

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

// All assumed, for rooms that people live and work in; tried on the models of docs/validation/foreign_models.md.
constexpr double level_part = 0.98;    ///< least upward part of a level surface's normal (tried 0.9-0.99)
constexpr double same_floor_m = 0.08;  ///< thresholds and carpets (0.05-0.1)
constexpr double head_m = 1.7;         ///< where walls are cut: above furniture, below lintels (1.5-1.9)
constexpr double knee_m = 0.3;         ///< where a sill is (0.2-0.5)
constexpr double least_ceiling_m = 1.9, most_ceiling_m = 8.0;
constexpr double filled_hole_m2 = 3.0;  ///< of a floor, where furniture stands (1-5)

using Meshes = std::span<const TriMesh* const>;
using Corners = std::array<Vec3, 3>;

void each_triangle(Meshes meshes, const auto& visit) {
  for (const TriMesh* mesh : meshes) {
    for (const auto& [a, b, c] : mesh->triangles)
      visit(Corners{mesh->positions[a], mesh->positions[b], mesh->positions[c]});
  }
}
Vec3 area_vector(const Corners& t) { return 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]); }
bool is_level(const Corners& t) {
  const Vec3 area = area_vector(t);
  return std::abs(area.y) >= level_part * glm::length(area);
}
double lowest(const Corners& t) { return std::min({t[0].y, t[1].y, t[2].y}); }
double highest(const Corners& t) { return std::max({t[0].y, t[1].y, t[2].y}); }

/// Where triangles cross a height.
void take_section(Cells& cells, const CellGrid& grid, Meshes meshes, double height_m) {
  each_triangle(meshes, [&](const Corners& t) {
    if (lowest(t) > height_m || highest(t) <= height_m) return;
    std::vector<Vec2> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &p = t[i], &q = t[(i + 1) % 3];
      if ((p.y <= height_m) == (q.y <= height_m)) continue;
      ends.push_back(floor_point(p + (height_m - p.y) / (q.y - p.y) * (q - p)));
    }
    if (ends.size() == 2) take_line(cells, grid, ends[0], ends[1]);
  });
}

void take_seen_from_above(Cells& cells, const CellGrid& grid, Meshes meshes, double from_m, double to_m) {
  // assumed: floors above one another some hundreds of times; what is made to take longer is left out
  constexpr double most_times = 1000.0;
  double left_m2 = most_times * static_cast<double>(grid.size()) * grid.side_m * grid.side_m;
  each_triangle(meshes, [&](const Corners& t) {
    if (lowest(t) < from_m || highest(t) > to_m || !is_level(t) || left_m2 <= 0.0) return;
    left_m2 -= std::abs(area_vector(t).y);
    take_triangle(cells, grid, floor_point(t[0]), floor_point(t[1]), floor_point(t[2]));
  });
}

CellGrid grid_of(Meshes meshes, double height_m, double side_m, FloorFrom from) {
  const double margin_m = from == FloorFrom::surfaces ? 0.5 : 1.5;  // room for doors that are shut in thought
  constexpr std::size_t most_cells = 3'000'000;
  Vec2 lower(std::numeric_limits<double>::max()), upper(std::numeric_limits<double>::lowest());
  each_triangle(meshes, [&](const Corners& t) {
    const bool is_floor = std::abs(lowest(t) - height_m) <= same_floor_m && is_level(t);
    const bool is_wall = lowest(t) <= height_m + knee_m && highest(t) >= height_m + knee_m;
    if (from == FloorFrom::surfaces ? !is_floor : !is_wall) return;
    for (const Vec3& p : t) lower = glm::min(lower, floor_point(p)), upper = glm::max(upper, floor_point(p));
  });
  if (lower.x > upper.x) lower = upper = Vec2(0.0);
  return {lower, upper, margin_m, side_m, most_cells};
}

/// What lies inside of walls, if gaps as wide as a double door are shut.
Cells enclosed_by(const CellGrid& grid, const Cells& walls) {
  const double half_m = 0.5 * widest_door_m;
  Cells shut = grown(grid, walls, half_m);
  fill_holes(grid, shut, std::numeric_limits<double>::infinity());
  return shrunk(grid, std::move(shut), half_m);
}

/// Cuts a slit from every hole that has other rooms in it to the outside: an outline has no holes.
void open_holes(const FloorPlan& plan, int room, Cells& cells) {
  constexpr std::size_t half_width = 1;
  for (const CellHole& hole : holes_of(plan.grid, cells)) {
    const auto is_other = [&](std::size_t cell) {
      return plan.room_of_cell[cell] >= 0 && plan.room_of_cell[cell] != room;
    };
    if (hole.is_at_edge || std::ranges::none_of(hole.cells, is_other)) continue;
    const std::size_t top = *std::ranges::min_element(hole.cells);
    for (std::size_t at = top; at >= plan.grid.n_columns; at -= plan.grid.n_columns) {
      for (std::size_t c = at - half_width; c <= at + half_width; ++c) cells[c] = 0;
    }
  }
}

/// The part of a plan round one room: the rest needs no time.
FloorPlan part_round(const FloorPlan& plan, int room) {
  constexpr std::size_t margin = 4;
  const CellGrid& grid = plan.grid;
  std::size_t left = grid.n_columns, right = 0, top = grid.n_rows, bottom = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (plan.room_of_cell[i] != room) continue;
    left = std::min(left, i % grid.n_columns), right = std::max(right, i % grid.n_columns);
    top = std::min(top, i / grid.n_columns), bottom = std::max(bottom, i / grid.n_columns);
  }
  left -= std::min(left, margin), top -= std::min(top, margin);
  right = std::min(right + margin, grid.n_columns - 1), bottom = std::min(bottom + margin, grid.n_rows - 1);
  FloorPlan part = plan;
  part.grid.corner = grid.corner + grid.side_m * Vec2(static_cast<double>(left), static_cast<double>(top));
  part.grid.n_columns = right + 1 - left, part.grid.n_rows = bottom + 1 - top;
  part.room_of_cell.clear();
  for (std::size_t row = top; row <= bottom; ++row) {
    const auto first = plan.room_of_cell.begin() + static_cast<std::ptrdiff_t>(row * grid.n_columns);
    part.room_of_cell.insert(part.room_of_cell.end(), first + static_cast<std::ptrdiff_t>(left),
                             first + static_cast<std::ptrdiff_t>(right + 1));
  }
  return part;
}

}  // namespace

FloorPlan floor_plan_at(std::span<const TriMesh* const> meshes, std::span<const Leaf> leaves, double height_m,
                        double side_m, FloorFrom from) {
  return Planner(maps_of(meshes, height_m, side_m, from), leaves, height_m).run();
}

// Level surfaces and walls of a model, on squares.

FloorMaps maps_of(Meshes meshes, double height_m, double side_m, FloorFrom from) {
  FloorMaps maps{grid_of(meshes, height_m, side_m, from), {}, {}, {}, {}, {}, {}};
  for (Cells* cells : {&maps.floor, &maps.walls, &maps.sills, &maps.ceiling, &maps.low})
    cells->assign(maps.grid.size(), 0);
  double top_m = height_m;
  each_triangle(meshes, [&](const Corners& t) { top_m = std::max(top_m, highest(t)); });
  const double cut_m = height_m + std::min(head_m, 0.85 * (top_m - height_m));  // walls of some models are cut lower
  take_seen_from_above(maps.floor, maps.grid, meshes, height_m - same_floor_m, height_m + same_floor_m);
  take_seen_from_above(maps.ceiling, maps.grid, meshes, height_m + least_ceiling_m, height_m + most_ceiling_m);
  take_seen_from_above(maps.low, maps.grid, meshes, height_m + same_floor_m, height_m + head_m);
  take_section(maps.walls, maps.grid, meshes, cut_m);
  take_section(maps.sills, maps.grid, meshes, height_m + knee_m);
  if (from == FloorFrom::walls) maps.floor = enclosed_by(maps.grid, maps.walls);
  Cells floor_and_walls = maps.floor;
  for (std::size_t i = 0; i < floor_and_walls.size(); ++i) floor_and_walls[i] |= maps.walls[i];
  fill_holes(maps.grid, floor_and_walls, filled_hole_m2);
  maps.blocked.assign(maps.grid.size(), 0);
  for (std::size_t i = 0; i < maps.blocked.size(); ++i) {
    if (floor_and_walls[i] != 0) maps.floor[i] = 1;
    maps.blocked[i] = maps.walls[i] != 0 || floor_and_walls[i] == 0 ? 1 : 0;
  }
  return maps;
}

std::vector<double> level_heights_m(Meshes meshes) {
  constexpr double bin_m = 0.02, least_m2 = 1.0, least_part = 0.1;
  constexpr double surely_m2 = 8.0;  // assumed (5-12): a room's floor, however large the ground around it is
  constexpr std::size_t most = 12;
  std::map<long, double> areas;  // by bin
  each_triangle(meshes, [&](const Corners& t) {
    if (is_level(t)) areas[std::lround((t[0].y + t[1].y + t[2].y) / 3.0 / bin_m)] += std::abs(area_vector(t).y);
  });
  std::vector<std::pair<double, long>> levels;
  for (const auto& [bin, area] : areas) levels.emplace_back(-area, bin);
  std::ranges::sort(levels);
  std::vector<double> heights;
  for (const auto& [area, bin] : levels) {
    const double height_m = static_cast<double>(bin) * bin_m;
    const auto is_near = [&](double known) { return std::abs(known - height_m) <= 1.5 * same_floor_m; };
    const double least = std::clamp(-least_part * levels.front().first, least_m2, surely_m2);
    if (-area < least || heights.size() == most) break;
    if (std::ranges::none_of(heights, is_near)) heights.push_back(height_m);
  }
  std::ranges::sort(heights);
  return heights;
}

// Outlines of a floor plan.

std::vector<std::vector<Vec2>> floor_outlines(const FloorPlan& plan) {
  constexpr double half_wall_m = 0.25;  // assumed: of the thickest inner walls (0.1-0.3)
  Cells rooms(plan.grid.size());
  for (std::size_t i = 0; i < rooms.size(); ++i) rooms[i] = plan.room_of_cell[i] >= 0 ? 1 : 0;
  Cells whole = shrunk(plan.grid, grown(plan.grid, rooms, half_wall_m), half_wall_m);
  for (std::size_t i = 0; i < rooms.size(); ++i) whole[i] |= rooms[i];
  fill_holes(plan.grid, whole, std::numeric_limits<double>::infinity());
  return outlines_of(plan.grid, whole, 1.2 * plan.grid.side_m);
}

std::vector<Vec2> room_outline(const FloorPlan& whole, int room) {
  const FloorPlan plan = part_round(whole, room);
  const double side_m = plan.grid.side_m;
  Cells cells(plan.grid.size());
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = plan.room_of_cell[i] == room ? 1 : 0;
  // A square off the walls and the neighbours, so that outlines without their lesser corners don't meet.
  cells = grown(plan.grid, shrunk(plan.grid, cells, 2.2 * side_m), 1.0 * side_m);
  open_holes(plan, room, cells);
  std::vector<std::vector<Vec2>> outlines = outlines_of(plan.grid, cells, 0.75 * side_m);
  if (outlines.empty()) return {};
  const auto size = [](const std::vector<Vec2>& loop) { return FloorArea({loop}, 0.0).area_m2(); };
  return *std::ranges::max_element(outlines, {}, size);
}

}  // namespace pirsim::studies
