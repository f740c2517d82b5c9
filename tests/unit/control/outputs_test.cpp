// What is told of lights: schedules, tables, and which delay to take.
#include "control/outputs.hpp"

#include <cmath>
#include <random>
#include <sstream>

#include "pirsim/control.hpp"
#include "schema/clock.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::control;

namespace {

constexpr double a_minute_s = 60.0;
const ColumnOwners one_sensor_alone{{"PIR"}, {}, {}};

RuleSpec desk_rule(std::vector<double> delays_min) {
  LightSpec light;
  light.id = "desk";
  light.delays_min = std::move(delays_min);
  return {"test", {light}};
}

/// A row that ends at these seconds of 2 March 2026, or of another day.
Sample row_at(double ends_s, std::uint8_t bit, int people, int replicate = 1, const std::string& date = "2026-03-02") {
  Sample row;
  row.replicate = replicate;
  row.trial = "1";
  row.time_s = ends_s;
  row.clock =
      clock_text(day_number(date, {}) + static_cast<std::int64_t>(ends_s / 86400.0), std::fmod(ends_s, 86400.0));
  row.people = people;
  row.bits = {bit};
  return row;
}

/// Rows of a minute through a control and a schedule of half hours.
struct Scheduled {
  explicit Scheduled(People people = People::known, double window_s = a_minute_s)
      : control(desk_rule({0.0}), one_sensor_alone, window_s, people),
        schedule(desk_rule({0.0}), window_s, 30, people) {}
  void add(const Sample& row) { schedule.add(control.add(row)); }
  [[nodiscard]] std::string text() const {
    std::ostringstream text;
    schedule.write(text);
    return text.str();
  }
  Control control;
  Schedule schedule;
};

constexpr double eleven_pm_s = 23 * 3600.0;

}  // namespace

TEST_CASE("a schedule has whole days, with the shares of each step") {
  Scheduled day;
  for (int i = 0; i < 60; ++i) day.add(row_at(eleven_pm_s + a_minute_s * (i + 1), i < 15, i < 45 ? 1 : 0));
  CHECK(day.schedule.n_days() == 1);  // the last row ends at midnight
  CHECK_THAT(day.text(), contains("time,light_desk,presence_desk\n2026-03-02T00:00,0.0000,0.0000\n"));
  CHECK_THAT(
      day.text(),
      contains("2026-03-02T22:30,0.0000,0.0000\n2026-03-02T23:00,0.5000,1.0000\n2026-03-02T23:30,0.0000,0.5000\n"));
  CHECK(std::ranges::count(day.text(), '\n') == 49);
  CHECK_THAT(day.schedule.remarks().at(0).message,
             contains("has 23.0 h of which nothing is known: it is dark and empty there"));
}

TEST_CASE("a schedule is the mean over runs of a date, and over the rows that are known") {
  Scheduled day;
  for (const int replicate : {1, 2, 3, 4}) {
    for (int i = 0; i < 60; ++i)
      day.add(row_at(eleven_pm_s + a_minute_s * (i + 1), replicate == 1, replicate <= 2 ? 1 : 0, replicate));
    day.add(row_at(86400.0 + a_minute_s, 0, 0, replicate));
  }
  CHECK_THAT(day.text(), contains("2026-03-02T23:00,0.2500,0.5000\n2026-03-02T23:30,0.2500,0.5000\n"));
  CHECK_THAT(day.text(), contains("2026-03-03T00:00,0.0000,0.0000\n"));
  Scheduled gaps;  // ten minutes lit, ten dark, ten unknown
  for (int i = 0; i < 30; ++i)
    gaps.add(row_at(a_minute_s * (i + 1), static_cast<std::uint8_t>(i < 10 ? 1 : i < 20 ? 0 : 2), i < 10 ? 1 : -1));
  CHECK_THAT(gaps.text(), contains("T00:00,1.0000,1.0000\n"));  // where people aren't counted nothing is
  Scheduled unpeopled(People::unknown);
  for (int i = 0; i < 30; ++i)
    unpeopled.add(row_at(a_minute_s * (i + 1), static_cast<std::uint8_t>(i < 10 ? 1 : i < 20 ? 0 : 2), -1));
  CHECK_THAT(unpeopled.text(), contains("time,light_desk\n2026-03-02T00:00,0.5000\n2026-03-02T00:30,0.0000\n"));
  Scheduled uncounted;  // a column of people in which nothing stands
  for (int i = 0; i < 30; ++i) uncounted.add(row_at(a_minute_s * (i + 1), 1, -1));
  CHECK_THROWS_WITH(uncounted.text(), contains("there is no schedule of light 'desk': nothing is known of it"));
}

