// Light that sensors switch: against brute force, closed forms and sequences by hand.
#include "pirsim/control.hpp"

#include <cmath>
#include <random>

#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::control;

namespace {

constexpr double minute_s = 60.0;
const ColumnOwners one_sensor{{"PIR"}, {}, {"door"}};

Sample row_of(int index, std::uint8_t bit, int people, double window_s = minute_s) {
  Sample row;
  row.replicate = 1;
  row.trial = "1";
  row.time_s = window_s * (index + 1);
  row.people = people;
  row.bits = {bit};
  row.doors = {0};
  return row;
}

RuleSpec rule_with(LightSpec light, std::vector<double> delays_min) {
  light.delays_min = std::move(delays_min);
  return {"test", {std::move(light)}};
}

/// "1" where it is lit, rows of a minute; motion and people: a character a row.
std::string lit(const LightSpec& light, double delay_min, const std::string& motion, const std::string& people,
                const std::string& door = "") {
  Control control(rule_with(light, {delay_min}), one_sensor, minute_s);
  std::string result;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    Sample row = row_of(static_cast<int>(i), static_cast<std::uint8_t>(motion[i] - '0'), people[i] - '0');
    if (!door.empty()) row.doors = {static_cast<std::uint8_t>(door[i] - '0')};
    result += static_cast<char>('0' + control.add(row).lit[0]);
  }
  return result;
}

RuleSpec parsed(const std::string& lights) { return parse_rule("pirsim_control: 1\nlights:\n" + lights, "rule.yaml"); }

}  // namespace

TEST_CASE("light by hand: on with motion, off when the delay is over, and what people pay") {
  //                                    motion         people
  CHECK(lit({}, 3.0, "0100000010", "1111111111") == "0111100011");
  CHECK(lit({}, 0.0, "0110000010", "1111111111") == "0110000010");
  CHECK(lit({}, 3.0, "0110000000", "1111111111") == "0111110000");  // every motion starts it anew
  LightSpec waved;
  waved.wave_s = 120.0;  // after two rows in the dark somebody brings it back, motion does so at once
  CHECK(lit(waved, 1.0, "1000000000", "1111111111") == "1100011000");
  CHECK(lit(waved, 1.0, "1001000000", "1111000011") == "1101100000");
  CHECK(lit(waved, 1.0, "0000000000", "1111110111") == "0011000001");
  Control control(rule_with({}, {3.0}), one_sensor, minute_s);
  const std::string motion = "0100000010", people = "0111111100";
  for (int i = 0; i < 10; ++i)
    control.add(row_of(i, static_cast<std::uint8_t>(motion[static_cast<std::size_t>(i)] - '0'),
                       people[static_cast<std::size_t>(i)] - '0'));
  const LightCosts costs = control.finish().lights.front();
  const DelayCosts& at = costs.at(3.0);
  CHECK(costs.hours == Approx(10.0 / 60.0));
  CHECK(costs.occupied_h == Approx(7.0 / 60.0));
  CHECK(costs.span_h == Approx(7.0 / 60.0));
  CHECK(at.lit_h == Approx(6.0 / 60.0));
  CHECK(at.lit_empty_h == Approx(2.0 / 60.0));
  CHECK(at.dark_h == Approx(3.0 / 60.0));
  CHECK(at.false_offs == 1);
  CHECK(at.false_offs_an_hour.value == Approx(60.0 / 7.0));
  CHECK(at.longest_dark_s == 180.0);
  CHECK(at.switched_on_a_day == 2.0);
  CHECK(at.mean_wait_s == 0.0);  // motion came with the person
  REQUIRE(costs.worst.size() == 1);
  CHECK(costs.worst[0].from_s == 300.0);
  CHECK(costs.worst[0].length_s == 180.0);
  CHECK(costs.worst[0].cause == DarkSpell::Cause::went_off);
}

