// What a log tells by itself, where it is known what it should.
#include "pirsim/log.hpp"

#include <random>

#include "support/catch.hpp"
#include "support/log_files.hpp"

using namespace pirsim;

namespace {

std::string line(double s, const std::string& sensor, bool is_on) {
  return std::to_string(s) + ',' + sensor + (is_on ? ",on\n" : ",off\n");
}

}  // namespace

TEST_CASE("a hold and a dead time are found, single faults aside, and exponential lengths have none") {
  std::mt19937 random(3);
  std::exponential_distribution<double> more(1.0);
  std::string text = "time,sensor,state\n";
  double s = 0.0, t = 0.0;
  text += line(0.0, "held", false) + line(0.0, "free", false);
  for (int i = 0; i < 2000; ++i) {
    s += 2.3 + (random() % 3 == 0 ? 0.0 : 60.0 * more(random));  // blind for 2.3 s
    text += line(s, "held", true);
    s += i == 700 ? 0.02 : 4.8 + (random() % 2 == 0 ? 0.0 : 3.0 * more(random));
    text += line(s, "held", false);
    t += 60.0 * more(random);
    text += line(t, "free", true);
    t += 10.0 * more(random);
    text += line(t, "free", false);
  }
  const LogFacts facts = facts_of(read_log_text(text));
  const LogSensorFacts &free = facts.sensors[0], &held = facts.sensors[1];
  CHECK(held.pulses.n == 2000);
  CHECK(held.pulses.floor_s == Approx(4.8).margin(1e-4));
  CHECK(held.pulses.floor_share > 0.5);
  CHECK(held.hold_s == 4.8);
  CHECK_FALSE(free.hold_s);
  CHECK(held.pulses.shortest_s == Approx(0.02).margin(1e-4));
  CHECK(held.pauses.floor_s == Approx(2.3).margin(1e-4));
  CHECK(held.pauses.floor_share > 0.3);
  CHECK(free.pulses.floor_s < 0.2);  // of the mean, -log(0.99)
  CHECK(free.pulses.floor_share < 0.01);
  CHECK(free.pulses.median_s == Approx(10.0 * std::log(2.0)).epsilon(0.08));  // standard error 3 %
}

TEST_CASE("shares and hours, of readings and of events alike") {
  std::string readings = "time,A\n", events = "time,sensor,state\n2025-04-06T23:50:00,A,off\n";
  const auto clock = [](int minute) {
    const int of_day = (23 * 60 + 50 + minute) % 1440;
    char text[32];
    std::snprintf(text, sizeof text, "2025-04-%02dT%02d:%02d:00", minute < 10 ? 6 : 7, of_day / 60, of_day % 60);
    return std::string(text);
  };
  for (int minute = 1; minute <= 40; ++minute) {
    const bool is_on = minute > 5 && minute <= 25;  // from 23:55 to 00:15
    readings += clock(minute) + (is_on ? ",1\n" : ",0\n");
  }
  events += clock(5) + ",A,on\n" + clock(25) + ",A,off\n" + clock(40) + ",A,off\n";
  for (const std::string& text : {readings, events}) {
    const LogSensorFacts sensor = facts_of(read_log_text(text)).sensors[0];
    CHECK(sensor.known_s == Approx(2400.0));
    CHECK(*sensor.motion_share() == Approx(0.5));
    CHECK(*sensor.motion_by_hour[23] == Approx(0.5));
    CHECK(*sensor.motion_by_hour[0] == Approx(0.5));
    CHECK_FALSE(sensor.motion_by_hour[1]);
    CHECK(sensor.pulses.n == 1);
    CHECK(sensor.pulses.median_s == Approx(1200.0));
  }
}

TEST_CASE("false triggers are those while nobody is there, away from other counts") {
  std::string text = "time_s,A,people\n";
  for (int s = 30; s <= 7200; s += 30) {
    const bool is_somebody = s <= 3600;
    const bool is_on = (is_somebody && s % 120 == 0) || s == 3630 || s == 5400 || s == 6000;
    text += std::to_string(s) + (is_on ? ",1," : ",0,") + (is_somebody ? "2\n" : "0\n");
  }
  const LogSensorFacts sensor = facts_of(read_log_text(text)).sensors[0];
  REQUIRE(sensor.false_triggers);
  CHECK(sensor.false_triggers->from == LogFalseTriggers::From::nobody);
  CHECK(sensor.false_triggers->n == 2);  // those at 5400 and 6000 s; that at 3630 s may be whoever left
  CHECK(sensor.false_triggers->hours == Approx(3000.0 / 3600.0));
}

