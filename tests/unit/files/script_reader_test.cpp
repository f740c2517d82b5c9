#include "pirsim/io.hpp"

#include <fstream>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;

namespace {

ScriptSpec read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "s.yaml") << text;
  return io::read_script(folder.path() / "s.yaml", overrides);
}

std::string fault(const std::string& text) {
  try {
    static_cast<void>(read(text));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

constexpr const char* two_variables = R"(
pirsim_script: 1
trials:
  for_each: {seat: [S1, S2, S3], tall: [1.6, 1.9]}
  id: ${seat}-${tall}
people:
  - id: a
    stature_m: ${tall}
    actions:
      - enter: door
      - {sit: "${seat}", at_s: 3.5, phase: seated}
      - work:
      - rise
)";

}  // namespace

TEST_CASE("for_each makes every combination, the last variable fastest, and fills it in") {
  const ScriptSpec script = read(two_variables);
  REQUIRE(script.trials.size() == 6);
  CHECK(script.trials[0].id == "S1-1.6");
  CHECK(script.trials[1].id == "S1-1.9");
  CHECK(script.trials[5].id == "S3-1.9");
  const PersonSpec& person = script.trials[5].people.at(0);
  CHECK(person.stature_m == 1.9);
  REQUIRE(person.actions.size() == 4);
  CHECK(std::get<action::Sit>(person.actions[1].what).seat == "S3");
  CHECK(person.actions[1].at_s == 3.5);
  CHECK(person.actions[1].phase == "seated");
  CHECK(std::get<action::Work>(person.actions[2].what).tilt_every_s == 30.0);
  CHECK(std::holds_alternative<action::Rise>(person.actions[3].what));
}

TEST_CASE("a script without trials is one trial, defaults are those of the paper") {
  const ScriptSpec script = read("pirsim_script: 1\npeople: [{id: a}]\n");
  REQUIRE(script.trials.size() == 1);
  CHECK(script.sensing.tick_rate_hz == 50);
  CHECK(script.sensing.ticks_per_window == 50);
  CHECK(script.sensing.rays_per_zone == RaysPerZone::five);
  CHECK(script.trials[0].people[0].stature_m == 1.86);
}

TEST_CASE("the resolved script reads back to itself") {
  const std::string once = io::to_yaml(read(two_variables));
  CHECK(io::to_yaml(read(once)) == once);
}

TEST_CASE("overrides replace values and are validated like the file") {
  CHECK(read(two_variables, {"seed=9", "people.0.mass_kg=60", "trials.for_each.seat=[S7]"}).trials.at(1).id ==
        "S7-1.9");
  CHECK_THROWS_AS(read(two_variables, {"people.0.mass=60"}), Error);
}

TEST_CASE("every fault of a script is told at once, each with its place") {
  const std::string text =
      fault("pirsim_script: 1\nseeds: 3\npeople:\n  - id: a\n    actions:\n      - sti: S1\n      - wait_s: -1\n");
  CHECK(text.find(":2:1: error: script: unknown key 'seeds' (did you mean 'seed'?)") != std::string::npos);
  CHECK(text.find(":6:9: error: 'sti' isn't an action (did you mean 'sit'?)") != std::string::npos);
  CHECK(text.find(":7:17: error: wait_s") != std::string::npos);
}

TEST_CASE("a file of another kind is told by one line, with the command that takes it") {
  CHECK(fault("# walks\npirsim_walk_test: 1\nspacing_m: 1\n")
            .ends_with(":2:19: error: this is a walk test: `pirsim walktest --script` takes it"));
  CHECK(fault("{\"asset\": {\"version\": \"2.0\"}, \"nodes\": []}").find("this is a glTF scene: `--scene` takes it") !=
        std::string::npos);
  CHECK(fault("glTF\x02").find("this is a glTF scene: `--scene` takes it") != std::string::npos);
  CHECK(fault("name: nothing known\n").find("'pirsim_script' is missing") != std::string::npos);
}

