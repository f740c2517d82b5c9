#include "surveys/coverage.hpp"

#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::studies;

namespace {

/// 3 x 2 squares of 1 m.
CoverageMap small_map(std::vector<MotionCount> counts) {
  return {FloorGrid(FloorArea({{{0, 0}, {3, 0}, {3, 2}, {0, 2}}}, 0.0), 1.0), {"A"}, 60, std::move(counts)};
}

}  // namespace

TEST_CASE("the figures of a small map, by hand", "[coverage]") {
  const CoverageFigures figures = figures_of(small_map({10, 14, 0, 0, 59, 50}));
  // Pairs with motion on both sides: 10-14, 14-59, 59-50.
  CHECK(figures.all.pairs == 3);
  CHECK(figures.all.mean_step == Approx((4 + 45 + 9) / 3.0));
  CHECK(figures.all.greatest_step == 59);  // 0 beside 59 counts here
  CHECK(figures.all.blind_fraction == Approx(2.0 / 6.0));
  CHECK(figures.all.seen_area_m2 == Approx(4.0));
}

TEST_CASE("two sensors: steps of both together, area of their union", "[coverage]") {
  CoverageMap map = small_map({});
  map.sensors = {"A", "B"};
  map.counts = {1, 0, 2, 0, 0, 0, 0, 0, 0, 5, 0, 9};
  const CoverageFigures figures = figures_of(map);
  CHECK(figures.all.mean_step == Approx((1 + 4) / 2.0));
  CHECK(figures.sensors[1].mean_step == Approx(4.0));
  CHECK(figures.all.seen_area_m2 == Approx(4.0));
  CHECK(figures.sensors[0].seen_area_m2 == Approx(2.0));
}

TEST_CASE("squares lie symmetrically on a symmetric floor and only where their centre is on it", "[coverage]") {
  const FloorGrid grid(FloorArea({{{-1.01, 0}, {1.01, 0}, {1.01, 1}, {-1.01, 1}}}, 0.0), 0.1);
  REQUIRE(grid.n_columns() == 21);
  for (std::size_t i = 0; i < 21; ++i) CHECK(grid.centre(i, 0).x == -grid.centre(20 - i, 0).x);
  CHECK(grid.n_squares() == 21 * 10);
  const FloorGrid bevelled(FloorArea({{{0, 0}, {1, 0}, {0, 1}}}, 0.0), 0.1);
  CHECK(bevelled.n_squares() < 60);
  CHECK(bevelled.on_floor(0, 0));
  CHECK_FALSE(bevelled.on_floor(9, 9));
}

TEST_CASE("the map as CSV has a line a square", "[coverage]") {
  CHECK(to_csv(small_map({1, 2, 3, 4, 5, 6})).starts_with("x_m,z_m,A\n0.5000,0.5000,1\n1.5000,0.5000,2\n"));
}