TEST_CASE("the quietest third of the nights, but not those that nobody saw") {
  std::string text = "entity_id,state,last_changed\nm,off,2025-04-01T00:00:00\n";
  const auto add = [&](int day, int hour, int n) {
    for (int i = 0; i < n; ++i) {
      char times[2][32];
      for (int k = 0; k < 2; ++k)
        std::snprintf(times[k], sizeof times[k], "2025-04-%02dT%02d:%02d:%02d", day, hour, i, 10 * k);
      text += std::string("m,on,") + times[0] + "\nm,off," + times[1] + '\n';
    }
  };
  for (int day = 1; day <= 7; ++day) {
    add(day, 2, day);
    add(day, 12, 30);
  }
  text += "m,unavailable,2025-04-08T00:00:00\nm,off,2025-04-08T10:00:00\n";
  const LogSensorFacts sensor = facts_of(read_log_text(text)).sensors[0];
  REQUIRE(sensor.false_triggers);
  CHECK(sensor.false_triggers->from == LogFalseTriggers::From::nights);
  CHECK(sensor.false_triggers->hours == Approx(10.0));
  CHECK(sensor.false_triggers->n == 1 + 2);
}

TEST_CASE("phi is the correlation of two rows of bits, and who leads is told where somebody does") {
  std::mt19937 random(11);
  std::string text = "time_s,A,B,C\n";
  double n = 0, a = 0, b = 0, both = 0;
  for (int i = 1; i <= 3000; ++i) {
    const bool on_a = random() % 4 == 0, on_b = random() % 3 == 0 || (on_a && random() % 2 == 0);
    const bool is_known = random() % 10 != 0;
    text += std::to_string(10 * i) + (on_a ? ",1," : ",0,") + (!is_known ? "" : on_b ? "1" : "0") + ",0\n";
    if (!is_known) continue;
    n += 1;
    a += on_a;
    b += on_b;
    both += on_a && on_b;
  }
  const LogFacts facts = facts_of(read_log_text(text));
  REQUIRE(facts.pairs.size() == 3);
  CHECK(facts.pairs[0].a == 0);
  CHECK(facts.pairs[0].b == 1);
  CHECK(*facts.pairs[0].phi ==
        Approx((both / n - a / n * b / n) / std::sqrt(a / n * (1 - a / n) * b / n * (1 - b / n))));
  CHECK_FALSE(facts.pairs[1].phi);
  CHECK_FALSE(facts.pairs[0].b_after_a_s);  // readings 10 s apart

  std::string walks = "time,sensor,state\n0,A,off\n0,B,off\n0,C,off\n";
  for (int i = 1; i <= 200; ++i) {
    const double s = 100.0 * i;
    walks += line(s, "A", true) + line(s + 1.5, "B", true) + line(s + 4.0, "A", false) + line(s + 4.5, "B", false);
    const double other = s + (random() % 2 == 0 ? 3.0 : -3.0);
    walks += line(other, "C", true) + line(other + 1.0, "C", false);
  }
  const LogFacts told = facts_of(read_log_text(walks));
  for (const LogPair& pair : told.pairs) {
    if (pair.a == 0 && pair.b == 1) {
      CHECK(*pair.b_after_a_s == Approx(1.5));
      CHECK(pair.n_together == 200);
      CHECK(pair.has_leader());
    }
    if (pair.a == 0 && pair.b == 2) CHECK_FALSE(pair.has_leader());
  }
}

TEST_CASE("gaps are told once for all sensors that have them") {
  const LogFacts facts = facts_of(read_log_text("time_s,A,B\n1,0,0\n2,0,1\n3,,0\n4,1,0\n9,0,0\n10,0,1\n"));
  REQUIRE(facts.gaps.size() == 2);
  CHECK(facts.gaps[0].from.us == 4'000'000);
  CHECK(facts.gaps[0].to.us == 8'000'000);
  CHECK(facts.gaps[0].sensors == std::vector<std::size_t>{0, 1});
  CHECK(facts.gaps[1].from.us == 2'000'000);
  CHECK(facts.gaps[1].to.us == 3'000'000);
  CHECK(facts.gaps[1].sensors == std::vector<std::size_t>{0});
}
