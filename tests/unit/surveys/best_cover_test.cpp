#include "surveys/placement.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "support/catch.hpp"

using namespace pirsim::studies;

namespace {

/// Each of the candidates covers each thing with probability 0.2.
Cover random_cover(unsigned seed, std::size_t n_candidates, std::size_t n_things) {
  std::mt19937 draw(seed);
  Cover cover;
  for (std::size_t i = 0; i < n_things; ++i) cover.worth.push_back(draw() % 9 + 1);
  for (std::size_t i = 0; i < n_candidates; ++i) {
    auto& covered = cover.covered.emplace_back();
    for (std::uint32_t thing = 0; thing < n_things; ++thing) {
      if (draw() % 5 == 0) covered.push_back(thing);
    }
  }
  return cover;
}

/// The most that any n candidates cover, by a set of things for each subset.
std::uint64_t most_of_all(const Cover& cover, int n) {
  std::uint64_t most = 0;
  for (unsigned subset = 0; subset < 1U << cover.covered.size(); ++subset) {
    if (std::popcount(subset) != n) continue;
    std::vector<bool> is_covered(cover.worth.size());
    for (std::size_t i = 0; i < cover.covered.size(); ++i) {
      if ((subset >> i & 1U) == 0) continue;
      for (const std::uint32_t thing : cover.covered[i]) is_covered[thing] = true;
    }
    std::uint64_t sum = 0;
    for (std::size_t thing = 0; thing < is_covered.size(); ++thing) sum += is_covered[thing] ? cover.worth[thing] : 0;
    most = std::max(most, sum);
  }
  return most;
}

}  // namespace

TEST_CASE("chosen candidates cover nearly what the best subset of all does, and never less than greed warrants",
          "[best_cover]") {
  int optimal = 0;
  constexpr int n_cases = 200;
  for (unsigned seed = 0; seed < n_cases; ++seed) {
    const Cover cover = random_cover(seed, 12, 30);
    const std::uint64_t most = most_of_all(cover, 4);
    const std::uint64_t by_greed = cover.worth_of(greedy(cover, 4));
    const std::uint64_t best = cover.worth_of(best_of(cover, {0, 1, 2, 3}));
    INFO(seed);
    CHECK(static_cast<double>(by_greed) >= (1.0 - std::exp(-1.0)) * static_cast<double>(most));
    CHECK(best >= by_greed);
    CHECK(best >= cover.worth_of({0, 1, 2, 3}));
    REQUIRE(best <= most);
    optimal += best == most ? 1 : 0;
  }
  CHECK(optimal > 0.9 * n_cases);
}

TEST_CASE("an exchange mends what greed spoils: the middle one covers most, both sides without it everything",
          "[best_cover]") {
  const Cover cover{{1, 1, 1, 1, 1, 1}, {{0, 1, 2}, {1, 2, 3, 4}, {3, 4, 5}}};
  CHECK(greedy(cover, 2) == std::vector<std::size_t>{1, 0});
  CHECK(cover.worth_of(greedy(cover, 2)) == 5);
  std::vector<std::size_t> best = best_of(cover, {0, 1});
  std::ranges::sort(best);
  CHECK(best == std::vector<std::size_t>{0, 2});
}

TEST_CASE("no candidate is taken twice, though none adds anything", "[best_cover]") {
  const Cover cover{{1}, {{0}, {}, {}}};
  std::vector<std::size_t> all = best_of(cover, {2, 1, 0});
  std::ranges::sort(all);
  CHECK(all == std::vector<std::size_t>{0, 1, 2});
  CHECK(cover.worth_of(all) == 1);
}
