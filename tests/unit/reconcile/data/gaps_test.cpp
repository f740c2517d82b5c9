// Rows in which motion is awaited, and those of them that are silent, counted by hand.
#include "reconcile/data/alignment.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

TEST_CASE("a sensor is awaited between motion on both sides, and silent in some of these rows", "[statistics]") {
  // A is awaited in rows 1 to 4, B in rows 2 and 3.
  const Series run{0, 1, 0, 7, {1, 0, 1, 1, 0, 0, 1, 1, 1, 1, 1, 0, 0, 0}};
  const std::vector<Gaps> gaps = gaps_of(run, 2);
  CHECK(gaps[0].awaited == 4.0);
  CHECK(gaps[0].silent == 1.0);
  CHECK(gaps[1].awaited == 2.0);
  CHECK(gaps[1].silent == 1.0);
  CHECK(gaps_of({0, 1, 0, 20, std::vector<std::uint8_t>(40, unknown_bit)}, 2)[0].awaited == 0.0);
}
