#include <algorithm>
#include <vector>

#include "engine/sim/pedestrian.hpp"
#include "support/catch.hpp"

using namespace pirsim::sim;

namespace {

std::vector<std::uint32_t> numbers(const Others& others) {
  std::vector<std::uint32_t> result;
  for (const Presence& other : others) result.push_back(other.person);
  return result;
}

}  // namespace

TEST_CASE("the others are all but one, in order, and those before come first", "[presence]") {
  for (std::size_t n = 1; n <= 4; ++n) {
    std::vector<Presence> all(n);
    for (std::size_t i = 0; i < n; ++i) all[i].person = static_cast<std::uint32_t>(10 + i);
    for (std::size_t me = 0; me <= n; ++me) {  // n: after all of them
      std::vector<std::uint32_t> expected;
      for (const Presence& one : all) expected.push_back(one.person);
      const Others among_all(all, me, Others::Me::not_there);
      CHECK(numbers(among_all) == expected);
      CHECK(among_all.before_me().size() == me);
      if (me == n) continue;
      expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(me));
      const Others others(all, me, Others::Me::among_them);
      CHECK(numbers(others) == expected);
      CHECK(others.empty() == expected.empty());
      CHECK(others.before_me().size() == me);
      CHECK(std::ranges::find(others, all[me].person, &Presence::person) == others.end());
      CHECK(std::ranges::count_if(others, is_solid) == static_cast<std::ptrdiff_t>(n - 1));
    }
  }
}

TEST_CASE("in an empty scene there is nobody else", "[presence]") {
  CHECK(Others().empty());
  CHECK(Others({}, 0, Others::Me::not_there).empty());
  CHECK(numbers(Others()).empty());
}
