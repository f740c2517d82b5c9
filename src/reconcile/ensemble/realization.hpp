// Realizations: what is uncertain about a room is drawn.
#pragma once

#include <cstdint>
#include <memory>

#include "pirsim/model.hpp"
#include "pirsim/scene.hpp"
#include "pirsim/script.hpp"

namespace pirsim::reconcile {

/// What realizations are drawn from.
struct RealizationSource {
  SceneSpec scene;
  ScriptSpec script;  ///< with the effects that the model already has
  NuisanceSpec nuisance;
  std::uint64_t seed = 0;
  /// The plain model, of which realizations share what is the same in them: lenses, calibrations, the room. It changes
  /// nothing but the time they take; may be null.
  std::shared_ptr<const Model> like{};
};
/// Compiles the plain model for a source; null if people can't get about in it as it is drawn.
[[nodiscard]] std::shared_ptr<const Model> model_to_share(const SceneSpec& scene, const ScriptSpec& script);

/// Scene and script of one dataset: one room, one set of people, one sequence of random choices.
struct Realization {
  SceneSpec scene;
  ScriptSpec script;
};

/// Draws realization `index` of the stream `seed`: seats, sensors, bodies and arms moved as the nuisance says, and a
/// seed of its own for everything random in the simulation. A realization is a pure function of the arguments, so that
/// two effects can be compared in the same realization. A realization that people can't get about in is no room that
/// the data may come from: take the next attempt.
[[nodiscard]] Realization draw_realization(const SceneSpec& scene, const ScriptSpec& script,
                                           const NuisanceSpec& nuisance, std::uint64_t seed, std::uint32_t index,
                                           std::uint32_t attempt = 0);

}  // namespace pirsim::reconcile
