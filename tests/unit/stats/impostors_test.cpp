// Rows of classes that the test has never seen, against rows of the class that they are taken for.
#include "stats/conformal.hpp"

#include <array>
#include <cmath>

#include "pirsim/random.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::stats;

namespace {

using Point = std::array<double, 4>;

/// Nothing, a class in the middle, and two beside it; each normal with variance 1.
constexpr std::array<Point, 4> centres{{{0, 0, 0, 0}, {6, 0, 0, 0}, {6, 3, 0, 0}, {6, 0, 3, 0}}};
constexpr std::size_t middle = 1;
constexpr Point unknown{6, 1.4, 1.4, 0};  // nearer to the middle than to any other

std::vector<double> densities_at(const Point& centre, Stream& stream) {
  Point place = centre;
  for (double& coordinate : place) coordinate += stream.normal();
  std::vector<double> log_densities;
  for (const Point& other : centres) {
    double square = 0.0;
    for (std::size_t i = 0; i < place.size(); ++i) square += (place[i] - other[i]) * (place[i] - other[i]);
    log_densities.push_back(-0.5 * square);
  }
  return log_densities;
}

struct Rows {
  Matrix<double> log_densities;
  std::vector<int> labels;
  Split split;
};

Rows rows_of_all(Stream& stream) {
  Rows rows;
  for (int label = 0; label < 4; ++label) {
    for (int i = 0; i < 600; ++i) {
      (i < 300 ? rows.split.fitting : rows.split.calibration).push_back(rows.labels.size());
      rows.log_densities.append_row(
          std::span<const double>(densities_at(centres[static_cast<std::size_t>(label)], stream)));
      rows.labels.push_back(label);
    }
  }
  return rows;
}

constexpr int n = 2000;

/// Share of n rows about this point whose p is at most 0.05.
double refused(const ImpostorTests& tests, const Point& centre, Stream& stream) {
  int hits = 0;
  for (int i = 0; i < n; ++i) hits += tests.p(middle, densities_at(centre, stream)) <= 0.05 ? 1 : 0;
  return static_cast<double>(hits) / n;
}

/// Three standard errors of a share near 0.05: of n rows, and of the 300 that they are compared with.
const double tolerance = 3.0 * std::sqrt(0.05 * 0.95 * (1.0 / n + 1.0 / 300.0));

}  // namespace

TEST_CASE("rows of its own are refused at the level, those of an unknown class far more often", "[stats]") {
  Stream stream({1, 0, 0, Purpose::test});
  const Rows rows = rows_of_all(stream);
  const ImpostorTests tests = ImpostorTests::fit(rows.log_densities, rows.labels, rows.split);
  CHECK(refused(tests, centres[middle], stream) <= 0.05 + tolerance);
  CHECK(refused(tests, unknown, stream) >= 0.3);

  // The twin: an unknown on the side where no class lies has no likeness among the impostors.
  constexpr Point elsewhere{6, -1.4, -1.4, 0};
  CHECK(refused(tests, elsewhere, stream) < 0.1);
}

TEST_CASE("a class without impostors refuses nothing", "[stats]") {
  Stream stream({3, 0, 0, Purpose::test});
  Rows rows = rows_of_all(stream);
  for (int& label : rows.labels) label = label > 1 ? 0 : label;  // nothing and one class
  Matrix<double> two(rows.log_densities.rows(), 2);
  for (std::size_t row = 0; row < two.rows(); ++row)
    for (std::size_t c = 0; c < 2; ++c) two(row, c) = rows.log_densities(row, c);
  const ImpostorTests tests = ImpostorTests::fit(two, rows.labels, rows.split);
  CHECK(tests.p(1, {{-1000.0, -1000.0}}) == 1.0);
}
