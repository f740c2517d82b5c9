#include "engine/body/ground.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim::body;

namespace {

/// A random grid whose cells are free with the given probability; steps go between free cells, no corner cut.
StepGrid random_grid(pirsim::Stream& stream, int columns, int rows, double free_share) {
  std::vector<bool> free;
  for (int i = 0; i < columns * rows; ++i) free.push_back(stream.uniform() < free_share);
  const auto is_free = [&](int column, int row) {
    return column >= 0 && column < columns && row >= 0 && row < rows &&
           free[static_cast<std::size_t>(row * columns + column)];
  };
  StepGrid grid{columns, rows, std::vector<std::uint8_t>(free.size(), 0)};
  for (int cell = 0; cell < columns * rows; ++cell) {
    const int column = cell % columns;
    const int row = cell / columns;
    for (unsigned direction = 0; direction < 8; ++direction) {
      const Step s = steps[direction];
      if (is_free(column, row) && is_free(column + s.column, row + s.row) && is_free(column + s.column, row) &&
          is_free(column, row + s.row)) {
        grid.open[static_cast<std::size_t>(cell)] |= static_cast<std::uint8_t>(1U << direction);
      }
    }
  }
  return grid;
}

/// Least costs from `start` to all cells, by relaxing every step until nothing changes.
std::vector<double> brute_force_costs(const StepGrid& grid, int start) {
  std::vector<double> cost(grid.open.size(), std::numeric_limits<double>::infinity());
  cost[static_cast<std::size_t>(start)] = 0.0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t cell = 0; cell < cost.size(); ++cell) {
      for (unsigned direction = 0; direction < 8; ++direction) {
        if ((grid.open[cell] >> direction & 1) == 0) continue;
        const std::size_t next =
            cell + static_cast<std::size_t>(steps[direction].row * grid.columns + steps[direction].column);
        const double through = cost[cell] + std::hypot(steps[direction].column, steps[direction].row);
        if (through < cost[next] - 1e-9) cost[next] = through, changed = true;
      }
    }
  }
  return cost;
}

/// The cost of a way; fails the test if one of its steps isn't open.
double cost_of(const StepGrid& grid, const std::vector<int>& way) {
  double cost = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const int across = way[i] % grid.columns - way[i - 1] % grid.columns;
    const int along = way[i] / grid.columns - way[i - 1] / grid.columns;
    bool found = false;
    for (unsigned direction = 0; direction < 8; ++direction) {
      found = found || (steps[direction].column == across && steps[direction].row == along &&
                        (grid.open[static_cast<std::size_t>(way[i - 1])] >> direction & 1) != 0);
    }
    REQUIRE(found);
    cost += std::hypot(across, along);
  }
  return cost;
}

}  // namespace

TEST_CASE("A* finds ways exactly as short as brute force, and none where there is none", "[way_search]") {
  pirsim::Stream stream({.seed = 11});
  int found = 0;
  int none = 0;
  for (int round = 0; round < 300; ++round) {
    const StepGrid grid = random_grid(stream, 5 + round % 17, 4 + round % 13, 0.55 + 0.4 * stream.uniform());
    const auto n_cells = static_cast<std::uint32_t>(grid.open.size());
    const int start = static_cast<int>(stream.index(n_cells));
    const std::vector<double> costs = brute_force_costs(grid, start);
    for (int i = 0; i < 10; ++i) {
      const int goal = static_cast<int>(stream.index(n_cells));
      const std::vector<int> way = shortest_way(grid, start, goal);
      const double best = costs[static_cast<std::size_t>(goal)];
      REQUIRE(way.empty() == std::isinf(best));
      if (way.empty()) {
        ++none;
        continue;
      }
      ++found;
      REQUIRE(way.front() == start);
      REQUIRE(way.back() == goal);
      REQUIRE(cost_of(grid, way) == Approx(best).margin(1e-9));
      REQUIRE(shortest_way(grid, start, goal) == way);
    }
  }
  CHECK(found > 500);
  CHECK(none > 500);
}

TEST_CASE("cells have the same label exactly if there is a way between them", "[way_search]") {
  pirsim::Stream stream({.seed = 12});
  for (int round = 0; round < 50; ++round) {
    const StepGrid grid = random_grid(stream, 14, 9, 0.6);
    const std::vector<int> part = connected_parts(grid);
    const auto start = static_cast<std::size_t>(stream.index(14 * 9));
    const std::vector<double> costs = brute_force_costs(grid, static_cast<int>(start));
    for (std::size_t cell = 0; cell < part.size(); ++cell) {
      REQUIRE((part[cell] == part[start]) == std::isfinite(costs[cell]));
    }
  }
}

TEST_CASE("of equally short ways through an open grid always the same one is taken", "[way_search]") {
  pirsim::Stream stream({.seed = 13});
  const StepGrid grid = random_grid(stream, 8, 6, 1.1);
  const std::vector<int> way = shortest_way(grid, 0, 8 * 5 + 7);
  CHECK(cost_of(grid, way) == Approx(2.0 + 5.0 * std::numbers::sqrt2));
  // All ways of two straight and five diagonal steps tie; cells of low index go first, which are those of row 0.
  CHECK(way == std::vector<int>{0, 1, 2, 11, 20, 29, 38, 47});
}

TEST_CASE("what people leave of a floor is worked out anew when one of them has moved", "[way_search]") {
  WayMemory memory;
  int worked = 0;
  const auto left_by = [&](double x) {
    return memory.left_by({{x, 2.0, 0.3}, {1.0, 1.0, 0.3}}, [&] {
      ++worked;
      return StepsLeft{{1, 1, {0}}, {worked}};
    });
  };
  CHECK(left_by(1.0)->parts == std::vector<int>{1});
  CHECK(left_by(1.0)->parts == std::vector<int>{1});
  CHECK(left_by(1.5)->parts == std::vector<int>{2});
  CHECK(left_by(1.0)->parts == std::vector<int>{3});  // only the last ones are kept
  CHECK(worked == 3);
}
