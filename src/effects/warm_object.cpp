// Something warm moves that is no person: a pet, a robot, a fan.
#include <glm/geometric.hpp>

#include "effects/bystander.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::effects {
namespace {

constexpr double clear_m = 0.3;

/// A body like a person's, as large as said: its solids are as wide for their height.
BystanderPlan object(const EffectSpec& effect, const Vec2& place) {
  constexpr double density = 75.0 / (1.75 * 1.75 * 1.75);  // of a person
  constexpr double stouter = 2.0;                          // assumed (1-3): four legs or a casing
  const double height_m = effect.parameters.at("height_m");
  return {.id = "warm object",
          .role = PersonRole::object,
          .stature_m = height_m,
          .mass_kg = stouter * density * height_m * height_m * height_m,
          .speed_m_s = effect.parameters.at("speed_m_s"),
          .place = place,
          .again = {}};
}

void alter(StudyInForce& study, const EffectSpec& effect) {
  const Vec2 place = place_of(effect, study.scene, clear_m);
  BystanderPlan plan = object(effect, place);
  if (word(effect, "moves") == "sweeps") {
    const double heading = radians(effect.parameters.at("heading_deg")), sweep_m = effect.parameters.at("sweep_m");
    plan.again.emplace_back(action::Walk{{place + sweep_m * direction_of(heading)}});
    plan.again.emplace_back(action::Walk{{place}});
  } else {
    const double every_s = effect.parameters.at("every_s");
    for (const Vec2& stop : round_trip(study.scene, clear_m, place)) {
      plan.again.emplace_back(action::Walk{{stop}});
      plan.again.emplace_back(action::Wait{every_s});
    }
  }
  add_bystander(study, plan, effect.where);
}

void draw(EffectSpec& effect, const SceneSpec& scene, const ScriptSpec&, Stream& stream) {
  draw_place(effect, scene, clear_m, stream);
}

void settle(EffectSpec& effect, const SceneSpec& scene) { settle_place(effect, scene, clear_m); }

}  // namespace

const Effect& warm_object() {
  static const Effect effect{
      .info = {.name = "warm_object",
               .family = Family::environment,
               .stage = "placement",
               .summary =
                   "Something warm moves: it roams from one free place to the next, as a pet or a robot does, or "
                   "sweeps in place, as a fan or a curtain over a radiator.",
               .fingerprint = "ones that have to do with a place and not with the person",
               .confused_with = {"trigger_bursts", "second_person", "false_triggers"},
               .parameters =
                   {whether("present", "assumed"), place_coordinate("x_m"), place_coordinate("z_m"),
                    detail("height_m", "m", 0.3, 0.2, 1.2, 0.1, 3.0, "assumed: a cat's to a stand fan's"),
                    detail("speed_m_s", "m/s", 0.3, 0.1, 0.6, 0.02, 2.0, "assumed: a robot's 0.3, a cat's walk 0.6"),
                    detail("every_s", "s", 10.0, 1.0, 60.0, 0.0, 3600.0, "assumed: rests so long at a place",
                           {"moves", "roams"}),
                    detail("sweep_m", "m", 0.3, 0.15, 0.6, 0.05, 5.0, "assumed: so far and back", {"moves", "sweeps"}),
                    detail("heading_deg", "deg", 0.0, -180.0, 180.0, -360.0, 360.0, "any", {"moves", "sweeps"})},
               .choices = {{"moves", ChoiceKind::variant, {"roams", "sweeps"}, "roams"}, place_choice()},
               .reach = Reach::geometry,
               .idle_in = {Survey::coverage, Survey::walk_test}},
      .alter = alter,
      .draw = draw,
      .settle = settle};
  return effect;
}

}  // namespace pirsim::effects