TEST_CASE("light by hand: timers that run out, least times, doors, switches and nights") {
  LightSpec runs_out, least, latch, manual;
  runs_out.timer = Timer::runs_out;
  CHECK(lit(runs_out, 2.0, "0110000110", "1111111111") == "0111000111");
  CHECK(lit(runs_out, 2.0, "1111111111", "1111111111") == "1111111111");  // and never off in motion
  least.least_on_min = 5.0;
  CHECK(lit(least, 1.0, "0100000000", "1111111111") == "0111110000");
  latch.door = "door";
  CHECK(lit(latch, 1.0, "0110000000", "1111111111", "0000000100") == "0111111110");
  CHECK(lit(latch, 1.0, "0110000000", "1111111111", "1111111111") == "0111000000");  // never shut
  // Who shuts the door behind them is out; who moves half a minute later is in.
  Control box(rule_with(latch, {0.5}), one_sensor, 1.0);
  const auto lit_at = [&](int from, int to, std::uint8_t bit, std::uint8_t door) {
    bool is_lit = false;
    for (int i = from; i < to; ++i) {
      Sample row = row_of(i, bit, 0, 1.0);
      row.doors = {door};
      is_lit = box.add(row).lit[0] == 1;
    }
    return is_lit;
  };
  CHECK(lit_at(0, 5, 1, 1));
  CHECK(lit_at(5, 10, 1, 0));
  CHECK_FALSE(lit_at(10, 100, 0, 0));
  CHECK(lit_at(100, 101, 1, 0));
  CHECK(lit_at(101, 1000, 0, 0));
  CHECK(lit_at(1000, 1001, 0, 1));
  CHECK_FALSE(lit_at(1001, 1100, 0, 0));
  manual.manual = ManualSpec{120.0, 120.0};
  CHECK(lit(manual, 1.0, "1110000000", "0000000000") == "0000000000");  // motion alone switches nothing on
  CHECK(lit(manual, 2.0, "0000000000", "0111100000") == "0001110000");  // the switch after two minutes
  CHECK(lit(manual, 1.0, "0000001000", "0111000000") == "0001101100");  // motion within the grace
  CHECK(lit(manual, 1.0, "0000000100", "0111000000") == "0001100110");  // at its end
  CHECK(lit(manual, 1.0, "0000000010", "0111000000") == "0001100000");  // and after it
  LightSpec night;
  night.night = NightSpec{22.0, 6.0, 0.0};
  Control control(rule_with(night, {10.0}), one_sensor, minute_s);
  std::string result;
  for (const char* clock : {"21:59:00", "22:00:00", "22:01:00", "22:02:00", "05:59:00", "06:01:00"}) {
    Sample row = row_of(static_cast<int>(result.size()), result.size() < 2 ? 1 : 0, 1);
    row.clock = std::string("2026-03-02T") + clock;
    result += static_cast<char>('0' + control.add(row).lit[0]);
  }
  CHECK(result == "110000");
}

TEST_CASE("light is on exactly while there was motion within the delay, by brute force") {
  std::mt19937 random(7);
  const double window_s = 10.0;
  for (const double delay_min : {0.0, 0.5, 2.0, 7.0}) {
    Control control(rule_with({}, {delay_min}), {{"A", "B"}, {}, {}}, window_s);
    std::vector<bool> moved;
    for (int i = 0; i < 5000; ++i) {
      Sample row = row_of(i, random() % 40 == 0, static_cast<int>(random() % 3), window_s);
      row.bits.push_back(random() % 60 == 0);
      moved.push_back(row.bits[0] || row.bits[1]);
      const auto within = std::min<std::ptrdiff_t>(i + 1, static_cast<std::ptrdiff_t>(delay_min * 6.0) + 1);
      const bool expected = std::find(moved.end() - within, moved.end(), true) != moved.end();
      REQUIRE(control.add(row).lit[0] == (expected ? 1 : 0));
    }
  }
}

