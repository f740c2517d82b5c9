#include "geom/cell_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

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

namespace {

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

}  // namespace

Regions regions_of(const CellGrid& grid, const std::vector<double>& distance_m, const RegionLimits& limits) {
  return Flood(grid, distance_m, limits).run();
}

namespace {

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
