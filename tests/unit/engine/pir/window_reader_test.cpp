#include "engine/pir/zone_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "support/catch.hpp"

using namespace pirsim;

namespace {

/// Readings of one sensor at the end of each of `rows` rows of five ticks, if it triggers at one tick alone.
std::vector<int> rows_after_trigger(std::int32_t lead, std::int64_t trigger_tick, int rows) {
  pir::WindowReader reader({lead}, 5);
  std::vector<int> read;
  for (std::int64_t tick = 1; tick <= 5 * rows; ++tick) {
    const std::array<std::uint8_t, 1> trigger{static_cast<std::uint8_t>(tick == trigger_tick)};
    reader.advance(trigger);
    if (tick % 5 == 0) read.push_back(reader.readings()[0]);
  }
  return read;
}

}  // namespace

TEST_CASE("a reader in step with the rows tells each row's own triggers") {
  for (std::int64_t tick = 1; tick <= 5; ++tick) REQUIRE(rows_after_trigger(0, tick, 3) == std::vector{1, 0, 0});
  REQUIRE(rows_after_trigger(0, 6, 3) == std::vector{0, 1, 0});
}

TEST_CASE("a reader out of step tells what came after its poll one row later") {
  REQUIRE(rows_after_trigger(2, 3, 3) == std::vector{1, 0, 0});  // read at ticks 3, 8, 13
  REQUIRE(rows_after_trigger(2, 4, 3) == std::vector{0, 1, 0});
  REQUIRE(rows_after_trigger(2, 8, 3) == std::vector{0, 1, 0});
  REQUIRE(rows_after_trigger(2, 9, 3) == std::vector{0, 0, 1});
}

TEST_CASE("drawn leads are even over the window and each sensor has its own") {
  constexpr int n = 20000, window = 50;
  double sum = 0.0;
  int same = 0;
  for (std::uint32_t run = 0; run < n; ++run) {
    const std::vector<std::int32_t> leads = pir::drawn_leads(2, window, 3, run);
    REQUIRE((leads[0] >= 0 && leads[0] < window));
    sum += leads[0];
    same += leads[0] == leads[1] ? 1 : 0;
  }
  const double sd_of_mean = std::sqrt((window * window - 1.0) / 12.0 / n);  // 0.10
  REQUIRE(std::abs(sum / n - 24.5) < 4.0 * sd_of_mean);
  REQUIRE(std::abs(sum / n - 25.0) > 4.0 * sd_of_mean);  // must fail: counted from 1
  REQUIRE(std::abs(same - n / 50.0) < 4.0 * std::sqrt(n / 50.0));
}
