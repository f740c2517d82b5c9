// What is drawn of counts, against what they leave open.
#include "reconcile/ensemble/realization.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

/// A reading a minute for four hours.
CountsSpec counts() {
  CountsSpec spec;
  for (int i = 0; i <= 240; ++i) {
    spec.times_s.push_back(60.0 * i);
    spec.people.push_back(i < 20 ? 0 : i < 100 ? 1 : i < 102 ? 3 : i < 200 ? 2 : 0);
  }
  return spec;
}

std::vector<double> changes_of(const CountsSpec& spec) {
  std::vector<double> at_s;
  for (std::size_t k = 1; k < spec.people.size(); ++k) {
    if (spec.people[k] != spec.people[k - 1]) at_s.push_back(spec.times_s[k]);
  }
  return at_s;
}

}  // namespace

TEST_CASE("Comings and goings move by as much as the nuisance says, one apart from the other", "[nuisance]") {
  const CountsSpec given = counts();
  const std::vector<double> known = changes_of(given);
  Stream stream({1, 0, 0, Purpose::test});
  constexpr int n = 400;
  std::vector<double> sums(known.size(), 0.0), squares(known.size(), 0.0);
  for (int i = 0; i < n; ++i) {
    const CountsSpec moved = with_other_times(given, 45.0, stream);
    REQUIRE(moved.people == given.people);
    REQUIRE(std::ranges::is_sorted(moved.times_s, std::less_equal<>()));
    REQUIRE(moved.times_s.front() == given.times_s.front());
    REQUIRE(moved.times_s.back() == given.times_s.back());
    const std::vector<double> drawn = changes_of(moved);
    for (std::size_t k = 0; k < known.size(); ++k) {
      REQUIRE(std::abs(drawn[k] - known[k]) <= 45.0 + 1.0);
      sums[k] += (drawn[k] - known[k]) / n;
      squares[k] += (drawn[k] - known[k]) * (drawn[k] - known[k]) / n;
    }
  }
  // Uniform: no mean, and a third of the square of its half-width; of the two changes two minutes apart too.
  for (std::size_t k = 0; k < known.size(); ++k) {
    CHECK(std::abs(sums[k]) < 4.0 * 45.0 / std::sqrt(3.0 * n));
    CHECK(std::abs(squares[k] - 675.0) < 120.0);
  }
  CHECK(with_other_times(given, 0.0, stream).times_s == given.times_s);
}

TEST_CASE("Some of the seats that nobody needs are nobody's, as many as may be", "[nuisance]") {
  SceneSpec scene;
  for (int i = 0; i < 8; ++i) scene.seats.emplace_back().id = "S" + std::to_string(i);
  std::array<int, 9> sizes{};
  std::set<std::string> seen;
  for (std::uint32_t i = 0; i < 600; ++i) {
    OccupancySpec occupancy;
    occupancy.counts = counts();
    Stream stream({1, i, 0, Purpose::test});
    draw_presence(scene, NuisanceSpec{}, stream, occupancy);
    ++sizes.at(occupancy.seats.empty() ? 8 : occupancy.seats.size());
    for (const std::string& seat : occupancy.seats) seen.insert(seat);
    REQUIRE(std::set<std::string>(occupancy.seats.begin(), occupancy.seats.end()).size() == occupancy.seats.size());
  }
  for (std::size_t n = 0; n < 3; ++n) CHECK(sizes[n] == 0);  // three are there at once
  for (std::size_t n = 3; n < 9; ++n) CHECK(std::abs(sizes[n] - 100) < 40);
  CHECK(seen.size() == 8);
  OccupancySpec occupancy;
  occupancy.counts = counts();
  Stream stream({1, 0, 0, Purpose::test});
  NuisanceSpec known{};
  known.own_seats = 0.0;
  known.time_s = 0.0;
  draw_presence(scene, known, stream, occupancy);
  CHECK(occupancy.seats.empty());
  CHECK(occupancy.counts->times_s == counts().times_s);
}
