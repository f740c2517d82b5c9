#include "pirsim/reconcile/seal.hpp"

#include <set>
#include <sstream>

#include "pirsim/core/digest.hpp"
#include "pirsim/core/error.hpp"
#include "pirsim/effects/catalogue.hpp"
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
  io::MeasuredCsvWriter csv(text, frame_of(world.scene, world.script).sensors);
  run_study(model, {.threads = 1}, [&](const RunResult& result) {
    for (const Sample& row : result.samples) csv.write(row);
  });
  return text.str();
}

/// Which has every effect but these, all switched off.
ScriptSpec with_all_but(const std::set<std::string>& left_out) {
  ScriptSpec script = one_seat();
  for (const effects::Effect* effect : effects::catalogue()) {
    if (!left_out.contains(effect->info.name)) script.effects.push_back(effects::off(*effect));
  }
  return script;
}

/// What a row tells beside the sensors: run, trial, time and phase.
std::string without_sensors(const std::string& rows) {
  std::istringstream lines(rows);
  std::string rest;
  for (std::string line; std::getline(lines, line);) {
    std::size_t comma = line.find(',');
    for (int column = 0; column < 3; ++column) comma = line.find(',', comma + 1);
    rest += line.substr(0, comma) + '\n';
  }
  return rest;
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

TEST_CASE("only the sensors tell what was hidden", "[reconcile][seal]") {
  // Their seat is elsewhere, or they are taller or lean when they rise: they walk longer or shorter, as they would if
  // it were so in the real room, and whoever measures there writes down when the work began.
  const std::set<std::string> change_the_way{"seats_shifted", "seat_shift", "seat_scatter", "body_size", "trunk_tilt"};
  const SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  const NuisanceSpec none{0.0, 0.0, 0.0, 0.0, 0.0};
  const std::string plain = seal(scene, one_seat(), {none, Hidden::nothing, 1, 1, {}}).rows;
  CHECK(plain.starts_with("replicate,trial,time_s,phase,PIR1,"));
  std::size_t seen = 0;
  for (const effects::Effect* effect : effects::catalogue()) {
    const std::string& name = effect->info.name;
    INFO(name);
    const Challenge challenge = seal(scene, with_all_but({name}), {none, Hidden::one, 1, 1, {}});
    CHECK(challenge.answer.find('"' + name + '"') != std::string::npos);
    CHECK(challenge.rows.substr(0, challenge.rows.find('\n')) == plain.substr(0, plain.find('\n')));
    if (!change_the_way.contains(name)) CHECK(without_sensors(challenge.rows) == without_sensors(plain));
    seen += challenge.rows != plain ? 1 : 0;
  }
  CHECK(seen > 15);  // the others are too weak, or far from this seat
}

TEST_CASE("what can't be hidden beside the script's own effects is refused", "[reconcile][seal]") {
  const SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  const auto sealed = [&](Hidden hidden, const std::set<std::string>& left) {
    return seal(scene, with_all_but(left), {{}, hidden, 1, 1, {}}).answer;
  };
  for (const Hidden hidden : {Hidden::one, Hidden::two, Hidden::any}) {
    CHECK_THROWS_WITH(sealed(hidden, {}), contains("effects that the script doesn't have: 0, needed: "));
  }
  for (const Hidden hidden : {Hidden::two, Hidden::any}) {
    try {
      static_cast<void>(sealed(hidden, {"clock_lag"}));
      FAIL("hidden");
    } catch (const Error& error) {
      CHECK(error.code() == ErrorCode::usage);
    }
  }
  CHECK(sealed(Hidden::one, {"clock_lag"}).find("clock_lag") != std::string::npos);
  const std::string both = sealed(Hidden::two, {"clock_lag", "dead_sensor"});
  CHECK(both.find("clock_lag") != std::string::npos);
  CHECK(both.find("dead_sensor") != std::string::npos);
  CHECK_NOTHROW(sealed(Hidden::nothing, {}));
  CHECK_NOTHROW(sealed(Hidden::alien, {}));
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
