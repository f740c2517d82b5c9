// What is told of lights: tables, and which delay to take.
#include "surveys/light_page.hpp"

#include <cmath>
#include <random>
#include <sstream>
#include <tuple>

#include "model/schema/clock.hpp"
#include "pirsim/control.hpp"
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

/// A row that ends at these seconds of 2 March 2026.
Sample row_at(double ends_s, std::uint8_t bit, int people, int replicate = 1) {
  Sample row;
  row.replicate = replicate;
  row.trial = "1";
  row.time_s = ends_s;
  row.clock = clock_text(day_number("2026-03-02", {}), ends_s);
  row.people = people;
  row.bits = {bit};
  return row;
}

}  // namespace

TEST_CASE("a row's time that is none is told") {
  Control control(desk_rule({1.0}), one_sensor_alone, a_minute_s, People::known);
  Sample row = row_at(a_minute_s, 0, 0);
  row.clock = "8 o'clock";
  CHECK_THROWS_WITH(control.add(row), contains("the time '8 o'clock' of a row is none"));
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
  CHECK_THAT(line_of(People::unknown, -1),
             contains("desk,1,1,1,,0.516667,,,0.516667,,,1,,,,,,,,,,,,,,desk: whom it goes"));
  // Nobody came: no time in which it could have gone off on somebody.
  CHECK_THAT(line_of(People::known, 0),
             contains("desk,1,1,1,0,0.516667,0.516667,0,0.516667,,,1,0,,,,,,,0,,,0.516667,,,desk: nobody"));
  CHECK_THAT(line_of(People::known, -1), contains("desk,1,0,0,0,0,0,0,,,,0,0,,,,,,,0,,,,,,desk: nothing is known"));
}

// -------------------------------------------------------------------------------------------- which delay to take

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

// -------------------------------------------------------------------------------------------- who sleeps

namespace {

/// Two areas with a sensor each: a night of an hour in which one or both sleep, then an hour in which both are up.
Costs night_of(const std::string& phase_of_night) {
  RuleSpec rule{"home", {}};
  for (const std::string area : {"bedroom", "living"}) {
    LightSpec light;
    light.id = light.area = area;
    light.sensors = {"PIR_" + area};
    light.delays_min = {1.0};
    rule.lights.push_back(light);
  }
  Control control(rule, {{"PIR_bedroom", "PIR_living"}, {"bedroom", "living"}, {}}, a_minute_s);
  for (int i = 0; i < 120; ++i) {
    Sample row = row_at(a_minute_s * (i + 1), 0, 2);
    const bool is_night = i < 60;
    // At night the sleeper stirs every ten minutes, which lights the bedroom.
    row.bits = {static_cast<std::uint8_t>(is_night && i % 10 == 0 ? 1 : 0),
                static_cast<std::uint8_t>(is_night ? 0 : 1)};
    row.people_of_areas = is_night ? std::vector<int>{1, 1} : std::vector<int>{0, 2};
    row.phase = is_night ? phase_of_night : "occupied";
    control.add(row);
  }
  return control.finish();
}

}  // namespace

TEST_CASE("who sleeps is nobody in the dark, and whoever is up elsewhere is") {
  // Lit for two rows of ten, so the sleeper's light goes off six times an hour.
  const auto bedroom = [](const Costs& costs) { return costs.lights[0]; };
  const auto living = [](const Costs& costs) { return costs.lights[1]; };
  for (const auto& [phase, bed_asleep, living_asleep] :
       {std::tuple{"occupied", false, false}, std::tuple{"asleep in bedroom", true, false},
        std::tuple{"asleep", true, true}, std::tuple{"asleep in bed", false, false},
        std::tuple{"asleep in living + bedroom", true, true}, std::tuple{"asleep in attic + living", false, true}}) {
    CAPTURE(phase);
    const Costs costs = night_of(phase);
    CHECK(bedroom(costs).occupied_h == Approx(bed_asleep ? 0.0 : 1.0).margin(1e-12));
    CHECK(bedroom(costs).asleep_h == Approx(bed_asleep ? 1.0 : 0.0).margin(1e-12));
    CHECK(bedroom(costs).at(1.0).false_offs == (bed_asleep ? 0.0 : 6.0));
    CHECK(bedroom(costs).at(1.0).lit_empty_h == Approx(bed_asleep ? 0.2 : 0.0).margin(1e-12));
    CHECK(living(costs).occupied_h == Approx(living_asleep ? 1.0 : 2.0));
    CHECK(living(costs).at(1.0).dark_h == Approx(living_asleep ? 0.0 : 1.0).margin(1e-12));
    const bool says_so = to_text(costs).find("Who sleeps or goes to bed wants no light") != std::string::npos;
    CHECK(says_so == (bed_asleep || living_asleep));
  }
}

TEST_CASE("that the days are too few is said once of lights that share it") {
  LightCosts one = costs_of(7, {7}), other = one, third = costs_of(2, {7});
  other.id = "door";
  const std::vector<LightCosts> lights{one, other, third};
  const std::vector<std::string> sentences = advise_all(lights);
  REQUIRE(sentences.size() == 3);
  CHECK(sentences[0] == advise(one).sentence);
  CHECK_THAT(sentences[0], contains("7 days are too few"));
  CHECK_THAT(sentences[1], contains("door: the best guess is 7 min") && !contains("too few"));
  CHECK(sentences[2] == advise(third).sentence);  // of other days
}
