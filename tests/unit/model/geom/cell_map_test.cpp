// Squares of a plane against brute force and closed forms.
#include "rooms/suggested_floor.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "support/catch.hpp"

using namespace pirsim;

namespace {

CellGrid grid_of(std::size_t n_columns, std::size_t n_rows, double side_m) {
  CellGrid grid({0.0, 0.0}, {1.0, 1.0}, 0.0, 1.0, 100);
  grid.corner = {-3.0, 2.0};
  grid.side_m = side_m;
  grid.n_columns = n_columns, grid.n_rows = n_rows;
  return grid;
}

/// Twice the signed area, positive for one that runs counter-clockwise seen from above: z points down the page.
double signed_m2(const std::vector<Vec2>& loop) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &a = loop[i], &b = loop[(i + 1) % loop.size()];
    sum += b.x * a.y - a.x * b.y;
  }
  return 0.5 * sum;
}

}  // namespace

TEST_CASE("distances between squares are those of all pairs", "[cells]") {
  std::mt19937 random(7);
  for (const auto& [columns, rows, one_in] : {std::array{23, 17, 40}, std::array{1, 30, 5}, std::array{40, 9, 3}}) {
    const CellGrid grid = grid_of(static_cast<std::size_t>(columns), static_cast<std::size_t>(rows), 0.25);
    Cells taken(grid.size());
    for (auto& cell : taken) cell = random() % static_cast<unsigned>(one_in) == 0 ? 1 : 0;
    taken[0] = 1;
    const std::vector<double> distances = distances_m(grid, taken);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      double least = 1e9;
      for (std::size_t k = 0; k < grid.size(); ++k) {
        if (taken[k] != 0) least = std::min(least, glm::distance(grid.centre(i), grid.centre(k)));
      }
      REQUIRE(distances[i] == Approx(least));
    }
  }
  CHECK(std::isinf(distances_m(grid_of(3, 3, 1.0), Cells(9, 0))[4]));
}

TEST_CASE("an outline has the area of its squares, holes filled", "[cells]") {
  std::mt19937 random(11);
  const CellGrid grid = grid_of(30, 20, 0.1);
  for (int trial = 0; trial < 20; ++trial) {
    Cells taken(grid.size(), 0);
    for (int n = 0; n < 12; ++n) {  // overlapping rectangles
      const std::size_t c = random() % 25, r = random() % 15, width = 1 + random() % 5, height = 1 + random() % 5;
      for (std::size_t i = r; i < r + height; ++i) {
        for (std::size_t k = c; k < c + width; ++k) taken[i * grid.n_columns + k] = 1;
      }
    }
    double outlines = 0.0;
    for (const auto& loop : outlines_of(grid, taken, 0.0)) {
      CHECK(signed_m2(loop) > 0.0);
      outlines += signed_m2(loop);
    }
    // Squares that can't be reached from the edge without crossing what is taken, corners included.
    Cells outside(grid.size(), 0);
    bool grows = true;
    const auto is_free = [&](long c, long r) {
      if (c < 0 || r < 0 || c >= 30 || r >= 20) return true;
      return outside[static_cast<std::size_t>(r * 30 + c)] != 0;
    };
    while (grows) {
      grows = false;
      for (long r = 0; r < 20; ++r) {
        for (long c = 0; c < 30; ++c) {
          const auto cell = static_cast<std::size_t>(r * 30 + c);
          bool beside = false;
          for (long y = r - 1; y <= r + 1; ++y) {
            for (long x = c - 1; x <= c + 1; ++x) beside = beside || ((x != c || y != r) && is_free(x, y));
          }
          if (taken[cell] == 0 && outside[cell] == 0 && beside) outside[cell] = 1, grows = true;
        }
      }
    }
    const auto n = std::ranges::count(outside, 0);
    CHECK(outlines == Approx(0.01 * static_cast<double>(n)));
  }
}

TEST_CASE("simplified outlines stay within the tolerance", "[cells]") {
  const CellGrid grid = grid_of(60, 60, 0.1);
  Cells disc(grid.size());
  for (std::size_t i = 0; i < disc.size(); ++i) disc[i] = glm::distance(grid.centre(i), Vec2(0.0, 5.0)) < 2.5 ? 1 : 0;
  const auto loops = outlines_of(grid, disc, 0.12);
  REQUIRE(loops.size() == 1);
  CHECK(loops[0].size() < 40);
  CHECK(signed_m2(loops[0]) == Approx(3.14159265 * 2.5 * 2.5).epsilon(0.03));
}

TEST_CASE("gaps as wide as a door part regions, wider ones and bulges don't", "[cells]") {
  const auto rooms = [](double gap_m) {
    const CellGrid grid = grid_of(122, 62, 0.05);  // a frame of one square round 6 m x 3 m, with a wall at 3 m
    Cells walls(grid.size(), 0);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const std::size_t c = i % 122, r = i / 122;
      const bool is_frame = c == 0 || r == 0 || c == 121 || r == 61;
      const bool is_wall = (c == 60 || c == 61) && std::abs((static_cast<double>(r) - 30.5) * 0.05) > 0.5 * gap_m;
      walls[i] = is_frame || is_wall ? 1 : 0;
    }
    return regions_of(grid, distances_m(grid, walls), {});
  };
  for (const double gap_m : {0.6, 0.8, 1.0, 1.2}) {
    const Regions regions = rooms(gap_m);
    CHECK(regions.count == 2);
    REQUIRE(regions.gaps.size() == 1);
    CHECK(regions.gaps[0].width_m == Approx(gap_m).margin(0.1));
  }
  CHECK(rooms(1.5).count == 1);
  CHECK(rooms(0.0).gaps.empty());
}
