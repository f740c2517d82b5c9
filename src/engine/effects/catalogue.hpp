// Everything that a plain model is known to leave out, with what carries it out.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/effects/pipeline.hpp"
#include "engine/study/study_in_force.hpp"
#include "pirsim/effects.hpp"
#include "pirsim/random.hpp"

namespace pirsim::effects {

/// Hooks get an EffectSpec with every parameter filled in; null where the effect doesn't act.
struct Effect {
  EffectInfo info;
  void (*alter)(StudyInForce& study, const EffectSpec& effect) = nullptr;
  /// Before a sensor holds its motion: what the element sees, and what the circuit makes of it.
  std::unique_ptr<TriggerStage> (*make_stage)(const EffectSpec& effect, const StageContext& context) = nullptr;
  /// Behind it: what becomes of a sensor's output.
  std::unique_ptr<TriggerStage> (*make_output_stage)(const EffectSpec& effect, const StageContext& context) = nullptr;
  /// Puts the clocks of the sensors that it is for wrong; stages come before.
  void (*set_clocks)(const EffectSpec& effect, const StageContext& context, Clocks& clocks) = nullptr;
  std::unique_ptr<RowStage> (*make_row_stage)(const EffectSpec& effect, const StageContext& context) = nullptr;
  /// Puts what the ranges alone can't draw (a free place in the room) into a spec drawn from them.
  void (*draw)(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec& script, Stream& stream) = nullptr;
  /// Moves parameters that were estimated to what the room has a place for.
  void (*settle)(EffectSpec& effect, const SceneSpec& scene) = nullptr;
  /// Why it can't be meant so in this scene, though every name and number of the script is good; empty: it can.
  std::string (*fault)(const EffectSpec& effect, const SceneSpec& scene) = nullptr;
};

/// In the order in which they act; alter() first, then stages tick by tick, then rows.
[[nodiscard]] const std::vector<const Effect*>& catalogue();
/// Throws Error(usage) with the nearest name.
[[nodiscard]] const Effect& find(std::string_view name);

/// Those that a script has what they need for, as counts of people.
[[nodiscard]] std::vector<const Effect*> catalogue_for(const ScriptSpec& script);
/// Names of the others that change the model in the same way: no data tell them apart.
[[nodiscard]] std::vector<std::string> twins_of(std::string_view name);

/// The study with the effects of `script` applied: alter() of each, in the catalogue's order. Throws Error(input) for
/// what check() finds.
[[nodiscard]] StudyInForce in_force(SceneSpec scene, const ScriptSpec& script);

/// Does any sensor answer by its zones?
[[nodiscard]] bool any_of_zones(const SceneSpec& scene, const SensingSpec& sensing);
/// Whether an effect can change anything there: it acts on a response that some sensor has.
[[nodiscard]] bool means_anything(const EffectInfo& info, const SceneSpec& scene, const SensingSpec& sensing);

/// Whether a parameter of that effect means anything with its choices.
[[nodiscard]] bool applies(const ParameterInfo& parameter, const EffectSpec& effect);
/// The first of an effect's strengths that applies.
[[nodiscard]] const ParameterInfo& strength_parameter(const EffectSpec& effect);
[[nodiscard]] bool is_off(const EffectSpec& effect);
/// With every parameter that applies: those not given take the typical value.
[[nodiscard]] EffectSpec resolved(const Effect& effect, EffectSpec spec);
[[nodiscard]] EffectSpec off(const Effect& effect);
/// Parameters that apply, from their priors; words and variants with even odds; a sensor from all and each (even odds
/// between `all` and one of them).
[[nodiscard]] EffectSpec draw_from_prior(const Effect& effect, const SceneSpec& scene, const ScriptSpec& script,
                                         Stream& stream);

/// An effect whose parameters were estimated, as this scene has room for it: somebody stands in a free place, no sensor
/// hangs in the ceiling.
[[nodiscard]] EffectSpec settled(EffectSpec effect, const SceneSpec& scene);

// The catalogue in words.

/// A parameter for a reader, its unit left out: "probability of a miss", "hold".
[[nodiscard]] std::string phrase_of(const ParameterInfo& parameter);
/// What was chosen, for a reader: "trend growing", "sensor PIR3".
[[nodiscard]] std::string phrase_of(const ChoiceInfo& choice, const std::string& value);
/// A line an effect: name, family, the parameters that are its strength with their range, what it does.
[[nodiscard]] std::string list_text();
/// All that is known of one effect, for a terminal.
[[nodiscard]] std::string to_text(const Effect& effect);
/// All that is known of all effects, as Markdown: what docs/effects.md holds.
[[nodiscard]] std::string list_markdown();

}  // namespace pirsim::effects