TEST_CASE("false-offs and dark time of memoryless motion are those of the closed form") {
  // Motion in each row with probability p, whatever was before: silences are geometric, the discrete exponential. It
  // goes off d + 1 rows after a motion that none follows, and is dark where the last d + 1 rows were still.
  constexpr double p = 0.02, window_s = 10.0;
  constexpr int n_days = 40, rows_a_day = 8640;
  std::mt19937 random(11);
  std::bernoulli_distribution moves(p);
  Control control(rule_with({}, {10.0}), {{"PIR"}, {}, {}}, window_s);
  std::vector<DelayCosts> before;
  for (int day = 0; day < n_days; ++day) {
    for (int i = 0; i < rows_a_day; ++i)
      control.add(row_of(day * rows_a_day + i, moves(random), 1, window_s), std::to_string(day));
  }
  const LightCosts costs = control.finish().lights.front();
  CHECK(costs.days == n_days);
  for (const double delay_min : {1.0, 5.0, 10.0, 20.0}) {
    const DelayCosts& at = costs.at(delay_min);
    const auto dark = [&](double minutes) { return std::pow(1.0 - p, 6.0 * minutes + 1.0); };
    const auto offs_an_hour = [&](double minutes) { return 360.0 * p * dark(minutes); };
    // 90 % of the drawn days are 1.645 standard errors to either side.
    const auto error = [](const Figure& figure) {
      return (figure.over_days->high - figure.over_days->low) / (2.0 * 1.645);
    };
    CHECK(std::abs(at.dark_share.value - dark(delay_min)) < 3.0 * error(at.dark_share));
    CHECK(std::abs(at.false_offs_an_hour.value - offs_an_hour(delay_min)) < 3.0 * error(at.false_offs_an_hour));
    // Two minutes of another delay must be told.
    CHECK(std::abs(at.dark_share.value - dark(delay_min + 2.0)) > 3.0 * error(at.dark_share));
    // No two offs are within d + 1 rows, else they are independent: of n rows the variance is n pi (1 - (2 d + 3) pi).
    const double d = 6.0 * delay_min, pi = p * dark(delay_min), n = n_days * rows_a_day;
    const double exact = std::sqrt(n * pi * (1.0 - (2.0 * d + 3.0) * pi)) / costs.occupied_h;
    CHECK(error(at.false_offs_an_hour) == Approx(exact).epsilon(0.4));  // from 40 days: 12 % is its standard error
  }
}

TEST_CASE("A light that never went off on somebody may do so: its rate is bounded by the hours in which it didn't") {
  const auto costs_of = [](int n_days, bool moves) {
    Control control(rule_with({}, {10.0}), {{"PIR"}, {}, {}}, minute_s);
    for (int day = 0; day < n_days; ++day) {
      for (int i = 0; i < 600; ++i) control.add(row_of(day * 600 + i, moves || i % 60 == 0, 1), std::to_string(day));
    }
    return control.finish().lights.front().at(10.0);
  };
  const DelayCosts never = costs_of(3, true);  // 30 occupied hours
  REQUIRE(never.false_offs == 0);
  REQUIRE(never.false_offs_an_hour.over_days);
  CHECK(never.false_offs_an_hour.over_days->low == 0.0);
  // Poisson's chance of none in all hours, at the interval's upper end.
  CHECK(std::exp(-30.0 * never.false_offs_an_hour.over_days->high) == Approx(0.05));
  CHECK_FALSE(never.dark_share.over_days);  // draws of nothing tell nothing
  CHECK_FALSE(costs_of(2, true).false_offs_an_hour.over_days);
  CHECK(costs_of(3, false).false_offs_an_hour.over_days->low > 0.0);
}

TEST_CASE("A light by a counter goes off once it is as sure that nobody is there, and motion brings it back") {
  const std::string bits = "0100000010", people = "0111100001";
  const std::vector<double> nobody{0.99, 0.0, 0.4, 0.6, 0.75, 0.85, 0.92, 0.99, 0.1, 0.2};
  Control control(rule_with({}, {3.0}), {{"PIR"}, {}, {}}, minute_s, People::expected);
  for (std::size_t i = 0; i < bits.size(); ++i)
    control.add(row_of(static_cast<int>(i), static_cast<std::uint8_t>(bits[i] - '0'), people[i] - '0'), {}, nobody[i]);
  const LightCosts costs = control.finish().lights.front();
  const auto at = [&](double level) { return *std::ranges::find(costs.by_nobody, level, &DelayCosts::nobody); };
  CHECK(at(0.5).lit_h * 60.0 == Approx(2 + 2));
  CHECK(at(0.5).false_offs == 1.0);
  CHECK(at(0.7).lit_h * 60.0 == Approx(3 + 2));
  CHECK(at(0.9).lit_h * 60.0 == Approx(5 + 2));
  CHECK(at(0.9).false_offs == 0.0);
  CHECK(at(0.9).lit_empty_h * 60.0 == Approx(1 + 1));
  CHECK(at(0.9).empty_share.value == Approx(0.2));
  CHECK(at(0.99).lit_h * 60.0 == Approx(6 + 2));
  CHECK(costs.at(3.0).lit_h * 60.0 == Approx(4 + 2));
  Control known(rule_with({}, {3.0}), {{"PIR"}, {}, {}}, minute_s);
  known.add(row_of(0, 1, 1));
  CHECK(known.finish().lights.front().by_nobody.empty());
  LightSpec of_area;
  of_area.area = "a";
  CHECK_THROWS_AS(Control(rule_with(of_area, {3.0}), {{"PIR"}, {"a"}, {}}, minute_s, People::expected), Error);
}

