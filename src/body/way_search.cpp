#include "body/way_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

namespace pirsim::body {
namespace {

double octile(int columns, int a, int b) noexcept {
  const int across = std::abs(a % columns - b % columns);
  const int along = std::abs(a / columns - b / columns);
  return std::max(across, along) + (std::numbers::sqrt2 - 1.0) * std::min(across, along);
}

std::vector<int> traced_back(const std::vector<int>& parent, int goal) {
  std::vector<int> way;
  for (int cell = goal; cell >= 0; cell = parent[static_cast<std::size_t>(cell)]) way.push_back(cell);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace

std::vector<int> shortest_way(const StepGrid& grid, int start, int goal) {
  using Entry = std::pair<double, int>;  // estimate of the whole way, cell: orders ties by the cell's index
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> frontier;
  std::vector<double> cost(grid.open.size(), std::numeric_limits<double>::infinity());
  std::vector<int> parent(grid.open.size(), -1);
  std::vector<std::uint8_t> done(grid.open.size(), 0);
  cost[static_cast<std::size_t>(start)] = 0.0;
  frontier.emplace(octile(grid.columns, start, goal), start);
  while (!frontier.empty()) {
    const int cell = frontier.top().second;
    frontier.pop();
    if (cell == goal) return traced_back(parent, goal);
    if (std::exchange(done[static_cast<std::size_t>(cell)], std::uint8_t{1}) != 0) continue;
    for (int direction = 0; direction < n_directions; ++direction) {
      if (!grid.is_open(cell, direction)) continue;
      const int next = grid.neighbour(cell, direction);
      const auto at = static_cast<std::size_t>(next);
      const double through = cost[static_cast<std::size_t>(cell)] + (direction % 2 == 0 ? 1.0 : std::numbers::sqrt2);
      if (through >= cost[at]) continue;
      cost[at] = through;
      parent[at] = cell;
      frontier.emplace(through + octile(grid.columns, next, goal), next);
    }
  }
  return {};
}

std::vector<int> connected_parts(const StepGrid& grid) {
  std::vector<int> label(grid.open.size(), -1);
  std::vector<int> pending;
  for (int seed = 0; seed < static_cast<int>(label.size()); ++seed) {
    if (label[static_cast<std::size_t>(seed)] >= 0) continue;
    label[static_cast<std::size_t>(seed)] = seed;
    pending.push_back(seed);
    while (!pending.empty()) {
      const int cell = pending.back();
      pending.pop_back();
      for (int direction = 0; direction < n_directions; ++direction) {
        if (!grid.is_open(cell, direction)) continue;
        const int next = grid.neighbour(cell, direction);
        if (label[static_cast<std::size_t>(next)] >= 0) continue;
        label[static_cast<std::size_t>(next)] = seed;
        pending.push_back(next);
      }
    }
  }
  return label;
}

namespace {

constexpr double coarse_m = 0.05;  ///< distance of the places at which legs are cut short: half a cell
constexpr double fine_m = 0.005;
constexpr int max_passes = 10;      ///< each pass shortens; in rooms two or three suffice
constexpr double gain_m = 1e-4;     ///< a pass that gains less is the last
constexpr int halvings = 12;        ///< of the length by which a corner is cut off: to a millimetre and below
constexpr double corner_rad = 0.2;  ///< a smaller change of direction isn't cut off. assumed (0.1-0.5)

double length_of(const std::vector<Vec2>& way) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += glm::distance(way[i - 1], way[i]);
  return length;
}

std::vector<Vec2> subdivided(const std::vector<Vec2>& way, double spacing_m) {
  std::vector<Vec2> points{way.front()};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const int parts = std::max(1, static_cast<int>(std::ceil(glm::distance(way[i - 1], way[i]) / spacing_m)));
    for (int part = 1; part < parts; ++part) {
      points.push_back(way[i - 1] + (way[i] - way[i - 1]) * (static_cast<double>(part) / parts));
    }
    points.push_back(way[i]);
  }
  return points;
}

/// From each point straight to a far one, found by steps that double while they succeed and halve where they don't.
std::vector<Vec2> shortcut(const std::vector<Vec2>& points, const StraightWay& straight) {
  std::vector<Vec2> kept{points.front()};
  for (std::size_t i = 0; i + 1 < points.size();) {
    std::size_t next = i + 1;
    for (std::size_t step = 1; step > 0;) {
      const bool reached = next + step < points.size() && straight(points[i], points[next + step]);
      if (reached) next += step;
      step = reached ? 2 * step : step / 2;
    }
    kept.push_back(points[next]);
    i = next;
  }
  return kept;
}

/// How much of the corner between a and b can be cut off, measured along either leg.
double cut_m(const Vec2& a, const Vec2& corner, const Vec2& b, const StraightWay& straight) {
  const double turn = std::remainder(heading_of(b - corner) - heading_of(corner - a), 2.0 * std::numbers::pi);
  if (std::abs(turn) < corner_rad) return 0.0;
  const Vec2 to_a = glm::normalize(a - corner);
  const Vec2 to_b = glm::normalize(b - corner);
  double cut = 0.0;
  // Half of the shorter leg at most: the other half belongs to the corner at its other end.
  double step = 0.25 * std::min(glm::distance(a, corner), glm::distance(corner, b));
  for (int i = 0; i < halvings; ++i, step *= 0.5) {
    if (straight(corner + to_a * (cut + step), corner + to_b * (cut + step))) cut += step;
  }
  return cut;
}

/// Two corners of half the angle instead of each one.
std::vector<Vec2> corners_cut_off(const std::vector<Vec2>& way, const StraightWay& straight) {
  std::vector<Vec2> result{way.front()};
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    const double cut = cut_m(way[i - 1], way[i], way[i + 1], straight);
    if (cut > 0.0) {
      result.push_back(way[i] + glm::normalize(way[i - 1] - way[i]) * cut);
      result.push_back(way[i] + glm::normalize(way[i + 1] - way[i]) * cut);
    } else {
      result.push_back(way[i]);
    }
  }
  result.push_back(way.back());
  return result;
}

}  // namespace

std::vector<Vec2> pulled_tight(std::vector<Vec2> way, const StraightWay& straight) {
  if (way.size() < 3) return way;
  // Coarse first, because the way over the cells has many corners, then fine.
  for (const double spacing_m : {coarse_m, fine_m}) {
    for (int pass = 0; pass < max_passes; ++pass) {
      const double before = length_of(way);
      for (int direction = 0; direction < 2; ++direction) {
        way = shortcut(subdivided(way, spacing_m), straight);
        std::reverse(way.begin(), way.end());
      }
      if (before - length_of(way) < gain_m) break;
    }
  }
  return corners_cut_off(way, straight);
}

}  // namespace pirsim::body
