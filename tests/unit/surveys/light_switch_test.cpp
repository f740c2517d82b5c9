// The switch against models said anew at a row a second, for rows of any length; doors; nights that end in the morning.
#include "surveys/light.hpp"

#include <algorithm>
#include <random>

#include "model/schema/clock.hpp"
#include "pirsim/control.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::control;

namespace {

/// Bursts of motion and long pauses, a bit a second.
std::vector<bool> motion_of(unsigned seed, std::size_t n) {
  std::mt19937 random(seed);
  std::vector<bool> motion(n);
  bool is_busy = false;
  for (std::size_t i = 0; i < n; ++i) {
    if (random() % (is_busy ? 200 : 400) == 0) is_busy = !is_busy;
    motion[i] = is_busy && random() % 15 == 0;
  }
  return motion;
}

/// Rows of so many seconds: was it ever so in one?
std::vector<bool> any_in(const std::vector<bool>& seconds, std::size_t row_s) {
  std::vector<bool> rows(seconds.size() / row_s);
  for (std::size_t i = 0; i < rows.size() * row_s; ++i)
    if (seconds[i]) rows[i / row_s] = true;
  return rows;
}

/// Lit from the first motion for the delay after it; the next motion behind that lights it anew.
std::vector<bool> covered(const std::vector<bool>& motion, std::size_t delay) {
  std::vector<bool> lit(motion.size());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (!motion[i]) continue;
    const std::size_t last = std::min(i + delay, motion.size() - 1);
    for (; i < last; ++i) lit[i] = true;
    lit[i] = true;
  }
  return lit;
}
/// Lit where a motion is at most the delay ago.
std::vector<bool> followed(const std::vector<bool>& motion, std::size_t delay) {
  std::vector<bool> lit(motion.size());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (motion[i])
      std::fill_n(lit.begin() + static_cast<std::ptrdiff_t>(i), std::min(delay + 1, motion.size() - i), true);
  }
  return lit;
}

struct Switched {
  std::vector<bool> lit;
  LightCosts costs;
};
Switched switched(const std::vector<bool>& motion, std::size_t row_s, double delay_min, Timer timer) {
  LightSpec light;
  light.delays_min = {delay_min};
  light.timer = timer;
  Control control({"test", {light}}, {{"PIR"}, {}, {}}, static_cast<double>(row_s));
  Switched result;
  Sample row;
  row.people = 1;
  for (const bool moves : motion) {
    row.bits = {static_cast<std::uint8_t>(moves)};
    result.lit.push_back(control.add(row).lit[0] == 1);
  }
  result.costs = control.finish().lights.front();
  return result;
}

}  // namespace

TEST_CASE("by rows of any length a light is on in those in which it is on by the second") {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const std::vector<bool> motion = motion_of(seed, 20'000);
    for (const std::size_t row_s : {1U, 2U, 5U, 10U, 30U, 60U}) {
      for (const std::size_t delay_s : {0U, 60U, 300U}) {
        INFO(seed << ' ' << row_s << ' ' << delay_s);
        const double delay_min = static_cast<double>(delay_s) / 60.0;
        const std::vector<bool> in_rows = any_in(motion, row_s);
        CHECK(switched(in_rows, row_s, delay_min, Timer::restarts).lit == any_in(followed(motion, delay_s), row_s));
        // When a timer that runs out was started within a row isn't told: as if by the row.
        const Switched runs_out = switched(in_rows, row_s, delay_min, Timer::runs_out);
        CHECK(runs_out.lit == covered(in_rows, delay_s / row_s));
        for (std::size_t i = 0; i < in_rows.size(); ++i) CHECK_FALSE((in_rows[i] && !runs_out.lit[i]));
      }
    }
  }
}

TEST_CASE("a timer that runs out never goes off on somebody who moves in every row") {
  for (const std::size_t row_s : {1U, 7U, 30U, 45U, 300U}) {
    const Switched always = switched(std::vector<bool>(500, true), row_s, 1.0, Timer::runs_out);
    for (const DelayCosts& at : always.costs.by_delay) {
      CHECK(at.false_offs == 0);
      CHECK(at.dark_h == 0.0);
    }
  }
}

TEST_CASE("a pulse that began before the door was shut isn't motion behind it, however long a sensor holds") {
  // Somebody is in for five minutes and moves all the time; the door is open from ten seconds before they leave until
  // two seconds after. Nobody comes again in an hour.
  const auto lit_s = [](int hold_s, double settle_s, int moves_at = -1) {
    LightSpec light;
    light.door = "wc";
    light.settle_s = settle_s;
    light.delays_min = {2.0};
    Control control({"test", {light}}, {{"PIR"}, {}, {"wc"}}, 1.0);
    int lit = 0;
    Sample row;
    for (int i = 1; i <= 3600; ++i) {
      const bool is_again = moves_at > 0 && moves_at <= i && i <= moves_at + hold_s;
      row.bits = {static_cast<std::uint8_t>((i > 10 && i <= 310 + hold_s) || is_again)};
      row.doors = {static_cast<std::uint8_t>((i > 5 && i <= 13) || (i > 300 && i <= 312))};
      row.people = i > 10 && i <= 310 ? 1 : 0;
      lit += control.add(row).lit[0];
    }
    return lit;
  };
  CHECK(lit_s(0, 10.0) == 420);
  for (const int hold_s : {5, 13, 30, 90, 600}) CHECK(lit_s(hold_s, 10.0) == 420 + hold_s);
  CHECK(lit_s(90, 0.0) == 510);
  // A pulse of its own, five seconds after the door was shut: within the time to settle or not.
  CHECK(lit_s(2, 10.0, 318) == 430);
  CHECK(lit_s(2, 3.0, 318) == 3600 - 10);
  CHECK(lit_s(2, 10.0, 330) == 3600 - 10);
}

