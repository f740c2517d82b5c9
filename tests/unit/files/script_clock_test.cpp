// `begin` of a script and `at` of its actions.
#include "pirsim/io.hpp"
#include "support/catch.hpp"

using namespace pirsim;

namespace {

ScriptSpec script_of_clock(const std::string& head, const std::string& actions,
                           const std::vector<std::string>& set = {}) {
  return io::parse_script("pirsim_script: 1\n" + head + "people: [{id: a, actions: [" + actions + "]}]\n", "s.yaml",
                          set);
}

std::vector<std::optional<double>> times_of(const ScriptSpec& script) {
  std::vector<std::optional<double>> times;
  for (const ScriptedAction& action : script.trials.front().people.front().actions) times.push_back(action.at_s);
  return times;
}

void refused_clock(const std::string& head, const std::string& actions, const std::string& message) {
  INFO(head << actions);
  CHECK_THROWS_WITH(script_of_clock(head, actions), contains(message));
}

using Times = std::vector<std::optional<double>>;
const std::string six = "begin: 2026-03-02T06:00\n";
const std::string cleaned = "schedule: {from: 07:00, to: 20:00, cleaning: 19:00}\n";

}  // namespace

TEST_CASE("at is the first time of the run that the clock shows this, and beside at_s it is the same") {
  const ScriptSpec script = script_of_clock(
      six, "{enter: door, at: \"06:45\"}, {sit: S1}, {rise: , at: 07:00:30}, {leave: door, at: 2026-03-03T06:45}");
  CHECK(script.begin == "2026-03-02T06:00");
  CHECK(times_of(script) == Times{2700.0, std::nullopt, 3630.0, 86400.0 + 2700.0});
  CHECK(times_of(script_of_clock(six, "{enter: door, at: 06:00}, {leave: door, at: 05:00}")) == Times{0.0, 82800.0});
}

TEST_CASE("Overriding begin moves what is at a time of day") {
  const std::string actions = "{enter: door, at: 06:45}, {leave: door, at_s: 9000}";
  CHECK(times_of(script_of_clock(six, actions, {"begin=2026-03-02T05:00"})) == Times{6300.0, 9000.0});
  CHECK(times_of(script_of_clock("", actions, {"begin=2026-03-02 06:30"})) == Times{900.0, 9000.0});
}

TEST_CASE("A script with a clock is written with its times, and read back as it was") {
  const ScriptSpec script =
      script_of_clock(six,
                      "{enter: door, at: 06:45}, {rise: , at_s: 2700.02}, {walk: {to_xz_m: [[1, 1]]}, at_s: 3600}, "
                      "{leave: door, at: 2026-03-03T06:45}");
  const std::string text = io::to_yaml(script);
  CHECK_THAT(text, contains("begin: 2026-03-02T06:00"));
  CHECK_THAT(text, contains("at: 06:45"));
  CHECK_THAT(text, contains("at_s: 2700.02"));
  CHECK_THAT(text, contains("at: 07:00"));
  CHECK_THAT(text, contains("at: 2026-03-03T06:45"));
  const ScriptSpec again = io::parse_script(text, "again.yaml");
  CHECK(times_of(again) == times_of(script));
  CHECK(io::to_yaml(again) == text);
  CHECK(io::to_yaml(script_of_clock("", "{enter: door, at_s: 2700}")).find("begin") == std::string::npos);
}

TEST_CASE("Beside a schedule, at is a time of the part of the day that is simulated") {
  CHECK(times_of(script_of_clock(cleaned, "{enter: door, at: 08:30}, {leave: door, at: 19:59}")) ==
        Times{5400.0, 46740.0});
  refused_clock(cleaned, "{enter: door, at: 06:30}", "at: 06:30 isn't between the schedule's `from` and `to`");
  refused_clock(cleaned, "{enter: door, at: 2026-03-02T08:30}", "leave out the date");
  refused_clock(six + cleaned, "{enter: door}", "s.yaml:2:8: error: begin: a schedule's `first_day` and `from`");
}

TEST_CASE("A clock that can't be understood is refused with its place and the remedy") {
  refused_clock("", "{enter: door, at: 06:45}",
                "s.yaml:2:46: error: at: the script has no clock: add `begin: 2026-03-02T00:00`");
  refused_clock(six, "{enter: door, at: 06:45, at_s: 4}", "at: stands beside at_s");
  refused_clock(six, "{enter: door, at: half past}", "at: expected a time of day, e.g. 06:45");
  refused_clock(six, "{enter: door, at: 2026-03-01T06:45}", "is before the run begins, at 2026-03-02T06:00:00");
  refused_clock(six, "{enter: door, at: 2027-03-01T06:45}", "more than 115 days");
  refused_clock("begin: 2026-03-02\n", "{enter: door, at: 06:45}",
                "s.yaml:2:8: error: begin: expected the date and time at which runs begin, e.g. 2026-03-02T07:00, got "
                "'2026-03-02'");
  refused_clock("begin: [1]\n", "{enter: door}", "s.yaml:2:8: error: script: begin");
  refused_clock("begn: 2026-03-02T06:00\n", "{enter: door}", "(did you mean 'begin'?)");
  refused_clock(six, "{at: 06:45}", "an action is missing");
  try {
    static_cast<void>(script_of_clock("begin: soon\n", "{enter: door, at: 06:45}"));
    FAIL("a script that begins soon was read");
  } catch (const Error& error) {
    CHECK(error.issues().size() == 1);  // `at` of a clock that isn't understood is no second fault
  }
}

TEST_CASE("What is to begin after the run's end is warned of, by the clock or in seconds") {
  const ScriptSpec script = script_of_clock(six + "duration_s: 3600\n", "{enter: door, at: 05:00}, {leave: door}");
  REQUIRE(script.warnings.size() == 1);
  CHECK(to_string(script.warnings.front()) ==
        "s.yaml:4:36: warning: 'a' is to begin this at 2026-03-03T05:00:00, but the run ends at 2026-03-02T07:00:00: "
        "it never happens");
  CHECK(script_of_clock("duration_s: 30\n", "{enter: door, at_s: 31}").warnings.size() == 1);
  CHECK(script_of_clock("duration_s: 30\n", "{enter: door, at_s: 29}").warnings.empty());
}
