#include "reconcile/validation/seal.hpp"

#include <set>
#include <sstream>

#include "core/digest.hpp"
#include "effects/catalogue.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"
#include "pirsim/study.hpp"
#include "reconcile/ensemble/simulated_realization.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "support/short_study.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

ScriptSpec one_seat() { return test::short_study({"S4"}, 30.0); }

std::string rows_of(const Realization& realization) {
  const Model model = compile(realization.scene, realization.script);
  std::ostringstream text;
  io::CsvWriter csv(text, measured_columns(frame_of(realization.scene, realization.script)));
  run_study(model, {.threads = 1}, [&](const RunResult& result) {
    for (const Sample& row : result.samples) csv.write(row);
  });
  return text.str();
}

/// Which has every effect but these, all switched off.
ScriptSpec with_all_but(const std::set<std::string>& left_out) {
  ScriptSpec script = one_seat();
  for (const effects::Effect* effect : effects::catalogue_for(one_seat())) {
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

const std::string valid_answer =
    R"({"pirsim_sealed_answer": 1, "hidden": "one", "effects": [{"name": "thermal_contrast"}], "out_of_catalogue_fault": null,)"
    R"( "measured_sha256": "x"})";
const std::string valid_report =
    R"({"pirsim_reconcile_report": 1, "measured": {"sha256": "x"}, "verdict": "named", "effects": ["range_scale"]})";

Score opened(const std::string& answer, const std::string& report) {
  return open_answer({"secret.json", answer}, sha256(answer), {"report.json", report});
}

std::string changed(std::string text, const std::string& old, const std::string& now) {
  REQUIRE(text.find(old) != std::string::npos);
  return text.replace(text.find(old), old.size(), now);
}

}  // namespace

TEST_CASE("a challenge is none of the realizations that an analysis with the same seed simulates",
          "[reconcile][seal]") {
  const SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  const ScriptSpec script = one_seat();
  constexpr std::uint64_t seed = 1;  // the analysis' own, which somebody may well take for a secret
  const Challenge challenge = seal(scene, script, {{}, Hidden::nothing, 1, seed, "salt"});
  CHECK(challenge.rows == seal(scene, script, {{}, Hidden::nothing, 1, seed, "pepper"}).rows);
  CHECK(challenge.rows != seal(scene, script, {{}, Hidden::nothing, 1, seed + 1, "salt"}).rows);
  for (std::uint32_t index = 0; index < 3; ++index) {
    CHECK(challenge.rows != rows_of(draw_realization(scene, script, {}, seed, index, 0)));
  }
}

TEST_CASE("only the sensors tell what was hidden", "[reconcile][seal]") {
  // Their seat is elsewhere, they are taller, lean when they rise or walk at a pace of their own: they walk longer or
  // shorter, as they would if it were so in the real room, and whoever measures there writes down when the work began.
  const std::set<std::string> change_the_way{"seats_shifted", "seat_shift", "seat_scatter",
                                             "body_size",     "trunk_tilt", "natural_motion"};
  const SceneSpec scene = test::shipped_scene("meeting_room.gltf");
  const NuisanceSpec none{0.0, 0.0, 0.0, 0.0, 0.0};
  const std::string plain = seal(scene, one_seat(), {none, Hidden::nothing, 1, 1, {}}).rows;
  CHECK(plain.starts_with("replicate,trial,time_s,phase,PIR1,"));
  std::size_t seen = 0;
  for (const effects::Effect* effect : effects::catalogue_for(one_seat())) {
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
  CHECK_NOTHROW(sealed(Hidden::out_of_catalogue, {}));
}

TEST_CASE("a report or an answer that isn't understood is refused by its name", "[reconcile][seal]") {
  struct Fault {
    std::string old, now, message;
  };
  const auto refused = [](const std::string& answer, const std::string& report, const std::string& message) {
    INFO(answer + "\n" + report);
    try {
      static_cast<void>(opened(answer, report));
      FAIL("not refused");
    } catch (const Error& error) {
      CHECK(error.code() == ErrorCode::input);
      CHECK(error.issues().size() == 1);
      CHECK(error.what() == message);
    }
  };
  CHECK(opened(valid_answer, valid_report).mark == Mark::exact);
  for (const auto& [old, now, message] : std::vector<Fault>{
           {"range_scale", "range_scall", "'range_scall' is not an effect (did you mean 'range_scale'?)"},
           {R"("named")", R"("nonsense")",
            "'/verdict' is 'nonsense', not one of no-disagreement, named, one-of, several, nearest, none-in-catalogue, "
            "faulty-data"},
           {R"("named")", "3", "'/verdict' isn't there, or isn't what it should be"},
           {R"("named")", R"("no-disagreement")", "'/effects' isn't empty, though the verdict is no-disagreement"},
           {R"("named")", R"("none-in-catalogue")", "'/effects' isn't empty, though the verdict is none-in-catalogue"},
           {"report\": 1", "report\": 2", "'pirsim_reconcile_report' isn't 1, the only one that this pirsim reads"},
           {"_report", "_rapport", "expected a JSON object with 'pirsim_reconcile_report'"},
           {R"({"sha256": "x"})", "[]", "'/measured/sha256' isn't there, or isn't what it should be"},
           {R"(["range_scale"])", R"("range_scale")", "'/effects' isn't there, or isn't what it should be"},
           {R"("x")", R"("y")", "the report is about other data than those of this challenge"},
           {"}", "", "expected a JSON object with 'pirsim_reconcile_report'"}}) {
    refused(valid_answer, changed(valid_report, old, now), "report.json: error: " + message);
  }
  for (const auto& [old, now, message] : std::vector<Fault>{
           {"thermal_contrast", "thermal_contrasts",
            "'thermal_contrasts' is not an effect (did you mean 'thermal_contrast'?)"},
           {R"("one")", R"("three")", "'/hidden' is 'three', not one of any, nothing, one, two, out-of-catalogue"},
           {"answer\": 1", "answer\": \"1\"", "'pirsim_sealed_answer' isn't 1, the only one that this pirsim reads"},
           {R"("name")", R"("nom")", "'/effects/0/name' isn't there, or isn't what it should be"},
           {"null", "{}", "'/out_of_catalogue_fault/name' isn't there, or isn't what it should be"},
           {R"("out_of_catalogue_fault": null,)", "",
            "'/out_of_catalogue_fault' isn't there, or isn't what it should be"},
           {"{", "[{", "expected a JSON object with 'pirsim_sealed_answer'"}}) {
    refused(changed(valid_answer, old, now), valid_report, "secret.json: error: " + message);
  }
  CHECK_THROWS_WITH(open_answer({"secret.json", valid_answer}, sha256("another"), {"report.json", valid_report}),
                    contains("secret.json: error: the answer is not the one"));
}

TEST_CASE("whoever names the twin of what was hidden is right and whoever names another is not", "[reconcile][seal]") {
  const auto mark = [&](const std::string& effect) {
    return opened(valid_answer, changed(valid_report, "range_scale", effect)).mark;
  };
  CHECK(mark("range_scale") == Mark::exact);
  CHECK(mark("thermal_contrast") == Mark::exact);
  CHECK(mark("soft_zone_edges") == Mark::family);
  CHECK(mark("dead_sensor") == Mark::wrong);
}
