#include "stats/intervals.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "files/write/summary.hpp"
#include "pirsim/error.hpp"
#include "support/catch.hpp"

using namespace pirsim::stats;
using pirsim::studies::crps;

namespace {

/// mean |x - y| - 1/2 mean |x - x'|, pair by pair.
double crps_by_pairs(const std::vector<double>& x, double y) {
  double error = 0.0;
  double spread = 0.0;
  for (const double a : x) {
    error += std::abs(a - y);
    for (const double b : x) spread += std::abs(a - b);
  }
  const auto n = static_cast<double>(x.size());
  return error / n - 0.5 * spread / (n * n);
}

/// Integral of (F(z) - [z >= y])^2, the score's definition, for whole numbers: F is constant between them.
double crps_by_integral(const std::vector<double>& x, double y) {
  double sum = 0.0;
  for (int z = -200; z < 200; ++z) {
    const auto below = std::count_if(x.begin(), x.end(), [&](double member) { return member <= z; });
    const double f = static_cast<double>(below) / static_cast<double>(x.size()) - (z >= y ? 1.0 : 0.0);
    sum += f * f;
  }
  return sum;
}

}  // namespace

TEST_CASE("the ensemble CRPS agrees with its pairs and with its integral", "[stats]") {
  const std::vector<std::vector<double>> ensembles{{5}, {1, 3}, {0, 0, 0}, {7, 2, 9, 2, 100}, {-5, 4, 4, 12, 3, 3, 0}};
  for (const std::vector<double>& x : ensembles) {
    for (const double y : {-7.0, 0.0, 2.0, 3.0, 55.0}) {
      pirsim::Tally counted;
      for (const double member : x) ++counted[static_cast<int>(member)];
      CHECK(crps(counted, y) == Approx(crps_by_pairs(x, y)).margin(1e-12));
      CHECK(crps(counted, y) == Approx(crps_by_integral(x, y)).margin(1e-12));
    }
  }
  CHECK(crps({{4, 1}}, 9) == 5.0);
  CHECK(crps({{4, 2}}, 4) == 0.0);
  CHECK_THROWS_AS(crps({}, 5), pirsim::Error);
}

TEST_CASE("the CRPS of a large uniform ensemble is that of the uniform distribution", "[stats]") {
  // Members 0..n-1, seen from the middle: integral of F^2 and (1-F)^2 gives n / 12 for the continuous uniform.
  pirsim::Tally members;
  for (int value = 0; value < 1200; ++value) members[value] = 1;
  CHECK(crps(members, 600) == Approx(1200.0 / 12.0).epsilon(1e-3));
}

TEST_CASE("the energy score of numbers is their CRPS and ignores rotations", "[stats]") {
  const std::vector<double> x{7, 2, 9, 2, 100};
  Matrix<double> line(5, 1), turned(5, 2);
  for (std::size_t i = 0; i < 5; ++i) {
    line(i, 0) = x[i];
    turned(i, 0) = 0.6 * x[i];
    turned(i, 1) = 0.8 * x[i];
  }
  CHECK(energy_score(line, std::vector<double>{3.0}) == Approx(crps_by_pairs(x, 3.0)));
  CHECK(energy_score(turned, std::vector<double>{1.8, 2.4}) == Approx(crps_by_pairs(x, 3.0)));
  CHECK_THROWS_AS(energy_score(turned, std::vector<double>{1.0}), pirsim::Error);
}

TEST_CASE("the area between samples is the mean distance of their order statistics", "[stats]") {
  const std::vector<double> a{3, 1, 2, 2}, b{9, 0, 2, 4};
  CHECK(area_between(a, b) == Approx((1.0 + 0.0 + 2.0 + 6.0) / 4.0));  // 1-0, 2-2, 2-4, 3-9
  CHECK(area_between(a, a) == 0.0);
  // Unequal sizes: each value of the smaller sample taken as often as makes them equal.
  const std::vector<double> c{5, 1}, twice{5, 1, 5, 1}, d{0, 3, 3, 4};
  CHECK(area_between(c, d) == Approx(area_between(twice, d)));
  CHECK(area_between(c, d) == Approx(area_between(d, c)));
  // Moving a sample by 2.5 moves it by 2.5.
  std::vector<double> moved = a;
  for (double& value : moved) value += 2.5;
  CHECK(area_between(a, moved) == Approx(2.5));
}
