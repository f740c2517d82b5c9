// What every entry of the catalogue keeps to. A new entry is tested here without another line.
#include <algorithm>
#include <set>

#include "engine/sim/recording.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"
#include "support/temporary_folder.hpp"

using namespace pirsim;
using namespace pirsim::test;
using effects::Effect;
using effects::Reach;

namespace {

struct Place {
  SceneSpec scene;
  ScriptSpec script;
};
std::vector<Place> places() {
  return {{shipped_scene("meeting_room.gltf"), short_study_a()}, {shipped_scene("open_office.gltf"), short_office()}};
}
/// Who is there is told by counts.
Place counted() {
  Place place{shipped_scene("meeting_room.gltf"), script_of({})};
  CountsSpec& counts = place.script.trials.front().occupancy.emplace().counts.emplace();
  counts.times_s = {0.0, 60.0};
  counts.people = {1, 2};
  return place;
}
Model model_of(const Place& place, std::vector<EffectSpec> effects) {
  return compile(place.scene, with(place.script, std::move(effects)));
}

std::vector<EffectSpec> everything(EffectSpec (*at)(const Effect&)) {
  std::vector<EffectSpec> specs;
  for (const Effect* effect : effects::catalogue()) specs.push_back(at(*effect));
  return specs;
}

}  // namespace

TEST_CASE("every effect at off leaves every row as it is: in a meeting room and an open office", "[seconds]") {
  for (const Place& place : places()) {
    const auto plain = results_of(model_of(place, {}));
    CHECK(same_rows(results_of(model_of(place, everything(effects::off))), plain));
    for (const Effect* effect : effects::catalogue()) {
      INFO(effect->info.name << " in " << place.scene.name);
      CHECK(same_rows(results_of(model_of(place, {effects::off(*effect)})), plain));
    }
  }
}

TEST_CASE("every effect at full strength changes some row: in one of the rooms at least", "[seconds]") {
  std::set<std::string> seen;
  std::vector<Place> all = places();
  all.push_back(counted());
  for (const Place& place : all) {
    const auto plain = results_of(model_of(place, {}));
    for (const Effect* effect : effects::catalogue()) {
      const Model model = model_of(place, {strong(*effect)});
      if (!same_rows(results_of(model), plain)) seen.insert(effect->info.name);
    }
  }
  for (const Effect* effect : effects::catalogue()) {
    INFO(effect->info.name);
    CHECK(seen.contains(effect->info.name));
  }
}

TEST_CASE("an effect's rows don't depend on the number of threads and a copied state goes on alike", "[seconds]") {
  const Place place = places().front();
  for (const Effect* effect : effects::catalogue()) {
    INFO(effect->info.name);
    const Model model = model_of(place, {strong(*effect)});
    const auto one = results_of(model, 1);
    CHECK(same_rows(one, results_of(model, 2)));
    State state(model, 1);
    for (int i = 0; i < 20; ++i) step(model, state);
    State copy = state;
    while (step(model, state)) {
      REQUIRE(step(model, copy));
      REQUIRE(copy.sample() == state.sample());
    }
    CHECK(one[1].samples.back() == copy.sample());
  }
}

TEST_CASE("remembered zones give the rows of the study with every effect that acts after them") {
  const Place place = places().front();
  const Model plain = model_of(place, {});
  const Recording plain_tracks = record(plain, all_runs(plain), 1);
  for (const Effect* effect : effects::catalogue()) {
    INFO(effect->info.name);
    const EffectSpec spec = strong(*effect);
    const Model model = model_of(place, {spec});
    const auto rows = results_of(model);
    const effects::Pipeline pipeline = sim::make_stages(plain, std::vector{spec});
    const bool traced_anew = effect->info.reach == Reach::geometry || pipeline.looks_ahead();
    const Recording own_tracks = traced_anew ? record(model, all_runs(model), 1) : Recording{};
    const Recording& tracks = traced_anew ? own_tracks : plain_tracks;
    const auto logic = sim::make_logic(model);
    logic->prepare(tracks);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      CHECK(sim::replay(tracks, i, *logic, model.script().seed, pipeline).samples == rows[i].samples);
    }
  }
}