TEST_CASE("Costs to expect are means over the draws, with the middle of them") {
  std::vector<Costs> draws;
  for (int draw = 0; draw < 21; ++draw) {  // sits for so many minutes after the motion, then nobody
    Control control(rule_with({}, {2.0}), {{"PIR"}, {}, {}}, minute_s, People::expected);
    for (int i = 0; i < 40; ++i) control.add(row_of(i, i == 0 ? 1 : 0, i < draw ? 1 : 0));
    draws.push_back(control.finish());
  }
  const LightCosts costs = expected_of(draws).lights.front();
  CHECK(costs.people == People::expected);
  CHECK(costs.occupied_h * 60.0 == Approx(10.0));
  CHECK(costs.at(2.0).false_offs == Approx(17.0 / 21.0));           // 3 lit minutes: of 0 to 3 it goes off on nobody
  CHECK(costs.at(2.0).dark_h * 60.0 == Approx(17.0 * 9.0 / 21.0));  // 1 to 17
  CHECK(costs.at(2.0).lit_empty_h * 60.0 == Approx((3.0 + 2.0 + 1.0) / 21.0));
  CHECK(costs.by_nobody.front().lit_empty_h * 60.0 == Approx(30.0));  // by a counter that is never sure it stays lit
  REQUIRE(costs.at(2.0).dark_share.over_days);
  CHECK(costs.at(2.0).dark_share.over_days->low == 0.0);
  CHECK(costs.at(2.0).dark_share.over_days->high == Approx(16.0 / 19.0));  // the 19th of those with somebody
}

TEST_CASE("A light goes on through gaps of the rows: it is lit where a motion is at most the delay ago") {
  constexpr int n = 5000, delay = 5;
  std::mt19937 random(3);
  std::bernoulli_distribution moves(0.1), gap_begins(0.05), gap_goes_on(0.7);
  Control control(rule_with({}, {double{delay}}), {{"PIR"}, {}, {}}, minute_s);
  int last_motion = -1000, switched_on = 0, short_gaps = 0, gap = 0;
  bool was_lit = false;
  for (int i = 0; i < n; ++i) {
    gap = gap_begins(random) || (gap > 0 && gap_goes_on(random)) ? gap + 1 : 0;
    const std::uint8_t bit = gap > 0 ? 2 : moves(random) ? 1 : 0;
    if (bit == 1) last_motion = i;
    const bool is_lit = i - last_motion <= delay;
    CHECK(control.add(row_of(i, bit, 0)).lit[0] == (gap > 0 ? 2 : is_lit ? 1 : 0));
    switched_on += is_lit && !was_lit;
    short_gaps += gap == 1 && is_lit;
    was_lit = is_lit;
  }
  REQUIRE(short_gaps > 20);
  const LightCosts costs = control.finish().lights.front();
  CHECK(costs.known_days == Approx(costs.hours / 24.0));
  CHECK(costs.at(delay).switched_on_a_day == Approx(switched_on / costs.known_days));
}

TEST_CASE("A light is switched in rows whose people nobody counted, and they aren't counted") {
  Control control(rule_with({}, {3.0}), {{"PIR"}, {}, {}}, minute_s);
  const std::string bits = "0100000", people = "--11111", lit = "2211100";  // -: not counted by anybody
  for (std::size_t i = 0; i < bits.size(); ++i) {
    const int n = people[i] == '-' ? -1 : 1;
    CHECK(control.add(row_of(static_cast<int>(i), static_cast<std::uint8_t>(bits[i] - '0'), n)).lit[0] == lit[i] - '0');
  }
  const LightCosts costs = control.finish().lights.front();
  CHECK(costs.unknown_h == Approx(2.0 / 60.0));
  CHECK(costs.at(3.0).false_offs == 1);
  CHECK(costs.at(3.0).dark_share.value == Approx(2.0 / 5.0));
}