TEST_CASE("rows longer than a schedule's step cover all of theirs") {
  Scheduled hours(People::known, 2.0 * 3600.0);
  hours.add(row_at(2.0 * 3600.0 + 900.0, 1, 1));  // from 00:15
  CHECK_THAT(hours.text(), contains("T00:00,1.0000,1.0000\n2026-03-02T00:30,1.0000,1.0000\n"));
  CHECK_THAT(hours.text(), contains("T02:00,1.0000,1.0000\n2026-03-02T02:30,0.0000,0.0000\n"));
  Scheduled night(People::known, 3600.0);
  night.add(row_at(86400.0 + 1800.0, 1, 1));  // over midnight
  CHECK_THAT(night.text(),
             contains("2026-03-02T23:30,1.0000,1.0000\n2026-03-03T00:00,1.0000,1.0000\n2026-03-03T00:30,0.0"));
}

TEST_CASE("a schedule tells of leap days and missing dates, and wants a clock") {
  Scheduled leap, gap;
  for (const char* date : {"2028-02-28", "2028-02-29", "2028-03-01"}) {
    for (int i = 0; i < 48; ++i) leap.add(row_at(1800.0 * (i + 1), 0, 0, 1, date));
  }
  REQUIRE(leap.schedule.n_days() == 3);
  CHECK_THAT(leap.schedule.remarks().back().message, contains("of a leap year `Schedule:File` takes 8784 hours"));
  for (const char* date : {"2026-02-28", "2026-03-02"}) gap.add(row_at(60.0, 0, 0, 1, date));
  CHECK_THAT(gap.schedule.remarks().back().message, contains("lacks 1 date between its first and its last"));
  Sample row = row_at(60.0, 0, 0);
  row.clock.clear();
  CHECK_THROWS_WITH(gap.add(row), contains("rows have no clock"));
  row.clock = "8 o'clock";
  CHECK_THROWS_WITH(gap.add(row), contains("the time '8 o'clock' of a row is none"));
}

TEST_CASE("what isn't known of people is empty, not 0") {
  const auto line_of = [](People people, int n) {
    Control control(desk_rule({1.0}), one_sensor_alone, a_minute_s, people);
    for (int i = 0; i < 60; ++i) control.add(row_at(a_minute_s * (i + 1), i < 30, n));
    const Costs costs = control.finish();
    const std::string text = to_csv(costs);
    const std::size_t at = text.find("desk,1,");
    return text.substr(at, text.find('\n', at) - at) + advise(costs.lights.front()).sentence;
  };
  CHECK_THAT(line_of(People::unknown, -1), contains("desk,1,1,1,,0.516667,,,0.516667,,,1,,,,,,,,,,desk: whom it goes"));
  // Nobody came: no time in which it could have gone off on somebody.
  CHECK_THAT(line_of(People::known, 0),
             contains("desk,1,1,1,0,0.516667,0.516667,0,0.516667,,,1,0,,,,,,,0,,desk: nobody"));
  CHECK_THAT(line_of(People::known, -1), contains("desk,1,0,0,0,0,0,0,,,,0,0,,,,,,,0,,desk: nothing is known"));
}

// -------------------------------------------------------------------------------------------------- which delay to
// take

