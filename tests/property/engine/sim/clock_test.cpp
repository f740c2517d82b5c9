// Runs of a script with a clock of its own.
#include "pirsim/state.hpp"
#include "pirsim/study.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

ScriptSpec script_at(const std::string& begin) {
  return io::parse_script("pirsim_script: 1\nreplicates: 2\n" + begin +
                              "trials:\n  for_each: {door: [door]}\n  id: ${door}\n"
                              "people: [{id: a, actions: [{enter: \"${door}\", at_s: 3}, {leave: \"${door}\"}]}]\n",
                          "s.yaml");
}

Model model_at(const std::string& begin, const Model* like = nullptr) {
  return compile(shipped_scene("meeting_room.gltf"), script_at(begin), {.like = like});
}

}  // namespace

TEST_CASE("A clock adds its times to the rows and changes nothing else") {
  const Model plain = model_at(""), timed = model_at("begin: 2026-03-02T23:59:58\n");
  CHECK(timed.columns()[3] == "time");
  CHECK(plain.columns()[3] == "phase");
  for (std::uint32_t run = 0; run < 2; ++run) {
    std::vector<Sample> rows = run_once(timed, run).samples;
    REQUIRE(rows.size() > 5);
    CHECK(rows[0].clock == "2026-03-02T23:59:59");  // of the second replicate as well
    CHECK(rows[1].clock == "2026-03-03T00:00:00");
    CHECK(run_once(timed, run, Record::samples, Trace::none, Occupants::told).occupants.front().clock == rows[3].clock);
    for (Sample& row : rows) row.clock.clear();
    CHECK(rows == run_once(plain, run).samples);
  }
}

TEST_CASE("A model that is made like another one has the clock of its own script") {
  const Model first = model_at("begin: 2026-03-02T06:00\n");
  CHECK(run_once(model_at("begin: 2026-05-04T07:00\n", &first), 0).samples.front().clock == "2026-05-04T07:00:01");
  CHECK(run_once(model_at("", &first), 0).samples.front().clock.empty());
}

TEST_CASE("Actions whose times run backwards are told by the clock that rows have") {
  const auto times = [](const std::string& begin) {
    return io::parse_script("pirsim_script: 1\n" + begin +
                                "people: [{id: a, actions: [{enter: door, at_s: 3600}, {leave: door, at_s: 60}]}]\n",
                            "s.yaml");
  };
  CHECK_THROWS_WITH(compile(shipped_scene("meeting_room.gltf"), times("begin: 2026-03-02T06:00\n")),
                    contains("'a' starts at 2026-03-02T06:01:00, before an action that is written above it and starts "
                             "at 2026-03-02T07:00:00"));
  CHECK_THROWS_WITH(
      compile(shipped_scene("meeting_room.gltf"), times("")),
      contains("'a' starts at 60 s, before an action that is written above it and starts at 3600 s: time runs"));
}