TEST_CASE("A light that a shut door keeps lit begins anew after a gap longer than its delay, people known or not") {
  LightSpec latch;
  latch.door = "door";
  const auto lit_in = [&](const std::string& bits, const std::string& people) {
    Control control(rule_with(latch, {1.0}), one_sensor, minute_s);
    std::string result;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      const int n = people[i] == '-' ? -1 : people[i] - '0';
      const Sample row = row_of(static_cast<int>(i), static_cast<std::uint8_t>(bits[i] - '0'), n);
      result += static_cast<char>('0' + control.add(row).lit[0]);
    }
    return result;
  };
  CHECK(lit_in("0112000", "1111111") == "0112111");
  CHECK(lit_in("0112200", "1111111") == "0112200");
  CHECK(lit_in("0110000", "111--11") == "0112211");     // the sensors are known: no gap
  CHECK(lit_in("01120200", "111-1-11") == "01121211");  // two gaps of a row
}

TEST_CASE("A light of one of several areas that names no sensors is switched by all, and says so") {
  LightSpec kitchen;
  kitchen.area = "kitchen";
  const auto remarks = [&](std::vector<std::string> areas) {
    return Control(rule_with(kitchen, {1.0}), {{"A"}, std::move(areas), {}}, minute_s).finish().remarks;
  };
  CHECK_THAT(remarks({"hall", "kitchen"}).at(0).message, contains("the sensors of all areas switch it"));
  CHECK(remarks({"kitchen"}).empty());
  kitchen.sensors = {"A"};
  CHECK(remarks({"hall", "kitchen"}).empty());
}

TEST_CASE("several sensors, areas, unknown readings and new runs") {
  LightSpec both;
  both.together = TogetherSpec{2, 120.0};
  Control control(rule_with(both, {1.0}), {{"A", "B"}, {}, {}}, minute_s);
  const std::string a = "1000100002", b = "0000010000", expected = "0000011002";
  for (std::size_t i = 0; i < a.size(); ++i) {
    Sample row = row_of(static_cast<int>(i), static_cast<std::uint8_t>(a[i] - '0'), 1);
    row.bits.push_back(static_cast<std::uint8_t>(b[i] - '0'));
    CHECK(control.add(row).lit[0] == expected[i] - '0');
  }
  const LightCosts costs = control.finish().lights.front();
  CHECK(costs.hours == Approx(9.0 / 60.0));
  CHECK(costs.unknown_h == Approx(1.0 / 60.0));

  LightSpec kitchen;
  kitchen.area = "kitchen";
  Control by_area(rule_with(kitchen, {1.0}), {{"A"}, {"hall", "kitchen"}, {}}, minute_s);
  Sample row = row_of(0, 1, 5);
  row.people_of_areas = {5, 0};
  CHECK(by_area.add(row).people[0] == 0);
  row = row_of(0, 0, 5);  // a second run begins in the dark
  row.replicate = 2;
  row.people_of_areas = {0, 5};
  const LitRow second = by_area.add(row);
  CHECK(second.lit[0] == 0);
  CHECK(second.people[0] == 5);
  CHECK(by_area.finish().lights[0].at(1.0).lit_empty_h == Approx(1.0 / 60.0));
}

TEST_CASE("hours of darkness are counted alone, midnight belongs to the day before, and waits are from coming in") {
  LightSpec evening;
  evening.from_h = 22.0;
  Control control(rule_with(evening, {1.0}), one_sensor, minute_s);
  // 20:00 to midnight; somebody comes at 23:00 into the dark and is noticed three minutes later, motion at 21:00 is by
  // day.
  for (int i = 0; i < 240; ++i) {
    Sample row = row_of(i, i == 60 || i == 183, i >= 180 ? 1 : 0);
    const int end_min = 20 * 60 + i + 1;
    const auto two = [](int n) { return (n < 10 ? "0" : "") + std::to_string(n); };
    row.clock =
        end_min == 1440 ? "2026-03-03T00:00:00" : "2026-03-02T" + two(end_min / 60) + ":" + two(end_min % 60) + ":00";
    CHECK(control.add(row).lit[0] == (i == 183 || i == 184 ? 1 : 0));
  }
  const Costs costs = control.finish();
  CHECK(costs.remarks.empty());
  const LightCosts& light = costs.lights.front();
  CHECK(light.hours == Approx(2.0));
  CHECK(light.occupied_h == Approx(1.0));
  const DelayCosts& at = light.at(1.0);
  CHECK(at.dark_h == Approx(58.0 / 60.0));
  CHECK(at.mean_wait_s == 180.0);
  CHECK(at.longest_wait_s == 180.0);
  REQUIRE(light.worst.size() == 2);
  CHECK(light.worst[0].cause == DarkSpell::Cause::went_off);
  CHECK(light.worst[0].length_s == 55.0 * minute_s);
  CHECK(light.worst[1].cause == DarkSpell::Cause::stayed_off);
  CHECK(light.worst[1].length_s == 180.0);
  Control no_clock(rule_with(evening, {1.0}), one_sensor, minute_s);
  no_clock.add(row_of(0, 1, 1));
  CHECK_THAT(no_clock.finish().remarks.at(0).message, contains("the rows have no clock"));
}