namespace {

/// Days of ten hours in which somebody is there; a minute's motion after each of these pauses, round and round.
LightCosts costs_of(int n_days, const std::vector<int>& pauses_min, double rule_min = 10.0, double at_most = 1.0) {
  RuleSpec rule = desk_rule({rule_min});
  rule.lights.front().at_most_a_week = at_most;
  Control control(rule, one_sensor_alone, a_minute_s);
  std::size_t pause = 0;
  int still = 0;
  for (int day = 0; day < n_days; ++day) {
    for (int i = 0; i < 600; ++i) {
      const bool moves = still >= pauses_min[pause] || i == 0;
      if (moves && i > 0) pause = (pause + 1) % pauses_min.size();
      still = moves ? 0 : still + 1;
      Sample row = row_at(a_minute_s * (i + 1), moves, 1, day);
      row.clock.clear();
      control.add(row);
    }
  }
  return control.finish().lights.front();
}

}  // namespace

TEST_CASE("the advice is the shortest delay that the days show to be long enough, by the rule of three") {
  // All pauses last 7 minutes: no false-off from 7 minutes on, dozens a day below. In n days without one less than 3 /
  // n a day are shown: once a week from 21 days on.
  using Ground = Advice::Ground;
  const Advice short_of = advise(costs_of(20, {7})), shown = advise(costs_of(21, {7}));
  CHECK(short_of.ground == Ground::too_few_days);
  CHECK(short_of.delay_min == 7.0);
  CHECK_THAT(short_of.sentence,
             contains("desk: 20 days are too few to tell which delay goes off on somebody less than "
                      "once a week: 21 days without a false-off would do. The best guess is 7 min: no "
                      "false-off in 200.0 h of occupied time, which shows less than one in 67"));
  CHECK(shown.ground == Ground::shown);
  CHECK(shown.delay_min == 7.0);
  CHECK(shown.sentence ==
        "desk: 7 min: off on somebody less than once a week, 0 s of empty light a day; at 10 min "
        "not once, and 0 s.");
  // 75 a day: pauses of 7 minutes and the minute of motion.
  CHECK_THAT(advise(costs_of(21, {7}, 7.0)).sentence, contains("at 5 min 75.0 times a day, and 0 s."));
  CHECK(advise(costs_of(5, {7}, 10.0, 7.0)).ground == Ground::shown);  // once a day: 3 days
  CHECK(advise(costs_of(2, {7}, 10.0, 7.0)).ground == Ground::too_few_days);
  const Advice never = advise(costs_of(21, {7, 90}));
  CHECK(never.ground == Ground::no_delay);
  CHECK_FALSE(never.delay_min);
  CHECK_THAT(never.sentence,
             contains("no delay up to 60 min keeps false-offs to less than once a week: at 60 min it goes off"));
}

TEST_CASE("the advised delay is long enough in 95 of 100 samples, of motion whose rate is known") {
  // Motion in a minute with probability p: it goes off on somebody p (1 - p)^(d + 1) times a minute, in the long run.
  constexpr double p = 0.25;
  constexpr int n_samples = 120, n_days = 60, rows_a_day = 600;
  const auto a_week = [](double d) { return 7.0 * rows_a_day * p * std::pow(1.0 - p, d + 1.0); };
  std::mt19937 random(5);
  std::bernoulli_distribution moves(p);
  int wrong = 0, shown = 0;
  double sum = 0.0;
  for (int sample = 0; sample < n_samples; ++sample) {
    Control control(desk_rule({10.0}), one_sensor_alone, a_minute_s);
    for (int day = 0; day < n_days; ++day) {
      for (int i = 0; i < rows_a_day; ++i) {
        Sample row = row_at(a_minute_s * (i + 1), moves(random), 1, day);
        row.clock.clear();
        control.add(row);
      }
    }
    const Advice advice = advise(control.finish().lights.front());
    if (advice.ground != Advice::Ground::shown) continue;
    ++shown;
    wrong += a_week(*advice.delay_min) >= 1.0;
    sum += *advice.delay_min;
  }
  CHECK(shown == n_samples);
  CHECK(a_week(24.0) < 1.0);  // the truth: from 24 minutes on
  CHECK(a_week(23.0) > 1.0);
  CHECK(wrong <= 12);                   // 6 expected, standard error 2.4
  CHECK(sum / n_samples < 24.0 + 4.0);  // and isn't much too long
}