TEST_CASE("a trial's name may not become empty by what is filled in") {
  const std::string text =
      "pirsim_script: 1\ntrials:\n  for_each: {seat: [S1, \"\"]}\n  id: ${seat}\npeople: [{id: a}]\n";
  CHECK(fault(text).find(":4:7: error: trials: id: expected a text that isn't empty") != std::string::npos);
}

TEST_CASE("two actions in one entry, an entry without one, and two people of one name are refused") {
  const std::string people = "pirsim_script: 1\npeople:\n  - id: a\n    actions:\n";
  CHECK(fault(people + "      - {sit: S1, rise: }\n").find("one action per entry") != std::string::npos);
  CHECK(fault(people + "      - at_s: 4\n").find("an action is missing") != std::string::npos);
  CHECK(fault("pirsim_script: 1\npeople: [{id: a}, {id: a}]\n").find("a second person 'a'") != std::string::npos);
}

TEST_CASE("a script for another folder finds the same files from there", "[io]") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "studies");
  std::filesystem::create_directories(folder.path() / "found" / "deep");
  std::ofstream(folder.path() / "sums.csv") << "trial,sensor,real\n";
  std::ofstream(folder.path() / "studies" / "s.yaml") << "pirsim_script: 1\npeople: []\n"
                                                         "summary: {phases: [working], reference: ../sums.csv}\n";
  const ScriptSpec script = io::read_script(folder.path() / "studies" / "s.yaml");
  const std::filesystem::path there = folder.path() / "found" / "deep" / "s.yaml";
  std::ofstream(there) << io::to_yaml(io::moved(script, there.parent_path()));
  const ScriptSpec again = io::read_script(there);
  CHECK(again.summary.reference_file == "../../sums.csv");
  CHECK(std::filesystem::equivalent(std::filesystem::path(again.directory) / again.summary.reference_file,
                                    folder.path() / "sums.csv"));
  ScriptSpec absolute = script;
  absolute.summary.reference_file = "/sums.csv";
  CHECK(io::moved(absolute, there.parent_path()).summary.reference_file == "/sums.csv");
  CHECK(io::moved(ScriptSpec{}, there.parent_path()).summary.reference_file.empty());
}

TEST_CASE("a dollar sign that stands for itself is written so that it is read so", "[script]") {
  const ScriptSpec script = read(
      "pirsim_script: 1\npeople: [{id: a, actions: [{enter: door}, {wait_s: 1, phase: \"cost $${x} or $${y\"}]}]\n");
  CHECK(script.trials.front().people.front().actions.back().phase == "cost ${x} or ${y");
  CHECK(read(io::to_yaml(script)).trials.front().people.front().actions.back().phase == "cost ${x} or ${y");
}

TEST_CASE("an action's value of another form is told with an example that can be read") {
  const auto told = [](const std::string& action) {
    return fault("pirsim_script: 1\nbegin: 2026-03-02T08:00\npeople:\n  - id: a\n    actions:\n      - " + action +
                 "\n");
  };
  CHECK_THAT(told("enter: {door: x}"), contains("s.yaml:6:16: error: enter: expected a text, got a map; for example "
                                                "{enter: door, at: \"09:00\"}"));
  for (const char* wrong :
       {"wait_s: {s: 60}", "wait: 60", "appear: [1, 2]", "enter: [door]", "walk: 3", "sit: [S1]", "lie: [bed]",
        "stand: [stove]", "work: 60", "rise: [now]", "turn: 90", "leave: {door: x}", "follow: 3"}) {
    const std::string text = told(wrong);
    CAPTURE(wrong, text);
    const auto at = text.find("; for example ");
    REQUIRE(at != std::string::npos);
    const std::string example = text.substr(at + 14, text.find('\n', at) - at - 14);
    CHECK(told(example).empty());
    CHECK(example.substr(1, example.find(':')) == std::string(wrong).substr(0, example.find(':')));
  }
  CHECK(told("wait_s: -3").find("for example") == std::string::npos);  // the form is right
  CHECK(told("sit: {seats: S1}").find("for example") == std::string::npos);
}