TEST_CASE("rules are read with their places, and what can't be is refused") {
  const RuleSpec rule = parsed(
      "  - {area: office, sensors: [A, B], together: {sensors: 2}, delay_min: [5, 15], manual: {grace_s: 30},\n"
      "     timer: runs_out, least_on_min: 2, door: front, night: {from: \"21:00\", delay_min: 1}, from: \"06:00\", "
      "power_w: 80}\n");
  REQUIRE(rule.lights.size() == 1);
  const LightSpec& light = rule.lights[0];
  CHECK(light.id == "office");
  CHECK(light.delays_min == std::vector<double>{5.0, 15.0});
  CHECK(light.manual->grace_s == 30.0);
  CHECK(light.night->from_h == 21.0);
  CHECK(light.from_h == 6.0);
  const auto refused = [](const std::string& lights, const std::string& message) {
    INFO(lights);
    CHECK_THROWS_WITH(parsed(lights), contains(message));
  };
  refused("  - {delay_mn: 5}\n", "unknown key 'delay_mn' (did you mean 'delay_min'?)");
  refused("  - {delay_min: 525600}\n", "rule.yaml:3:17: error: light: delay_min: expected");
  refused("  - {delay_min: -1}\n", "delay_min: expected");
  refused("  - {area: office, sensors: []}\n", "sensors: light 'office' has none that could switch it");
  refused("  - {from: \"20:00\", to: \"20:00\"}\n", "rule.yaml:3:25: error: light: `to` is `from`: it is never dark");
  refused("  - {from: \"00:00\", to: \"00:00\"}\n", "it is never dark");
  refused("  - {settle_s: 5}\n", "rule.yaml:3:16: error: settle_s: of its door, and the light has no `door`");
  refused("  - {sensors: [A, B, A]}\n", "rule.yaml:3:22: error: light: sensors: 'A' is named twice");
  refused("  - {delay_min: [5, 10, 5.0]}\n", "rule.yaml:3:25: error: delay_min: 5 is named twice");
  CHECK(parsed("  - {from: \"18:00\", to: \"07:00\"}\n").lights.front().to_h == 7.0);
  CHECK(parsed("  - {door: front, settle_s: 3, at_most_a_week: 0.5}\n").lights.front().settle_s == 3.0);
  refused("  - {id: a}\n  - {id: a}\n", "a second light 'a'");
  refused("  []\n", "lights");
  refused("  - {timer: runs}\n", "timer: ");
}

TEST_CASE("a rule that doesn't fit the rows is refused, each fault with its light") {
  const ColumnOwners columns{{"PIR1", "PIR2"}, {"office"}, {}};
  const auto refused = [&](const std::string& light, const std::string& message) {
    INFO(light);
    CHECK_THROWS_WITH(Control(parsed("  - " + light + "\n"), columns, 1.0), contains(message));
  };
  refused("{sensors: [PIR3]}", "the rows have no sensor 'PIR3' (did you mean 'PIR1'?)");
  refused("{area: ofice}", "the rows have no people of an area 'ofice' (did you mean 'office'?)");
  refused("{door: front}", "the rows have no door 'front'; there are none");
  CHECK_THROWS_WITH(Control(parsed("  - manual: {}\n"), columns, 1.0, People::unknown),
                    contains("manual goes by who is in the dark, and the rows have no people"));
  CHECK_THROWS_WITH(Control(parsed("  - {door: front}\n"), {{"PIR1"}, {}, {"bath", "bedroom"}}, 1.0),
                    contains("no door 'front'; there are bath, bedroom"));
  refused("{together: {sensors: 3}}", "together: 3 sensors of 2");
}
