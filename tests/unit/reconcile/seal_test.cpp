#include "pirsim/reconcile/seal.hpp"

#include <sstream>

#include "pirsim/core/digest.hpp"
#include "pirsim/io/csv_writer.hpp"
#include "pirsim/reconcile/simulated_world.hpp"
#include "pirsim/sim/study.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/short_study.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

ScriptSpec one_seat() { return test::short_study({"S4"}, 30.0); }

std::string rows_of(const World& world) {
  const Model model = compile(world.scene, world.script);
  std::ostringstream text;
  io::CsvWriter csv(text, model.columns());
  run_study(model, {.threads = 1}, [&](const RunResult& result) {
    for (const Sample& row : result.samples) csv.write(row);
  });
  return text.str();
}

}  // namespace

TEST_CASE("a challenge is none of the worlds that an analysis with the same seed simulates", "[reconcile][seal]") {
  const SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  const ScriptSpec script = one_seat();
  constexpr std::uint64_t seed = 1;  // the analysis' own, which somebody may well take for a secret
  const Challenge challenge = seal(scene, script, {{}, Hidden::nothing, 1, seed, "salt"});
  CHECK(challenge.rows == seal(scene, script, {{}, Hidden::nothing, 1, seed, "pepper"}).rows);
  CHECK(challenge.rows != seal(scene, script, {{}, Hidden::nothing, 1, seed + 1, "salt"}).rows);
  for (std::uint32_t index = 0; index < 3; ++index) {
    CHECK(challenge.rows != rows_of(draw_world(scene, script, {}, seed, index, 0)));
  }
}

TEST_CASE("whoever names the twin of what was hidden is right and whoever names another is not", "[reconcile][seal]") {
  const std::string answer =
      R"({"pirsim_sealed_answer": 1, "hidden": "one", "effects": [{"name": "thermal_contrast"}], "alien": null,)"
      R"( "measured_sha256": "x"})";
  const auto mark = [&](const std::string& effect) {
    const std::string report = R"({"pirsim_reconcile_report": 1, "measured": {"sha256": "x"}, "verdict": "named",)"
                               R"( "effects": [")" +
                               effect + R"("]})";
    return open_answer(answer, sha256(answer), report).mark;
  };
  CHECK(mark("range_scale") == Mark::exact);
  CHECK(mark("thermal_contrast") == Mark::exact);
  CHECK(mark("soft_zone_edges") == Mark::family);
  CHECK(mark("dead_sensor") == Mark::wrong);
}