TEST_CASE("an effect reads back from the script that is written of it and does the same") {
  const TemporaryFolder folder;
  const Place place = places().front();
  Stream stream({7, 0, 0, Purpose::test});
  for (const Effect* effect : effects::catalogue()) {
    INFO(effect->info.name);
    const EffectSpec spec = effects::draw_from_prior(*effect, place.scene, place.script, stream);
    const std::string text = io::to_yaml(with(place.script, {spec}));
    const ScriptSpec again = io::read_script(folder.write("script.yaml", text));
    REQUIRE(again.effects.size() == 1);
    CHECK(again.effects[0].parameters == spec.parameters);
    CHECK(again.effects[0].choices == spec.choices);
    CHECK(io::to_yaml(again) == text);
  }
}

TEST_CASE("a prior's draws are accepted by the check and stay in their ranges") {
  Stream stream({8, 0, 0, Purpose::test});
  for (const Place& place : places()) {
    for (const Effect* effect : effects::catalogue()) {
      for (int i = 0; i < 20; ++i) {
        const EffectSpec spec = effects::draw_from_prior(*effect, place.scene, place.script, stream);
        Diagnostics diagnostics;
        effects::check(std::vector{spec}, place.scene, diagnostics);
        INFO(effect->info.name);
        REQUIRE_FALSE(diagnostics.has_errors());
        REQUIRE_FALSE(effects::is_off(spec));
        for (const effects::ParameterInfo& parameter : effect->info.parameters) {
          INFO(parameter.name);
          REQUIRE(spec.parameters.contains(parameter.name) == effects::applies(parameter, spec));
          if (!effects::applies(parameter, spec)) continue;
          const double value = spec.parameters.at(parameter.name);
          const bool either_way = effect->info.name == "seats_shifted";  // by one, and by minus one
          REQUIRE((either_way ? std::abs(value) == parameter.high : value >= parameter.low && value <= parameter.high));
        }
      }
    }
  }
}

TEST_CASE("a parameter with a range varies: no other is fitted") {
  Stream stream({9, 0, 0, Purpose::test});
  const Place place = places().front();
  for (const Effect* effect : effects::catalogue()) {
    std::map<std::string, std::set<double>> values;
    for (int i = 0; i < 60; ++i) {
      for (const auto& [name, value] : effects::draw_from_prior(*effect, place.scene, place.script, stream).parameters)
        values[name].insert(value);
    }
    for (const effects::ParameterInfo& parameter : effect->info.parameters) {
      INFO(effect->info.name << ' ' << parameter.name);
      if (effect->info.name != "seats_shifted")  // which way is told by the likeliest kind
        CHECK((values[parameter.name].size() > 1) == (parameter.low < parameter.high));
    }
  }
}

TEST_CASE("a parameter that means nothing with the choices is refused and leaves an effect off") {
  const auto spec = [](const std::string& height, double value, const std::string& what) {
    return EffectSpec{"missing_occluder", {{height, value}}, {{"what", what}}, {}};
  };
  Diagnostics faults;
  effects::check(std::vector{spec("height_m", 1.0, "box")}, faults);
  REQUIRE(faults.has_errors());
  CHECK_THAT(faults.issues().front().message, contains("height_m means nothing without what: chair_backs"));
  CHECK(effects::is_off(spec("box_height_m", 0.0, "box")));
  CHECK_FALSE(effects::is_off(spec("box_height_m", 1.0, "box")));
  CHECK(effects::is_off(spec("height_m", 0.0, "chair_backs")));
  CHECK(effects::strength_parameter(spec("box_height_m", 1.0, "box")).name == "box_height_m");
  CHECK(effects::strength_parameter({"missing_occluder", {}, {}, {}}).name == "height_m");
}

