// The clock of a study: how times are read, and what moments of a run are called.
#include "model/schema/clock.hpp"

#include <string>

#include "support/catch.hpp"

using namespace pirsim;

namespace {

RunClock clock_at(const std::string& begin) {
  const auto clock = clock_from(begin);
  REQUIRE(clock);
  return *clock;
}

}  // namespace

TEST_CASE("A run's beginning is a date and a time, and nothing else") {
  CHECK(clock_at("1970-01-02T00:00:05").begin_s == 86405);
  CHECK(clock_at("2026-03-02 07:00") == clock_at("2026-03-02T7:00:00"));
  CHECK(clock_at("2026-03-02T24:00") == clock_at("2026-03-03T00:00"));
  for (const char* text :
       {"", "2026-03-02", "07:00", "2026-02-30T07:00", "2026-03-02T25:00", "2026-03-02T07:60", "2026-03-02T7",
        "2026-3-2T07:00", "2026- 3- 2T07:00", "2026-03-02T07:00Z", "2026-03-02T 7:00", "2026-03-02T-1:00",
        "2026-03-02T07:5", "2026-03-02T07:00:5", "2026-03-02T07:00:", "20260302T07:00"}) {
    INFO(text);
    CHECK_FALSE(clock_from(text));
  }
}

TEST_CASE("A time of day is the first one of the run, a date the one that it names") {
  const RunClock clock = clock_at("2026-03-02T07:30");
  CHECK(clock.run_seconds("07:30") == 0.0);
  CHECK(clock.run_seconds("07:30:01") == 1.0);
  CHECK(clock.run_seconds("07:29") == 86400.0 - 60.0);
  CHECK(clock.run_seconds("24:00") == 16.5 * 3600.0);
  CHECK(clock.run_seconds("00:00") == 16.5 * 3600.0);
  CHECK(clock.run_seconds("2026-03-04T07:30") == 2 * 86400.0);
  CHECK(clock.run_seconds("2026-03-02T07:00") == -1800.0);
  CHECK_FALSE(clock.run_seconds("730"));
  CHECK_FALSE(clock.run_seconds("2026-03-02"));
  CHECK(clock_at("2026-03-02T00:00").run_seconds("24:00") == 86400.0);
  CHECK(clock_at("2026-03-02T00:00").run_seconds("00:00") == 0.0);
}

TEST_CASE("What the clock shows is read back as the same moment") {
  for (const char* begin : {"2026-03-02T00:00", "2026-02-28T23:59:30", "1969-12-31T12:00"}) {
    const RunClock clock = clock_at(begin);
    for (const double run_s : {0.0, 1.0, 59.0, 30.0, 3600.0, 86399.0, 86400.0, 86430.0, 200000.0}) {
      INFO(begin << ", " << run_s << " s: " << clock.text(run_s) << ", " << clock.shortest_text(run_s));
      CHECK(clock.run_seconds(clock.text(run_s)) == run_s);
      CHECK(clock.run_seconds(clock.shortest_text(run_s)) == run_s);
    }
  }
  const RunClock clock = clock_at("2026-03-02T06:00");
  CHECK(clock.text(2700.4) == "2026-03-02T06:45:00");
  CHECK(clock.shortest_text(2700.0) == "06:45");
  CHECK(clock.shortest_text(2701.0) == "06:45:01");
  CHECK(clock.shortest_text(86400.0 + 2700.0) == "2026-03-03T06:45");
  CHECK(moment_text(clock, 2700.0) == "2026-03-02T06:45:00");
  CHECK(moment_text(std::nullopt, 2700.5) == "2700.5 s");
}

TEST_CASE("Hours, minutes and seconds since something began may be more than a day") {
  CHECK(elapsed_seconds("0:10:05") == 605.0);
  CHECK(elapsed_seconds("30:00:00") == 108000.0);
  for (const char* text : {"10:05", "0:60:00", "0:10:5", ":10:05", "-1:00:00", "1e3", "0:10:05.5"}) {
    INFO(text);
    CHECK_FALSE(elapsed_seconds(text));
  }
}

TEST_CASE("A trial has its schedule's clock or its script's, and never two") {
  ScriptSpec script;
  TrialSpec own, scheduled;
  scheduled.schedule.emplace();
  scheduled.schedule->from_h = 7.5;
  CHECK_FALSE(clock_of(script, own));
  CHECK(clock_of(script, scheduled)->text(0.0) == "2026-03-02T07:30:00");
  script.begin = "2026-05-04T06:00";
  CHECK(clock_of(script, own)->text(60.0) == "2026-05-04T06:01:00");
  Diagnostics faults;
  check(script, faults);
  CHECK_FALSE(faults.has_errors());
  script.trials = {scheduled};
  script.trials.front().id = "day";
  script.trials.front().schedule->cleaning_h = 19.0;
  check(script, faults);
  REQUIRE(faults.issues().size() == 1);
  CHECK_THAT(faults.issues().front().message, contains("script.begin: a schedule's `first_day` and `from` say when"));
  script.begin = "tomorrow";
  Diagnostics others;
  check(script, others);
  REQUIRE(others.issues().size() == 1);
  CHECK_THAT(others.issues().front().message, contains("script.begin: expected the date and time"));
}

TEST_CASE("Hours are told as a clock shows them, and a day's end as 24:00") {
  CHECK(hours_text(0.0) == "0:00");
  CHECK(hours_text(8.1) == "8:06");
  CHECK(hours_text(24.0) == "24:00");
  CHECK(hours_text(25.5) == "1:30");
}