TEST_CASE("while sensors aren't known, a door that opens lets the light go off") {
  LightSpec light;
  light.door = "wc";
  light.delays_min = {2.0};
  Control control({"test", {light}}, {{"PIR"}, {}, {"wc"}}, 60.0);
  const std::string bits = "0102000000", doors = "0001000000", lit = "0112100000";
  for (std::size_t i = 0; i < bits.size(); ++i) {
    Sample row;
    row.bits = {static_cast<std::uint8_t>(bits[i] - '0')};
    row.doors = {static_cast<std::uint8_t>(doors[i] - '0')};
    INFO(i);
    CHECK(control.add(row).lit[0] == (i == 5 ? 1 : lit[i] - '0'));  // two minutes after it opened
  }
}

TEST_CASE("hours of darkness may cross midnight: what is counted is what a watch says") {
  LightSpec evening;
  evening.from_h = 18.0, evening.to_h = 7.0;
  evening.delays_min = {0.0};
  Control control({"test", {evening}}, {{"PIR"}, {}, {}}, 60.0);
  int counted = 0, lit = 0, minutes_from_first_to_last = 0;
  for (int i = 1; i <= 2 * 1440; ++i) {
    Sample row;
    row.time_s = 60.0 * i;
    row.clock = clock_text(20'514 + i / 1440, 60.0 * (i % 1440));
    const int of_day = (i - 1) % 1440;  // the minute that it covers
    const bool is_dark = of_day >= 18 * 60 || of_day < 7 * 60;
    row.bits = {static_cast<std::uint8_t>(i % 3 == 0)};
    row.people = of_day >= 6 * 60 && of_day < 19 * 60 ? 1 : 0;
    const LitRow told = control.add(row, row.clock.substr(0, 10));
    CHECK(told.lit[0] == (is_dark && i % 3 == 0 ? 1 : 0));
    counted += is_dark;
    lit += told.lit[0];
    minutes_from_first_to_last += is_dark && row.people > 0;
  }
  const Costs costs = control.finish();
  CHECK(costs.remarks.empty());
  const LightCosts& light = costs.lights.front();
  CHECK(light.hours == Approx(counted / 60.0));
  CHECK(light.hours == 26.0);
  CHECK(light.occupied_h == 4.0);
  CHECK(light.span_h == Approx(minutes_from_first_to_last / 60.0));  // daylight between them costs no light
  CHECK(light.at(0.0).lit_h == Approx(lit / 60.0));
}

TEST_CASE("a delay that isn't made of whole rows is told as what it becomes") {
  LightSpec light;
  light.id = "desk";
  light.delays_min = {1.0, 3.0};
  const auto remarks = [&](double window_s) {
    return Control({"t", {light}}, {{"PIR"}, {}, {}}, window_s).finish().remarks;
  };
  CHECK(remarks(1.0).empty());
  CHECK(remarks(60.0).empty());
  REQUIRE(remarks(45.0).size() == 1);
  CHECK_THAT(remarks(45.0)[0].message, contains("in rows of 45 s a delay of 1 min is one of 0.75 min"));
}

TEST_CASE("a run of several days is as many days, and what isn't known is none of them") {
  Control control({"t", {{}}}, {{"PIR"}, {}, {}}, 3600.0);
  for (int i = 1; i <= 72; ++i) {
    Sample row;
    row.time_s = 3600.0 * i;
    row.bits = {static_cast<std::uint8_t>(i > 48 ? 2 : i % 4 == 0)};
    control.add(row);
  }
  const LightCosts costs = control.finish().lights.front();
  CHECK(costs.days == 1);
  CHECK(costs.known_days == Approx(2.0));
  CHECK(costs.at(0.0).switched_on_a_day == Approx(6.0));
}

TEST_CASE("a log's first and last date are days in part, and an hour isn't told as if it were a day of such") {
  const auto costs_of = [](int from_h, int to_h, LightSpec light) {
    light.delays_min = {0.0};
    Control control({"t", {light}}, {{"PIR"}, {}, {}}, 3600.0);
    for (int i = from_h + 1; i <= to_h; ++i) {
      Sample row;
      row.time_s = 3600.0 * (i - from_h);
      row.clock = clock_text(20'514 + i / 24, 3600.0 * (i % 24));
      row.bits = {1};
      control.add(row, clock_text(20'514 + (i - 1) / 24, 0.0).substr(0, 10));
    }
    return control.finish().lights.front();
  };
  LightSpec night;
  night.from_h = 18.0, night.to_h = 6.0;
  CHECK(costs_of(12, 12 + 72, {}).days == 4);
  CHECK(costs_of(12, 12 + 72, {}).known_days == Approx(3.0));
  CHECK(costs_of(12, 12 + 72, night).known_days == Approx(3.0));  // of twelve hours
  CHECK(costs_of(18, 18 + 12, night).known_days == Approx(1.0));
  CHECK(costs_of(10, 11, {}).known_days == Approx(1.0));
  CHECK(costs_of(10, 11, {}).a_day(1.0) == Approx(1.0));
}