TEST_CASE("entries are complete and refer to one another by name") {
  std::set<std::string> names;
  for (const Effect* effect : effects::catalogue()) names.insert(effect->info.name);
  CHECK(names.size() == effects::catalogue().size());
  for (const Effect* effect : effects::catalogue()) {
    const effects::EffectInfo& info = effect->info;
    INFO(info.name);
    CHECK_FALSE(info.summary.empty());
    CHECK_FALSE(info.fingerprint.empty());
    CHECK_FALSE(info.stage.empty());
    REQUIRE_FALSE(info.parameters.empty());
    CHECK(info.parameters.front().role == effects::Role::strength);
    for (const std::string& other : info.confused_with) CHECK(names.contains(other));
    CHECK((info.same_as.empty() || effects::info(info.same_as).same_as.empty()));
    for (const effects::ParameterInfo& parameter : info.parameters) {
      INFO(parameter.name);
      CHECK_FALSE(parameter.source.empty());
      const bool is_fixed = parameter.low == parameter.high;
      CHECK((parameter.low < parameter.high || parameter.scale == effects::Scale::whole ||
             (is_fixed && parameter.role == effects::Role::detail)));
      CHECK(parameter.least <= std::min({parameter.low, parameter.off, parameter.typical}));
      CHECK(parameter.most >= std::max({parameter.high, parameter.off, parameter.typical}));
      CHECK((parameter.scale != effects::Scale::logarithmic || parameter.low > 0.0));
      CHECK((parameter.role == effects::Role::strength || parameter.off == parameter.typical));
    }
    const bool rows = effect->make_row_stage != nullptr, triggers = effect->make_stage != nullptr ||
                                                                    effect->make_output_stage != nullptr ||
                                                                    effect->set_clocks != nullptr;
    CHECK((effect->alter != nullptr || rows || triggers));
    CHECK((info.reach == Reach::rows) == rows);
    CHECK((info.reach == Reach::triggers) == triggers);
  }
}

TEST_CASE("faults of the data say what the data look like, and parameters have words for a reader") {
  for (const effects::EffectInfo& info : effects::list()) {
    INFO(info.name);
    CHECK(info.as_if.empty() == (info.family != effects::Family::data));
  }
  const auto phrase = [](const char* effect, std::size_t i) {
    return effects::phrase_of(effects::info(effect).parameters.at(i));
  };
  CHECK(phrase("missed_triggers", 0) == "probability of a miss");
  CHECK(phrase("pulse_stretching", 0) == "hold");
  CHECK(phrase("false_triggers", 0) == "rate");
  CHECK(phrase("warm_object", 4) == "speed");
  CHECK(phrase("clock_lag", 1) == "drift");
  CHECK(phrase("arm_motion", 0) == "amplitude scale");
  CHECK(effects::phrase_of({"there_was", effects::ChoiceKind::variant, {}, {}}, "one_more_than_told") ==
        "there was one more than told");
  CHECK(effects::phrase_of({"sensor", effects::ChoiceKind::sensor, {}, {}}, "PIR_1") == "sensor PIR_1");
}

TEST_CASE("a contrast of temperature is a factor of all ranges but a beam's, its square root") {
  CHECK(effects::info("thermal_contrast").same_as == "range_scale");
  CHECK(effects::twins_of("range_scale") == std::vector<std::string>{"thermal_contrast"});
  const auto ranges_with = [](const EffectSpec& effect) {
    ScriptSpec script;
    script.effects = {effect};
    SceneSpec shipped = shipped_scene("meeting_room.gltf");
    const SensorModelSpec barrier = shipped.sensor_models["barrier"] =
        io::read_sensor_model(test::data("sensors/LIGHT-BARRIER.yaml"));
    SceneSpec scene = effects::in_force(shipped, script).scene;
    CHECK(scene.sensor_models.at("barrier").clusters.at(0).range_m == barrier.clusters.at(0).range_m);
    scene.sensor_models.erase("barrier");
    std::vector<double> ranges;
    for (const auto& [id, model] : scene.sensor_models)
      for (const ClusterSpec& cluster : model.clusters) ranges.push_back(cluster.range_m);
    return ranges;
  };
  const std::vector<double> warm = ranges_with({"thermal_contrast", {{"delta_t_k", 9.0}}, {}, {}});
  const std::vector<double> far = ranges_with({"range_scale", {{"scale", 1.5}}, {}, {}});
  REQUIRE(warm.size() == far.size());
  for (std::size_t i = 0; i < warm.size(); ++i) CHECK(warm[i] == Approx(far[i]));
}
