#include "stats/classes.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "pirsim/error.hpp"
#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::stats;

namespace {

struct Placed {
  Matrix<double> places;
  std::vector<int> labels;
};

/// Class 0 lies around (0, 0), class 1 around (3, 0), both with unit noise; class 2 on a bow: (s, s^2 / 4) with s even
/// in 0 to 8 and noise of 0.2, which no single normal distribution describes.
Placed draw_layers(std::size_t rows, std::uint32_t study) {
  Stream stream({95, study, 0, Purpose::test});
  Placed drawn{Matrix<double>(rows, 2), {}};
  for (std::size_t r = 0; r < rows; ++r) {
    const int label = static_cast<int>(r % 3);
    const double noise = label == 2 ? 0.2 : 1.0, s = 8.0 * stream.uniform();
    const std::array<double, 2> centre{label == 2 ? s : 3.0 * label, label == 2 ? s * s / 4.0 : 0.0};
    for (std::size_t c = 0; c < 2; ++c) drawn.places(r, c) = centre[c] + noise * stream.normal();
    drawn.labels.push_back(label);
  }
  return drawn;
}

}  // namespace

TEST_CASE("a single layer has the density of the normal distribution that made its rows", "[stats]") {
  const Placed table = draw_layers(6000, 0);
  const NormalLayers layers = NormalLayers::fit(table.places, table.labels, 3, {.layers = 1});
  // log N(x; 0, I) - log N(x; (3, 0), I) = -3 x + 4.5. Means of 2,000 rows err by 0.022, so that at |x| <= 3 the
  // difference errs by 0.022 x 3 sqrt(2), twice that with the covariances'.
  for (const double x : {-1.0, 0.0, 1.5, 3.0}) {
    const std::vector<double> logs = layers.log_densities(std::array{x, 0.5});
    CHECK(logs[0] - logs[1] == Approx(-3.0 * x + 4.5).margin(4 * 0.18));
  }
  const double peak = layers.log_densities(std::array{0.0, 0.0})[0];
  CHECK(peak - layers.log_densities(std::array{2.0, 0.0})[0] == Approx(2.0).margin(0.3));
}

TEST_CASE("a class that runs away from the first one along a bow is followed by its layers", "[stats]") {
  const Placed table = draw_layers(6000, 1);
  const auto gap = [&](std::size_t n) {
    const NormalLayers layers = NormalLayers::fit(table.places, table.labels, 3, {.layers = n});
    // On the bow, and as far above the chord's normal distribution, whose mean is 5.33 at x = 4, as the bow lies below.
    return layers.log_densities(std::array{4.0, 4.0})[2] - layers.log_densities(std::array{4.0, 6.67})[2];
  };
  CHECK(gap(3) > 8.0);
  CHECK(std::abs(gap(1)) < 0.5);  // the twin
}

TEST_CASE("densities of layers integrate to the same number for every class", "[stats]") {
  const Placed table = draw_layers(3000, 2);
  const NormalLayers layers = NormalLayers::fit(table.places, table.labels, 3);
  std::array<double, 3> sums{};
  for (double x = -6.0; x < 14.0; x += 0.05) {
    for (double y = -6.0; y < 22.0; y += 0.05) {
      const std::vector<double> logs = layers.log_densities(std::array{x, y});
      for (std::size_t k = 0; k < 3; ++k) sums[k] += std::exp(logs[k]) * 0.05 * 0.05;
    }
  }
  // The number that all share is log (2 pi)^(d / 2).
  for (const double sum : sums) CHECK(sum == Approx(2.0 * std::numbers::pi).epsilon(0.01));
}

TEST_CASE("layers refuse too few rows and places of another length", "[stats]") {
  const Placed table = draw_layers(60, 3);
  CHECK_THROWS_AS(NormalLayers::fit(table.places, table.labels, 4), Error);
  const NormalLayers layers = NormalLayers::fit(table.places, table.labels, 3);
  CHECK_THROWS_AS(layers.log_densities(std::array{1.0}), Error);
}
