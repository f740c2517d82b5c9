// A realization with effects on top, however it gets there, against the slow way: a study of its own with these
// effects.
#include <algorithm>

#include "reconcile/ensemble/realization.hpp"
#include "support/catch.hpp"
#include "support/effects.hpp"

using namespace pirsim;
using namespace pirsim::test;
using reconcile::frame_of;
using reconcile::Realization;
using reconcile::RealizationSource;
using reconcile::Series;
using reconcile::SimulatedRealization;
using reconcile::StudyFrame;

namespace {

/// None if people can't get about in it.
std::optional<std::vector<Series>> study_with(const StudyFrame& frame, const Realization& realization,
                                              const std::vector<EffectSpec>& more, int n_replicates) {
  ScriptSpec script = realization.script;
  script.replicates = n_replicates;
  script.effects.insert(script.effects.end(), more.begin(), more.end());
  try {
    std::vector<Series> data;
    for (const RunResult& result : results_of(compile(realization.scene, script))) {
      data.push_back(*series_of(frame, result.replicate, result.trial, result.samples));
    }
    return data;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::infeasible) throw;
    return std::nullopt;
  }
}

constexpr int n_replicates = 2;

/// n_runs: replicates of a study. Two tell that they aren't mistaken for each other.
void check_every_effect(const RealizationSource& source, int n_draws, int n_runs) {
  const StudyFrame frame = frame_of(source.scene, source.script);
  Stream stream({source.seed, 0, 0, Purpose::test});
  const SimulatedRealization realization(source, frame, 3, n_runs);
  CHECK(realization.plain(0, n_runs) == *study_with(frame, realization.drawn(), {}, n_runs));
  for (const effects::Effect* effect : effects::catalogue()) {
    const auto& own = source.script.effects;  // none is looked for a second time
    if (std::ranges::find(own, effect->info.name, &EffectSpec::name) != own.end()) continue;
    for (int draw = 0; draw < n_draws; ++draw) {
      INFO(effect->info.name << ", draw " << draw);
      const EffectSpec spec =
          effects::draw_from_prior(*effect, realization.drawn().scene, realization.drawn().script, stream);
      const auto data = realization.with_effects(std::span(&spec, 1), 0, n_runs);
      CHECK((data == study_with(frame, realization.drawn(), {spec}, n_runs)));
    }
  }
}

}  // namespace

TEST_CASE("a realization with any effect of the catalogue gives the rows of a study with it", "[seconds]") {
  check_every_effect({shipped_scene("meeting_room.gltf"), short_study_a(), {}, 11}, 2, 2);
}

TEST_CASE("the same with several people who keep out of each other's way", "[seconds]") {
  check_every_effect({shipped_scene("open_office.gltf"), short_office(), {}, 12}, 1, 2);
}

TEST_CASE("the same on top of a model that has effects already: soft edges and two elements", "[seconds]") {
  const EffectSpec edges{"soft_zone_edges", {{"sigma_deg", 1.0}}, {}, {}};
  const EffectSpec elements{"dual_polarity", {{"threshold", 0.6}}, {}, {}};
  for (const EffectSpec& own : {edges, elements}) {
    check_every_effect({shipped_scene("meeting_room.gltf"), with(short_study_a(), {own}), {}, 13}, 1, 1);
  }
}

TEST_CASE("the same with analog sensors", "[seconds]") {
  ScriptSpec script = short_study_a();
  script.sensing.response = Response::analog;
  check_every_effect({shipped_scene("meeting_room.gltf"), script, {}, 15}, 1, 1);
}

TEST_CASE("the same with analog sensors and several people, who hide one another", "[seconds]") {
  ScriptSpec script = short_office();
  script.sensing.response = Response::analog;
  check_every_effect({shipped_scene("open_office.gltf"), script, {}, 16}, 1, 1);
}

TEST_CASE("the same where sensors that answer by zones hang beside analog ones", "[seconds]") {
  SceneSpec scene = shipped_scene("meeting_room.gltf");
  SensorModelSpec by_zones = scene.sensor_models.begin()->second;
  by_zones.id = "BY_ZONES";
  by_zones.response = Response::zones;
  scene.sensor_models.emplace(by_zones.id, by_zones);
  scene.sensors[0].model = scene.sensors[3].model = by_zones.id;
  ScriptSpec script = short_study_a();
  script.sensing.response.reset();
  check_every_effect({scene, script, {}, 17}, 1, 1);
}

TEST_CASE("who tried the same few steps round somebody for ever gets past them in the end") {
  // Found in a reference table: a bystander so near a bend of the way that every try ended after 5 cm.
  const RealizationSource source{
      shipped_scene("open_office.gltf"), shipped_script("office.yaml", {"sensing.response=zones"}), {}, 1};
  const StudyFrame frame = frame_of(source.scene, source.script);
  const SimulatedRealization realization(source, frame, 23, n_replicates);
  const auto& all = effects::catalogue();
  const auto second_person =
      std::ranges::find(all, "second_person", [](const auto* effect) { return effect->info.name; });
  const auto place = static_cast<std::uint32_t>(second_person - all.begin());
  Stream stream({source.seed, 23, place, Purpose::reference_parameters});
  const EffectSpec effect =
      effects::draw_from_prior(**second_person, realization.drawn().scene, realization.drawn().script, stream);
  CHECK(realization.with_effects(std::span(&effect, 1), 0, n_replicates).has_value());
}

TEST_CASE("people of the nuisance swing their arms unevenly and sway, unless an effect says how they do") {
  NuisanceSpec nuisance;
  nuisance.uneven_arms = 0.4;
  nuisance.trunk_sway_deg = 2.0;
  const RealizationSource source{shipped_scene("meeting_room.gltf"), short_study_a(), nuisance, 14};
  const StudyFrame frame = frame_of(source.scene, source.script);
  const SimulatedRealization realization(source, frame, 0, n_replicates);
  const std::vector<EffectSpec>& drawn = realization.drawn().script.effects;
  REQUIRE(drawn.size() == 2);
  CHECK(0.0 < drawn[0].parameters.at("spread"));
  CHECK(drawn[0].parameters.at("spread") <= 0.4);
  CHECK(0.0 < drawn[1].parameters.at("amplitude_deg"));
  CHECK(drawn[1].parameters.at("amplitude_deg") <= 2.0);
  CHECK(realization.plain(0, n_replicates) == *study_with(frame, realization.drawn(), {}, n_replicates));

  const SimulatedRealization by_the_metronome({source.scene, source.script, {}, 14}, frame, 0, n_replicates);
  CHECK(realization.drawn().script.seed == by_the_metronome.drawn().script.seed);
  CHECK(realization.plain(0, n_replicates) != by_the_metronome.plain(0, n_replicates));

  const EffectSpec sways{"trunk_sway", {{"amplitude_deg", 6.0}}, {}, {}};
  Realization with_it = realization.drawn();
  with_it.script.effects = {drawn[0]};
  CHECK((realization.with_effects(std::span(&sways, 1), 0, n_replicates) ==
         study_with(frame, with_it, {sways}, n_replicates)));
}
