#include "reconcile/data/statistics.hpp"

#include <array>
#include <utility>

#include "support/catch.hpp"

using pirsim::reconcile::Correlation;

TEST_CASE("a correlation is that of the textbook and doesn't ask where the numbers lie", "[reconcile]") {
  // Anscombe's first quartet, r = 0.81642 (Anscombe, The American Statistician 27, 1973), also with both columns moved.
  constexpr std::array<std::pair<double, double>, 11> quartet{{{10, 8.04},
                                                               {8, 6.95},
                                                               {13, 7.58},
                                                               {9, 8.81},
                                                               {11, 8.33},
                                                               {14, 9.96},
                                                               {6, 7.24},
                                                               {4, 4.26},
                                                               {12, 10.84},
                                                               {7, 4.82},
                                                               {5, 5.68}}};
  Correlation correlation, moved, against;
  for (const auto& [x, y] : quartet) {
    correlation.add(x, y);
    moved.add(x + 100.0, 3.0 * y - 50.0);
    against.add(-x, y);
  }
  CHECK(correlation.value() == Approx(0.81642).epsilon(1e-5));
  CHECK(moved.value() == Approx(0.81642).epsilon(1e-5));
  CHECK(against.value() == Approx(-0.81642).epsilon(1e-5));
}

TEST_CASE("what doesn't vary goes together with nothing", "[reconcile]") {
  Correlation correlation;
  CHECK(correlation.value() == 0.0);
  for (const double x : {1.0, 2.0, 3.0}) correlation.add(x, 0.7);
  CHECK(correlation.value() == 0.0);
}
