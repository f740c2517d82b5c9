#include "body/grid_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
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

bool is_open(const StepGrid& grid, int cell, int direction) noexcept {
  return (grid.open[static_cast<std::size_t>(cell)] >> direction & 1) != 0;
}

int neighbour(const StepGrid& grid, int cell, int direction) noexcept {
  const Step step = steps[static_cast<std::size_t>(direction)];
  return cell + step.row * grid.columns + step.column;
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
      if (!is_open(grid, cell, direction)) continue;
      const int next = neighbour(grid, cell, direction);
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
        if (!is_open(grid, cell, direction)) continue;
        const int next = neighbour(grid, cell, direction);
        if (label[static_cast<std::size_t>(next)] >= 0) continue;
        label[static_cast<std::size_t>(next)] = seed;
        pending.push_back(next);
      }
    }
  }
  return label;
}

}  // namespace pirsim::body
