// Somebody or something warm in the room of whom the script doesn't know.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "effects/kit.hpp"

namespace pirsim::effects {

/// What one of them does, again and again until the longest trial is over.
struct BystanderPlan {
  std::string_view id;  ///< several in one room go by numbers
  PersonRole role = PersonRole::bystander;
  double stature_m = 1.75;
  double mass_kg = 75.0;
  double speed_m_s = 1.2;
  Vec2 place;  ///< where they are at the beginning
  double heading_deg = 0.0;
  std::vector<Action> again{};
};
/// Adds one to every trial.
void add_bystander(StudyInForce& study, const BystanderPlan& plan, const Where& where);

/// Several free places, far from each other, as one walks from the first through the others.
[[nodiscard]] std::vector<Vec2> round_trip(const SceneSpec& scene, double clear_m, const Vec2& from);

// Parameters and hooks of effects that have a place: `place: free` (the one farthest from all seats) or `given`.

[[nodiscard]] ChoiceInfo place_choice();
[[nodiscard]] ParameterInfo place_coordinate(std::string name);
/// Throws Error(infeasible) if it is to be a free one and there is none.
[[nodiscard]] Vec2 place_of(const EffectSpec& effect, const SceneSpec& scene, double clear_m);
void draw_place(EffectSpec& effect, const SceneSpec& scene, double clear_m, Stream& stream);
void settle_place(EffectSpec& effect, const SceneSpec& scene, double clear_m);

}  // namespace pirsim::effects
